"""The link process's end of its pipe: a loop that does not read, or stops in mid-word, does not hold it up."""

from __future__ import annotations

import queue
import threading
from collections import deque
from multiprocessing.connection import Connection
from typing import Generic, TypeVar

Said = TypeVar("Said")
Told = TypeVar("Told")


class End:
    """The loop has closed its end of the pipe, or died."""


class Channel(Generic[Said, Told]):
    """Reads and writes in threads of its own; what a hung loop does not read waits, or is replaced by newer.

    Args:
        pipe: to the loop.

    Attributes:
        gone: whether the loop has closed its end, or died.
    """

    def __init__(self, pipe: Connection) -> None:
        self._pipe = pipe
        self._inbox: queue.SimpleQueue[Said | End] = queue.SimpleQueue()
        self._outbox: deque[Told] = deque()
        self._latest: Told | None = None
        self._wake = threading.Condition()
        self.gone = False
        for work in (self._read, self._write):
            threading.Thread(target=work, daemon=True).start()

    def get(self, timeout_s: float) -> Said | End:
        """The next thing that the loop said, or `End`; raises `queue.Empty` where nothing comes in time."""
        return self._inbox.get(timeout=timeout_s)

    def tell(self, report: Told) -> None:
        """Sends it as soon as the loop reads; never waits, never drops."""
        with self._wake:
            self._outbox.append(report)
            self._wake.notify()

    def show(self, snapshot: Told) -> None:
        """Sends it as soon as the loop reads, unless a newer one comes before."""
        with self._wake:
            self._latest = snapshot
            self._wake.notify()

    def _read(self) -> None:
        try:
            while True:
                self._inbox.put(self._pipe.recv())
        except (EOFError, OSError):
            self.gone = True
            self._inbox.put(End())

    def _write(self) -> None:
        try:
            while True:
                with self._wake:
                    self._wake.wait_for(lambda: self._outbox or self._latest is not None)
                    if self._outbox:
                        item = self._outbox.popleft()
                    else:
                        item, self._latest = self._latest, None  # type: ignore[assignment]
                self._pipe.send(item)
        except OSError:
            return
