"""Scenes, trajectories and the like for flight tests."""

from __future__ import annotations

import numpy as np

from mintpilot.core.geometry import Box, Vec3
from mintpilot.core.plan import Site, Stop
from mintpilot.core.task import Action
from mintpilot.core.trajectory import Trajectory
from mintpilot.simulation.scene import ClosedRoom, Person, Scene, Smoke, Solid

START: Vec3 = (2.0, 2.0, 1.5)


def block(lo: Vec3, hi: Vec3, name: str = "crate-1", kind: str = "crate", **more: object) -> Solid:
    return Solid(id=name, kind=kind, extent_m=Box(lo_m=lo, hi_m=hi), **more)


def scene(**more: object) -> Scene:
    return Scene(name="hall", volume=Box(lo_m=(0, 0, 0), hi_m=(12, 8, 3.5)), start_m=START, **more)


def smoke(*, toxic: bool) -> Smoke:
    return Smoke(id="smoke-1", extent_m=Box(lo_m=(5, 0, 0), hi_m=(7, 8, 3)), toxic=toxic)


def room(occupant: Person | None) -> ClosedRoom:
    return ClosedRoom(
        id="room-1",
        extent_m=Box(lo_m=(9, 5, 0), hi_m=(12, 8, 2.6)),
        door_m=Box(lo_m=(10, 5, 0), hi_m=(10.9, 5.1, 2)),
        viewpoint_m=(10.45, 3.8, 1.5),
        occupant=occupant,
    )


def line(a: Vec3, b: Vec3, speed_mps: float = 1.5, step_s: float = 0.02) -> Trajectory:
    """Smoothly from a to b, heading along the line; the mean speed is the one given."""
    gap = np.subtract(b, a)
    length = float(np.linalg.norm(gap))
    duration = max(length / speed_mps, 0.2)
    time = np.linspace(0.0, duration, int(duration / step_s) + 2)
    s = time / duration
    shape = 10 * s**3 - 15 * s**4 + 6 * s**5
    rate = (30 * s**2 - 60 * s**3 + 30 * s**4) / duration
    bend = (60 * s - 180 * s**2 + 120 * s**3) / duration**2
    return Trajectory(
        time_s=time,
        position_m=np.asarray(a) + shape[:, None] * gap,
        velocity_mps=rate[:, None] * gap,
        acceleration_mps2=bend[:, None] * gap,
        yaw_rad=np.full(len(time), np.arctan2(gap[1], gap[0]) if length > 0 else 0.0),
    )


def stop(action: Action, place: Vec3, *others: Vec3) -> Stop:
    return Stop(id="stop", action=action, sites=tuple(Site(position_m=p) for p in (place, *others)))
