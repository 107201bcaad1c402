"""Recorders without a disk, and one that feeds several."""

from __future__ import annotations

from mintpilot.core.events import Event
from mintpilot.core.ports import Recorder


class NullRecorder(Recorder):
    """Forgets everything at once."""

    def record(self, event: Event) -> None:
        """Does nothing."""


class MemoryRecorder(Recorder):
    """Keeps the events themselves, for tests and benchmarks.

    Attributes:
        events: all events, oldest first.
    """

    def __init__(self) -> None:
        self.events: list[Event] = []

    def record(self, event: Event) -> None:
        """Keeps the event."""
        self.events.append(event)


class TeeRecorder(Recorder):
    """Gives every event to several recorders, in their order."""

    def __init__(self, *recorders: Recorder) -> None:
        self._recorders = recorders

    def record(self, event: Event) -> None:
        """Hands the event on."""
        for recorder in self._recorders:
            recorder.record(event)
