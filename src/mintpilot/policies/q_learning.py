"""Q-learning on a grid, in numpy: many walkers at once, every joint hypothesis and every goal (method, section 15).

The world is deterministic and each move costs its length, so values are learned without discount and with step size 1:
they become exact once every action was taken often enough. All values begin at 0, which promises too much: what was
not tried yet looks best, and is tried.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mintpilot.core.errors import InputError
from mintpilot.core.geometry import Ints
from mintpilot.core.policy import policy_task, step_lengths, steps
from mintpilot.policies.grid import PolicyGrid
from mintpilot.policies.table import TabularPolicy

MAX_VALUES = 200_000_000
"""Values that may be learned at once: 800 MB."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Training:
    """How a policy is learned."""

    transitions: int = 20_000_000
    """Moves that are made and learned from."""
    walkers: int = 2048
    """Walkers that move at once."""
    explore: float = 0.2
    """Share of moves that are drawn at random among the allowed ones."""
    restart: float = 0.01
    """Share of moves after which a walker begins elsewhere; it always does at its goal."""
    seed: int = 0

    def __post_init__(self) -> None:
        if self.transitions < 1 or self.walkers < 1:
            raise InputError(f"{self.transitions} transitions of {self.walkers} walkers: both must be at least 1")
        if not (0 <= self.explore <= 1 and 0 < self.restart <= 1):
            raise InputError(f"explore {self.explore}, restart {self.restart}: shares, and restart above 0")


def learn(grid: PolicyGrid, training: Training) -> TabularPolicy:
    """Learns a table. The same grid, training and seed give the same values.

    Raises:
        InputError: the table would be larger than `MAX_VALUES`.
    """
    shape = (grid.masks, len(grid.goals), grid.free.size, len(steps(grid.free.shape)))
    if np.prod(shape, dtype=float) > MAX_VALUES:
        raise InputError(
            f"a table of {shape} (joint hypotheses, goals, cells, actions) has more than {MAX_VALUES} values; take a "
            "coarser map, fewer regions or fewer goals"
        )
    walk = _Walk(grid, training)
    for _ in range(-(-training.transitions // training.walkers)):
        walk.step()
    return TabularPolicy(grid, walk.learned().reshape(shape))


class _Walk:
    """Walkers on all tasks (joint hypothesis and goal). A place is a cell of a task; all are numbered through."""

    def __init__(self, grid: PolicyGrid, training: Training) -> None:
        self._training, self._rng = training, np.random.default_rng(training.seed)
        shape, count = np.array(grid.free.shape), grid.masks * len(grid.goals)
        by_mask = [policy_task(grid.under(mask), grid.goals[0]).allowed for mask in range(grid.masks)]
        allowed = np.repeat(np.stack(by_mask), len(grid.goals), axis=0).reshape(count * grid.free.size, -1)
        self._values = np.where(allowed, np.float32(0), np.float32(-np.inf))
        is_goal = np.zeros((grid.masks, len(grid.goals), grid.free.size), bool)
        for number, goal in enumerate(grid.goals):
            is_goal[:, number, np.ravel_multi_index(goal, grid.free.shape)] = True
        self._is_goal = is_goal.ravel()
        self._beginnings = np.flatnonzero(allowed.any(axis=1) & ~self._is_goal)
        if not len(self._beginnings):
            raise InputError("no cell of this grid has a way out: there is nothing to learn; look at the map")
        self._offset: Ints = steps(grid.free.shape) @ np.array([shape[1] * shape[2], shape[2], 1])
        self._length = step_lengths(grid.free.shape).astype(np.float32)
        self._place = self._places(training.walkers)

    def step(self) -> None:
        """One move of every walker."""
        place, count = self._place, self._training.walkers
        values = self._values[place]
        action = values.argmax(axis=1)
        explores = np.flatnonzero(self._rng.random(count) < self._training.explore)
        draw = self._rng.random((len(explores), values.shape[1]), np.float32)
        action[explores] = np.where(np.isneginf(values[explores]), np.float32(-1), draw).argmax(axis=1)
        there = place + self._offset[action]
        arrived = self._is_goal[there]
        ahead = np.where(arrived, np.float32(0), self._values[there].max(axis=1))
        self._values[place, action] = ahead - self._length[action]
        again = arrived | (self._rng.random(count) < self._training.restart)
        there[again] = self._places(int(again.sum()))
        self._place = there

    def learned(self) -> NDArray[np.float32]:
        """(places, actions); 0 for actions that are not allowed."""
        return np.where(np.isneginf(self._values), np.float32(0), self._values)

    def _places(self, count: int) -> Ints:
        drawn: Ints = self._beginnings[self._rng.integers(len(self._beginnings), size=count)]
        return drawn
