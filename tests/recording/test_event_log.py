"""The event log on a real disk: exact, whole after any kill, and honest about what was done to it."""

from __future__ import annotations

import contextlib
import dataclasses
import hashlib
import json
import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from mintpilot.conformance.recorder import sample_events
from mintpilot.core import events as ev
from mintpilot.core.errors import RecordError
from mintpilot.core.observation import Frame
from mintpilot.recording.event_log import EVENTS_SCHEMA_VERSION, EventLogWriter, read_event_log

from .conftest import tell
from .values import differences, replaced

TORTURE = settings(
    max_examples=80, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow]
)


def write(path: Path, events: tuple[Any, ...] | None = None, *, close: bool = True) -> Path:
    writer = EventLogWriter(path, program="9.9", clock=lambda: 1000.25)
    for event in tell() if events is None else events:
        writer.append(event)
    if close:
        writer.close()
    return path


@pytest.fixture(scope="module")
def told() -> bytes:
    """A whole log of the small mission."""
    import tempfile

    with tempfile.TemporaryDirectory() as folder:
        return write(Path(folder) / "log").read_bytes()


def chained(*lines: dict[str, Any]) -> bytes:
    """Lines as a careful forger makes them: each with the chain that belongs to it."""
    last, out = b"", b""
    for fields in lines:
        body = json.dumps(fields).encode()[:-1]
        last = hashlib.blake2b(last + body, digest_size=16).hexdigest().encode()
        out += body + b',"chain":"' + last + b'"}\n'
    return out


HEADER = {"format": "mintpilot-events", "schema_version": EVENTS_SCHEMA_VERSION, "program": "9.9", "at_s": 0.0}


def seen(event: Any) -> Any:
    """What the log keeps of an event: all but the picture."""
    if not isinstance(event, ev.FrameSeen):
        return event
    frame = event.frame
    rgb, depth = frame.rgb * 0, frame.depth_m * float("nan")
    return dataclasses.replace(event, frame=dataclasses.replace(frame, rgb=rgb, depth_m=depth))


def test_a_mission_comes_back_to_the_last_bit(tmp_path):
    events = tell()
    log = read_event_log(write(tmp_path / "events.ndjson"))
    back = list(log)
    assert [b.number for b in back] == list(range(1, len(events) + 1))
    assert {b.at_s for b in back} == {1000.25}
    for event, logged in zip(events, back, strict=True):
        assert differences(seen(event), logged.event) == []
    assert (log.program, log.begun_s, log.cut, log.lost) == ("9.9", 1000.25, "", 0)
    assert list(read_event_log(tmp_path))[-1].number == len(events), "a run folder will do; a log can be read again"


def test_a_flown_mission_comes_back_to_the_last_bit(tmp_path):
    events = sample_events()
    write(tmp_path / "log", events)
    for event, logged in zip(events, read_event_log(tmp_path / "log"), strict=True):
        assert differences(seen(event), logged.event) == []


def test_pictures_are_not_in_the_log(tmp_path):
    size = write(tmp_path / "log", tuple(e for e in tell() if isinstance(e, ev.FrameSeen))).stat().st_size
    assert size / 12 < 1200
    (frame,) = {type(e.event.frame) for e in read_event_log(tmp_path / "log")}  # type: ignore[union-attr]
    assert frame is Frame


def test_a_map_and_a_plan_that_did_not_change_cost_next_to_nothing(tmp_path):
    events = tell()
    once = write(tmp_path / "a", events).stat().st_size
    deliberated = next(e for e in events if isinstance(e, ev.Deliberated))
    thrice = write(tmp_path / "b", (*events, deliberated, deliberated)).stat().st_size
    assert (thrice - once) / 2 < 7000


def test_a_log_is_never_overwritten(tmp_path):
    write(tmp_path / "log")
    with pytest.raises(RecordError, match="File exists; give a new file"):
        EventLogWriter(tmp_path / "log")


def test_an_event_that_cannot_be_written_leaves_the_log_sound(tmp_path):
    writer = EventLogWriter(tmp_path / "log")
    events = tell()
    for event in events:
        writer.append(event)
    with pytest.raises(RecordError, match=r"Timed\.seconds: 'long'"):
        writer.append(ev.Timed(stage="x", seconds="long"))  # type: ignore[arg-type]
    for event in events:
        writer.append(event)
    writer.close()
    log = read_event_log(tmp_path / "log")
    assert [type(e.event) for e in log] == [type(e) for e in events * 2]
    assert (log.lost, log.cut) == (1, "")


