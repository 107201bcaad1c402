"""Ctrl-C and being told to end: both break off what runs, and neither gets lost."""

from __future__ import annotations

import signal
from types import FrameType
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from mintpilot.core.events import Event

_wanted = False


def listen() -> None:
    """From now on SIGINT and SIGTERM raise `KeyboardInterrupt`. A SIGINT that the caller ignores stays ignored."""
    global _wanted
    _wanted = False
    signal.signal(signal.SIGTERM, _interrupt)
    if signal.getsignal(signal.SIGINT) is not signal.SIG_IGN:
        signal.signal(signal.SIGINT, _interrupt)


def stop_if_wanted(event: Event) -> None:
    """Raises `KeyboardInterrupt` where one was wanted but got lost; call it with every event of a mission.

    An exception that is raised while a library's clean-up or call-back runs is printed and dropped by Python.
    """
    from mintpilot.core.events import MissionEnded

    global _wanted
    if _wanted and not isinstance(event, MissionEnded):
        _wanted = False
        raise KeyboardInterrupt


def _interrupt(_number: int, _frame: FrameType | None) -> None:
    global _wanted
    _wanted = True
    raise KeyboardInterrupt
