"""A room that is flown to has a result: found, empty, or it could not be seen; and what is not known is not done."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from assembly.test_instruction_missions import written
from mintpilot.assembly.api import run_mission
from mintpilot.core.geometry import Box, GridFrame
from mintpilot.core.mission import Outcome, Sight
from mintpilot.core.semantic_map import Cell, Room, SemanticMap
from mintpilot.mission.sights import seen_share
from mintpilot.recording.people import look_line
from mintpilot.recording.record import MissionRecord, read_record
from mintpilot.recording.report import report_html
from mintpilot.recording.run_summary import summary
from mintpilot.simulation.judge import SceneJudge


def flown(tmp_path: Path, instruction: str, **truth: str) -> MissionRecord:
    return run_mission(written(tmp_path, instruction, truth=truth), vehicle="kinematic", out=tmp_path / "run")


@pytest.mark.long
@pytest.mark.parametrize(
    ("instruction", "truth", "result", "words"),
    [
        ("Is there anybody in the garage?", {"garage": "present"}, Sight.FOUND, "found 1 person"),
        ("Is there anybody in the garage?", {"garage": "absent"}, Sight.EMPTY, "nobody is there"),
        ("Search the garage for the wrench.", {"garage": "present"}, Sight.EMPTY, "no wrench was seen there"),
        ("Look into the garage.", {"garage": "present"}, Sight.FOUND, "found 1 person"),
    ],
)
def test_what_a_look_came_to_is_told_everywhere(
    tmp_path: Path, instruction: str, truth: dict[str, str], result: Sight, words: str
) -> None:
    record = flown(tmp_path, instruction, **truth)
    assert record.outcome is Outcome.SUCCESS
    (look,) = record.looks
    assert (look.result, look.n) == (result, 1)
    assert look_line(look).endswith(words)
    assert json.loads(summary(record).model_dump_json())["looks"][0]["result"] == result.value
    assert words in report_html(record, tmp_path / "run")
    assert read_record(tmp_path / "run").looks == record.looks


@pytest.mark.long
def test_a_room_that_cannot_be_seen_accomplishes_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(SceneJudge, "view", lambda *_: None)  # as beside a real vehicle: the map alone tells
    record = flown(tmp_path, "Look into the garage and go to the lamp.", garage="present")
    assert record.outcome is Outcome.PARTIAL
    assert [one.text for one in record.achieved] == ["go to the lamp"]
    (left,) = record.left
    assert (left.n, left.resource) == (1, "sight")
    assert "0% of its doorway" in left.reason


@pytest.mark.parametrize(("behind", "share"), [(Cell.FREE, 1.0), (Cell.UNKNOWN, 0.0), (Cell.OCCUPIED, 0.0)])
def test_how_much_was_seen_is_counted_behind_the_door(behind: Cell, share: float) -> None:
    frame = GridFrame(origin_m=(0.0, 0.0, 0.0), resolution_m=0.25, shape=(8, 40, 40))
    cells = np.full(frame.shape, Cell.FREE, np.uint8)
    cells[:, 20:, :] = behind
    door = Box(lo_m=(4.5, 4.9, 0.0), hi_m=(5.5, 5.0, 2.0))
    room = Room(id="r", door_m=door, viewpoint_m=(5.0, 4.0, 1.0))
    assert seen_share(SemanticMap(frame=frame, cells=cells), room) == share
    half = cells.copy()
    half[:, 20:, :20] = Cell.UNKNOWN
    seen = seen_share(SemanticMap(frame=frame, cells=half), room)
    assert 0.3 < seen < 0.7 if share else seen == 0.0
