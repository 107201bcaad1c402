"""The lossless record of a mission's events: ``events.ndjson``, from which a mission can be re-thought.

One line an event, written through at once. The first line names the schema's version, the last one says that the log
was closed. What an event may hold is decided by its type hints alone: a class that joins the union
`mintpilot.core.events.Event` is recorded without further code.

Maps are written as differences (`mintpilot.recording.map_deltas`), plans once (`mintpilot.recording.shared_plans`).
Pictures are not in the log: a frame keeps its time, pose and camera model, and is read with black pixels and no depth.
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import IO

from pydantic import JsonValue

from mintpilot.core.errors import MintPilotError, RecordError
from mintpilot.core.events import Event
from mintpilot.recording.codec_parts import shown
from mintpilot.recording.event_codec import EventCodec
from mintpilot.recording.event_lines import MAX_LINE_BYTES, opened, plain_json, sealed

EVENTS_FILE = "events.ndjson"
EVENTS_SCHEMA_VERSION = 6
"""Of the log; raised when a field is added without a default, renamed or removed. Version 1 was lossy."""
_FORMAT = "mintpilot-events"


@dataclass(frozen=True, slots=True, kw_only=True)
class LoggedEvent:
    """One event as it stands in the log."""

    number: int
    """Counts all events of the mission, from 1; a gap shows events that could not be written."""
    at_s: float
    """When it was recorded, seconds since 1970."""
    event: Event


class EventLogWriter:
    """Appends events to a new log. A line is in the operating system's hands when `append` returns.

    Args:
        path: the file; refused where it exists.
        program: version of the program, for messages of later readers.
        clock: wall-clock seconds since 1970.

    Raises:
        RecordError: the file cannot be made, or exists.
    """

    def __init__(self, path: Path, *, program: str = "", clock: Callable[[], float] = time.time) -> None:
        self._clock = clock
        self._codec = EventCodec()
        self._number = 0
        self._end = (0, b"")
        header: dict[str, JsonValue] = {
            "format": _FORMAT,
            "schema_version": EVENTS_SCHEMA_VERSION,
            "program": program,
            "at_s": clock(),
        }
        try:
            self._file = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_APPEND, 0o644)
            self._write(header)
        except OSError as error:
            raise RecordError(f"cannot write the events {path}: {error.strerror}; give a new file") from error

    def append(self, event: Event) -> None:
        """Writes one event. After a failure the log is as it was before, and the next event may be written.

        Raises:
            RecordError: the event holds what has no exact form, or is too large.
            OSError: the disk does not take it.
        """
        self._number += 1
        try:
            self._write({"number": self._number, "at_s": self._clock(), "event": self._codec.encode(event)})
        except BaseException:  # Ctrl-C as well: the next event must not build on one that is not there
            self._codec.forget()
            raise

    def close(self) -> None:
        """Writes the closing line and closes the file; a second call does nothing.

        Raises:
            OSError: the disk does not take the line. The file is closed all the same.
        """
        if self._file < 0:
            return
        try:
            self._write({"closed": True, "events": self._number, "at_s": self._clock()})
        finally:
            os.close(self._file)
            self._file = -1

    def _write(self, fields: dict[str, JsonValue]) -> None:
        size, last = self._end
        if os.fstat(self._file).st_size != size:  # the line before was not written to its end
            os.ftruncate(self._file, size)
        line, chain = sealed(fields, last)
        rest = memoryview(line)
        while rest:
            rest = rest[os.write(self._file, rest) :]
        self._end = (size + len(line), chain)


def read_event_log(path: Path) -> EventLog:
    """The log of a run folder, or in that file; also of a mission that is still running or was killed.

    Raises:
        RecordError: it cannot be read, is no event log, or was written by an older or a newer version of MintPilot.
    """
    return EventLog(path / EVENTS_FILE if path.is_dir() else path)


class EventLog:
    """The events of a log, oldest first; each loop reads the file anew and holds one line at a time.

    Looping raises `RecordError` at the first line that was changed, removed, moved or put in, with its number; what
    stands before it has been given by then.

    Attributes:
        path: the file.
        program: version of MintPilot that wrote it.
        begun_s: when it was begun, seconds since 1970.
        cut: after a loop, one sentence on where and how the log ends before its closing line; empty for a whole one.
        lost: after a loop, how many events could not be written in flight.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self.cut = ""
        self.lost = 0
        with _Lines(path) as lines:
            header = lines.header()
        self.program = str(header.get("program", ""))
        begun = header.get("at_s")
        self.begun_s = begun if isinstance(begun, int | float) else 0.0

    def __iter__(self) -> Iterator[LoggedEvent]:
        self.cut, self.lost = "", 0
        codec, expected = EventCodec(), 1
        with _Lines(self.path) as lines:
            lines.header()
            while (fields := lines.next(expected)) is not None:
                if "closed" in fields:
                    count = fields.get("events")
                    self.lost += count - expected + 1 if type(count) is int else 0
                    lines.finish()
                    return
                logged = _logged(fields, codec, expected, lines.place)
                self.lost += logged.number - expected
                expected = logged.number + 1
                yield logged
            self.cut = lines.cut


