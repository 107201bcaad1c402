"""The planners that stand behind the port: on the voxel map, tasks over exact legs."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from mintpilot.core.geometry import Bools, Ints
from mintpilot.core.plan import PlanningProblem
from mintpilot.core.ports import Planner
from mintpilot.planning.decision_list import DecisionList
from mintpilot.planning.joint_search import Effort, JointSearch
from mintpilot.planning.lattice import swept_cells
from mintpilot.planning.lazy import lazy_paths
from mintpilot.planning.plan_space import GridPlanSpace
from mintpilot.planning.terrain import terrain_of

FindPath: TypeAlias = Callable[[Bools, tuple[int, int, int], tuple[int, int, int]], tuple[float, Ints] | None]
"""A path finder of which nothing else is known: (free cells (nz, ny, nx), start cell, goal cell) to (cost in edges,
cells (n, 3)), or None where there is no path. It must be exact, and its paths must stay in free cells."""


class GridPlanner(Planner):
    """Plans on the voxel map with the joint search: one map search for each pair of places.

    Args:
        effort: bounds on the work of one search.
    """

    def __init__(self, effort: Effort | None = None) -> None:
        self._effort = effort

    def open(self, problem: PlanningProblem) -> GridPlanSpace:
        """The plans of that problem. Equal problems give equal plans, whatever the order of their gaps.

        Raises:
            InfeasibleError: the start is not in flyable space, or a stop that is not optional can be reached under no
                hypothesis.
            MissionError: a gap or stop contradicts the map.
        """
        terrain = terrain_of(problem)
        return GridPlanSpace(problem, terrain, JointSearch(terrain.free, terrain.regions, self._effort))


class LazyPlanner(Planner):
    """Plans with a path finder that is a black box, by lazy branching: as exact, with more searches.

    Args:
        find: the path finder. One that is not exact gives sound plans too, but maybe not the best.
        max_searches: bound on its calls for one pair of places.
        reversible: whether its way back is as good as the way there, reversed, so that one search serves for both.
    """

    def __init__(self, find: FindPath, *, max_searches: int = 4096, reversible: bool = True) -> None:
        self._find, self._max_searches, self._reversible = find, max_searches, reversible

    def open(self, problem: PlanningProblem) -> GridPlanSpace:
        """The plans of that problem, as `GridPlanner.open`."""
        terrain = terrain_of(problem)
        search = _BlackBox(self._find, terrain.free, terrain.regions, self._max_searches, reversible=self._reversible)
        return GridPlanSpace(problem, terrain, search)


class _BlackBox:
    """Decision lists between cells from a path finder that knows nothing of regions."""

    def __init__(
        self, find: FindPath, free: Bools, regions: tuple[Ints, ...], max_searches: int, *, reversible: bool
    ) -> None:
        self.searches = 0
        self.reversible = reversible
        self._find, self._free, self._max_searches = find, free, max_searches
        self._regions = regions
        self._ends: tuple[tuple[int, int, int], tuple[int, int, int]] = ((0, 0, 0), (0, 0, 0))

    def between(self, start: ArrayLike, goal: ArrayLike) -> DecisionList[Ints]:
        """All paths between two cells, one search for each set of blocked regions that matters."""
        a, b = (tuple(int(i) for i in np.ravel(cell)) for cell in (start, goal))
        self._ends = ((a[0], a[1], a[2]), (b[0], b[1], b[2]))
        return lazy_paths(self, max_searches=self._max_searches)

    def path(self, blocked: frozenset[int]) -> tuple[float, Ints, frozenset[int]] | None:
        """One search with those regions blocked."""
        self.searches += 1
        free = self._free.copy()
        for r in blocked:
            free.ravel()[self._regions[r]] = False
        if not all(free[end] for end in self._ends):
            return None
        found = self._find(free, *self._ends)
        if found is None:
            return None
        swept = swept_cells(found[1])
        flat = np.ravel_multi_index(tuple(swept.T), free.shape)
        entered = frozenset(r for r, cells in enumerate(self._regions) if np.isin(flat, cells).any())
        return found[0], found[1], entered
