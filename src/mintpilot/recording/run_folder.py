"""The run folder: everything of one mission on disk, readable at any moment.

config.json     what was to be done, with every setting resolved
events.ndjson   all events exactly, one line each, written as they happen
flight.mcap     the same for viewers such as Foxglove, written as it happens
record.json     the record; replaced after every decision, final at the end
frames/         pictures that the drone saw
photographs/    those that the instruction asked for, one for each thing
tree.*          the tree as JSON, text, SVG and Graphviz
topdown.*       map with planned and flown paths
report.html     all of it for people
"""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Mapping
from datetime import datetime
from pathlib import Path
from types import TracebackType
from typing import Self

from pydantic import JsonValue

from mintpilot.core.errors import RecordError
from mintpilot.core.events import (
    Asked,
    Deliberated,
    Event,
    FactsChanged,
    FrameSeen,
    LegFlown,
    MapUpdated,
    MissionEnded,
    MissionStarted,
    PlanChosen,
    QuestionTimed,
    StopsDone,
    ViewTaken,
)
from mintpilot.core.ports import Recorder
from mintpilot.core.task import Action
from mintpilot.recording.build import build_record, versions
from mintpilot.recording.event_log import EVENTS_FILE, EventLogWriter
from mintpilot.recording.frames import FRAMES, FrameStore, write_jpeg
from mintpilot.recording.history import History
from mintpilot.recording.mcap_log import MCAP_FILE, McapRecorder
from mintpilot.recording.record import MissionRecord, NoticeRecord

_DECISIONS = (MissionStarted, Deliberated, Asked, PlanChosen, LegFlown, MissionEnded)
DERIVED = (MapUpdated, Deliberated, PlanChosen, LegFlown, FactsChanged, StopsDone, QuestionTimed)
"""What follows from the steps, and is large: it is not written a second time."""
_UNWRITTEN = (*DERIVED, ViewTaken)
_RUNNING = "The mission was still running when this was written."
_CUT_SHORT = "The mission was ended before it was finished."