def _logged(fields: dict[str, JsonValue], codec: EventCodec, expected: int, place: str) -> LoggedEvent:
    number, at_s = fields.get("number"), fields.get("at_s")
    if fields.keys() != {"number", "at_s", "event"} or type(number) is not int or not isinstance(at_s, int | float):
        raise RecordError(
            f"{place}: an event has a number, a time and its fields; this line was not written by MintPilot"
        )
    if number < expected:
        raise RecordError(f"{place}: event {number} stands after event {expected - 1}; numbers ascend")
    try:
        return LoggedEvent(number=number, at_s=at_s, event=codec.decode(fields["event"]))
    except MintPilotError as error:
        raise RecordError(f"{place} (event {number}): {error}") from error


class _Lines:
    """Lines of one log, checked against their chain; a context manager that closes the file."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._number = 0
        self._chain = b""
        self.cut = ""
        try:
            self._file: IO[bytes] = path.open("rb")
        except OSError as error:
            raise RecordError(f"cannot read the events {path}: {error.strerror}; give a run folder") from error

    def __enter__(self) -> _Lines:
        return self

    def __exit__(self, *_: object) -> None:
        self._file.close()

    @property
    def place(self) -> str:
        """Of the line that was read last."""
        return f"{self._path}, line {self._number}"

    def header(self) -> dict[str, JsonValue]:
        """The first line. Raises `RecordError` where it is not that of a log that this program reads."""
        line = self._line()
        if not line.strip():
            raise RecordError(f"{self._path} holds no event: the mission was ended before the first one")
        fields = plain_json(line)
        if fields is not None and "event" in fields and "number" in fields and "format" not in fields:
            raise RecordError(f"{self._path} was flown with an older version: readable as a report, not replayable")
        if fields is None or fields.get("format") != _FORMAT:
            raise RecordError(f"{self._path} is not an event log of MintPilot: give a run folder or its {EVENTS_FILE}")
        version = fields.get("schema_version")
        if version != EVENTS_SCHEMA_VERSION:
            raise RecordError(
                f"{self._path}: schema version {shown(version)}, this program reads {EVENTS_SCHEMA_VERSION}; "
                f"read it with MintPilot {shown(fields.get('program'))}, which wrote it"
            )
        return self._checked(line, "was changed after it was written")

    def next(self, expected: int) -> dict[str, JsonValue] | None:
        """The next line; None at the end of a log that was not closed, and `cut` says so.

        Args:
            expected: number of the event that should stand there, for the message where it does not.
        """
        line = self._line()
        if not line.endswith(b"\n"):
            where = f"event {expected - 1}" if expected > 1 else "its first line"
            torn = f", and line {self._number} was not written to its end" if line else ""
            self.cut = f"the log ends after {where}{torn}: still running, killed, or cut off"
            return None
        return self._checked(line, _damage(line, expected))

    def finish(self) -> None:
        """Nothing stands after the closing line. Raises `RecordError` where something does."""
        if self._line():
            raise RecordError(f"{self.place} stands after the closing line: it was put in; remove it")

    def _checked(self, line: bytes, damage: str) -> dict[str, JsonValue]:
        held = opened(line.removesuffix(b"\n"), self._chain)
        if held is None:
            raise RecordError(f"{self.place} {damage}: restore the file")
        fields, self._chain = held
        return fields

    def _line(self) -> bytes:
        self._number += 1
        try:
            line = self._file.readline(MAX_LINE_BYTES + 1)
        except OSError as error:
            raise RecordError(f"cannot read the events {self._path}: {error.strerror}; give a run folder") from error
        if len(line) > MAX_LINE_BYTES:
            raise RecordError(f"{self.place} is longer than {MAX_LINE_BYTES} bytes: not written by MintPilot")
        return line


def _damage(line: bytes, expected: int) -> str:
    fields = plain_json(line)
    number = None if fields is None else fields.get("number")
    if type(number) is int and number != expected:
        return f"holds event {number} where event {expected} was written: lines were removed, moved or put in"
    return "was changed after it was written, or the line before it was removed"
