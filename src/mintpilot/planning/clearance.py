"""Exact distances between a body that is flown along straight pieces and the cells that it must stay away from.

The body is a ball, in a flat map a disc, of radius `VehicleLimits.clearance_m`. Swept along a segment it touches a cell
if and only if the segment comes nearer to the cell's cube (square) than that radius. The distance is found in closed
form, so that the result does not depend on the size of the cells.

Barred are cells that are occupied or unknown, cells of regions not known passable, and all that lies outside the grid:
sideways, and in a voxel map above and below too.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from mintpilot.core.compiled import compiled
from mintpilot.core.geometry import Bools, Floats, GridFrame, Ints
from mintpilot.core.semantic_map import Cell, Knowledge, SemanticMap

TOLERANCE_M = 1e-7
"""Rounding error allowed for in distances, metres."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Surroundings:
    """The barred cells in a box around some points, in units of cells."""

    barred: Bools
    """Flags (nz, ny, nx) of a part of the grid and what lies beside it; outside of the array nothing is known."""
    frame: GridFrame
    """The grid of the map."""
    corner: Ints
    """Cell (3,) ``[x, y, z]`` of the map at ``barred[0, 0, 0]``; it may lie outside the grid."""
    keep: float
    """Distance to be kept, in cells."""

    def spots(self, points_m: ArrayLike) -> Floats:
        """Points (n, 3) ``[x, y, z]``, metres, in cells from the array's corner. In a flat map z is made 0.5."""
        points = np.atleast_2d(np.asarray(points_m, float))
        spots = (points - np.asarray(self.frame.origin_m)) / self.frame.resolution_m - self.corner
        if self.frame.is_flat:
            spots[:, 2] = 0.5
        return np.ascontiguousarray(spots)

    def least_gaps(self, points_m: ArrayLike) -> Floats:
        """For each piece of the polyline (n, 3) the least distance to a barred cell, in cells, at most `keep`.

        A single point counts as one piece.
        """
        gaps: Floats = _least_gaps(self.barred, self.spots(points_m), self.keep)
        return gaps

    def gap_at(self, point_m: ArrayLike) -> float:
        """The least distance of one point (3,) to a barred cell, in cells, at most `keep`. Compiles nothing."""
        lowest = np.argwhere(self.barred)[:, ::-1]
        spot = self.spots(point_m)[0]
        apart = np.maximum(np.maximum(lowest - spot, spot - (lowest + 1)), 0.0)
        return min(self.keep, float(np.sqrt((apart * apart).sum(axis=1).min(initial=np.inf))))

    def nearest(self, a_m: ArrayLike, b_m: ArrayLike) -> tuple[Ints, float, float]:
        """Of the segment from a to b, the first spot that comes nearer than `keep` to a barred cell.

        Returns:
            (cell (3,) ``[z, y, x]`` of the map; how far along the segment, 0 to 1; distance in cells).
        """
        k, j, i, share, gap = _first_breach(self.barred, self.spots(a_m)[0], self.spots(b_m)[0], self.keep)
        return np.array([k, j, i]) + self.corner[::-1], float(share), float(gap)


def surroundings(
    map: SemanticMap, points_m: ArrayLike, keep_m: float, *, passable: Collection[str] = ()
) -> Surroundings:
    """What a body may touch on straight ways between the given points.

    Args:
        map: what is known.
        points_m: points (n, 3), finite, in or near the grid; all ways lie in their bounding box.
        keep_m: distance to be kept from barred cells, metres.
        passable: ids of regions that are taken as passable besides those known to be.
    """
    frame = map.frame
    keep = min(keep_m / frame.resolution_m, float(sum(frame.shape)))  # no cell of the grid is further from its border
    spots = (np.atleast_2d(np.asarray(points_m, float)) - frame.origin_m) / frame.resolution_m
    spare = np.ceil(keep) + 2
    size = np.array(frame.shape[::-1])
    # Beyond the grid all is barred: one cell of it is enough, further ones are farther away.
    low = np.clip(np.floor(spots.min(axis=0)) - spare, -1, size - 1).astype(np.int64)
    high = np.clip(np.ceil(spots.max(axis=0)) + spare, 1, size + 1).astype(np.int64)
    if frame.is_flat:
        low[2], high[2] = 0, 1
    barred = np.ones(tuple((high - low)[::-1]), bool)
    inside_low, inside_high = np.maximum(low, 0), np.minimum(high, size)
    window = tuple(slice(int(a), int(b)) for a, b in zip(inside_low[::-1], inside_high[::-1], strict=True))
    part = tuple(
        slice(int(a), int(b)) for a, b in zip((inside_low - low)[::-1], (inside_high - low)[::-1], strict=True)
    )
    barred[part] = map.cells[window] != Cell.FREE
    for region in map.regions:
        if region.passable is not Knowledge.YES and region.id not in passable and region.cells.size:
            cells = np.stack(np.unravel_index(region.cells, frame.shape), axis=1)
            near = ((cells >= inside_low[::-1]) & (cells < inside_high[::-1])).all(axis=1)
            barred[tuple((cells[near] - low[::-1]).T)] = True
    return Surroundings(barred=barred, frame=frame, corner=low, keep=keep)


