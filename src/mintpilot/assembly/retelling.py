"""A recorded mission told again to whoever watches, as it was told then."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Protocol

from mintpilot.core.errors import RecordError
from mintpilot.core.events import Event, MissionStarted, Noticed, Stepped
from mintpilot.core.inputs import MissionBegun
from mintpilot.core.message import message
from mintpilot.core.ports import Recorder
from mintpilot.core.query import Question
from mintpilot.mission.directives import ShowQuestion, Tell, WithdrawQuestion
from mintpilot.mission.journal import Journal
from mintpilot.mission.replay import setup_of
from mintpilot.mission.state import MissionState
from mintpilot.mission.step import initial_state, step
from mintpilot.recording.event_log import read_event_log
from mintpilot.recording.run_folder import DERIVED
from mintpilot.wording.speech import Speech


class Watcher(Protocol):
    """Sees a mission: its events, and what operators were told."""

    def record(self, event: Event) -> None:
        """Takes in one event."""
        ...

    def show(self, question: Question, patience_s: float) -> None:
        """A question was put."""
        ...

    def withdraw(self, question: str, why: str) -> None:
        """A question was taken back."""
        ...

    def tell(self, text: str) -> None:
        """Something was said."""
        ...


def retell(run: Path, watcher: Watcher) -> str:
    """Tells a recorded mission again, whether it was finished or broken off; what follows from its steps is made anew.

    Args:
        run: the run folder, or its events file.
        watcher: who is told.

    Returns:
        Where the record breaks off; empty where it is whole.

    Raises:
        RecordError: it cannot be read, is damaged, is of another version, or does not begin with its beginning.
    """
    log = read_event_log(run)
    for _ in retold((logged.event for logged in log), watcher):
        pass
    if log.cut:
        watcher.record(Noticed(kind="record", text=message("The record breaks off: {cut}.", cut=log.cut)))
    return log.cut


def retold(events: Iterable[Event], watcher: Watcher) -> Iterator[MissionState]:
    """Tells the events of a mission again, one step after another; gives the state after each step.

    Raises:
        RecordError: they do not begin with the beginning.
    """
    journal = Journal(_Derived(watcher))
    started: MissionStarted | None = None
    spoken = Speech()
    state: MissionState | None = None
    for event in events:
        if isinstance(event, DERIVED):
            continue
        watcher.record(event)
        if isinstance(event, MissionStarted):
            started, spoken = event, Speech(event.language, dict(event.names))
        if not isinstance(event, Stepped):
            continue
        if state is None:
            if started is None or not isinstance(event.input, MissionBegun):
                raise RecordError("the record does not begin with the start of a mission: give a whole run folder")
            state = initial_state(setup_of(started), event.input.vehicle)
        before, (state, directives) = state, step(state, event.input)
        journal.keep(before, event.input, state, directives)
        for directive in directives:
            match directive:
                case ShowQuestion():
                    watcher.show(directive.question, directive.patience_s)
                case WithdrawQuestion():
                    watcher.withdraw(directive.question, spoken(directive.why))
                case Tell():
                    watcher.tell(spoken(directive.text))
                case _:
                    pass
        yield state


class _Derived(Recorder):
    """Passes on what was not written, since it follows from the steps."""

    def __init__(self, watcher: Watcher) -> None:
        self._watcher = watcher

    def record(self, event: Event) -> None:
        if isinstance(event, DERIVED):
            self._watcher.record(event)
