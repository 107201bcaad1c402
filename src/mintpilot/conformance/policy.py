"""Checks of policies."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from mintpilot.conformance.sample import require
from mintpilot.core.errors import ConformanceError, InputError
from mintpilot.core.policy import PolicyState, PolicyTask, policy_task, steps
from mintpilot.core.ports import Policy


def check_policy(make: Callable[[], Policy], task: PolicyTask | None = None) -> None:
    """Values for every action, in every cell that can be flown, the same ones each time; another grid refused by name.

    Args:
        make: makes a fresh policy; called more than once.
        task: one that it was made for; None: a small flat hall, for policies that fit any grid.

    Raises:
        ConformanceError: it breaks the contract of `mintpilot.core.ports.Policy`.
    """
    task = task or _hall(5)
    policy, again = make(), make()
    actions = len(steps(task.free.shape))
    for cell in np.argwhere(task.allowed.any(axis=-1)):
        state = PolicyState(task=task, cell=(int(cell[0]), int(cell[1]), int(cell[2])))
        values = np.array(policy.q_values(state), float)
        require(
            values.shape == (actions,),
            policy,
            f"values of shape {values.shape} in cell {state.cell}; ({actions},) wanted",
        )
        usable = values[task.allowed[state.cell]]
        wrong = usable[np.isnan(usable) | (usable == np.inf)]
        require(not wrong.size, policy, f"value {wrong[:1]} in cell {state.cell}; finite or minus infinity it must be")
        for other, what in ((policy, "asked again"), (again, "made again")):
            same = np.array_equal(values, np.array(other.q_values(state), float))
            require(same, policy, f"{what}, it gives other values in cell {state.cell}; equal states, equal values")
    elsewhere = _hall(7)
    try:
        policy.q_values(PolicyState(task=elsewhere, cell=(0, 1, 1)))
    except InputError:
        return
    except Exception as error:
        raise ConformanceError(
            f"{type(policy).__name__}: on another grid it fails with {error!r}; InputError must say what does not fit"
        ) from error


def _hall(length: int) -> PolicyTask:
    """A flat hall with a wall across, open on one side."""
    free = np.ones((1, 4, length), bool)
    free[0, :3, length // 2] = False
    return policy_task(free, (0, 0, length - 1))
