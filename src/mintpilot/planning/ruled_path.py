"""Single flights under rules: the check of a motion, and the shortest way to one place (method, section 14)."""

from __future__ import annotations

import numpy as np

from mintpilot.core.errors import InfeasibleError
from mintpilot.core.geometry import Floats, Vec3
from mintpilot.core.plan import VehicleLimits
from mintpilot.core.rule import Ruling
from mintpilot.core.semantic_map import SemanticMap
from mintpilot.planning.flyable import known_flyable
from mintpilot.planning.lattice import lattice_of
from mintpilot.planning.rule_labels import RuleGrid
from mintpilot.planning.rule_search import RuledGround, RuledWays
from mintpilot.planning.terrain import start_cell


def keeps_rules(way_m: Floats, ruling: Ruling, map: SemanticMap, limits: VehicleLimits, *, as_along_m: Floats) -> bool:
    """Whether a motion leaves the rules in no state in which the path would not leave them.

    Args:
        way_m: the motion (n, 3), metres.
        ruling: the rules, and how far they have come.
        map: what is known.
        limits: size of the vehicle.
        as_along_m: the path (m, 3), metres: from where the drone is to the middle of a cell, then from cell to cell.
    """
    grid = RuleGrid(ruling=ruling, map=map, limits=limits)
    start = grid.number(ruling.states)
    cells = np.clip(map.frame.cells_of(as_along_m[1:]), 0, np.array(map.frame.shape) - 1)
    planned = grid.flown(start, as_along_m[:2], ruling.held)
    planned = grid.followed(planned, np.ravel_multi_index(tuple(cells.T), map.frame.shape), ruling.held)
    came = grid.flown(start, way_m, ruling.held)
    return came >= 0 and planned >= 0 and grid.covers(planned, came)


def ruled_path(
    map: SemanticMap, limits: VehicleLimits, ruling: Ruling, *, start_m: Vec3, goal_m: Vec3
) -> Floats | None:
    """The shortest way through known flyable space that keeps all rules if the flight ends there; None: none does."""
    free = known_flyable(map, limits)
    try:
        start, goal = start_cell(map, limits, free, start_m), start_cell(map, limits, free, goal_m)
    except InfeasibleError:
        return None
    grid, lattice = RuleGrid(ruling=ruling, map=map, limits=limits), lattice_of(free)
    flat = int(np.ravel_multi_index(tuple(start), map.frame.shape))
    hop = np.vstack([np.asarray([start_m], float), map.frame.centres_of(start[None])])
    begun = grid.followed(grid.flown(grid.number(ruling.states), hop, ruling.held), [flat], ruling.held)
    if begun < 0:
        return None
    sets, table = grid.table(begun, ruling.held)
    kept = np.array([grid.is_kept(int(number)) for number in sets])
    ground = RuledGround(lattice=lattice, allowed=lattice.allowed, sets=sets, table=table, kinds=grid.over(lattice),
                         uncertain=np.zeros(lattice.size), easier=grid.easier(sets), kept=kept)  # fmt: skip
    ways = RuledWays(ground=ground, node=lattice.node(start), rest=np.zeros(lattice.size))
    ways.grow()
    node = lattice.node(goal)
    ends = [(cost, state) for state, cost in ways.at(node) if kept[state]]
    if not ends:
        return None
    cells = lattice.cells(ways.path(node, min(ends)[1]))
    return np.vstack([np.asarray([start_m], float), map.frame.centres_of(cells)])
