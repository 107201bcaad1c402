"""A record without a run folder."""

from __future__ import annotations

from mintpilot.core.events import Event
from mintpilot.core.ports import Recorder
from mintpilot.recording.build import build_record
from mintpilot.recording.history import History
from mintpilot.recording.record import MissionRecord


class HistoryRecorder(Recorder):
    """Keeps what a record is made of, on no disk: for benchmarks and for callers that want the record only."""

    def __init__(self) -> None:
        self._history = History()

    def record(self, event: Event) -> None:
        """Keeps one event; pictures are counted, not kept."""
        self._history.add(event)

    def close(self, reason: str = "The mission was ended before it was finished.") -> MissionRecord:
        """The record of what was told so far; ``reason`` counts where no verdict was recorded."""
        return build_record(self._history, unfinished=reason)