def test_a_disk_that_fails_in_the_middle_of_a_line_leaves_the_log_sound(tmp_path, monkeypatch):
    events = tell()
    writer = EventLogWriter(tmp_path / "log")
    true_write = os.write
    for number, event in enumerate(events):

        def half(file: int, data: bytes) -> int:
            true_write(file, data[: len(data) // 2])
            raise OSError(28, "No space left on device")

        if number % 3 == 1:
            with monkeypatch.context() as patch:
                patch.setattr(os, "write", half)
                with pytest.raises(OSError, match="No space"):
                    writer.append(event)
        else:
            writer.append(event)
    writer.close()
    log = read_event_log(tmp_path / "log")
    kept = [e for number, e in enumerate(events) if number % 3 != 1]
    for event, logged in zip(kept, log, strict=True):
        assert differences(seen(event), logged.event) == []
    assert log.lost == len(events) - len(kept)
    assert not log.cut


CHILD = """
import sys
sys.path.insert(0, {here!r})
from pathlib import Path
from conftest import tell
from mintpilot.recording.event_log import EventLogWriter
events = tell()
writer = EventLogWriter(Path({path!r}))
print("ready", flush=True)
while True:
    for event in events:
        writer.append(event)
"""


@pytest.mark.long
@pytest.mark.parametrize("seed", range(3))
def test_a_killed_writer_leaves_every_event_that_it_had_written(tmp_path, seed):
    code = CHILD.format(here=str(Path(__file__).parent), path=str(tmp_path / "log"))
    process = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE)
    assert process.stdout is not None
    assert process.stdout.readline() == b"ready\n"
    time.sleep(random.Random(seed).uniform(0.0, 0.15))
    os.kill(process.pid, signal.SIGKILL)
    process.wait()
    process.stdout.close()
    events = tell()
    log = read_event_log(tmp_path / "log")
    for number, logged in enumerate(log):
        assert logged.number == number + 1
        assert type(logged.event) is type(events[number % len(events)])
    assert "killed" in log.cut
    assert (tmp_path / "log").read_bytes().count(b"\n") - 1 == sum(1 for _ in log)


@pytest.mark.long
@TORTURE
@given(st.data())
def test_a_torn_tail_is_readable_up_to_the_cut_and_said(tmp_path, told, data):
    length = data.draw(st.integers(told.index(b"\n") + 1, len(told) - 1))
    (tmp_path / "log").write_bytes(told[:length])
    log = read_event_log(tmp_path / "log")
    whole = told[:length].count(b"\n") - 1
    assert sum(1 for _ in log) == whole
    assert "its first line" in log.cut if whole == 0 else f"after event {whole}" in log.cut
    assert ("not written to its end" in log.cut) == (told[length - 1 : length] != b"\n")


def damaged(lines: list[bytes], kind: str, at: int) -> list[bytes]:
    if kind == "edited":
        return [*lines[:at], lines[at].replace(b"1000.25", b"1000.26", 1), *lines[at + 1 :]]
    if kind == "removed":
        return lines[:at] + lines[at + 1 :]
    if kind == "doubled":
        return [*lines[:at], lines[at], *lines[at:]]
    return [*lines[:at], lines[at + 1], lines[at], *lines[at + 2 :]]


@pytest.mark.long
@pytest.mark.parametrize("kind", ["edited", "removed", "doubled", "swapped"])
def test_changed_lines_are_found_and_named(tmp_path, told, kind):
    lines = told.splitlines(keepends=True)
    for at in range(1, len(lines) - 1):
        (tmp_path / "log").write_bytes(b"".join(damaged(lines, kind, at)))
        found: list[int] = []
        with pytest.raises(RecordError) as error:
            found.extend(e.number for e in read_event_log(tmp_path / "log"))
        place = at + 2 if kind == "doubled" else at + 1
        assert f"line {place} " in str(error.value)
        assert "restore the file" in str(error.value)
        assert found == list(range(1, place - 1)), "what stands before it is read"


def test_an_edited_first_line_and_a_line_after_the_end_are_found(tmp_path, told):
    (tmp_path / "log").write_bytes(told.replace(b'"9.9"', b'"9.8"', 1))
    with pytest.raises(RecordError, match="line 1 was changed"):
        read_event_log(tmp_path / "log")
    (tmp_path / "log").write_bytes(told + b"{}\n")
    with pytest.raises(RecordError, match="after the closing line"):
        list(read_event_log(tmp_path / "log"))


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", "holds no event"),
        (b'{"event":"MissionStarted","number":0,"at_s":1.0}\n', "older version: readable as a report, not replayable"),
        (
            chained({**HEADER, "schema_version": EVENTS_SCHEMA_VERSION + 1}),
            rf"schema version {EVENTS_SCHEMA_VERSION + 1}, this program reads {EVENTS_SCHEMA_VERSION}; "
            r"read it with MintPilot '9\.9'",
        ),
        (b"\xff\xfe nonsense\n", "is not an event log of MintPilot"),
        (b'{"format":"other"}\n', "is not an event log"),
        (b'{"format":"mintpilot-ev', "is not an event log"),
        (b"[" * 100_000, "is not an event log"),
    ],
)
def test_foreign_older_and_newer_files_are_refused_by_name(tmp_path, content, message):
    (tmp_path / "log").write_bytes(content)
    with pytest.raises(RecordError, match=message):
        read_event_log(tmp_path / "log")


