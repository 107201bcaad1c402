"""Deliberation in a warmed-up process of its own, beside a real vehicle (method, section 8).

The compiled search holds the interpreter lock for as long as it runs, so a thread would stall the loop.
"""

from __future__ import annotations

import multiprocessing
import signal
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from multiprocessing.connection import Connection
from multiprocessing.context import SpawnProcess
from typing import Final, cast

from mintpilot.core.errors import DeviceError, MintPilotError
from mintpilot.core.inputs import DeliberationEnded
from mintpilot.mission.deliberation import DeliberationParts
from mintpilot.mission.requests import Request
from mintpilot.mission.worker import Worker, worked_out

READY_S: Final = 120.0
"""Longest time that the process may take to start and to compile, seconds of the clock on the wall."""
STUCK_S: Final = 20.0
"""A request that nobody waits for any more may go on this long before its process is ended, seconds."""
END_S: Final = 2.0
"""Time that an idle process gets to end by itself, seconds."""
DEATHS: Final = 3
"""After so many deaths in a row no further process is started: each request fails at once."""


@dataclass(frozen=True, slots=True)
class _Failed:
    """Why the process cannot deliberate at all."""

    reason: str


@dataclass(slots=True, eq=False)
class _Process:
    handle: SpawnProcess
    pipe: Connection
    ready: bool = False


class ProcessWorker(Worker):
    """Works requests out one after the other in a process of its own; neither `submit` nor `poll` waits for it.

    Only the newest request counts: an older one that has not begun is dropped. A process that dies gives that request
    back as failed and is started again; so is one that is stuck in a request that a newer one has replaced.

    Args:
        make_parts: makes the parts in the process; it is pickled, and called once for each process.
        ready_s: longest time that starting may take, seconds of the clock on the wall.
        stuck_s: how long a replaced request may go on, seconds of the clock on the wall.
        clock: seconds of the clock on the wall, never going back.

    Raises:
        DeviceError: the process does not become ready, with the reason.
    """

    def __init__(
        self,
        make_parts: Callable[[], DeliberationParts],
        *,
        ready_s: float = READY_S,
        stuck_s: float = STUCK_S,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._make_parts = make_parts
        self._stuck_s, self._clock = stuck_s, clock
        self._waiting: Request | None = None
        self._at: Request | None = None
        self._since = 0.0
        self._failed: list[tuple[Request, str]] = []
        self._deaths = 0
        self._process = self._start()
        if not self._process.pipe.poll(ready_s):
            self.close()
            raise DeviceError(
                f"the deliberation process was not ready within {ready_s:g} s; the machine may be too busy: try again"
            )
        try:
            self._hear()
        except DeviceError:
            self.close()
            raise

    @property
    def pid(self) -> int | None:
        """Number of the process; None: there is none."""
        return self._process.handle.pid

    def submit(self, request: Request, time_s: float) -> None:  # noqa: ARG002 - it begins as soon as it can
        """See `Worker.submit`."""
        self._waiting = request
        if self._at is not None and self._clock() - self._since > self._stuck_s:
            self._end()
            self._at = None
            self._process = self._start()
        self._send()
        if self._deaths >= DEATHS:
            self._failed.append((request, f"the deliberation process has died {DEATHS} times in a row"))
            self._waiting = None

    def poll(self, time_s: float) -> tuple[DeliberationEnded, ...]:
        """See `Worker.poll`."""
        done: list[DeliberationEnded] = []
        try:
            while self._deaths < DEATHS and self._process.pipe.poll():
                ended = self._hear()
                if ended is not None:
                    done.append(replace(ended, time_s=time_s))
        except (DeviceError, EOFError, OSError) as error:
            self._lost(str(error))
        self._send()
        for request, reason in self._failed:
            done.append(DeliberationEnded(time_s=time_s, request=request.id, decision=None, reason=reason))
        self._failed.clear()
        return tuple(done)

    def close(self) -> None:
        """See `Worker.close`."""
        self._end()

    def _start(self) -> _Process:
        context = multiprocessing.get_context("spawn")
        ours, theirs = context.Pipe()
        handle = context.Process(
            target=_deliberate_until_closed, args=(theirs, self._make_parts), name="mintpilot-deliberation", daemon=True
        )
        handle.start()
        theirs.close()
        return _Process(handle, ours)

    def _send(self) -> None:
        """Hands the waiting request over, if the process is idle: it then reads at once, and nobody waits."""
        if self._waiting is None or self._at is not None or not self._process.ready:
            return
        request, self._waiting = self._waiting, None
        self._at, self._since = request, self._clock()
        try:
            self._process.pipe.send(request)
        except OSError as error:
            self._lost(str(error))

    def _hear(self) -> DeliberationEnded | None:
        """One message of the process; None: it is ready."""
        message = self._process.pipe.recv()
        if isinstance(message, _Failed):
            raise DeviceError(f"the deliberation process cannot work: {message.reason}")
        if message is None:
            self._process.ready = True
            return None
        self._at, self._deaths = None, 0
        return cast(DeliberationEnded, message)

    def _lost(self, why: str) -> None:
        """The process has died: what it was at has failed, and another one is started."""
        self._end()
        code = self._process.handle.exitcode
        self._deaths += 1
        lost = (self._at, self._waiting) if self._deaths >= DEATHS else (self._at,)
        self._at = None
        for request in lost:
            if request is not None:
                reason = f"the deliberation process ended (exit code {code}{f': {why}' if why else ''})"
                self._failed.append((request, reason))
        if self._deaths < DEATHS:
            self._process = self._start()
        else:
            self._waiting = None

    def _end(self) -> None:
        """Ends the process, by force where it does not end by itself."""
        process = self._process
        process.pipe.close()
        process.ready = False
        process.handle.join(0.0 if self._at is not None else END_S)
        if process.handle.is_alive():
            process.handle.kill()
            process.handle.join()


def _deliberate_until_closed(pipe: Connection, make_parts: Callable[[], DeliberationParts]) -> None:
    """The process: gets ready, then works out one request after the other until its pipe is closed."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is an order, and the loop's to hear
    from mintpilot.planning.warm import warm_up

    try:
        parts = make_parts()
        warm_up()
    except MintPilotError as error:
        pipe.send(_Failed(str(error)))
        return
    pipe.send(None)
    while True:
        try:
            request = pipe.recv()
            pipe.send(worked_out(parts, request, 0.0))
        except (EOFError, OSError):
            return
