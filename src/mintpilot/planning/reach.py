"""How near one can get: for surveys of a world that is only partly known."""

from __future__ import annotations

import numpy as np

from mintpilot.core.geometry import Floats, Vec3
from mintpilot.core.plan import VehicleLimits
from mintpilot.core.semantic_map import SemanticMap
from mintpilot.planning.flyable import known_flyable
from mintpilot.planning.grid_search import distance_field, shortest_path


def nearest_reachable(map: SemanticMap, limits: VehicleLimits, *, start_m: Vec3, goal_m: Vec3) -> Floats | None:
    """The way to the known-flyable place that is nearest to the goal and can be reached from the start.

    Args:
        map: what is known.
        limits: size of the vehicle.
        start_m: where the vehicle is, metres; it may be up to half a metre from flyable space.
        goal_m: where it would like to be, metres.

    Returns:
        Way-points (n, 3), metres, beginning at the start; None where no flyable cell is near the start.
    """
    free = known_flyable(map, limits)
    cells = np.argwhere(free)
    if not len(cells):
        return None
    centres = map.frame.centres_of(cells)
    offsets = np.linalg.norm(centres - np.asarray(start_m), axis=1)
    first = int(np.argmin(offsets))
    if offsets[first] > 0.5:
        return None
    start = tuple(int(i) for i in cells[first])
    reachable = np.isfinite(distance_field(free, start))[tuple(cells.T)]
    distances = np.where(reachable, np.linalg.norm(centres - np.asarray(goal_m), axis=1), np.inf)
    last = tuple(int(i) for i in cells[int(np.argmin(distances))])
    _, way = shortest_path(free, start, last)
    return np.vstack([np.asarray([start_m], float), map.frame.centres_of(way)])
