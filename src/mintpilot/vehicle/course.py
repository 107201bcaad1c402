"""Following a trajectory in time: its clock slows down to brake, and waits for a vehicle that lags behind."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from mintpilot.core.geometry import Floats, Vec3
from mintpilot.core.trajectory import Trajectory

BRAKING_MPS2 = 2.0
"""Hardest change of speed along the trajectory while its clock slows down to brake, or speeds up again, m/s^2."""
LAG_M = 0.5
"""From this distance between the vehicle and where it should be, the clock slows down, metres ..."""
FAR_M = 1.0
"""... and from this one it stands still."""
_SLOWEST_MPS = 0.2


@dataclass(frozen=True, slots=True, kw_only=True)
class SetPoint:
    """Where the vehicle should be now, on the map. The place is never ahead of now: no far target is ever sent."""

    position_m: Vec3
    velocity_mps: Vec3 = (0.0, 0.0, 0.0)
    yaw_rad: float = 0.0
    """0 along x, counter-clockwise."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Course:
    """A trajectory under way."""

    trajectory: Trajectory
    along_s: float = 0.0
    """How far it has come, on the trajectory's own clock."""
    rate: float = 1.0
    """Speed of that clock: 1 flies as planned, 0 stands."""
    braking: bool = False

    @property
    def at_rest(self) -> bool:
        """Whether the set-point does not move any more: at the end, or braked."""
        return self.along_s >= self.trajectory.duration_s or (self.braking and self.rate <= 0)

    def set_point(self) -> SetPoint:
        """Where the vehicle should be now."""
        way = self.trajectory
        at = self.along_s + float(way.time_s[0])
        speed = 0.0 if self.at_rest else self.rate
        return SetPoint(
            position_m=_row(at, way.time_s, way.position_m),
            velocity_mps=_row(at, way.time_s, way.velocity_mps * speed),
            yaw_rad=float(np.interp(at, way.time_s, way.yaw_rad)),
        )


def advanced(course: Course, seconds: float, lag_m: float) -> Course:
    """The course some time later, for a vehicle that is ``lag_m`` from its set-point."""
    way = course.trajectory
    at = course.along_s + float(way.time_s[0])
    speed = max(float(np.linalg.norm(_row(at, way.time_s, way.velocity_mps))), _SLOWEST_MPS)
    change = BRAKING_MPS2 / speed * seconds
    rate = max(course.rate - change, 0.0) if course.braking else course.rate + change
    rate = min(rate, max((FAR_M - lag_m) / (FAR_M - LAG_M), 0.0), 1.0)
    along = min(course.along_s + seconds * (course.rate + rate) / 2, way.duration_s)
    return replace(course, along_s=along, rate=rate)


def straight(start_m: Vec3, goal_m: Vec3, yaw_rad: float, speed_mps: float) -> Trajectory:
    """From rest to rest along a line, smooth in acceleration; ``speed_mps`` is the mean speed."""
    start, way = np.asarray(start_m, float), np.asarray(goal_m, float) - np.asarray(start_m, float)
    duration_s = max(float(np.linalg.norm(way)) / speed_mps, 0.1)
    time_s = np.linspace(0.0, duration_s, max(round(duration_s / 0.05), 2) + 1)
    t = (time_s / duration_s)[:, None]
    return Trajectory(
        time_s=time_s,
        position_m=start + way * (10 * t**3 - 15 * t**4 + 6 * t**5),
        velocity_mps=way * (30 * t**2 - 60 * t**3 + 30 * t**4) / duration_s,
        acceleration_mps2=way * (60 * t - 180 * t**2 + 120 * t**3) / duration_s**2,
        yaw_rad=np.full(len(time_s), yaw_rad),
    )


def _row(at: float, time_s: Floats, rows: Floats) -> Vec3:
    x, y, z = (float(np.interp(at, time_s, rows[:, axis])) for axis in range(3))
    return (x, y, z)
