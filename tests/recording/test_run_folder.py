"""The run folder on a real disk: whole, cut short, killed, full, refused."""

from __future__ import annotations

import io
import json
import os
import resource
import signal
import subprocess
import sys
from dataclasses import replace
from datetime import UTC, datetime
from itertools import pairwise
from pathlib import Path

import pytest
from PIL import Image
from rich.console import Console

from mintpilot.core.errors import RecordError
from mintpilot.core.events import Deliberated, LegFlown, MapUpdated, PlanChosen
from mintpilot.core.mission import Outcome
from mintpilot.recording.event_log import read_event_log
from mintpilot.recording.record import read_record
from mintpilot.recording.recorders import MemoryRecorder, NullRecorder, TeeRecorder
from mintpilot.recording.run_folder import RunFolder, new_run_path
from mintpilot.recording.terminal_report import print_report

HERE = Path(__file__).parent
CHILD = """
import resource, signal, sys
sys.path.insert(0, {here!r})
from pathlib import Path
from conftest import tell
from mintpilot.recording.run_folder import RunFolder
{before}
folder = RunFolder(Path({path!r}))
{after}
for event in tell():
    folder.record(event)
{end}
"""


def child(path: Path, *, before: str = "", after: str = "", end: str = "") -> subprocess.Popen[bytes]:
    code = CHILD.format(here=str(HERE), path=str(path), before=before, after=after, end=end)
    return subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE)


@pytest.mark.long
def test_a_finished_mission_leaves_everything(tmp_path, make_events):
    with RunFolder(tmp_path / "run", clock=lambda: 1000.0) as folder:
        for event in make_events():
            folder.record(event)
    record = folder.close()
    names = {p.name for p in folder.path.iterdir()}
    assert names >= {
        "config.json",
        "events.ndjson",
        "record.json",
        "report.html",
        "topdown.svg",
        "topdown.png",
        "frames",
    }
    assert names >= {"tree.txt", "tree.json", "tree.svg", "tree.dot"}
    assert not [name for name in names if name.endswith(".part")]
    assert read_record(folder.path) == record
    assert record.outcome is Outcome.SUCCESS
    assert record.complete
    assert [n.kind for n in record.notices] == ["new-object"], "nothing failed to be written or drawn"
    with Image.open(folder.path / "topdown.png") as plot:
        assert min(plot.size) > 300


FOLLOWS_FROM_STEPS = (MapUpdated, Deliberated, PlanChosen, LegFlown)
"""The steps hold the same: it is not written a second time."""


@pytest.mark.long
def test_events_are_on_disk_as_they_happen(tmp_path, make_events):
    folder = RunFolder(tmp_path)
    count = 0
    for event in make_events():
        folder.record(event)
        written = list(read_event_log(tmp_path))
        if isinstance(event, FOLLOWS_FROM_STEPS):
            assert len(written) == count
            continue
        count += 1
        assert [e.number for e in written] == list(range(1, count + 1))
        assert type(written[-1].event) is type(event)
    folder.close()


@pytest.mark.long
def test_a_killed_program_loses_no_event(tmp_path, make_events):
    process = child(tmp_path / "run", end="print('told', flush=True)\nsignal.pause()")
    assert process.stdout is not None
    assert process.stdout.readline() == b"told\n"
    os.kill(process.pid, signal.SIGKILL)
    process.wait()
    process.stdout.close()
    told = [event for event in make_events() if not isinstance(event, FOLLOWS_FROM_STEPS)]
    log = read_event_log(tmp_path / "run")
    assert [type(e.event) for e in log] == [type(event) for event in told]
    assert f"after event {len(told)}: still running, killed" in log.cut
    assert read_record(tmp_path / "run").outcome is Outcome.SUCCESS
    assert list((tmp_path / "run" / "frames").glob("*.jpg"))


@pytest.mark.long
def test_a_record_is_there_while_the_mission_runs(tmp_path, make_events):
    folder = RunFolder(tmp_path)
    for event in make_events()[:-1]:
        folder.record(event)
    record = read_record(tmp_path)
    assert record.outcome is Outcome.ABORTED
    assert not record.complete
    assert record.questions[0].reply.value == "no"
    folder.close()


@pytest.mark.long
@pytest.mark.parametrize(
    ("error", "reason"),
    [(KeyboardInterrupt(), "Ctrl-C"), (RuntimeError("motor 3 stands still"), "motor 3 stands still")],
)
def test_ctrl_c_and_crashes_leave_a_readable_folder(tmp_path, make_events, error, reason):
    folder = RunFolder(tmp_path)
    for event in make_events(ended=False):
        folder.record(event)
    with pytest.raises(type(error)), folder:
        raise error
    record = read_record(tmp_path)
    assert record.outcome is Outcome.ABORTED
    assert reason in record.reason
    assert reason in (tmp_path / "report.html").read_text("utf-8")


def test_a_folder_closed_before_anything_happened_is_readable(tmp_path):
    assert RunFolder(tmp_path).close() == read_record(tmp_path)


