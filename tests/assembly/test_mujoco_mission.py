"""One whole mission with physics and camera: surveyed, asked about, flown, recorded."""

from __future__ import annotations

import pytest

from mintpilot.assembly.api import run_mission
from mintpilot.assembly.replaying import verify_run
from mintpilot.cli.demos import demo_mission
from mintpilot.core.mission import Outcome
from mintpilot.recording.record import read_record

pytestmark = [pytest.mark.sim, pytest.mark.xdist_group("mission")]


@pytest.fixture(scope="module")
def flown(tmp_path_factory):
    pytest.importorskip("mujoco")
    out = tmp_path_factory.mktemp("mission") / "run"
    return run_mission(demo_mission("medicine"), vehicle="mujoco", seed=0, out=out), out


@pytest.mark.long
def test_the_right_box_is_found_by_asking_and_brought(flown):
    record, _ = flown
    assert record.outcome is Outcome.SUCCESS, record.reason
    assert record.questions
    assert all(gap.startswith("target:") for question in record.questions for gap in question.gaps)
    assert all(question.reply.value in ("yes", "no") for question in record.questions)
    asked = [gap for gap in record.gaps if gap.asked]
    assert asked
    assert asked[0].entropy_bits > 1


@pytest.mark.long
def test_the_rotors_keep_to_the_planned_way(flown):
    flight = flown[0].flight
    assert 0 < flight.rms_error_m < 0.15
    assert flight.flown_m == pytest.approx(flight.planned_m, rel=0.15)


@pytest.mark.long
def test_the_survey_was_flown_and_pictures_were_looked_at(flown):
    record, _ = flown
    assert record.survey is not None
    assert record.survey.flown_m > 5
    assert record.frames > 10
    assert any(seen.kind == "object" for seen in record.seen)


@pytest.mark.long
def test_the_run_folder_tells_it_all(flown):
    record, out = flown
    names = {path.name for path in out.iterdir()}
    wanted = {"record.json", "report.html", "events.ndjson", "config.json", "frames", "topdown.svg", "topdown.png"}
    assert wanted | {"tree.txt", "tree.json", "tree.svg", "tree.dot"} <= names
    assert list((out / "frames").glob("*.jpg"))
    assert read_record(out) == record
    report = (out / "report.html").read_text(encoding="utf-8")
    assert record.questions[0].text in report
    assert "data:image/jpeg;base64," in report  # the pictures are inside: one file to hand on


def test_it_is_thought_through_again_and_equal(flown):
    done = verify_run(flown[1])
    assert done.verification.difference is None
    assert done.verification.steps > 100
    seconds = flown[0].flight.seconds + flown[0].survey.seconds
    size = (flown[1] / "events.ndjson").stat().st_size
    assert size / seconds * 60 < 2_000_000, "bytes a minute of flight"
