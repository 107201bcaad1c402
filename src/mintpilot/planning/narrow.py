"""Whether a place is cut off only because passages are too narrow for the body, and what to do about it."""

from __future__ import annotations

import math

import numpy as np
from scipy import ndimage

from mintpilot.core.message import Message, message
from mintpilot.core.plan import PlanningProblem, Site
from mintpilot.core.semantic_map import Cell, Knowledge
from mintpilot.planning.terrain import Terrain, cells_around, distances_m


def narrow_passages(problem: PlanningProblem, terrain: Terrain, site: Site) -> Message:
    """A sentence for a site that a body without size could get to, empty where it could not either.

    It names the size of the cells, the width of the body, and how many cells wide a passage must be: the centre of one
    of its cells must be as far from both sides as the clearance, so the number is odd.
    """
    frame, limits = terrain.frame, problem.limits
    free = np.array(problem.map.cells == Cell.FREE)
    for region in problem.map.regions:
        if region.passable is Knowledge.NO:
            free.ravel()[region.cells] = False
    parts, _ = ndimage.label(free)
    middle = frame.cells_of(np.array([site.position_m]))[0]
    if frame.is_flat:
        middle[0] = 0
    cells = cells_around(frame, middle, math.ceil(site.reach_m / frame.resolution_m) + 1)
    cells = cells[distances_m(frame, cells, site.position_m) <= site.reach_m + frame.resolution_m]
    if not (parts[tuple(cells.T)] == parts[tuple(terrain.start)]).any():
        return Message()
    wide = math.ceil(2 * limits.clearance_m / frame.resolution_m - 1e-9) // 2 * 2 + 1
    return message(
        "passages are too narrow: the body is {body_m:.2f} m wide (radius and margin on both sides), and with cells of "
        "{cell_m:g} m a passage must be {cells} of them ({wide_m:.2f} m) wide; give a finer map, or reduce the "
        "vehicle's radius or margin",
        body_m=2 * limits.clearance_m,
        cell_m=frame.resolution_m,
        cells=wide,
        wide_m=wide * frame.resolution_m,
    )
