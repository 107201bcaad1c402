"""What a simulator follows: a trajectory at any times, its way to a stop when interrupted, and whether it may start."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mintpilot.core.errors import DeviceError, InputError
from mintpilot.core.geometry import Floats, Vec3
from mintpilot.core.trajectory import Trajectory

START_TOLERANCE_M = 0.5
"""A trajectory must begin at most this far from the vehicle, metres."""
BRAKING_MPS2 = 2.0
"""Hardest braking of an interrupted flight, besides what its own curve takes."""
DESCENT_MPS = 0.5
"""Fastest descent to the ground."""
LANDED_M = 0.15
"""Height of the drone's centre above the floor once it stands on its legs, metres."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Reference:
    """Where the drone should be at n times."""

    time_s: Floats
    """(n,), on the trajectory's clock."""
    position_m: Floats
    """(n, 3)."""
    velocity_mps: Floats
    """(n, 3)."""
    acceleration_mps2: Floats
    """(n, 3)."""
    yaw_rad: Floats
    """(n,)."""

    def until(self, rows: int) -> Reference:
        """The first rows of it."""
        return Reference(
            time_s=self.time_s[:rows],
            position_m=self.position_m[:rows],
            velocity_mps=self.velocity_mps[:rows],
            acceleration_mps2=self.acceleration_mps2[:rows],
            yaw_rad=self.yaw_rad[:rows],
        )


def check_start(trajectory: Trajectory, position_m: Vec3) -> None:
    """Refuses what cannot be followed from here.

    Raises:
        InputError: the trajectory is empty, malformed, not finite, or its times do not ascend.
        DeviceError: it begins farther than `START_TOLERANCE_M` from the vehicle.
    """
    n = len(trajectory.time_s)
    if n == 0:
        raise InputError("the trajectory is empty: give at least one sample, where the vehicle is")
    shapes = [
        ("position_m", trajectory.position_m, (n, 3)),
        ("velocity_mps", trajectory.velocity_mps, (n, 3)),
        ("acceleration_mps2", trajectory.acceleration_mps2, (n, 3)),
        ("yaw_rad", trajectory.yaw_rad, (n,)),
    ]
    for name, array, shape in shapes:
        if array.shape != shape:
            raise InputError(f"the trajectory's {name} has shape {array.shape}: {n} times need {shape}")
    for name, array, _ in (("time_s", trajectory.time_s, (n,)), *shapes):
        if not np.isfinite(array).all():
            sample = int(np.argmin(np.isfinite(array.reshape(n, -1)).all(axis=1)))
            raise InputError(f"the trajectory's {name} is not finite at sample {sample}: plan it again")
    if (np.diff(trajectory.time_s) <= 0).any():
        raise InputError("the trajectory's times do not ascend: give each sample a later time than the one before")
    gap = float(np.linalg.norm(trajectory.position_m[0] - np.asarray(position_m)))
    if gap > START_TOLERANCE_M:
        start = tuple(round(float(x), 2) for x in trajectory.position_m[0])
        here = tuple(round(float(x), 2) for x in position_m)
        raise DeviceError(
            f"the trajectory begins at {start}, {gap:.2f} m from the vehicle at {here}; at most {START_TOLERANCE_M} m "
            "is allowed: plan again from the vehicle's place"
        )


def time_steps(duration_s: float, step_s: float) -> Floats:
    """Times (n,) from 0 to exactly ``duration_s``, a step apart but for the last; at least two."""
    steps = max(int(np.ceil(duration_s / step_s - 1e-9)), 1)
    return np.minimum(step_s * np.arange(steps + 1, dtype=float), duration_s)


def hover(position_m: Floats, yaw_rad: float, time_s: Floats) -> Reference:
    """Staying in one place (3,) at these times (n,)."""
    still = np.zeros((len(time_s), 3))
    return Reference(
        time_s=time_s,
        position_m=position_m + still,
        velocity_mps=still,
        acceleration_mps2=still,
        yaw_rad=np.full(len(time_s), yaw_rad),
    )


