"""Missions by sound alone, heard by the real recognisers: noise, cut and misheard words, and a flood of them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from functools import cache
from typing import Final

import numpy as np

from mintpilot.assembly.components import Choices, VehicleChoice
from mintpilot.assembly.registry import load
from mintpilot.assembly.talk import Talk
from mintpilot.assembly.voiced import WorldKnowledge, hears_here, speech_for
from mintpilot.assembly.worlds import World
from mintpilot.conformance.faults.drawing import Draw
from mintpilot.conformance.faults.faulty_operator import FaultyOperator
from mintpilot.conformance.faults.faulty_source import FaultySource
from mintpilot.conformance.faults.faulty_vehicle import FaultyVehicle
from mintpilot.conformance.faults.kinds import Fault, FaultKind
from mintpilot.conformance.faults.ledger import Ledger
from mintpilot.conformance.faults.stage import Stage
from mintpilot.core.errors import DeviceError
from mintpilot.core.geometry import Floats
from mintpilot.voice.hearing import Ear
from mintpilot.voice.loopback import LoopbackPerson
from mintpilot.voice.operator import VoiceOperator, VoiceParts
from mintpilot.voice.ports import RATE_HZ, Hypothesis, Recogniser, SoundLink, Speech
from mintpilot.voice.rotor import mixed

QUIETEST_DB, LOUDEST_DB = 12.0, -6.0
"""The person's voice over the rotors, from a small fault to a large one."""
BABBLE: Final = ("yes", "no", "confirm", "stop", "land", "say again", "the kettle is on", "one two three four")
MISHEARD: Final = ("yes", "no", "confirm", "stop", "land", "say again", "", "box two")
FLOODED_S: Final = 3.0
"""Between two bursts of a flood, seconds."""


@contextmanager
def on_voice(draw: Draw, world: World, ledger: Ledger, talk: Talk) -> Iterator[Stage]:
    """The kinematic simulator, and a person who takes part by sound alone."""
    calm, ear = replace(draw, faults=()), hears_here()
    speech = Words(speech_for("en"))
    knowledge, rng = WorldKnowledge(world, talk), draw.rng

    def reply(heard: str) -> str | None:
        words = knowledge(heard)
        wrong = draw.first(FaultKind.OPERATOR_WRONG)
        if words is not None and wrong is not None and wrong.is_on(ledger.now_s):
            words = {"yes": "no", "no": "yes"}.get(words, words)
        if words is not None:
            ledger.spoken.append((ledger.now_s, words))
        return words

    person = LoopbackPerson(ear=ear.first, voice=speech, reply=reply, rng=rng)
    hears = Ear(first=Mishearing(ear.first, draw, ledger), second=ear.second)
    parts = VoiceParts(
        speech=speech,
        ear=hears,
        activity=load("activity", "silero")(),
        link=FaultySound(person, speech, draw, ledger),
    )
    operator = VoiceOperator(parts, understand=talk.understand, order_of=talk.order_of, is_patient=True)
    try:
        yield Stage(
            choices=Choices(vehicle=VehicleChoice.KINEMATIC),
            operators=(FaultyOperator(operator, calm, ledger),),
            beset=lambda made: replace(
                made,
                vehicle=FaultyVehicle(made.vehicle, calm, ledger),
                map_source=FaultySource(made.map_source, calm, ledger),
            ),
        )
    finally:
        operator.close()


class Words(Speech):
    """Says each text once, and keeps the sound: as files would."""

    languages = ("en",)

    def __init__(self, speech: Speech) -> None:
        self._say = cache(speech.say)

    def say(self, text: str, *, lang: str = "en", speed: float = 1.0) -> Floats:  # noqa: ARG002
        """See `Speech.say`."""
        return self._say(text)


