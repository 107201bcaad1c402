"""The impact metric ``q-value``: what a gap costs by the values of a policy (method, sections 3 and 15)."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np

from mintpilot.core.errors import InputError
from mintpilot.core.gap import PASSABLE, Assumptions
from mintpilot.core.geometry import Floats, Ints
from mintpilot.core.plan import Plan, PlanningProblem
from mintpilot.core.policy import GridCell, PolicyTask, policy_task, steps
from mintpilot.core.ports import PlanMetric, Policy
from mintpilot.planning.terrain import Terrain, terrain_of
from mintpilot.policies.exact import ExactPolicy
from mintpilot.policies.following import checked_values
from mintpilot.reasoning.metrics import FrechetMetric


class QValueMetric(PlanMetric):
    """The loss of acting on the policy for one hypothesis where another holds, summed along the way that it takes.

    In each cell of the cautious plan the loss is what the values under the favourable hypothesis give for their best
    action, less what they give for the action taken. With exact values the sum is the difference of the two plans'
    costs, so that the gaps judged critical are those of the regret rule. Distances between paths are Frechet's.

    Args:
        policy: whose values judge; None: the exact one.
        problem: of which the plans are; None: not said yet, see `on`.
    """

    def __init__(self, policy: Policy | None = None, problem: PlanningProblem | None = None) -> None:
        self._policy, self._problem = policy or ExactPolicy(), problem
        self._terrain = None if problem is None else terrain_of(problem)
        self._tasks: dict[tuple[int, GridCell], PolicyTask] = {}

    def divergence(self, a_m: Floats, b_m: Floats) -> float:
        """Frechet distance, metres."""
        return FrechetMetric().divergence(a_m, b_m)

    def on(self, problem: PlanningProblem) -> PlanMetric:
        """See `PlanMetric.on`."""
        return self if problem is self._problem else QValueMetric(self._policy, problem)

    def loss_s(self, best: Plan, sure: Plan, given: Assumptions) -> float:
        """See `PlanMetric.loss_s`: flight by the policy's values, and the stays."""
        if self._terrain is None or self._problem is None:
            raise InputError("metric 'q-value' judges plans of a problem: call `on` with that problem first")
        edge_s = self._terrain.frame.resolution_m / self._problem.limits.cruise_mps
        blocked = sum(1 << r for r, gap in enumerate(self._terrain.gaps) if PASSABLE not in given.possible(gap))
        followed = self._edges(self._terrain, sure, blocked, follows=True)
        wanted = self._edges(self._terrain, best, blocked, follows=False)
        stays_s = sum(leg.stop.dwell_s for leg in sure.legs) - sum(leg.stop.dwell_s for leg in best.legs)
        return math.inf if math.inf in (followed, wanted) else (followed - wanted) * edge_s + stays_s

    def _edges(self, terrain: Terrain, plan: Plan, blocked: int, *, follows: bool) -> float:
        """Edges that a plan takes by the values under a hypothesis: as it flies, or at its best between its stops."""
        edges = 0.0
        last: GridCell | None = None
        for leg in plan.legs:
            cells = _cells(terrain, leg.path_m, first=last is None)
            last = _cell(cells[-1])
            if len(cells) > 1:
                task = self._task(terrain, blocked, last)
                edges += self._value(task, _cell(cells[0])) + (self._lost(task, cells) if follows else 0.0)
        return edges

    def _value(self, task: PolicyTask, cell: GridCell) -> float:
        """Edges to the goal by the policy's values."""
        return -float(checked_values(self._policy, task, cell).max())

    def _lost(self, task: PolicyTask, cells: Ints) -> float:
        """Edges lost along a way, by the values of the actions that were not taken."""
        numbers = {tuple(step): number for number, step in enumerate(steps(task.free.shape).tolist())}
        lost = 0.0
        for here, there in pairwise(cells):
            values = checked_values(self._policy, task, _cell(here))
            taken = values[numbers[tuple((there - here).tolist())]]
            if taken == -np.inf:
                return math.inf
            lost += float(values.max() - taken)
        return lost

    def _task(self, terrain: Terrain, blocked: int, goal: GridCell) -> PolicyTask:
        if (blocked, goal) not in self._tasks:
            free = terrain.free.copy()
            for r, cells in enumerate(terrain.regions):
                if blocked >> r & 1:
                    free.ravel()[cells] = False
            self._tasks[blocked, goal] = policy_task(free, goal)
        return self._tasks[blocked, goal]


def _cells(terrain: Terrain, path_m: Floats, *, first: bool) -> Ints:
    """The cells (n, 3) of a leg, each once; the first leg begins where all paths do, whatever the true start is."""
    cells = terrain.frame.cells_of(path_m)
    if terrain.frame.is_flat:
        cells[:, 0] = 0
    if first and _cell(cells[0]) != _cell(terrain.start):
        cells = cells[1:] if len(cells) > 1 else terrain.start[None]
    own = np.concatenate([np.array([True]), np.any(np.diff(cells, axis=0) != 0, axis=1)])
    found: Ints = cells[own]
    return found


def _cell(cell: Ints) -> GridCell:
    z, y, x = (int(i) for i in cell)
    return (z, y, x)
