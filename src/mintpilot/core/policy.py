"""What a policy is asked: one state of a flight over a grid (method, section 15)."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from typing import TypeAlias

import numpy as np

from mintpilot.core.errors import MapError
from mintpilot.core.geometry import Bools, Floats, Ints, frozen

GridCell: TypeAlias = tuple[int, int, int]
"""Cell ``(z, y, x)`` of a grid."""


def steps(shape: tuple[int, ...]) -> Ints:
    """The actions on a grid of that shape (nz, ny, nx) as changes of (z, y, x), shape (8, 3) if nz is 1, else (26, 3).

    In ascending order of (z, y, x): on a flat grid the first is (0, -1, -1), the last (0, 1, 1).
    """
    return _steps(shape[0] == 1)


def step_lengths(shape: tuple[int, ...]) -> Floats:
    """Length of each action in cell edges, shape (actions,)."""
    lengths: Floats = np.sqrt(np.abs(steps(shape)).sum(axis=1).astype(float))
    return lengths


@cache
def _steps(flat: bool) -> Ints:
    layers = (0,) if flat else (-1, 0, 1)
    around = [step for step in itertools.product(layers, (-1, 0, 1), (-1, 0, 1)) if any(step)]
    found = np.array(around, np.int64)
    frozen(found)
    return found


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PolicyTask:
    """One goal on one grid under one joint hypothesis. Made by `policy_task`."""

    free: Bools
    """Cells that may be flown (nz, ny, nx), those of regions that are taken as blocked left out. Read-only."""
    goal: GridCell
    """Where the flight ends."""
    allowed: Bools
    """Actions that may be taken (nz, ny, nx, actions): every cell that the move sweeps is free. Read-only."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PolicyState:
    """Where a flight is."""

    task: PolicyTask
    """The same value for all states of one task, so that a policy may remember what it worked out for it."""
    cell: GridCell
    """Where the drone is: a free cell."""


def policy_task(free: Bools, goal: GridCell) -> PolicyTask:
    """The task of flying to that cell.

    Args:
        free: cells that may be flown (nz, ny, nx); copied.
        goal: one of its cells.

    Raises:
        MapError: the goal is outside the grid.
    """
    if free.ndim != 3 or not all(0 <= i < n for i, n in zip(goal, free.shape, strict=True)):
        raise MapError(f"goal {goal} is outside the grid of {free.shape} cells; give a cell (z, y, x) of it")
    return PolicyTask(free=_immutable(free), goal=goal, allowed=_immutable(_allowed(free)))


def _immutable(flags: Bools) -> Bools:
    """A copy that nobody can make writable again: it is handed to strangers."""
    return np.frombuffer(np.ascontiguousarray(flags, bool).tobytes(), bool).reshape(flags.shape)


def _allowed(free: Bools) -> Bools:
    """A move is allowed if all cells of the block that it sweeps (2, 4 or 8) are free: corners are not cut."""
    padded = np.pad(free, 1)
    return np.stack([np.logical_and.reduce(list(_swept(padded, step))) for step in steps(free.shape)], axis=-1)


def _swept(padded: Bools, step: Ints) -> Iterator[Bools]:
    for part in itertools.product(*((0, int(s)) if s else (0,) for s in step)):
        yield padded[tuple(slice(1 + p, n - 1 + p) for p, n in zip(part, padded.shape, strict=True))]


__all__ = ["GridCell", "PolicyState", "PolicyTask", "policy_task", "step_lengths", "steps"]