@pytest.mark.long
def test_a_full_disk_is_noted_and_the_mission_goes_on(tmp_path):
    """A real limit of the operating system on the size of files: writing beyond it fails half-way through a line."""
    limit = "signal.signal(signal.SIGXFSZ, signal.SIG_IGN)\nresource.setrlimit(resource.RLIMIT_FSIZE, (6000, {hard}))"
    hard = resource.getrlimit(resource.RLIMIT_FSIZE)[1]
    freed = f"resource.setrlimit(resource.RLIMIT_FSIZE, ({hard}, {hard}))"
    again = f"{freed}\nfor event in tell()[:3]: folder.record(event)\nfolder.close()"
    process = child(tmp_path / "run", after=limit.format(hard=hard), end=again)
    assert process.communicate(timeout=60)[0] == b""
    assert process.returncode == 0
    log = read_event_log(tmp_path / "run")
    numbers = [e.number for e in log]
    assert len(numbers) > 5
    assert not log.cut
    assert log.lost == numbers[-1] - len(numbers)
    assert any(b - a > 1 for a, b in pairwise(numbers)), "the gap shows in the numbers"
    assert numbers[-3:] == [numbers[-1] - 2, numbers[-1] - 1, numbers[-1]]
    notices = {n.kind: n.text for n in read_record(tmp_path / "run").notices}
    assert "could not be written" in notices["record-incomplete"]


@pytest.mark.long
def test_what_the_disk_does_not_take_whole_is_not_there_at_all(tmp_path):
    """The limit comes back before the drawings: neither half a report nor an empty one is left, and none is named."""
    hard = resource.getrlimit(resource.RLIMIT_FSIZE)[1]
    full = f"signal.signal(signal.SIGXFSZ, signal.SIG_IGN)\nresource.setrlimit(resource.RLIMIT_FSIZE, (30000, {hard}))"
    process = child(tmp_path / "run", end=f"{full}\nfolder.close()")
    assert process.communicate(timeout=60)[0] == b""
    record = read_record(tmp_path / "run")
    (lost,) = [n.text for n in record.notices if n.kind == "record-incomplete"]
    assert "report.html (File too large)" in lost
    left = {p.name for p in (tmp_path / "run").iterdir()}
    assert "report.html" not in left
    assert "tree.txt" in left
    assert all(p.stat().st_size for p in (tmp_path / "run").iterdir() if p.is_file())
    told = io.StringIO()
    print_report(record, Console(width=100, file=told))
    assert "What it flew" in told.getvalue()
    assert "Report:" not in told.getvalue()


def test_a_folder_that_cannot_be_written_is_refused_before_the_mission(tmp_path):
    file = tmp_path / "file"
    file.write_text("x")
    with pytest.raises(RecordError, match=r"cannot write the run folder.*give a folder"):
        RunFolder(file / "run")


def test_a_second_run_does_not_overwrite_the_first(tmp_path):
    RunFolder(tmp_path).close()
    with pytest.raises(RecordError, match="holds a run already"):
        RunFolder(tmp_path)


def test_the_given_configuration_is_kept(tmp_path):
    RunFolder(tmp_path, config={"mintpilot": 1, "seed": 3}).close()
    assert json.loads((tmp_path / "config.json").read_text()) == {"mintpilot": 1, "seed": 3}


@pytest.mark.long
def test_pictures_are_bounded_and_those_that_prove_something_stay(tmp_path, make_events):
    told = make_events()
    frame = next(e for e in told if type(e).__name__ == "FrameSeen")
    folder = RunFolder(tmp_path)
    for event in told:
        folder.record(event)
    for index in range(12, 40):
        folder.record(type(frame)(index=index, frame=frame.frame, detections=()))
    record = folder.close()
    kept = {int(p.stem) for p in (tmp_path / "frames").iterdir()}
    proofs = {seen.view[0] for seen in record.seen if seen.view}
    assert proofs <= kept
    assert len(kept) <= len(proofs) + 8


def test_new_paths_are_new_and_safe(tmp_path):
    now = datetime(2026, 1, 2, 3, 4, 5, tzinfo=UTC)
    first = new_run_path(tmp_path, "../Fire, warehouse?", now)
    assert first == tmp_path / "2026-01-02T03-04-05-fire--warehouse"
    first.mkdir()
    assert new_run_path(tmp_path, "../Fire, warehouse?", now).name.endswith("-2")


def test_recorders_without_a_disk(make_events):
    memory, other = MemoryRecorder(), MemoryRecorder()
    tee = TeeRecorder(memory, NullRecorder(), other)
    told = make_events()
    for event in told:
        tee.record(event)
    assert tuple(memory.events) == tuple(other.events) == told


def test_the_first_picture_at_a_stop_that_asks_for_one_is_kept_by_its_name(tmp_path, make_events):
    told = make_events()
    frame = next(e for e in told if type(e).__name__ == "FrameSeen")
    leg = next(e for e in told if type(e).__name__ == "LegFlown")
    with RunFolder(tmp_path) as folder:
        for event in (frame, replace(leg, stop_id="photograph:2:box-1"), frame, frame, replace(leg, stop_id="go:3")):
            folder.record(event)
    assert [p.name for p in (tmp_path / "photographs").iterdir()] == ["photograph-2-box-1.jpg"]
