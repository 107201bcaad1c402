"""Where to look from next: for surveys of a world that is only partly known.

Next-best-view exploration: places that can be reached through known free space are weighed by how much that is new
could be seen from them, and by how far away they are.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mintpilot.core.errors import InfeasibleError
from mintpilot.core.geometry import Bools, Floats, GridFrame, Ints, Vec3
from mintpilot.core.plan import VehicleLimits
from mintpilot.core.semantic_map import SemanticMap
from mintpilot.planning.flyable import known_flyable
from mintpilot.planning.grid_search import distance_field, shortest_path
from mintpilot.planning.sight import view_gain_m3
from mintpilot.planning.terrain import start_cell


@dataclass(frozen=True, slots=True, kw_only=True)
class LookAround:
    """How places are weighed."""

    reach_m: float = 5.0
    """Unknown space this near counts."""
    close_m: float = 4.5
    """Surfaces count until they were looked at from this near."""
    elevation_rad: tuple[float, float] = (-0.65, 0.3)
    """Lowest and highest angle that the camera sees, against the horizon."""
    least_gain_m3: float = 4.0
    """Places that show less that is new are not worth going to."""
    places: int = 160
    """How many places are weighed at a time."""
    fading_m: float = 8.0
    """At this distance a gain counts 1/e of what it counts here."""
    apart_m: float = 2.0
    """No place this near to one that was looked around from before."""
    lowest_m: float = 1.0
    """Height above the volume's floor, at least."""


def next_view(
    map: SemanticMap,
    limits: VehicleLimits,
    *,
    start_m: Vec3,
    seen_from_m: Floats,
    inspected: Bools,
    settings: LookAround,
) -> Floats | None:
    """The way to the best place to look around from.

    Args:
        map: what is known.
        limits: size of the vehicle.
        start_m: where the vehicle is, metres; it may be up to half a metre from flyable space.
        seen_from_m: places (n, 3) where it has looked around, metres.
        inspected: surface cells (nz, ny, nx) that were looked at from near.
        settings: how places are weighed.

    Returns:
        Way-points (n, 3), metres, beginning at the start; None where nothing is worth the way.
    """
    free = known_flyable(map, limits)
    start = _start(map, limits, free, start_m)
    if start is None:
        return None
    way_cells = distance_field(free, start)
    cells = np.argwhere(np.isfinite(way_cells) & free)
    centres = map.frame.centres_of(cells)
    high = centres[:, 2] >= map.frame.origin_m[2] + settings.lowest_m
    apart = np.full(len(cells), np.inf)
    for place in seen_from_m:
        apart = np.minimum(apart, np.linalg.norm(centres - place, axis=1))
    chosen = np.flatnonzero(high & (apart > settings.apart_m))
    chosen = chosen[:: max(1, len(chosen) // settings.places)]
    if not len(chosen):
        return None
    gain_m3 = view_gain_m3(
        map,
        inspected,
        centres[chosen],
        reach_m=settings.reach_m,
        close_m=settings.close_m,
        elevation_rad=settings.elevation_rad,
    )
    way_m = way_cells[tuple(cells[chosen].T)] * map.frame.resolution_m
    worth = np.where(gain_m3 >= settings.least_gain_m3, gain_m3 * np.exp(-way_m / settings.fading_m), 0.0)
    if not worth.any():
        return None
    return _way(free, map.frame, start, cells[chosen[int(np.argmax(worth))]], start_m)


def way_to(map: SemanticMap, limits: VehicleLimits, *, start_m: Vec3, goal_m: Vec3) -> Floats | None:
    """The shortest way through known flyable space; None where there is none. Ends are snapped within half a metre."""
    free = known_flyable(map, limits)
    start, goal = _start(map, limits, free, start_m), _nearest(free, map.frame, goal_m)
    if start is None or goal is None:
        return None
    return _way(free, map.frame, start, np.asarray(goal), start_m)


def _way(free: Bools, frame: GridFrame, start: tuple[int, int, int], goal: Ints, start_m: Vec3) -> Floats | None:
    try:
        _, way = shortest_path(free, start, goal)
    except InfeasibleError:
        return None
    return np.vstack([np.asarray([start_m], float), frame.centres_of(way)])


def _start(map: SemanticMap, limits: VehicleLimits, free: Bools, start_m: Vec3) -> tuple[int, int, int] | None:
    """The cell where paths from a place begin; None where there is none."""
    try:
        z, y, x = (int(i) for i in start_cell(map, limits, free, start_m))
    except InfeasibleError:
        return None
    return (z, y, x)


def _nearest(free: Bools, frame: GridFrame, point_m: Vec3) -> tuple[int, int, int] | None:
    """The flyable cell nearest to a point, within half a metre."""
    cells = np.argwhere(free)
    if not len(cells):
        return None
    offsets = np.linalg.norm(frame.centres_of(cells) - np.asarray(point_m), axis=1)
    best = int(np.argmin(offsets))
    z, y, x = (int(i) for i in cells[best])
    return (z, y, x) if offsets[best] <= 0.5 else None