class Mishearing(Recogniser):
    """A recogniser that takes words for others while that is drawn. The other one does not: both must agree.

    Args:
        inner: the true one.
        draw: which faults come.
        ledger: knows the time.
    """

    def __init__(self, inner: Recogniser, draw: Draw, ledger: Ledger) -> None:
        self._inner, self._fault, self._ledger = inner, draw.first(FaultKind.MISHEARD), ledger
        self._rng = np.random.default_rng([draw.number, 23])

    def hypotheses(self, samples: Floats) -> tuple[Hypothesis, ...]:
        """See `Recogniser.hypotheses`."""
        fault = self._fault
        if fault is None or not fault.is_on(self._ledger.now_s) or self._rng.random() > 0.3 + 0.7 * fault.size:
            return self._inner.hypotheses(samples)
        word = MISHEARD[int(self._rng.integers(len(MISHEARD)))]
        return (Hypothesis(text=word, probability=1.0),) if word else ()


class FaultySound(SoundLink):
    """The microphone: noisy, cutting words off, hearing them twice, flooded, or gone.

    Args:
        inner: the person at the other end.
        speech: says what others say.
        draw: which faults come.
        ledger: knows the time; is told when the microphone is gone.
    """

    def __init__(self, inner: SoundLink, speech: Speech, draw: Draw, ledger: Ledger) -> None:
        self._inner, self._speech, self._draw, self._ledger = inner, speech, draw, ledger
        self._rng = np.random.default_rng([draw.number, 29])
        self._next_s = 0.0

    def play(self, samples: Floats, time_s: float) -> None:
        """See `SoundLink.play`."""
        self._inner.play(samples, time_s)

    def stop(self) -> None:
        """See `SoundLink.stop`."""
        self._inner.stop()

    def is_playing(self, time_s: float) -> bool:
        """See `SoundLink.is_playing`."""
        return self._inner.is_playing(time_s)

    def listen(self, time_s: float) -> Sequence[Floats]:
        """What the microphone makes of it."""
        if self._on(FaultKind.OPERATOR_GONE) is not None:
            self._ledger.tell(FaultKind.OPERATOR_GONE)
            raise DeviceError("the microphone is gone")
        pieces = [self._bent(piece) for piece in self._inner.listen(time_s)]
        if self._on(FaultKind.DOUBLED) is not None:
            pieces = [piece for piece in pieces for _ in range(2)]
        flood = self._on(FaultKind.FLOODING)
        if flood is not None and self._ledger.now_s >= self._next_s:
            self._next_s = self._ledger.now_s + FLOODED_S * (1.5 - flood.size)
            pieces += self._babble(1 + int(flood.size * 6))
        return pieces

    def close(self) -> None:
        """See `SoundLink.close`."""
        self._inner.close()

    def _bent(self, sound: Floats) -> Floats:
        cut, noise = self._on(FaultKind.TRUNCATED), self._on(FaultKind.NOISE)
        if cut is not None:
            loud = np.flatnonzero(np.abs(sound) > 0.02)
            if len(loud):
                at = int(loud[0] + (loud[-1] - loud[0]) * float(self._rng.uniform(0.1, 0.9)))
                sound = sound[:at] if self._rng.random() < 0.5 else sound[at:]
        if noise is not None and len(sound):
            sound = mixed(sound, QUIETEST_DB + (LOUDEST_DB - QUIETEST_DB) * noise.size, self._rng)
        return sound

    def _babble(self, count: int) -> list[Floats]:
        """Words that nobody was asked for, in pieces of any length, some of which are no sound."""
        quiet = np.zeros(RATE_HZ // 2)
        said = [BABBLE[int(i)] for i in self._rng.integers(len(BABBLE), size=count)]
        self._ledger.spoken += [(self._ledger.now_s, words) for words in said]
        sound = np.concatenate([part for words in said for part in (self._speech.say(f"{words}."), quiet)])
        strange = (np.zeros(0), np.full(700, np.nan), np.full(1600, np.inf), np.ones(3200))
        return [sound, strange[int(self._rng.integers(len(strange)))]]

    def _on(self, kind: FaultKind) -> Fault | None:
        fault = self._draw.first(kind)
        return fault if fault is not None and fault.is_on(self._ledger.now_s) else None
