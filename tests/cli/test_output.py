"""What commands put out: their text, and the words while a mission is flown."""

from __future__ import annotations

from pathlib import Path

import pytest

from mintpilot import run_mission
from mintpilot.cli.output import put
from mintpilot.cli.progress import told
from mintpilot.core.errors import RecordError
from mintpilot.core.events import Event, LegFlown, PlanChosen

EXAMPLE = Path(__file__).parents[2] / "examples" / "my-building" / "mission.yaml"


def test_text_is_printed_or_written(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    put("a line\n", None)
    assert capsys.readouterr().out == "a line\n"
    put("a line\n", tmp_path / "new" / "file.txt")
    assert (tmp_path / "new" / "file.txt").read_text("utf-8") == "a line\n"
    assert capsys.readouterr().out.strip().endswith("file.txt")
    with pytest.raises(RecordError, match="choose another file with --out"):
        put("x", tmp_path)


def test_a_flight_is_told_by_what_is_done_there_and_not_by_ids() -> None:
    events: list[Event] = []
    run_mission(EXAMPLE, vehicle="kinematic", progress=events.append)
    plans = [e.plan for e in events if isinstance(e, PlanChosen) and e.plan is not None]
    stops = {leg.stop.id: leg.stop.text for plan in plans for leg in plan.legs}
    flown = [e for e in events if isinstance(e, LegFlown) and e.phase == "mission"]
    assert flown
    for event in flown:
        line, _ = told(event, stops)
        assert str(stops[event.stop_id]) in str(line)
        assert event.stop_id not in str(line)
