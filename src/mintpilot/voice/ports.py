"""What the voice operator needs: somebody who speaks, somebody who recognises, and a way for sound in and out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

from mintpilot.core.geometry import Floats

RATE_HZ = 16_000
"""Samples a second of all sound in this room: one channel, floating point, full scale 1."""


WORDS = ("yes", "yeah", "no", "confirm", "confirmed", "stop", "land")
"""Short words that recognisers which can score a given text give a probability of, each as the whole utterance."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Hypothesis:
    """One thing that may have been said."""

    text: str
    probability: float
    """0 to 1, as far as the recogniser's scores can be relied on."""


class Speech(Protocol):
    """Makes sound of text."""

    @property
    def languages(self) -> tuple[str, ...]:
        """The languages that it speaks, e.g. ``("en", "de")``."""
        ...

    def say(self, text: str, *, lang: str = "en", speed: float = 1.0) -> Floats:
        """The samples (n,) at `RATE_HZ`. May take a second; called on a thread of its own.

        Args:
            text: what is said.
            lang: one of `languages`.
            speed: 1 is usual, 2 twice as fast.

        Raises:
            DeviceError: it failed.
        """
        ...


class Recogniser(Protocol):
    """Makes text of the sound of one utterance."""

    def hypotheses(self, samples: Floats) -> tuple[Hypothesis, ...]:
        """What may have been said; none where nothing was recognised. Called on a thread of its own.

        First the text that is recognised freely, then other texts with their probabilities, in any order: those of
        `WORDS`, where the recogniser can score them.

        Args:
            samples: (n,) at `RATE_HZ`, finite, -1 to 1.

        Raises:
            DeviceError: it failed.
        """
        ...


class Activity(Protocol):
    """Tells speech from other sound."""

    @property
    def window(self) -> int:
        """How many samples are judged at a time."""
        ...

    def probability(self, samples: Floats) -> float:
        """How likely there is speech in the next ``window`` samples, 0 to 1."""
        ...


class SoundLink(Protocol):
    """Sound out and in. No method waits for a device."""

    def play(self, samples: Floats, time_s: float) -> None:
        """Begins to play, after what is still playing. ``time_s``: the mission clock, seconds."""
        ...

    def stop(self) -> None:
        """Ends what is playing at once."""
        ...

    def is_playing(self, time_s: float) -> bool:
        """Whether something is heard of it at this moment of the mission clock."""
        ...

    def listen(self, time_s: float) -> Sequence[Floats]:
        """What the microphone took since the last call, without the echo of what is played; in pieces of any length.

        Raises:
            DeviceError: the microphone is gone.
        """
        ...

    def close(self) -> None:
        """Gives the device back. Safe to call again."""
        ...
