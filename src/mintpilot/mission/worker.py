"""Who works requests out: here and now, or later (method, section 8)."""

from __future__ import annotations

import time
from typing import Protocol

from mintpilot.core.errors import MintPilotError
from mintpilot.core.inputs import DeliberationEnded
from mintpilot.mission.deliberation import DeliberationParts
from mintpilot.mission.requests import Request, decide


class Worker(Protocol):
    """Takes one request after the other. Never blocks longer than the work itself."""

    def submit(self, request: Request, time_s: float) -> None:
        """Takes a request at that time of the mission clock."""
        ...

    def poll(self, time_s: float) -> tuple[DeliberationEnded, ...]:
        """What has come back up to that time of the mission clock, oldest first."""
        ...

    def close(self) -> None:
        """Ends what it runs. Safe to call again."""
        ...


class InlineWorker(Worker):
    """Works a request out at once, and delivers the decision after a fixed time of the mission clock.

    Args:
        parts: what deliberation is done with.
        delay_s: mission time that a deliberation is charged with, seconds.
    """

    def __init__(self, parts: DeliberationParts, *, delay_s: float = 0.0) -> None:
        self._parts = parts
        self._delay_s = delay_s
        self._done: list[tuple[float, DeliberationEnded]] = []

    def submit(self, request: Request, time_s: float) -> None:
        """See `Worker.submit`."""
        due_s = time_s + self._delay_s
        self._done.append((due_s, worked_out(self._parts, request, due_s)))

    def poll(self, time_s: float) -> tuple[DeliberationEnded, ...]:
        """See `Worker.poll`."""
        ready = tuple(event for due_s, event in self._done if due_s <= time_s)
        self._done = [item for item in self._done if item[0] > time_s]
        return ready

    def close(self) -> None:
        """See `Worker.close`."""


def worked_out(parts: DeliberationParts, request: Request, time_s: float) -> DeliberationEnded:
    """The end of a deliberation that comes back at that time; a failure is a value."""
    begun = time.perf_counter()
    try:
        decision, reason = decide(parts, request), ""
    except MintPilotError as error:
        decision, reason = None, str(error)
    seconds = time.perf_counter() - begun
    return DeliberationEnded(time_s=time_s, request=request.id, decision=decision, reason=reason, seconds=seconds)
