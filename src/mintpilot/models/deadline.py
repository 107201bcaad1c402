"""A time-out that holds, whatever it is that hangs."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import TypeVar

from mintpilot.core.errors import DeviceError, MintPilotError

T = TypeVar("T")


def within(work: Callable[[], T], timeout_s: float, what: str) -> T:
    """The result of ``work``, if it comes in time; a late one is thrown away.

    The work runs in a daemon thread: one that never ends stops neither the mission nor the end of the program.

    Args:
        work: what is done.
        timeout_s: how long it is waited for, seconds.
        what: who does it, for the message.

    Raises:
        DeviceError: no result in time, or the work failed.
    """
    results: list[T] = []
    errors: list[Exception] = []

    def run() -> None:
        try:
            results.append(work())
        except Exception as error:  # a plug-in may fail in any way; it is told in the caller's thread
            errors.append(error)

    thread = threading.Thread(target=run, daemon=True, name=f"mintpilot {what}")
    thread.start()
    thread.join(max(0.0, timeout_s))
    if results:
        return results[0]
    if not errors:
        raise DeviceError(f"{what} did not answer within {timeout_s:g} s: going on without it")
    if isinstance(errors[0], MintPilotError):
        raise errors[0]
    raise DeviceError(f"{what} failed ({type(errors[0]).__name__}): going on without it") from errors[0]
