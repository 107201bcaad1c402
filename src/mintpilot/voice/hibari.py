"""The English voice "heart" of hibari: 8 MB, under Apache-2.0, a fiftieth of real time on one core."""

from __future__ import annotations

import re

import numpy as np

from mintpilot.core.errors import DeviceError
from mintpilot.core.geometry import Floats
from mintpilot.voice.audio import resampled, trimmed
from mintpilot.voice.models import HIBARI, checked_files
from mintpilot.voice.ports import Speech

LONGEST = 1000
"""Longest text, characters; more is cut off."""
_NO = re.compile(r"\bno\.", re.IGNORECASE)
"""Would be said as "number"."""


class HibariSpeech(Speech):
    """A text always sounds the same.

    Raises:
        MissingPartError: the package ``hibari-tts`` is not installed.
        InputError: its model is not the pinned one.
    """

    languages = ("en",)

    def __init__(self) -> None:
        model = checked_files("hibari", HIBARI) / next(iter(HIBARI))
        from hibari import SAMPLE_RATE, Hibari

        self._voice, self._rate_hz = Hibari(model=str(model)), SAMPLE_RATE
        self.say("Ready.")  # its rules of spelling are loaded now, not with the first question

    def say(self, text: str, *, lang: str = "en", speed: float = 1.0) -> Floats:
        """See `Speech.say`."""
        if lang not in self.languages:
            raise DeviceError(f"hibari does not speak '{lang}'; it speaks English")
        try:
            made = self._voice(_NO.sub("no!", text[:LONGEST]), speed=min(2.0, max(0.5, speed)), seed=0)
        except Exception as error:  # whatever the library raises, the caller learns of one kind
            raise DeviceError(f"speech by hibari failed: {error}") from error
        return trimmed(resampled(np.asarray(made, float), self._rate_hz))
