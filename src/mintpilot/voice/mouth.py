"""What is said next: by priority, synthesised on a thread of its own, kept for the next time."""

from __future__ import annotations

import re
from collections import OrderedDict
from collections.abc import Mapping
from concurrent.futures import Future, ThreadPoolExecutor
from concurrent.futures import TimeoutError as NotYet
from dataclasses import dataclass
from enum import IntEnum

import numpy as np

from mintpilot.core.errors import MintPilotError
from mintpilot.core.geometry import Floats
from mintpilot.voice.audio import clean
from mintpilot.voice.ports import RATE_HZ, SoundLink, Speech

_KEPT = 64
"""Texts whose sound is kept."""
_WAITING = 8
"""Notices that wait; more are shown only."""
MUTED_S = 0.6
"""What is not said aloud takes so long to read at least: what is said meanwhile does not answer it, seconds."""
_UNITS: Mapping[str, tuple[str, str]] = {
    "en": ("seconds", "metres"),
    "de": ("Sekunden", "Meter"),
    "fr": ("secondes", "mètres"),
    "es": ("segundos", "metros"),
}
"""How ``s`` and ``m`` are said."""
SYNTHESIS_S = 10.0
"""Speech that takes longer to make is given up: the caption stands, seconds."""


class Priority(IntEnum):
    """What is said before what."""

    ORDER = 0
    QUESTION = 1
    NOTICE = 2


@dataclass(frozen=True, slots=True, kw_only=True)
class Said:
    """A text that is to be said."""

    text: str
    priority: Priority
    question: str = ""
    """Id of the question that it asks or reads back."""


@dataclass(slots=True, kw_only=True)
class VoiceSettings:
    """How it sounds; may be changed at any time."""

    volume: float = 1.0
    """0 to 1."""
    speed: float = 1.0
    """1 is usual, 2 twice as fast."""
    muted: bool = False
    """Silence is said; captions remain."""


def aloud(text: str, lang: str) -> str:
    """A text with its units as they are said: ``3 s`` as ``3 seconds``."""
    for short, word in zip(("s", "m"), _UNITS.get(lang, ()), strict=False):
        text = re.sub(rf"(?<=\d) {short}\b(?!/)", f" {word}", text)
    return text


class Mouth:
    """Speaks one text after another. Never waits, unless it is told to.

    Args:
        speech: makes the sound; None: there are captions only.
        link: plays it.
        settings: volume, speed, mute.
        lang: of the texts.
        is_patient: whether `speak` waits until the sound is made: where time is simulated.
    """

    def __init__(
        self, speech: Speech | None, link: SoundLink, settings: VoiceSettings, *, lang: str, is_patient: bool
    ) -> None:
        self._speech, self._link, self._settings = speech, link, settings
        self._lang, self._is_patient = lang, is_patient
        self._waiting: list[Said] = []
        self._making: tuple[Said, Future[Floats], float] | None = None
        self._playing: Said | None = None
        self._kept: OrderedDict[tuple[str, float], Floats] = OrderedDict()
        self._pool = ThreadPoolExecutor(1, thread_name_prefix="mintpilot speech")

    def will_say(self, question: str) -> bool:
        """Whether something of that question is being said, or waits to be."""
        now = (self._making[0] if self._making is not None else None, self._playing, *self._waiting)
        return any(said is not None and said.question == question for said in now)

    def interrupt(self) -> None:
        """Stops what is playing; it does not count as said."""
        self._link.stop()
        self._playing = None

    def say(self, said: Said) -> None:
        """Says it when its turn has come; an order's text at once. The oldest of too many notices is left out."""
        if said.priority is Priority.ORDER:
            self.hush()
        notices = [waiting for waiting in self._waiting if waiting.priority is Priority.NOTICE]
        if len(notices) >= _WAITING:
            self._waiting.remove(notices[0])
        self._waiting.append(said)
        self._waiting.sort(key=lambda waiting: waiting.priority)

    def hush(self, question: str | None = None) -> None:
        """Stops at once, and forgets what waits: everything, or what belongs to that question."""
        self._waiting = [s for s in self._waiting if question is not None and s.question != question]
        if self._making is not None and question in (None, self._making[0].question):
            self._making = None
        if self._playing is not None and question in (None, self._playing.question):
            self._link.stop()
            self._playing = None

    def speak(self, time_s: float) -> list[Said]:
        """Goes on speaking; gives what has just been said to its end (or could not be said: its caption stands)."""
        ended: list[Said] = []
        if self._playing is not None and not self._link.is_playing(time_s):
            ended.append(self._playing)
            self._playing = None
        if self._making is None and self._playing is None and self._waiting:
            said = self._waiting.pop(0)
            self._making = (said, self._pool.submit(self._made, said.text, self._settings.speed), time_s)
        if self._making is not None:
            ended += self._play(*self._making, time_s)
        return ended

    def close(self) -> None:
        """Says nothing more."""
        self.hush()
        self._pool.shutdown(wait=False, cancel_futures=True)

    def _play(self, said: Said, made: Future[Floats], since_s: float, time_s: float) -> list[Said]:
        try:
            samples = made.result(timeout=SYNTHESIS_S if self._is_patient else 0)
        except NotYet:
            if not self._is_patient and time_s - since_s < SYNTHESIS_S:
                return []
            self._making = None
            return [said]
        except MintPilotError:
            self._making = None
            return [said]
        self._making, self._playing = None, said
        self._link.play(np.clip(self._settings.volume, 0.0, 1.0) * samples, time_s)
        return []

    def _made(self, text: str, speed: float) -> Floats:
        if self._settings.muted or self._speech is None:
            return np.zeros(int(MUTED_S * RATE_HZ))
        key = (text, speed)
        if key not in self._kept:
            self._kept[key] = clean(self._speech.say(aloud(text, self._lang), lang=self._lang, speed=speed))
            while len(self._kept) > _KEPT:
                self._kept.popitem(last=False)
        self._kept.move_to_end(key)
        return self._kept[key]
