"""The monitors' own geometry, by sampling. It uses nothing of planning, simulation or mapping."""

from __future__ import annotations

import itertools
import math

import numpy as np

from mintpilot.core.geometry import Bools, Box, Floats, GridFrame, Vec3
from mintpilot.simulation.scene import Person, Scene, Shape

SPACING_M = 0.03


def densely(points: Floats, spacing_m: float = SPACING_M) -> Floats:
    """Points along a polyline (n, 3), at most so far apart."""
    if len(points) < 2:
        return points
    lengths = np.linalg.norm(np.diff(points, axis=0), axis=1)
    counts = np.maximum(1, np.ceil(lengths / spacing_m).astype(int))
    parts = [points[:1]]
    for i in np.flatnonzero(lengths > 0):
        shares = np.arange(1, counts[i] + 1)[:, None] / counts[i]
        parts.append(points[i] + (points[i + 1] - points[i]) * shares)
    return np.concatenate(parts)


def gap_to_cells(points: Floats, barred: Bools, frame: GridFrame, most_m: float) -> Floats:
    """Distance (n,) of points (n, 3) to the nearest barred cube or the border of the grid, at most ``most_m``."""
    edge = frame.resolution_m
    size = np.array(barred.shape[::-1])
    axes = 2 if size[2] == 1 else 3
    spot = ((points - np.asarray(frame.origin_m)) / edge)[:, :axes]
    size = size[:axes]
    least = np.minimum(np.minimum(spot, size - spot).min(axis=1), most_m / edge)
    here, reach = np.floor(spot).astype(int), math.ceil(most_m / edge)
    for offset in itertools.product(range(-reach, reach + 1), repeat=axes):
        other = here + np.array(offset)
        inside = ((other >= 0) & (other < size)).all(axis=1)
        index = np.zeros((len(spot), 3), int)
        index[:, :axes] = np.where(inside[:, None], other, 0)
        solid = inside & barred[index[:, 2], index[:, 1], index[:, 0]]
        if solid.any():
            gap = np.maximum(np.maximum(other - spot, spot - other - 1), 0.0)
            least = np.where(solid, np.minimum(least, np.sqrt((gap * gap).sum(axis=1))), least)
    return np.asarray(np.maximum(least, 0.0) * edge)


def grown(flags: Bools) -> Bools:
    """Flags (nz, ny, nx) with all their 26 neighbours."""
    padded = np.pad(flags, 1)
    nz, ny, nx = flags.shape
    out = np.zeros_like(flags)
    for z, y, x in itertools.product(range(3), repeat=3):
        out |= padded[z : z + nz, y : y + ny, x : x + nx]
    return out


def box_gap(points: Floats, box: Box) -> tuple[Floats, Floats]:
    """Distance of points (n, 3) to a box: sideways and upwards, each (n,), 0 inside its shadow."""
    lo, hi = np.asarray(box.lo_m), np.asarray(box.hi_m)
    off = np.maximum(np.maximum(lo - points, points - hi), 0.0)
    return np.hypot(off[:, 0], off[:, 1]), off[:, 2]


def touched(points: Floats, times_s: Floats, scene: Scene, radius_m: float, half_height_m: float) -> str:
    """What an upright cylinder touches along these points first; empty: nothing.

    Args:
        points: centres (n, 3), metres.
        times_s: (n,) seconds of the mission.
        scene: the truth.
        radius_m: of the cylinder.
        half_height_m: of it.
    """
    for solid in scene.solids:
        here = times_s >= solid.appears_s if solid.appears_s > 0 else np.ones(len(points), bool)
        if _hits(points, solid.extent_m, solid.shape, radius_m, half_height_m)[here].any():
            return solid.id
    for room in scene.rooms:
        if _hits(points, room.extent_m, Shape.BOX, radius_m, half_height_m).any():
            return room.id
    for person in scene.persons:
        if any(_hits(points, part, Shape.CYLINDER, radius_m, half_height_m).any() for part in _body(person)):
            return person.id
    lo, hi = np.asarray(scene.volume.lo_m)[:2], np.asarray(scene.volume.hi_m)[:2]
    if ((points[:, :2] < lo + radius_m) | (points[:, :2] > hi - radius_m)).any():
        return "outer wall"
    low, high = scene.volume.lo_m[2], scene.volume.hi_m[2]
    if ((points[:, 2] < low + half_height_m) | (points[:, 2] > high - half_height_m)).any():
        return "floor or ceiling"
    return ""


def inside_smoke(points: Floats, box: Box, radius_m: float, half_height_m: float) -> Bools:
    """Where the cylinder reaches into a box (n,)."""
    return _hits(points, box, Shape.BOX, radius_m, half_height_m)


def hovered_near(trace: Floats, place_m: Vec3, reach_m: float) -> bool:
    """Whether the trace (n, 4) stands still somewhere within that distance of a place."""
    if len(trace) < 2:
        return False
    gone = np.linalg.norm(np.diff(trace[:, 1:], axis=0), axis=1)
    still = np.r_[True, gone < 1e-3] | np.r_[gone < 1e-3, True]
    near = np.linalg.norm(trace[:, 1:] - np.asarray(place_m), axis=1) <= reach_m
    return bool((still & near).any())


def _hits(points: Floats, box: Box, shape: Shape, radius_m: float, half_m: float) -> Bools:
    lo, hi = np.asarray(box.lo_m), np.asarray(box.hi_m)
    middle, size = (lo + hi) / 2, hi - lo
    side, up = box_gap(points, box)
    if shape is Shape.CYLINDER:
        side = np.maximum(np.hypot(*(points[:, :2] - middle[:2]).T) - size[:2].min() / 2, 0.0)
    elif shape is Shape.SPHERE:
        side = np.maximum(np.hypot(*(points[:, :2] - middle[:2]).T) - radius_m, 0.0)
        rise = np.maximum(np.abs(points[:, 2] - middle[2]) - half_m, 0.0)
        return np.asarray(side**2 + rise**2 < (size.min() / 2) ** 2)
    return np.asarray((side < radius_m) & (up < half_m))


def _body(person: Person) -> list[Box]:
    parts = []
    for along in (-0.6, 0.0, 0.6):
        x = person.position_m[0] + along * math.cos(person.yaw_rad)
        y = person.position_m[1] + along * math.sin(person.yaw_rad)
        z = person.position_m[2]
        parts.append(Box(lo_m=(x - 0.3, y - 0.3, z), hi_m=(x + 0.3, y + 0.3, z + 0.3)))
    return parts
