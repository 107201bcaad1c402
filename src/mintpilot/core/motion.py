"""What a vehicle may be told to do: one motion at a time (method, section 8)."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import TypeAlias

from mintpilot.core.plan import Stop
from mintpilot.core.trajectory import Trajectory


@dataclass(frozen=True, slots=True, kw_only=True)
class TakeOff:
    """Climb from the ground to the hover point above it. A vehicle that hovers already has arrived."""

    id: int
    height_m: float
    """Above the ground, metres."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class FollowTrajectory:
    """Fly a checked trajectory that begins at rest where the vehicle hovers, and hover at its end."""

    id: int
    trajectory: Trajectory


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PerformAction:
    """Do what a stop is for (pick, deliver, look) while hovering."""

    id: int
    stop: Stop
    dwell_s: float
    """How long it takes, seconds."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Land:
    """Descend from where the vehicle hovers to the ground right below, and stay there."""

    id: int


Motion: TypeAlias = TakeOff | FollowTrajectory | PerformAction | Land


class MotionEnd(StrEnum):
    """How a motion ended."""

    ARRIVED = "arrived"
    """At its end; the vehicle hovers (after landing: stands on the ground)."""
    STOPPED = "stopped"
    """Braked along the checked path when told to; the vehicle hovers."""
    REFUSED = "refused"
    """The vehicle would not begin it: it hovers where it was."""
    FAILED = "failed"
    """The vehicle cannot go on; the reason says why."""
