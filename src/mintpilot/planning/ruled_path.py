"""Single flights under rules: the check of a motion, and the shortest way to one place (method, section 14)."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from mintpilot.core.errors import InfeasibleError
from mintpilot.core.geometry import Floats, Vec3
from mintpilot.core.plan import VehicleLimits
from mintpilot.core.rule import Ruling
from mintpilot.core.semantic_map import SemanticMap
from mintpilot.planning.flyable import known_flyable
from mintpilot.planning.lattice import lattice_of
from mintpilot.planning.rule_labels import RuleGrid
from mintpilot.planning.rule_search import ways_from
from mintpilot.planning.terrain import start_cell


def keeps_rules(way_m: Floats, ruling: Ruling, map: SemanticMap, limits: VehicleLimits, *, as_along_m: Floats) -> bool:
    """Whether a motion (n, 3) leaves the rules in no state in which the path (m, 3) would not leave them."""
    grid = RuleGrid(ruling=ruling, map=map, limits=limits)
    start = grid.number(ruling.states)
    planned = grid.flown(start, _dense(as_along_m, map.frame.resolution_m / 2), ruling.held)
    came = grid.flown(start, _dense(way_m, map.frame.resolution_m / 4), ruling.held)
    return came >= 0 and planned >= 0 and grid.sets[came] <= grid.sets[planned]


def ruled_path(
    map: SemanticMap, limits: VehicleLimits, ruling: Ruling, *, start_m: Vec3, goal_m: Vec3
) -> Floats | None:
    """The shortest way through known flyable space that keeps all rules if the flight ends there; None: none does."""
    free = known_flyable(map, limits)
    goal = map.frame.cells_of(np.array([goal_m]))[0]
    if map.frame.is_flat:
        goal[0] = 0
    try:
        start = start_cell(map, limits, free, start_m)
    except InfeasibleError:
        return None
    if not map.frame.contains(goal[None])[0] or not free[tuple(goal)]:
        return None
    grid, lattice = RuleGrid(ruling=ruling, map=map, limits=limits), lattice_of(free)
    kinds = np.full(lattice.size, -1, np.int64)
    kinds[lattice.nodes_of_flat(np.arange(map.frame.size))] = grid.kinds
    flat = int(np.ravel_multi_index(tuple(start), map.frame.shape))
    begun = grid.after(grid.number(ruling.states), int(grid.kinds[flat]), ruling.held)
    if begun < 0:
        return None
    sets, table = grid.table(begun, ruling.held)
    ways = ways_from(lattice, lattice.allowed, lattice.node(start), sets, table, kinds, np.zeros(lattice.size))
    node = lattice.node(goal)
    ends = [(cost, state) for state, cost in ways.at(node) if grid.is_kept(int(sets[state]))]
    if not ends:
        return None
    cells = ways.path(node, min(ends)[1])
    return np.vstack([np.asarray([start_m], float), map.frame.centres_of(cells)])


def _dense(way_m: Floats, apart_m: float) -> Floats:
    """The way with points no further apart than that."""
    if len(way_m) < 2:
        return way_m
    pieces = [
        np.linspace(a, b, max(1, int(np.ceil(float(np.linalg.norm(b - a)) / apart_m))), endpoint=False)
        for a, b in pairwise(way_m)
    ]
    return np.concatenate([*pieces, way_m[-1:]])