def sampled(trajectory: Trajectory, time_s: Floats) -> Reference:
    """The trajectory at these times (n,) after its first sample; it hovers before and after."""
    at = np.asarray(time_s, float) + trajectory.time_s[0]
    return Reference(
        time_s=np.asarray(time_s, float),
        position_m=_between(at, trajectory.time_s, trajectory.position_m),
        velocity_mps=_between(at, trajectory.time_s, trajectory.velocity_mps),
        acceleration_mps2=_between(at, trajectory.time_s, trajectory.acceleration_mps2),
        yaw_rad=np.interp(at, trajectory.time_s, trajectory.yaw_rad),
    )


def braked(trajectory: Trajectory, from_s: float, step_s: float) -> Reference:
    """The way along the trajectory from ``from_s`` to a stop, in steps; the first sample is at ``from_s``.

    The trajectory's own clock is slowed down smoothly (half a cosine) to a halt, so that the drone stays on the curve.
    """
    speed = float(np.linalg.norm(sampled(trajectory, np.array([from_s])).velocity_mps))
    halt_s = max(speed * np.pi / 2 / BRAKING_MPS2, step_s)
    elapsed = np.asarray(step_s * np.arange(int(np.ceil(halt_s / step_s)) + 1), float)
    phase = np.pi * np.minimum(elapsed / halt_s, 1.0)
    rate = ((1 + np.cos(phase)) / 2)[:, None]
    slowing = (np.pi / 2 / halt_s * np.sin(phase))[:, None]
    along = sampled(trajectory, from_s + halt_s / 2 / np.pi * (phase + np.sin(phase)))
    return Reference(
        time_s=from_s + elapsed,
        position_m=along.position_m,
        velocity_mps=along.velocity_mps * rate,
        acceleration_mps2=along.acceleration_mps2 * rate**2 - along.velocity_mps * slowing,
        yaw_rad=along.yaw_rad,
    )


def joined(way: Reference, at: int, rest: Reference) -> Reference:
    """The way up to a row, then the rest, whose first row is that one."""
    return Reference(
        time_s=np.concatenate([way.time_s[:at], rest.time_s]),
        position_m=np.concatenate([way.position_m[:at], rest.position_m]),
        velocity_mps=np.concatenate([way.velocity_mps[:at], rest.velocity_mps]),
        acceleration_mps2=np.concatenate([way.acceleration_mps2[:at], rest.acceleration_mps2]),
        yaw_rad=np.concatenate([way.yaw_rad[:at], rest.yaw_rad]),
    )


def descent(position_m: Floats, yaw_rad: float, floor_m: float, step_s: float) -> Reference:
    """Straight down from a place (3,) to `LANDED_M` above the floor, in steps, with smooth start and end."""
    depth = max(float(position_m[2]) - floor_m - LANDED_M, 0.0)
    time_s = time_steps(max(1.5 * depth / DESCENT_MPS, step_s), step_s)
    t = time_s / time_s[-1]
    way = hover(position_m, yaw_rad, time_s)
    height, speed = np.zeros((len(t), 3)), np.zeros((len(t), 3))
    height[:, 2] = depth * (3 * t**2 - 2 * t**3)
    speed[:, 2] = depth * (6 * t - 6 * t**2) / time_s[-1]
    return Reference(
        time_s=time_s,
        position_m=way.position_m - height,
        velocity_mps=-speed,
        acceleration_mps2=way.acceleration_mps2,
        yaw_rad=way.yaw_rad,
    )


def as_vec3(row: Floats) -> Vec3:
    """The three numbers of a row (3,)."""
    return (float(row[0]), float(row[1]), float(row[2]))


def _between(at: Floats, time_s: Floats, rows: Floats) -> Floats:
    return np.stack([np.interp(at, time_s, rows[:, axis]) for axis in range(3)], axis=1)
