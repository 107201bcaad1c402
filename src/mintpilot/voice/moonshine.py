"""Moonshine's tiny English model, run by ONNX Runtime: one text, and the probabilities of short words."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from mintpilot.core.errors import DeviceError
from mintpilot.core.geometry import Floats
from mintpilot.voice.models import MOONSHINE, checked_files
from mintpilot.voice.ports import RATE_HZ, WORDS, Hypothesis, Recogniser

_LEAD_S = 0.25
"""Silence put before and after: the model loses short words at the very edge, seconds."""
_BEGIN, _END = 1, 2
_MARKS = (".", "!", "?")
_TOKENS_A_SECOND, _LEAST_TOKENS = 6.5, 8
"""The model repeats itself when it may write more than somebody can say."""
_HEADS, _HEAD_SIZE = 8, 36
_HARDLY = math.log(0.005)
"""Logarithm of the probability of a first token below which a word is not scored."""


class MoonshineRecogniser(Recogniser):
    """Gives one text, and of each of `mintpilot.voice.ports.WORDS` how likely it is the whole utterance.

    Args:
        threads: of the processor.

    Raises:
        MissingPartError: ``moonshine-voice`` (for its model) or ``onnxruntime`` is not installed.
        InputError: the model is not the pinned one.
    """

    def __init__(self, *, threads: int = 1) -> None:
        folder = checked_files("moonshine_voice", MOONSHINE) / "assets" / "tiny-en"
        checked_files("onnxruntime", {})
        import onnxruntime

        options = onnxruntime.SessionOptions()
        options.intra_op_num_threads, options.inter_op_num_threads = threads, 1
        self._encoder, self._decoder = (
            onnxruntime.InferenceSession(str(folder / name), options, providers=["CPUExecutionProvider"])
            for name in ("encoder_model.ort", "decoder_model_merged.ort")
        )
        self._past = [i.name for i in self._decoder.get_inputs() if i.name.startswith("past")]
        self._pieces = _vocabulary(folder / "tokenizer.bin")
        self._ids = {piece: number for number, piece in enumerate(self._pieces)}
        self._marks = [_END, *(self._ids[mark.encode()] for mark in _MARKS)]
        rows = [(word, text) for word in WORDS for text in (word.capitalize(), word.capitalize() + ",")]
        self._words = [word for word, _ in rows]
        self._said = [self._tokens(text) for _, text in rows]

    def hypotheses(self, samples: Floats) -> tuple[Hypothesis, ...]:
        """See `Recogniser.hypotheses`. The free text comes first; its probability is the mean of its tokens'."""
        quiet = np.zeros(int(_LEAD_S * RATE_HZ))
        sound = np.concatenate([quiet, samples, quiet]).astype(np.float32)[None]
        try:
            encoded = self._encoder.run(None, {"input_values": sound, "attention_mask": np.ones(sound.shape, np.int64)})
            free, firsts = self._free(encoded[0], sound.shape[1])
            words = self._scored(encoded[0], sound.shape[1], firsts) if free else ()
        except Exception as error:  # whatever the library raises, the caller learns of one kind
            raise DeviceError(f"the recogniser Moonshine failed: {error}") from error
        return (*free, *words) if free else ()

    def _free(self, encoded: Floats, length: int) -> tuple[tuple[Hypothesis, ...], Floats]:
        """The text, and the logarithms of the probabilities of its first token (vocabulary,)."""
        tokens, total, firsts = [_BEGIN], 0.0, np.zeros(0)
        for _ in range(_LEAST_TOKENS + int(_TOKENS_A_SECOND * length / RATE_HZ)):
            odds = self._odds(encoded, length, [tokens])[0, -1]
            firsts = odds if len(tokens) == 1 else firsts
            best = int(odds.argmax())
            total += float(odds[best])
            if best == _END:
                break
            tokens.append(best)
        text = b"".join(self._pieces[t] for t in tokens[1:]).decode(errors="replace").replace("▁", " ").strip()
        return ((Hypothesis(text=text, probability=math.exp(total / len(tokens))),) if text else ()), firsts

    def _scored(self, encoded: Floats, length: int, firsts: Floats) -> tuple[Hypothesis, ...]:
        """Each word by itself: the probability of its tokens and of an end after them.

        Words that hardly begin so are left out: no word is likelier than its first token.
        """
        found = dict.fromkeys(WORDS, 0.0)
        likely = [(w, said) for w, said in zip(self._words, self._said, strict=True) if firsts[said[0]] >= _HARDLY]
        if likely:
            longest = max(len(said) for _, said in likely)
            rows = [[_BEGIN, *said, *[_END] * (longest - len(said))] for _, said in likely]
            odds = self._odds(encoded, length, rows)
            for row, (word, said) in enumerate(likely):
                own = sum(float(odds[row, at, token]) for at, token in enumerate(said))
                ends = float(np.exp(odds[row, len(said), self._marks]).sum())
                found[word] += math.exp(own) * ends
        return tuple(Hypothesis(text=word, probability=min(1.0, p)) for word, p in found.items())

    def _odds(self, encoded: Floats, length: int, rows: Sequence[Sequence[int]]) -> Floats:
        """Logarithms of the probabilities of the next token: (rows, tokens, vocabulary)."""
        count = len(rows)
        feed: dict[str, Any] = {
            "encoder_attention_mask": np.ones((count, length), np.int64),
            "input_ids": np.array(rows, np.int64),
            "encoder_hidden_states": np.repeat(encoded, count, axis=0),
            "use_cache_branch": np.array([False]),
        }
        feed |= {name: np.zeros((count, _HEADS, 0, _HEAD_SIZE), np.float32) for name in self._past}
        logits = self._decoder.run(["logits"], feed)[0]
        logits -= logits.max(axis=-1, keepdims=True)
        return np.asarray(logits - np.log(np.exp(logits).sum(axis=-1, keepdims=True)))

    def _tokens(self, text: str) -> list[int]:
        """The longest pieces first; the short words here are cut so by the model itself."""
        left, found = ("▁" + text.replace(" ", "▁")).encode(), []
        while left:
            size = next(n for n in range(len(left), 0, -1) if left[:n] in self._ids)
            found.append(self._ids[left[:size]])
            left = left[size:]
        return found


def _vocabulary(file: Path) -> list[bytes]:
    """Pieces, each after its length: one byte, or two from 128 on."""
    data, at, found = file.read_bytes(), 0, []
    while at < len(data):
        size, at = data[at], at + 1
        if size >= 128:
            size, at = data[at] * 128 + size - 128, at + 1
        found.append(data[at : at + size])
        at += size
    return found
