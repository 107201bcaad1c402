"""The truth of spatial propositions along a way that is flown, by exact distances (method, section 14)."""

from __future__ import annotations

import numpy as np

from mintpilot.core.geometry import Bools, Floats, GridFrame, Ints
from mintpilot.core.plan import VehicleLimits
from mintpilot.core.rule import About, Proposition, Ruling
from mintpilot.core.semantic_map import SemanticMap
from mintpilot.core.tolerances import TOLERANCE
from mintpilot.planning.clearance import Surroundings
from mintpilot.planning.smoothing import densified

PIECES_PER_RADIUS = 4
"""A way is looked at in pieces of at most this part of the body's radius, and of a cell's edge."""
SHORTEST_M = 0.01
"""No piece is cut shorter than this, metres, however small the body is."""


def piece_m(frame: GridFrame, limits: VehicleLimits) -> float:
    """The longest piece of a way that is looked at as a whole, metres."""
    return max(min(frame.resolution_m, limits.radius_m) / PIECES_PER_RADIUS, SHORTEST_M)


def letters_along(
    ruling: Ruling, map: SemanticMap, limits: VehicleLimits, way_m: Floats, *, spare_m: float
) -> list[tuple[int, int]]:
    """What holds everywhere on each piece of a way, and what may hold somewhere on it, each once in a row.

    Args:
        ruling: the rules, bound to the map.
        map: what is known.
        limits: size of the vehicle, and how well it knows where it is.
        way_m: points (n, 3), metres, n at least 1; between them it leads straight.
        spare_m: by how much what is flown may leave that way besides, metres.
    """
    points = densified(np.asarray(way_m, float), piece_m(map.frame, limits))
    if len(points) == 1:
        points = np.repeat(points, 2, axis=0)
    yes = np.zeros(len(points) - 1, np.int64)
    may = np.zeros(len(points) - 1, np.int64)
    off_m = spare_m + 3 * limits.position_sigma_m
    for bit, (what, cells) in enumerate(zip(ruling.automaton.propositions, ruling.cells, strict=True)):
        if what.about.spatial:
            sure, possible = _truth(what, cells, map.frame, points, limits.radius_m, off_m)
            yes |= sure.astype(np.int64) << bit
            may |= (possible | sure).astype(np.int64) << bit
    new = np.concatenate([[True], (np.diff(yes) != 0) | (np.diff(may) != 0)])
    return list(zip(yes[new].tolist(), may[new].tolist(), strict=True))


def _truth(
    what: Proposition, cells: Ints, frame: GridFrame, points: Floats, radius_m: float, off_m: float
) -> tuple[Bools, Bools]:
    """On which pieces a proposition holds, and on which it may, if each point may be ``off_m`` away from the true."""
    length = np.linalg.norm(np.diff(points, axis=0), axis=1)
    far_m = what.metres + radius_m + off_m + float(length.max()) + frame.resolution_m
    region = np.zeros(frame.size, bool)
    region[cells] = True
    region = region.reshape(frame.shape)
    out_m = _gaps_m(frame, region, points, far_m, beyond=False)
    match what.about:
        case About.TOUCHES | About.WITHIN:
            deep_m = _gaps_m(frame, ~region, points, far_m, beyond=True)
            reach_m = what.metres + radius_m
            most_m = np.where(deep_m > 0, -deep_m, out_m + length)
            near = TOLERANCE if what.about is About.WITHIN else -TOLERANCE
            return most_m < reach_m - off_m, out_m < reach_m + off_m + near
        case About.IN:
            deep_m = _gaps_m(frame, ~region, points, far_m, beyond=True)
            return deep_m > off_m, out_m <= off_m
        case _:
            deep_m = _gaps_m(frame, ~region, points, far_m, beyond=True)
            inside = deep_m >= radius_m + off_m - TOLERANCE
            return inside, (deep_m + length >= radius_m - off_m) & (out_m <= off_m)


def _gaps_m(frame: GridFrame, solid: Bools, points: Floats, far_m: float, *, beyond: bool) -> Floats:
    """For each piece (n - 1,) its least distance to the surface of a solid cell, metres, at most ``far_m``.

    Args:
        frame: the grid.
        solid: flags (nz, ny, nx).
        points: way (n, 3), metres, n at least 2.
        far_m: no distance is followed further.
        beyond: whether what lies outside the grid is solid.
    """
    keep = far_m / frame.resolution_m
    spots = (points - frame.origin_m) / frame.resolution_m
    low = np.floor(spots.min(axis=0) - keep).astype(np.int64) - 1
    high = np.ceil(spots.max(axis=0) + keep).astype(np.int64) + 1
    if frame.is_flat:
        low[2], high[2] = 0, 1
    size = np.array(frame.shape[::-1])
    part = np.full(tuple((high - low)[::-1]), beyond)
    a, b = np.clip(low, 0, size), np.clip(high, 0, size)
    if (a < b).all():
        inside = tuple(slice(int(s), int(t)) for s, t in zip((a - low)[::-1], (b - low)[::-1], strict=True))
        part[inside] = solid[tuple(slice(int(s), int(t)) for s, t in zip(a[::-1], b[::-1], strict=True))]
    near = Surroundings(barred=part, frame=frame, corner=low, keep=keep)
    return near.least_gaps(points) * frame.resolution_m
