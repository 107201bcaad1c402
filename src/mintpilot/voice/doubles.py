"""Doubles: speech and recognition by a table of sounds instead of models, for tests and for trying a mission out."""

from __future__ import annotations

import zlib
from collections.abc import Iterable

import numpy as np

from mintpilot.core.geometry import Floats
from mintpilot.voice.ports import RATE_HZ, Activity, Hypothesis, Recogniser, Speech

_SECONDS = 0.5
"""Every text sounds as long as this."""
_LOUD = 0.1
"""Root mean square of the double's sounds."""
_SURE = 0.35
"""Least correlation with a sound of the table; that of other sounds stays below 0.1."""


class SpeechDouble(Speech):
    """Says each text as a burst of noise of its own, always the same; nobody but `RecogniserDouble` understands it."""

    languages = ("en", "de", "fr", "es")

    def say(self, text: str, *, lang: str = "en", speed: float = 1.0) -> Floats:  # noqa: ARG002
        """See `Speech.say`; all texts are equally long."""
        rng = np.random.default_rng(zlib.crc32(text.encode()))
        return _LOUD * rng.standard_normal(int(_SECONDS * RATE_HZ))


class RecogniserDouble(Recogniser):
    """Knows the sounds that `SpeechDouble` makes of some texts.

    Args:
        texts: those that it knows.
        heard_as: text → what it takes that for instead.
    """

    def __init__(self, texts: Iterable[str], heard_as: dict[str, str] | None = None) -> None:
        speech, taken = SpeechDouble(), heard_as or {}
        self._sounds = [(taken.get(text, text), speech.say(text)) for text in dict.fromkeys(texts)]

    def hypotheses(self, samples: Floats) -> tuple[Hypothesis, ...]:
        """See `Recogniser.hypotheses`: the probability is the correlation with the sound of the table."""
        from scipy.signal import fftconvolve

        found = []
        for text, sound in self._sounds:
            if len(samples) < len(sound):
                continue
            match = np.abs(fftconvolve(samples, sound[::-1], "valid"))
            energy = np.square(samples).cumsum()
            within = energy[len(sound) - 1 :] - np.concatenate([[0.0], energy[: -len(sound)]])
            score = float((match / np.sqrt(np.maximum(within, 1e-9) * float(sound @ sound))).max())
            if score >= _SURE:
                found.append(Hypothesis(text=text, probability=min(1.0, score)))
        return tuple(sorted(found, key=lambda h: -h.probability))


class ActivityDouble(Activity):
    """Takes everything for speech that is loud enough.

    Args:
        least: root mean square from which sound is speech.
    """

    window = 512

    def __init__(self, least: float = 0.05) -> None:
        self._least = least

    def probability(self, samples: Floats) -> float:
        """1 for loud windows, 0 for others."""
        return float(np.sqrt(np.mean(np.square(samples))) >= self._least)
