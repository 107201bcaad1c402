"""A policy that is a small network, learned elsewhere and run in numpy."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mintpilot.core.errors import InputError
from mintpilot.core.geometry import Floats
from mintpilot.core.policy import GridCell, PolicyState, PolicyTask, steps
from mintpilot.core.ports import Policy
from mintpilot.policies.grid import PolicyGrid

Layer = tuple[NDArray[np.float32], NDArray[np.float32]]
"""Weights (outputs, inputs) and biases (outputs,), as `torch.nn.Linear` has them."""


def observation_size(grid: PolicyGrid) -> int:
    """Number of inputs of a network for that grid."""
    return sum(grid.free.shape) + len(grid.goals) + len(grid.regions)


def observation(grid: PolicyGrid, mask: int, goal: int, cell: GridCell) -> NDArray[np.float32]:
    """What a network is shown, (inputs,): the cell's z, y and x and the goal, one-hot each, then a flag a region.

    Args:
        grid: where it holds.
        mask: joint hypothesis: the flag of region r is 1 where bit r is set (blocked), else -1.
        goal: index of the goal.
        cell: where the drone is.
    """
    size, hot, base = observation_size(grid), [], 0
    for index, count in zip((*cell, goal), (*grid.free.shape, len(grid.goals)), strict=True):
        hot.append(base + index)
        base += count
    seen = np.zeros(size, np.float32)
    seen[hot] = 1.0
    seen[base:] = [1.0 if mask >> r & 1 else -1.0 for r in range(len(grid.regions))]
    return seen


class NetworkPolicy(Policy):
    """Linear layers with ReLU between them, e.g. the Q-network of a DQN of Stable-Baselines3.

    Args:
        grid: where it holds.
        layers: from the observation to one value for each action.
        edges_per_unit: cell edges in one unit of the reward that it was learned with.

    Raises:
        InputError: the layers do not fit the grid or each other, or are not finite.
    """

    def __init__(self, grid: PolicyGrid, layers: tuple[Layer, ...], *, edges_per_unit: float = 1.0) -> None:
        size = observation_size(grid)
        for number, (weights, biases) in enumerate(layers):
            if weights.ndim != 2 or weights.shape[1] != size or biases.shape != weights.shape[:1]:
                raise InputError(
                    f"layer {number}: weights of shape {weights.shape} and biases of shape {biases.shape}; weights "
                    f"(n, {size}) and biases (n,) they must have for this grid. Export the network again."
                )
            if not (np.isfinite(weights).all() and np.isfinite(biases).all()):
                raise InputError(f"layer {number} has weights that are not finite; train the network again")
            size = weights.shape[0]
        actions = len(steps(grid.free.shape))
        if not layers or size != actions:
            raise InputError(f"a network with {size} outputs for {actions} actions; export the Q-network of this grid")
        if not 0 < edges_per_unit < np.inf:
            raise InputError(f"edges_per_unit = {edges_per_unit}: must be above 0 and finite")
        self.grid, self.layers, self.edges_per_unit = grid, layers, edges_per_unit
        self._last: tuple[PolicyTask, int, int] | None = None

    def q_values(self, state: PolicyState) -> Floats:
        """See `Policy.q_values`. Raises `InputError` for a task that is not of its grid."""
        if self._last is None or self._last[0] is not state.task:
            self._last = (state.task, *self.grid.place(state.task))
        _, mask, goal = self._last
        values: Floats = observation(self.grid, mask, goal, state.cell).astype(float)
        for number, (weights, biases) in enumerate(self.layers):
            values = weights @ values + biases
            if number < len(self.layers) - 1:
                values = np.maximum(values, 0.0)
        return values * self.edges_per_unit
