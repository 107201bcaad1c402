"""A whole mission by sound alone, with doubles for speech and recognition."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from mintpilot.assembly.api import run_mission
from mintpilot.assembly.talk import Talk
from mintpilot.assembly.voiced import LoopbackParts, loopback_operator
from mintpilot.assembly.worlds import build_world
from mintpilot.core.geometry import Floats
from mintpilot.mission_file.reader import read_mission
from mintpilot.recording.record import MissionRecord
from mintpilot.voice.doubles import ActivityDouble, RecogniserDouble, SpeechDouble
from mintpilot.voice.hearing import Ear
from mintpilot.voice.loopback import Conditions, LoopbackPerson
from mintpilot.voice.operator import VoiceOperator
from mintpilot.voice.ports import Hypothesis, Recogniser

MEDICINE = Path("examples/medicine.yaml")
SAYS = ("yes", "no", "confirm", "say again")


class Voice(SpeechDouble):
    """The drone's voice; keeps what it said, so that a person may know the words."""

    def __init__(self) -> None:
        self.spoken: list[str] = []

    def say(self, text: str, *, lang: str = "en", speed: float = 1.0) -> Floats:
        self.spoken.append(text)
        return super().say(text, lang=lang, speed=speed)


class PersonsEar(Recogniser):
    """Knows the words that the drone uses, and tells them by their sound alone."""

    def __init__(self, voice: Voice) -> None:
        self._voice = voice

    def hypotheses(self, samples: Floats) -> tuple[Hypothesis, ...]:
        return RecogniserDouble(self._voice.spoken).hypotheses(samples)


def fly(
    seed: int, *, snr_db: float | None = None, second: RecogniserDouble | None = None
) -> tuple[MissionRecord, LoopbackPerson]:
    made: list[tuple[VoiceOperator, LoopbackPerson]] = []
    voice = Voice()

    def operator(talk: Talk) -> VoiceOperator:
        world = build_world(read_mission(MEDICINE), base=MEDICINE.parent, seed=seed, parse=talk.parse)
        parts = LoopbackParts(
            speech=voice,
            ear=Ear(first=RecogniserDouble(SAYS), second=second or RecogniserDouble(SAYS)),
            activity=ActivityDouble(0.08),
            person_hears=PersonsEar(voice),
            person_speaks=SpeechDouble(),
        )
        rng = np.random.default_rng(seed)
        made.append(loopback_operator(world, talk, parts, rng=rng, conditions=Conditions(snr_db=snr_db)))
        return made[0][0]

    try:
        record = run_mission(MEDICINE, operator=operator, vehicle="kinematic", seed=seed)
    finally:
        made[0][0].close()
    return record, made[0][1]


@pytest.mark.long
@pytest.mark.parametrize("snr_db", [None, 10.0])
def test_the_medicine_is_delivered_by_sound_alone(snr_db: float | None) -> None:
    record, person = fly(3, snr_db=snr_db)
    assert record.outcome.value == "success", (person.heard, person.said)
    assert person.said.count("confirm") >= 1
    assert set(person.said) <= {"yes", "no", "confirm"}


def test_a_second_recogniser_that_hears_no_for_yes_and_yes_for_no_lets_nothing_through() -> None:
    veto = RecogniserDouble(SAYS, {"yes": "no", "no": "yes"})
    record, person = fly(3, second=veto)
    assert "confirm" not in person.said
    assert record.outcome.value != "success"
