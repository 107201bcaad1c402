"""What a report says in fixed words is said in the chosen language."""

import re

import pytest

from assembly.test_instruction_missions import written
from mintpilot.assembly.api import run_mission
from mintpilot.assembly.replaying import verify_run
from mintpilot.core.mission import Outcome, Sight
from mintpilot.recording.people import look_line
from mintpilot.recording.record import LookRecord
from mintpilot.recording.report import report_html
from mintpilot.recording.words import OUTCOME_WORDS
from mintpilot.wording.speech import Speech

LANGUAGES = ("en", "de", "fr", "es")


@pytest.mark.parametrize("outcome", list(Outcome))
def test_every_ending_has_words_of_its_own_in_every_language(outcome):
    assert len({Speech(lang)(OUTCOME_WORDS[outcome]) for lang in LANGUAGES}) == len(LANGUAGES)


@pytest.mark.parametrize("result", list(Sight))
def test_every_result_of_a_look_too(result):
    look = LookRecord(n=1, text="x", result=result, what="person", count=2, pictures=(), seen=0.25)
    assert len({look_line(look, lang) for lang in LANGUAGES}) == len(LANGUAGES)


@pytest.mark.long
def test_things_are_called_as_the_file_says_and_the_record_replays_exactly(tmp_path):
    path = written(tmp_path, "Go to the lamp.", truth={"haze": "passable"})
    text = path.read_text()
    described = "{en: the brown haze, de: der Dunst am Tor}"
    box = "{lo_m: [5, 0, 0], hi_m: [7, 8, 1]}"
    region = f"  regions: [{{id: haze, kind: smoke, description: {described}, box: {box}}}]\n"
    path.write_text(text.replace("world:\n", "world:\n" + region))
    record = run_mission(path, vehicle="kinematic", out=tmp_path / "run", lang="de")
    assert [q.text for q in record.questions] == ["Ist der Dunst am Tor zum Durchfliegen sicher?"]
    assert record.language == "de"
    html = report_html(record, tmp_path / "run")
    assert re.search(r"<html lang=\"de\">", html)
    assert Speech("de")(OUTCOME_WORDS[record.outcome]) in html
    assert verify_run(tmp_path / "run").verification.difference is None
