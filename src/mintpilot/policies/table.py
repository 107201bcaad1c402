"""A tabular policy: one value for each joint hypothesis, goal, cell and action of one grid."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mintpilot.core.errors import InputError
from mintpilot.core.geometry import Floats, frozen
from mintpilot.core.policy import PolicyState, PolicyTask, steps
from mintpilot.core.ports import Policy
from mintpilot.policies.grid import PolicyGrid


class TabularPolicy(Policy):
    """Looks its values up.

    Args:
        grid: where it holds.
        values: (joint hypotheses, goals, cells, actions) in cell edges, cells as flat indices; finite. Those of
            actions that are not allowed do not matter.

    Raises:
        InputError: the values do not fit the grid, or are not finite.
    """

    def __init__(self, grid: PolicyGrid, values: NDArray[np.float32]) -> None:
        wanted = (grid.masks, len(grid.goals), grid.free.size, len(steps(grid.free.shape)))
        if values.shape != wanted:
            raise InputError(
                f"a table of shape {values.shape} for a grid that needs {wanted} (joint hypotheses, goals, cells, "
                "actions); learn it anew"
            )
        wrong = int((~np.isfinite(values)).sum())
        if wrong:
            raise InputError(f"{wrong} of {values.size} values of the table are not finite; learn it anew")
        self.grid, self.values = grid, values
        frozen(self.values)
        self._last: tuple[PolicyTask, int, int] | None = None

    def q_values(self, state: PolicyState) -> Floats:
        """See `Policy.q_values`. Raises `InputError` for a task that is not of its grid."""
        if self._last is None or self._last[0] is not state.task:
            self._last = (state.task, *self.grid.place(state.task))
        _, mask, goal = self._last
        cell = int(np.ravel_multi_index(state.cell, self.grid.free.shape))
        values: Floats = self.values[mask, goal, cell].astype(float)
        return values
