"""Following a policy: its values checked, its best allowed action taken, to the goal or to where it fails."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mintpilot.core.errors import InputError, MintPilotError
from mintpilot.core.geometry import Floats, Ints, frozen
from mintpilot.core.policy import GridCell, PolicyState, PolicyTask, steps
from mintpilot.core.ports import Policy


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class FollowedPath:
    """The way that a policy takes to the goal."""

    cost: float
    """Length in cell edges."""
    cells: Ints
    """Cells (n, 3) from the start to the goal, neighbours, joined by allowed moves."""

    def __post_init__(self) -> None:
        frozen(self.cells)


def checked_values(policy: Policy, task: PolicyTask, cell: GridCell) -> Floats:
    """The policy's values (actions,) in a cell, minus infinity for what is not allowed there.

    Raises:
        InputError: it failed, or gave something else than a number for each action.
    """
    name, allowed = type(policy).__name__, task.allowed[cell]
    try:
        values = np.array(policy.q_values(PolicyState(task=task, cell=cell)), float)
    except MintPilotError:
        raise
    except Exception as error:  # a stranger's policy may fail in any way; the mission must learn which one it was
        raise InputError(f"policy {name} failed in cell {cell}: {error!r}. Mend it, or fly by another.") from error
    if values.shape != allowed.shape:
        raise InputError(
            f"policy {name}: values of shape {values.shape} in cell {cell}; one for each of the {allowed.size} actions "
            "of this grid it must give. Use one that was made for such a grid."
        )
    wrong = allowed & (np.isnan(values) | (values == np.inf))
    if wrong.any():
        raise InputError(
            f"policy {name}: value {values[wrong][0]} in cell {cell}; finite or minus infinity it must be. "
            "Learn it anew, or fly by another."
        )
    return np.where(allowed, values, -np.inf)


def follow(policy: Policy, task: PolicyTask, start: GridCell) -> FollowedPath | None:
    """The way from ``start`` that takes the best action everywhere, the first one among equals.

    Returns:
        The way; None where it comes to a cell again (it would go round for ever) or to one without a way on.

    Raises:
        InputError: see `checked_values`.
    """
    moves = steps(task.free.shape)
    here, seen, taken = start, {start: 0}, []
    if not task.free[start]:
        return None
    while here != task.goal:
        values = checked_values(policy, task, here)
        action = int(np.argmax(values))
        if values[action] == -np.inf:
            return None
        z, y, x = (int(i) for i in np.add(here, moves[action]))
        here = (z, y, x)
        if here in seen:
            return None
        seen[here] = len(seen)
        taken.append(action)
    counts = np.bincount(np.abs(moves[taken]).sum(axis=1), minlength=4) if taken else np.zeros(4)
    return FollowedPath(cost=float(counts @ np.sqrt(np.arange(4.0))), cells=np.array(list(seen), np.int64))