@compiled(error_model="numpy")
def box_gap(a: Floats, d: Floats, k: int, j: int, i: int) -> tuple[float, float]:
    """Squared distance between the segment from a (3,) to a + d, ``[x, y, z]``, and the unit cube of cell (k, j, i).

    Along one axis the distance to the cube is linear between the places where the segment meets the cube's two planes,
    so the squared distance is a parabola between neighbouring ones of them, and convex as a whole: the search goes on
    from place to place as long as it falls.

    Returns:
        (squared distance; how far along the segment, 0 to 1, it is reached).
    """
    t0 = 0.0
    while True:
        t1 = min(_next(a[0] - i, d[0], t0), _next(a[1] - j, d[1], t0), _next(a[2] - k, d[2], t0))
        middle = 0.5 * (t0 + t1)
        x, rx = _outside(a[0] - i, d[0], middle)
        y, ry = _outside(a[1] - j, d[1], middle)
        z, rz = _outside(a[2] - k, d[2], middle)
        square = rx * rx + ry * ry + rz * rz
        t = t0 if square == 0.0 else min(max(-(rx * x + ry * y + rz * z) / square, t0), t1)
        if t < t1 or t1 >= 1.0 or square == 0.0:
            x, y, z = x + t * rx, y + t * ry, z + t * rz
            return x * x + y * y + z * z, t
        t0 = t1


@compiled(error_model="numpy")
def _next(a: float, d: float, t0: float) -> float:
    """Where after t0 the coordinate a + t d is next 0 or 1; 1 where that is not before the segment's end."""
    found = 1.0
    if d != 0.0:
        for t in (-a / d, (1.0 - a) / d):
            if t0 < t < found:
                found = t
    return found


@compiled(error_model="numpy")
def _outside(a: float, d: float, t: float) -> tuple[float, float]:
    """How far a + t d is outside of 0 to 1, as (value at t = 0, rate) of the linear function that holds around t."""
    at = a + t * d
    if at < 0.0:
        return -a, -d
    if at > 1.0:
        return a - 1.0, d
    return 0.0, 0.0


@compiled(error_model="numpy")
def first_near(barred: Bools, a: Floats, d: Floats, keep: float) -> tuple[float, float, int, int, int]:
    """The barred cell nearest to the segment from a to a + d; ties: the one that is met first.

    Returns:
        (squared distance, at most ``keep**2``; how far along, 0 to 1; the cell (k, j, i), or -1 where none is nearer).
    """
    nz, ny, nx = barred.shape
    x0, x1 = min(a[0], a[0] + d[0]), max(a[0], a[0] + d[0])
    y0, y1 = min(a[1], a[1] + d[1]), max(a[1], a[1] + d[1])
    z0, z1 = min(a[2], a[2] + d[2]), max(a[2], a[2] + d[2])
    best, where, bk, bj, bi = keep * keep, 0.0, -1, -1, -1
    for k in range(max(0, int(np.floor(z0 - keep))), min(nz, int(np.ceil(z1 + keep)))):
        z = max(k - z1, z0 - k - 1, 0.0)
        for j in range(max(0, int(np.floor(y0 - keep))), min(ny, int(np.ceil(y1 + keep)))):
            y = max(j - y1, y0 - j - 1, 0.0)
            if y * y + z * z > best:
                continue
            for i in range(max(0, int(np.floor(x0 - keep))), min(nx, int(np.ceil(x1 + keep)))):
                if barred[k, j, i]:
                    x = max(i - x1, x0 - i - 1, 0.0)
                    if x * x + y * y + z * z > best:
                        continue
                    gap, t = box_gap(a, d, k, j, i)
                    if gap < best or (gap == best and bk >= 0 and t < where):
                        best, where, bk, bj, bi = gap, t, k, j, i
    return best, where, bk, bj, bi


@compiled(error_model="numpy")
def _least_gaps(barred: Bools, points: Floats, keep: float) -> Floats:
    """Pieces are looked at in parts of about one cell, so that few cells are near each."""
    gaps = np.full(max(len(points) - 1, 1), keep)
    for piece in range(len(gaps)):
        a = points[piece]
        d = points[min(piece + 1, len(points) - 1)] - a
        parts = max(1, int(np.ceil(np.sqrt((d * d).sum()))))
        for part in range(parts):
            gap = first_near(barred, a + d * (part / parts), d / parts, gaps[piece])[0]
            gaps[piece] = np.sqrt(gap)
            if gap == 0.0:
                break
    return gaps


@compiled(error_model="numpy")
def _first_breach(barred: Bools, a: Floats, b: Floats, keep: float) -> tuple[int, int, int, float, float]:
    d = b - a
    parts = max(1, int(np.ceil(np.sqrt((d * d).sum()))))
    for part in range(parts):
        gap, t, k, j, i = first_near(barred, a + d * (part / parts), d / parts, keep)
        if k >= 0:
            return k, j, i, (part + t) / parts, np.sqrt(gap)
    return -1, -1, -1, 0.0, keep
