"""A limit on the time that one trial computes."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType


class TrialTimeoutError(BaseException):
    """The time is up. Not an `Exception`, so that no part that forgives errors can swallow it."""


@contextmanager
def deadline(seconds: float) -> Iterator[None]:
    """Raises `TrialTimeoutError` in the block once it has run for that many seconds.

    Works in a process's main thread on systems with signals, and between steps of Python: what hangs in foreign code
    is ended by the pool, which ends the whole process. Elsewhere it does nothing.
    """
    if threading.current_thread() is not threading.main_thread() or not hasattr(signal, "setitimer"):
        yield
        return

    def ring(_number: int, _frame: FrameType | None) -> None:
        raise TrialTimeoutError

    before = signal.signal(signal.SIGALRM, ring)
    signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
