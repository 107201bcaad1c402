"""What is checked before a flight."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class Check:
    """One thing that was looked at."""

    check: str
    """What."""
    ok: bool
    value: str
    """As it is."""
    wanted: str
    """As it should be."""
    how: str = ""
    """What to do where it is not ok."""
    failsafe: bool = False
    """Whether it is about what the autopilot does by itself: ``--accept-failsafes`` then flies all the same."""
