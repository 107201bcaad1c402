"""Ctrl-C, being told to end, and a terminal that goes away: each breaks off what runs, and none gets lost."""

from __future__ import annotations

import signal
from types import FrameType
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from mintpilot.core.events import Event

_NAMES = {signal.SIGINT: "Ctrl-C", signal.SIGTERM: "a request to end (SIGTERM)"}
if hasattr(signal, "SIGHUP"):
    _NAMES[signal.SIGHUP] = "the end of its terminal (SIGHUP)"
_wanted = ""


def listen() -> None:
    """From now on SIGINT, SIGTERM and SIGHUP raise `KeyboardInterrupt`, with the signal's name in words.

    SIGINT and SIGHUP stay ignored where the caller ignores them (background work, ``nohup``).
    """
    global _wanted
    _wanted = ""
    for number in _NAMES:
        if number is signal.SIGTERM or signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, _interrupt)


def stop_if_wanted(event: Event) -> None:
    """Raises `KeyboardInterrupt` where one was wanted but got lost; call it with every event of a mission.

    An exception that is raised while a library's clean-up or call-back runs is printed and dropped by Python.
    """
    from mintpilot.core.events import MissionEnded

    global _wanted
    if _wanted and not isinstance(event, MissionEnded):
        name, _wanted = _wanted, ""
        raise KeyboardInterrupt(name)


def _interrupt(number: int, _frame: FrameType | None) -> None:
    global _wanted
    _wanted = _NAMES[signal.Signals(number)]
    raise KeyboardInterrupt(_wanted)
