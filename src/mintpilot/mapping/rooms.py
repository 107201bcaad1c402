"""Closed doors into rooms that may be looked into."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mintpilot.core.geometry import Box, Floats, GridFrame, Vec3
from mintpilot.core.semantic_map import Cell
from mintpilot.mapping.objects import Track
from mintpilot.mapping.settings import MappingSettings


def facing_of(door: Track) -> Floats:
    """Unit vector (3,), level, out of the door towards where it was seen from.

    From the flatness of the leaf's points where there are enough, else from the thin edge of its extent.
    """
    points = door.points_m
    if points is not None and len(points) >= 20:
        level = points[:, :2] - points[:, :2].mean(axis=0)
        _, vectors = np.linalg.eigh(level.T @ level)
        normal = np.array([vectors[0, 0], vectors[1, 0], 0.0])
    else:
        size = door.box_m.size_m
        normal = np.array([1.0, 0.0, 0.0]) if size[0] <= size[1] else np.array([0.0, 1.0, 0.0])
    towards = float((door.eye_m - np.asarray(door.box_m.centre_m)) @ normal)
    return normal if towards >= 0 else -normal


def viewpoint_of(
    door: Track, frame: GridFrame, cells: NDArray[np.uint8], radius_m: float, settings: MappingSettings
) -> Vec3:
    """Where to hover to look in: in front of the leaf, in known free space with room for the vehicle if there is any.

    The wished place is ``viewpoint_m`` before the leaf's middle at ``viewpoint_height_m``; the nearest place within
    0.7 m of it that has the most clearance wins. Where nothing near is free the wished place is given all the same.
    """
    middle = np.asarray(door.box_m.centre_m)
    middle[2] = frame.origin_m[2] if frame.is_flat else settings.viewpoint_height_m
    normal = facing_of(door)
    wish = middle + settings.viewpoint_m * normal
    side = np.array([-normal[1], normal[0], 0.0])
    best, best_rank = wish, (-1.0, 0.0)
    for out in (0.0, 0.15, 0.3, -0.15, 0.45, 0.6):
        for along in (0.0, 0.2, -0.2, 0.4, -0.4):
            for up in (0.0, 0.2, -0.2, 0.4):
                place = wish + out * normal + along * side + np.array([0.0, 0.0, up])
                rank = (_free_share(place, frame, cells, radius_m), -abs(out) - abs(along) - abs(up))
                if rank > best_rank:
                    best, best_rank = place, rank
    return (float(best[0]), float(best[1]), float(best[2]))


_BALL = np.array([(x, y, z) for x in (-1, 0, 1) for y in (-1, 0, 1) for z in (-1, 0, 1)], float)
_BALL /= np.maximum(1.0, np.linalg.norm(_BALL, axis=1))[:, None]


def _free_share(place: Floats, frame: GridFrame, cells: NDArray[np.uint8], radius_m: float) -> float:
    """Share of the vehicle's hull around a place that is in free cells."""
    around = frame.cells_of(place + radius_m * _BALL)
    inside = frame.contains(around)
    z, y, x = around[inside].T
    return float((cells[z, y, x] == Cell.FREE).sum()) / len(_BALL)


def same_door(a: Box, b: Box) -> float:
    """How likely two leaves are one: 1 for equal places, 0 from 1 m apart on."""
    return 1.0 - float(np.linalg.norm(np.asarray(a.centre_m) - np.asarray(b.centre_m)))