class RunFolder(Recorder):
    """Writes a mission into a folder; use it as a context manager, so that it is closed whatever happens.

    Args:
        path: the folder; made where it does not exist, refused where it holds a run already.
        config: the resolved configuration as plain data; without it the mission's own settings are kept.
        clock: wall-clock seconds since 1970.

    Raises:
        RecordError: the folder cannot be written, or holds a run already.
    """

    def __init__(
        self,
        path: Path,
        *,
        config: Mapping[str, JsonValue] | None = None,
        clock: Callable[[], float] = time.time,
    ) -> None:
        self.path = path
        self._history = History()
        self._lost: list[str] = []
        self._noted = 0
        self._photographed = ""
        self._has_config = config is not None
        self._record: MissionRecord | None = None
        if (path / EVENTS_FILE).exists():
            raise RecordError(f"run folder '{path}' holds a run already: give another one, or move it away")
        if path.is_dir() and any(path.iterdir()):
            raise RecordError(f"folder '{path}' is not empty and holds no run: give a new one for the run")
        try:
            (path / FRAMES).mkdir(parents=True, exist_ok=True)
            if config is not None:
                _replace(path / "config.json", json.dumps(config, indent=2, ensure_ascii=False, default=str))
        except OSError as error:
            raise RecordError(
                f"cannot write the run folder '{path}': {error.strerror}; "
                "give a folder that you may write, on a disk with room"
            ) from error
        self._events = EventLogWriter(path / EVENTS_FILE, program=versions().get("mintpilot", ""), clock=clock)
        self._frames = FrameStore(path / FRAMES)
        self._mcap = McapRecorder(path / MCAP_FILE, clock=clock)

    def record(self, event: Event) -> None:
        """Writes the event through at once. What cannot be written is noted, and the mission goes on."""
        self._history.add(event)
        if not isinstance(event, _UNWRITTEN):
            self._guard("an event", lambda: self._events.append(event))
        self._guard("the flight for viewers", lambda: self._mcap.record(event))
        if isinstance(event, LegFlown):
            self._photographed = event.stop_id if event.stop_id.startswith(f"{Action.PHOTOGRAPH}:") else ""
        if isinstance(event, FrameSeen):
            self._guard("a picture", lambda: self._frames.add(event.index, event.frame))
            if self._photographed:
                file = self.path / "photographs" / f"{self._photographed.replace(':', '-')}.jpg"
                self._guard("a photograph", lambda: write_jpeg(file, event.frame))
                self._photographed = ""
        elif isinstance(event, _DECISIONS):
            self._guard("the record", lambda: self._write_record(_RUNNING))
        if isinstance(event, MissionStarted) and not self._has_config:
            settings = json.dumps(build_record(self._history).settings, indent=2)
            self._guard("the configuration", lambda: _replace(self.path / "config.json", settings))

    def close(self, reason: str = _CUT_SHORT) -> MissionRecord:
        """Writes the final record, then pictures, drawings and report; returns the record. Never raises for the disk.

        Args:
            reason: why the mission ended, in one sentence, in case that no verdict was recorded; it then counts as
                aborted. A second call changes nothing.
        """
        from mintpilot.recording.products import write_products  # draws with matplotlib: only a finished run needs it

        if self._record is not None:
            return self._record
        self._guard("the end of the events", self._events.close)
        self._guard("the end of the flight for viewers", self._mcap.close)
        record = self._record = self._write_record(reason)
        self._guard("pictures", lambda: self._frames.prune({s.view[0] for s in record.seen if s.view}))
        failures = write_products(record, self._history, self.path)
        if failures or len(self._lost) != self._noted:
            self._lost.extend(failures)
            record = self._record = self._write_record(reason)
        return record

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if kind is None:
            self.close()
        elif issubclass(kind, KeyboardInterrupt):
            self.close("The operator ended the mission with Ctrl-C.")
        else:
            self.close(f"The program ended the mission: {error or kind.__name__}")

    def _write_record(self, unfinished: str) -> MissionRecord:
        record = build_record(
            self._history, run_dir=str(self.path).encode("utf-8", "replace").decode(), unfinished=unfinished
        )
        self._noted = len(self._lost)
        if self._lost:
            lost = NoticeRecord(kind="record-incomplete", text=_loss(self._lost))
            record = record.model_copy(update={"notices": (*record.notices, lost)})
        self._guard("the record", lambda: _replace(self.path / "record.json", record.model_dump_json(indent=1)))
        return record

    def _guard(self, what: str, write: Callable[[], object]) -> None:
        """Runs one piece of writing; a failure is noted, never raised: no disk is worth a crash in mid-flight."""
        try:
            write()
        except OSError as error:
            self._lost.append(f"{what} ({error.strerror or error})")
        except (RecordError, ValueError) as error:  # what has no form in the file, e.g. words that are no text
            self._lost.append(f"{what} ({error})")


def new_run_path(base: Path, name: str, now: datetime) -> Path:
    """A path under ``base`` that does not exist yet, e.g. ``runs/2026-11-22T03-20-11-fire-warehouse``.

    Args:
        base: folder of runs.
        name: of the mission; what no file name should hold becomes a hyphen.
        now: the time for the name.
    """
    slug = "".join(c if c.isascii() and (c.isalnum() or c in "-_") else "-" for c in name.lower()).strip("-")[:60]
    stem = f"{now:%Y-%m-%dT%H-%M-%S}-{slug or 'mission'}"
    path, count = base / stem, 2
    while path.exists():
        path, count = base / f"{stem}-{count}", count + 1
    return path


def _replace(file: Path, text: str) -> None:
    """Writes the file whole or not at all, so that a reader never sees half of it."""
    draft = file.with_name(f".{file.name}.part")
    try:
        draft.write_text(text, encoding="utf-8")
        draft.replace(file)
    except OSError:
        draft.unlink(missing_ok=True)
        raise


def _loss(lost: list[str]) -> str:
    kinds = list(dict.fromkeys(lost))
    shown = ", ".join(kinds[:4]) + (" …" if len(kinds) > 4 else "")
    return f"{len(lost)} times something could not be written: {shown}."