def test_a_file_that_is_not_there_or_no_file(tmp_path):
    with pytest.raises(RecordError, match="cannot read the events"):
        read_event_log(tmp_path / "nowhere")
    (tmp_path / "events.ndjson").mkdir()
    with pytest.raises(RecordError, match="cannot read the events"):
        read_event_log(tmp_path)


def test_a_forged_line_names_the_event_and_the_rule(tmp_path):
    good = {"number": 1, "at_s": 0.0, "event": {"type": "Timed", "stage": "x", "seconds": 1.0}}
    bad = [
        (
            {**good, "event": {"type": "Timed", "stage": "x", "seconds": "1"}},
            r"line 2 \(event 1\): Timed\.seconds: '1'",
        ),
        ({**good, "event": {"type": "Exec", "code": "x"}}, "the 'type' is one of MissionStarted"),
        ({**good, "number": 0}, "numbers ascend"),
        ({**good, "extra": 1}, "was not written by MintPilot"),
    ]
    for line, message in bad:
        (tmp_path / "log").write_bytes(chained(HEADER, line))
        with pytest.raises(RecordError, match=message):
            list(read_event_log(tmp_path / "log"))
    (tmp_path / "log").write_bytes(chained(HEADER, good))
    assert [e.number for e in read_event_log(tmp_path / "log")] == [1]


def test_a_map_that_does_not_fit_its_digest_names_the_event(tmp_path, told):
    lines = [json.loads(line) for line in told.splitlines()]
    for line in lines:
        del line["chain"]
    at = next(i for i, line in enumerate(lines) if "delta" in line.get("event", {}).get("map", {}))
    lines[at]["event"]["map"]["delta"]["regions"]["set"][0]["passable"] = "yes"
    (tmp_path / "log").write_bytes(chained(*lines))
    with pytest.raises(RecordError, match=rf"line {at + 1} \(event {at}\): MapUpdated\.map: the map's digest"):
        list(read_event_log(tmp_path / "log"))


def test_endless_lines_are_refused(tmp_path, monkeypatch):
    monkeypatch.setattr("mintpilot.recording.event_log.MAX_LINE_BYTES", 5000)
    (tmp_path / "log").write_bytes(chained(HEADER) + b"x" * 6000)
    with pytest.raises(RecordError, match="line 2 is longer than 5000 bytes"):
        list(read_event_log(tmp_path / "log"))


@TORTURE
@given(st.binary(max_size=300))
def test_any_bytes_are_refused(tmp_path, content):
    (tmp_path / "log").write_bytes(content)
    with pytest.raises(RecordError):
        list(read_event_log(tmp_path / "log"))


@pytest.mark.long
@TORTURE
@given(st.data())
def test_changed_bytes_never_raise_anything_else_nor_give_other_events(tmp_path, told, data):
    content = bytearray(told)
    for _ in range(data.draw(st.integers(1, 3))):
        at = data.draw(st.integers(0, len(content) - 1))
        content[at : at + data.draw(st.integers(0, 3))] = data.draw(st.binary(max_size=3))
    (tmp_path / "log").write_bytes(bytes(content))
    events = tell()
    with contextlib.suppress(RecordError):
        for event, logged in zip(events, read_event_log(tmp_path / "log"), strict=False):
            assert differences(seen(event), logged.event) == []


@pytest.mark.long
@TORTURE
@given(st.data())
def test_forged_lines_never_raise_anything_else(tmp_path, told, data):
    lines = [json.loads(line) for line in told.splitlines()]
    for line in lines:
        del line["chain"]
    at = data.draw(st.integers(0, len(lines) - 1))
    forged = replaced(lines[at], data)
    lines[at] = forged if isinstance(forged, dict) else {"x": forged}
    (tmp_path / "log").write_bytes(chained(*lines))
    with contextlib.suppress(RecordError):
        list(read_event_log(tmp_path / "log"))
