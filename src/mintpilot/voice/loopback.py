"""A simulated person at the other end of the sound: hears the question, knows the truth, answers aloud over rotors."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from mintpilot.core.geometry import Floats
from mintpilot.voice.ports import RATE_HZ, Recogniser, SoundLink, Speech
from mintpilot.voice.rotor import mixed

_AFTER_S = 0.8
"""Silence that the microphone takes after an answer, seconds."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Conditions:
    """How it is to talk there."""

    snr_db: float | None = None
    """The person's voice over the rotors, decibels; None: no rotors."""
    reaction_s: float = 1.0
    """From the end of what was heard to the answer, seconds."""


class LoopbackPerson(SoundLink):
    """Sound out goes to a simulated person, whose voice comes back through rotor noise.

    The person is never told which question is open: only what was heard decides.

    Args:
        ear: what the person hears is recognised by this.
        voice: how the person speaks.
        reply: the person's answer to heard words, from what they know of the world; None: says nothing.
        rng: of the noise.
        conditions: noise and reaction.

    Attributes:
        heard: what the person understood, oldest first.
        said: what the person answered, oldest first.
        sound_s: seconds of speech, both ways, and of reaction, up to the last answer.
    """

    def __init__(
        self,
        *,
        ear: Recogniser,
        voice: Speech,
        reply: Callable[[str], str | None],
        rng: np.random.Generator,
        conditions: Conditions = Conditions(),
    ) -> None:
        self._ear, self._voice, self._reply = ear, voice, reply
        self._rng, self._conditions = rng, conditions
        self._until_s = -np.inf
        self._due: list[tuple[float, Floats]] = []
        self.heard: list[str] = []
        self.said: list[str] = []
        self.sound_s = self._unanswered_s = 0.0

    def play(self, samples: Floats, time_s: float) -> None:
        """The person listens to the end, and answers after a moment."""
        begins_s = max(time_s, self._until_s)
        self._until_s = begins_s + len(samples) / RATE_HZ
        self._unanswered_s += len(samples) / RATE_HZ
        found = self._ear.hypotheses(samples)
        words = found[0].text if found else ""
        self.heard.append(words)
        answer = self._reply(words)
        if answer is None:
            return
        self.said.append(answer)
        spoken = self._voice.say(answer)
        quiet = np.zeros(int(_AFTER_S * RATE_HZ))
        sound = np.concatenate([quiet[: len(quiet) // 2], spoken, quiet])
        if self._conditions.snr_db is not None:
            sound = _over_rotors(sound, spoken, self._conditions.snr_db, self._rng)
        self.sound_s += self._unanswered_s + self._conditions.reaction_s + len(spoken) / RATE_HZ
        self._unanswered_s = 0.0
        self._due.append((self._until_s + self._conditions.reaction_s + len(sound) / RATE_HZ, sound))

    def stop(self) -> None:
        """The rest is not heard; what the person made of it so far stands."""
        self._until_s = -np.inf

    def is_playing(self, time_s: float) -> bool:
        """See `SoundLink.is_playing`."""
        return time_s < self._until_s

    def listen(self, time_s: float) -> Sequence[Floats]:
        """The person's answers that have been said by now."""
        due = [sound for until_s, sound in self._due if until_s <= time_s]
        self._due = [waiting for waiting in self._due if waiting[0] > time_s]
        return due

    def close(self) -> None:
        """Nothing to give back."""


def _over_rotors(sound: Floats, spoken: Floats, snr_db: float, rng: np.random.Generator) -> Floats:
    """Rotors run before, during and after the answer; the ratio is that of the words alone."""
    share = float(np.mean(np.square(spoken)) / max(float(np.mean(np.square(sound))), 1e-12))
    return mixed(sound, snr_db - 10 * float(np.log10(max(share, 1e-12))), rng)


def alike(heard: str, meant: str) -> float:
    """How much of either text is in the other: shared words over all, 0 to 1."""
    ours, theirs = (set(re.findall(r"[a-z0-9]+", text.casefold())) for text in (heard, meant))
    return len(ours & theirs) / max(1, len(ours | theirs))
