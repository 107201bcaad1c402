"""Who was found, and who is said to be there, as the short form, the terminal and the report have it."""

from __future__ import annotations

import io
import json

import pytest
from rich.console import Console

from mintpilot.recording.build import build_record
from mintpilot.recording.history import History
from mintpilot.recording.record import MissionRecord, SeenRecord
from mintpilot.recording.report import report_html
from mintpilot.recording.run_summary import summary
from mintpilot.recording.terminal_report import print_report


def seen(id: str, kind: str, state: str, view=None) -> SeenRecord:
    return SeenRecord(id=id, kind=kind, description=id, position_m=(1.0, 2.0, 0.1), state=state, view=view)


@pytest.fixture
def record() -> MissionRecord:
    things = (
        seen("person-1", "object", "person", (12, 3, 4, 30, 40)),
        seen("person-2", "object", "person", (7, 3, 4, 30, 40)),
        seen("thing-1", "object", "object", (9, 3, 4, 30, 40)),
        seen("room-1", "room", "yes", (9, 3, 4, 30, 40)),
        seen("room-2", "room", "no"),
        seen("room-3", "room", "open"),
        seen("smoke-1", "region", "yes"),
    )
    return build_record(History()).model_copy(update={"seen": things, "run_dir": "runs/one"})


def test_people_seen_are_counted_with_their_best_pictures(record):
    assert json.loads(summary(record).model_dump_json())["people"] == {
        "found": 2,
        "reported": 1,
        "pictures": ["frames/00012.jpg", "frames/00007.jpg"],
    }


def test_no_picture_is_named_where_none_was_kept(record):
    assert summary(record.model_copy(update={"run_dir": ""})).people.pictures == ()


def test_the_terminal_and_the_report_say_so(record, tmp_path):
    out = io.StringIO()
    print_report(record, Console(file=out, width=100))
    assert "2 people seen: frames/00012.jpg, frames/00007.jpg" in out.getvalue()
    assert "somebody is inside of 1 room, by what was answered" in out.getvalue()
    html = report_html(record, tmp_path)
    assert "2 people seen" in html
    assert "Somebody is inside of 1 room" in html


def test_nobody_is_no_line(record, tmp_path):
    empty = record.model_copy(update={"seen": ()})
    out = io.StringIO()
    print_report(empty, Console(file=out, width=100))
    assert "seen:" not in out.getvalue()
    assert summary(empty).people.found == summary(empty).people.reported == 0
