"""Placing things on a floor plan without blocking what must stay clear."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np

from mintpilot.core.geometry import Box, Vec3

TRIES = 300
GRID_M = 0.2
"""Walls and gates are drawn on this grid, so that a gate of 2 m is 2 m wide on a map of that resolution too."""


def snap(value_m: float) -> float:
    """The nearest multiple of the grid."""
    return round(round(value_m / GRID_M) * GRID_M, 6)


def block(x: tuple[float, float], y: tuple[float, float], z: tuple[float, float]) -> Box:
    """A box from its three spans, metres."""
    return Box(lo_m=(x[0], y[0], z[0]), hi_m=(x[1], y[1], z[1]))


def gap_m(a: Box, b: Box) -> float:
    """Distance between two boxes on the floor plan, metres; 0 when they touch or overlap."""
    dx = max(a.lo_m[0] - b.hi_m[0], b.lo_m[0] - a.hi_m[0], 0.0)
    dy = max(a.lo_m[1] - b.hi_m[1], b.lo_m[1] - a.hi_m[1], 0.0)
    return math.hypot(dx, dy)


def _samples(way: Sequence[tuple[float, float]]) -> list[tuple[float, float]]:
    """Points every 0.25 m along a polyline."""
    points = [way[0]]
    for (ax, ay), (bx, by) in pairwise(way):
        count = max(1, math.ceil(math.hypot(bx - ax, by - ay) / 0.25))
        points += [(ax + (bx - ax) * i / count, ay + (by - ay) * i / count) for i in range(1, count + 1)]
    return points


@dataclass(kw_only=True)
class Floor:
    """What is taken, and what must stay clear, while a world is drawn."""

    taken: list[Box] = field(default_factory=list)
    """Solids and rooms: nothing may overlap them."""
    clear: list[tuple[Box, float]] = field(default_factory=list)
    """(box, distance): nothing may come nearer to the box than that, metres."""

    def keep_clear(self, points: Sequence[tuple[float, float]], distance_m: float) -> None:
        """Keeps that distance around places on the floor plan."""
        self.clear += [(block((x, x), (y, y), (0.0, 0.0)), distance_m) for x, y in points]

    def keep_way_clear(self, way: Sequence[tuple[float, float]], distance_m: float) -> None:
        """Keeps that distance along a polyline on the floor plan."""
        self.keep_clear(_samples(way), distance_m)

    def fits(self, box: Box, spacing_m: float) -> bool:
        """Whether the box overlaps nothing taken (with some spacing) and leaves clear what must be."""
        return all(gap_m(box, other) > spacing_m for other in self.taken) and all(
            gap_m(box, place) >= distance for place, distance in self.clear
        )

    def place(
        self, rng: np.random.Generator, draw: Callable[[np.random.Generator], Box], *, spacing_m: float = 0.1
    ) -> Box | None:
        """Draws until something fits, takes the place and returns it; None when nothing did in `TRIES` draws."""
        for _ in range(TRIES):
            box = draw(rng)
            if self.fits(box, spacing_m):
                self.taken.append(box)
                return box
        return None


def length_m(way: Sequence[tuple[float, float]]) -> float:
    """Length of a polyline on the floor plan, metres."""
    return sum(math.dist(a, b) for a, b in pairwise(way))


def standing(centre: tuple[float, float], size: Vec3, volume: Box) -> Box:
    """A thing of that size standing on the floor at a place, pushed inside the volume."""
    spans = []
    for axis in (0, 1):
        half = size[axis] / 2
        middle = min(max(centre[axis], volume.lo_m[axis] + half), volume.hi_m[axis] - half)
        spans.append((middle - half, middle + half))
    return block(spans[0], spans[1], (volume.lo_m[2], volume.lo_m[2] + size[2]))
