"""Trajectories in time, and what was really flown."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from mintpilot.core.geometry import Floats, Vec3, frozen


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Trajectory:
    """A motion sampled evenly in time, at rest at both ends, checked against the map it was made for."""

    time_s: Floats
    """Sample times (n,), from 0, ascending."""
    position_m: Floats
    """(n, 3), world frame."""
    velocity_mps: Floats
    """(n, 3)."""
    acceleration_mps2: Floats
    """(n, 3)."""
    yaw_rad: Floats
    """Heading (n,), continuous (unwrapped), 0 along x, counter-clockwise."""

    def __post_init__(self) -> None:
        for array in (self.time_s, self.position_m, self.velocity_mps, self.acceleration_mps2, self.yaw_rad):
            frozen(array)

    @property
    def duration_s(self) -> float:
        """Seconds from first to last sample."""
        return float(self.time_s[-1]) if self.time_s.size else 0.0

    @property
    def length_m(self) -> float:
        """Length of the flown curve, metres."""
        return float(np.linalg.norm(np.diff(self.position_m, axis=0), axis=1).sum())


@dataclass(frozen=True, slots=True, kw_only=True)
class VehicleState:
    """Where the vehicle believes itself to be."""

    time_s: float
    position_m: Vec3
    velocity_mps: Vec3
    yaw_rad: float
    endurance_left_s: float = float("inf")
    """Flight time that is left, seconds."""


class FlightEnd(StrEnum):
    """How one trajectory ended."""

    ARRIVED = "arrived"
    """At its last sample, hovering."""
    INTERRUPTED = "interrupted"
    """The watch asked for a stop; the vehicle braked along the trajectory and hovers."""
    FAILED = "failed"
    """The vehicle cannot go on; the simulator's verdict or the link's error says why."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class FlightLog:
    """What was really flown along one trajectory."""

    end: FlightEnd
    time_s: Floats
    """(n,), vehicle's clock."""
    position_m: Floats
    """(n, 3), true position where the vehicle knows it, else its estimate."""
    reference_m: Floats
    """(n, 3), where it should have been."""
    reason: str = ""
    """For ``FAILED``: why."""

    def __post_init__(self) -> None:
        for array in (self.time_s, self.position_m, self.reference_m):
            frozen(array)
