"""What goes wrong around a mission: the disk, the memory, the process, the clock on the wall, deliberation."""

from __future__ import annotations

import errno
import os
import resource
import signal
import stat
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from mintpilot.conformance.faults.drawing import Draw
from mintpilot.conformance.faults.kinds import FaultKind
from mintpilot.conformance.faults.ledger import Counter, Ledger
from mintpilot.core.errors import InfeasibleError
from mintpilot.core.events import (
    Deliberated,
    Event,
    FactsChanged,
    LegFlown,
    MapUpdated,
    PlanChosen,
    QuestionTimed,
    StopsDone,
    ViewTaken,
)
from mintpilot.core.inputs import DeliberationEnded
from mintpilot.core.ports import Recorder
from mintpilot.mission.requests import Request
from mintpilot.mission.worker import Worker

UNWRITTEN = (MapUpdated, Deliberated, PlanChosen, LegFlown, FactsChanged, StopsDone, QuestionTimed, ViewTaken)
"""What a run folder does not write as an event: it follows from the others, or is for those who watch."""
SLOW_S = 0.004
"""Longest that a slow disk takes for a write."""
SPARE_BYTES = 48 * 2**20
"""Most memory that is left once it is short."""
LATE_S = 20.0
"""Longest that a deliberation takes."""


class CountingRecorder(Recorder):
    """Counts what was handed to a recorder, and kills the process where that is drawn.

    Args:
        inner: the run folder.
        written: set to the number of events that ought to be in the log; it outlives the process.
        draw: which faults come.
        ledger: is told of the facts that the mission knows of.
    """

    def __init__(self, inner: Recorder, written: Counter, draw: Draw, ledger: Ledger) -> None:
        self._inner, self._written, self._draw, self._ledger = inner, written, draw, ledger
        self._events = self._all = 0
        self.last: Event | None = None

    def record(self, event: Event) -> None:
        """Hands it on."""
        self._inner.record(event)
        self.last = event
        if isinstance(event, FactsChanged):
            for known in event.told:
                self._ledger.facts.setdefault(known.id, known)
        self._all += 1
        if not isinstance(event, UNWRITTEN):
            self._events += 1
            self._written.set(self._events)
        killed = self._draw.first(FaultKind.KILLED)
        if killed is not None and self._all >= killed.at_s:
            os.kill(os.getpid(), signal.SIGKILL)


@dataclass(slots=True)
class Disk:
    """The disk under a run folder while it is full, slow or gone. Short writes come before a full one."""

    draw: Draw
    ledger: Ledger
    folder: Path
    written: Counter
    """Counts the writes that failed."""
    _room: int = field(default=-1)

    @contextmanager
    def failing(self) -> Iterator[None]:
        """In the block the process's writes to regular files go through the fault."""
        true_write = os.write

        def write(file: int, data: bytes | memoryview) -> int:
            if not stat.S_ISREG(os.fstat(file).st_mode):
                return true_write(file, data)
            if self._on(FaultKind.DISK_GONE):
                self.written.refuse()
                raise OSError(errno.EIO, os.strerror(errno.EIO))
            if self._on(FaultKind.DISK_FULL):
                if self._room < 0:
                    self._room = int(self.draw.rng.integers(1, 5000))
                if self._room == 0:
                    self.written.refuse()
                    raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
                taken = true_write(file, data[: self._room])
                self._room -= taken
                return taken
            if self._on(FaultKind.DISK_SLOW):
                fault = self.draw.first(FaultKind.DISK_SLOW)
                assert fault is not None
                time.sleep(fault.size * SLOW_S)
            return true_write(file, data)

        os.write = write  # type: ignore[assignment]
        try:
            yield
        finally:
            os.write = true_write

    def _on(self, kind: FaultKind) -> bool:
        fault = self.draw.first(kind)
        return fault is not None and fault.is_on(self.ledger.now_s)


def wall_clock(draw: Draw) -> Callable[[], float]:
    """The clock on the wall, which jumps by hours, in either direction, while that is drawn."""
    fault, rng = draw.first(FaultKind.CLOCK_JUMPS), np.random.default_rng([draw.number, 3])
    if fault is None:
        return time.time
    return lambda: time.time() + float(rng.normal()) * 7200.0 * fault.size


def shorten_memory(draw: Draw) -> None:
    """From now on this process gets hardly any more memory. Cannot be taken back: only for a process of its own."""
    fault = draw.first(FaultKind.MEMORY_SHORT)
    if fault is None:
        return
    pages = int(Path("/proc/self/statm").read_text().split()[0])
    limit = pages * resource.getpagesize() + int(fault.size * SPARE_BYTES)
    resource.setrlimit(resource.RLIMIT_AS, (limit, limit))


class FaultyWorker(Worker):
    """Deliberates late, or not at all.

    Args:
        inner: who really works it out.
        draw: which faults come.
        ledger: knows the time.
    """

    def __init__(self, inner: Worker, draw: Draw, ledger: Ledger) -> None:
        self._inner, self._draw, self._ledger, self._rng = inner, draw, ledger, draw.rng
        self._late: list[tuple[float, DeliberationEnded]] = []

    def submit(self, request: Request, time_s: float) -> None:
        """Takes a request."""
        fails = self._draw.first(FaultKind.THINKING_FAILS)
        if fails is not None and fails.is_on(self._ledger.now_s) and self._rng.random() < 0.3 + 0.7 * fails.size:
            reason = str(InfeasibleError("the deliberation was lost"))
            ended = DeliberationEnded(time_s=time_s, request=request.id, decision=None, reason=reason)
            self._late.append((self._ledger.now_s, ended))
            return
        self._inner.submit(request, time_s)

    def poll(self, time_s: float) -> tuple[DeliberationEnded, ...]:
        """What has come back."""
        late = self._draw.first(FaultKind.THINKING_LATE)
        now_s = self._ledger.now_s
        for ended in self._inner.poll(time_s):
            on = late is not None and late.is_on(now_s)
            delay_s = late.size * LATE_S * float(self._rng.random()) if late is not None and on else 0.0
            self._late.append((now_s + delay_s, ended))
        ready = tuple(ended for at_s, ended in self._late if at_s <= now_s)
        self._late = [item for item in self._late if item[0] > now_s]
        return tuple(ended if ended.time_s >= time_s else _now(ended, time_s) for ended in ready)

    def close(self) -> None:
        """See `Worker.close`."""
        self._inner.close()


def _now(ended: DeliberationEnded, time_s: float) -> DeliberationEnded:
    return replace(ended, time_s=time_s)
