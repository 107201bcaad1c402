"""Compiles everything ahead of the first mission, so that nobody waits for it in flight."""

from __future__ import annotations

import functools

import numpy as np

from mintpilot.planning.joint_search import Effort, JointSearch


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
