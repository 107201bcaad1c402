"""The exact policy: the reference that learned ones are compared with (method, section 15)."""

from __future__ import annotations

import numpy as np

from mintpilot.core.geometry import Floats
from mintpilot.core.policy import PolicyState, PolicyTask, step_lengths, steps
from mintpilot.core.ports import Policy
from mintpilot.planning.distance_field import DistanceField
from mintpilot.planning.grid_search import GridSearch

KEPT = 64
"""Tasks whose distances are remembered; the oldest goes first."""


class ExactPolicy(Policy):
    """Knows the shortest distance from every cell to the goal. One search of the grid for each task."""

    def __init__(self) -> None:
        self._known: dict[PolicyTask, Floats] = {}

    def q_values(self, state: PolicyState) -> Floats:
        """Minus the length of each move and of the shortest way on; see `Policy.q_values`."""
        ahead = self._ahead(state.task)
        shape = state.task.free.shape
        ends = np.clip(np.add(state.cell, steps(shape)), 0, np.array(shape) - 1)
        return np.where(state.task.allowed[state.cell], -step_lengths(shape) - ahead[tuple(ends.T)], -np.inf)

    def _ahead(self, task: PolicyTask) -> Floats:
        """Distance of every cell (nz, ny, nx) to the goal in edges; infinite where there is no way."""
        if task not in self._known:
            if len(self._known) >= KEPT:
                del self._known[next(iter(self._known))]
            self._known[task] = distances(task)
        return self._known[task]


def distances(task: PolicyTask) -> Floats:
    """Distance of every cell (nz, ny, nx) to the goal in edges; infinite where there is no way."""
    if not task.free[task.goal]:
        return np.full(task.free.shape, np.inf)
    grid = GridSearch(task.free)
    field = DistanceField(grid.lattice, grid.work, grid.lattice.node(task.goal), -1, grid.lattice.allowed)
    field.grow()
    nodes = grid.lattice.nodes_of_flat(np.arange(task.free.size))
    found: Floats = field.everywhere()[nodes].reshape(task.free.shape)
    return found
