"""Compiles everything ahead of the first mission, so that nobody waits for it in flight."""

from __future__ import annotations

import functools

import numpy as np

from mintpilot.core.geometry import GridFrame
from mintpilot.core.plan import VehicleLimits
from mintpilot.core.semantic_map import Cell, SemanticMap
from mintpilot.planning.checks import check_trajectory
from mintpilot.planning.joint_search import Effort, JointSearch
from mintpilot.planning.trajectory import plan_trajectory


@functools.cache
def warm_up() -> None:
    """Compiles all searches into numba's cache on disk: seconds the first time, a blink afterwards.

    Called by whoever makes the components of a flight, before the vehicle's clock runs.
    """
    for shape in ((1, 5, 5), (4, 5, 5)):
        free = np.ones(shape, bool)
        ends = (0, 0, 0), (shape[0] - 1, 4, 4)
        regions = [np.flatnonzero(np.arange(free.size) % 5 == 2).astype(np.int64)]
        search = JointSearch(free, regions)
        search.between(*ends)
        search.under(*ends, 1)
        search.grid.distances(ends[0])
        JointSearch(free, regions, Effort(labels=1)).between(*ends)
    _fly_once()


def _fly_once() -> None:
    """A checked trajectory round a corner, as for a leg: what is not compiled yet would delay the first flight."""
    cells = np.full((3, 12, 12), Cell.FREE, np.uint8)
    cells[:, 5:7, 3:7] = Cell.OCCUPIED
    frame = GridFrame(origin_m=(0.0, 0.0, 0.0), resolution_m=0.5, shape=cells.shape)
    map = SemanticMap(frame=frame, cells=cells)
    path = np.array([[2.5, 1.0, 0.75], [4.5, 1.0, 0.75], [4.5, 5.0, 0.75], [2.5, 5.0, 0.75]])
    limits = VehicleLimits(radius_m=0.2)
    check_trajectory(plan_trajectory(path, map=map, limits=limits, end_yaw_rad=1.0), map, limits)
