"""Paths between places, made when asked for and remembered."""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike

from mintpilot.core.geometry import Ints
from mintpilot.planning.decision_list import DecisionList, ParetoPath

Cell3 = tuple[int, int, int]


class PathSearch(Protocol):
    """Finds all paths between two cells that are best under some set of blocked regions."""

    searches: int
    reversible: bool
    """Whether a way back is as good as the way there."""

    def between(self, start: ArrayLike, goal: ArrayLike) -> DecisionList[Ints]:
        """Decision list with costs in edges and paths as cells (n, 3)."""
        ...


class LegTable:
    """Decision lists between places.

    A way back is the way there, reversed, where the search says so: each pair is then searched once, always from its
    lower cell, so that the result does not depend on which direction was asked for first.
    """

    def __init__(self, search: PathSearch) -> None:
        self.search = search
        self._lists: dict[tuple[Cell3, Cell3], DecisionList[Ints]] = {}

    def between(self, start: Cell3, goal: Cell3) -> DecisionList[Ints]:
        """All paths from one place to the other."""
        key = (start, goal)
        if key not in self._lists:
            if goal < start and self.search.reversible:
                self._lists[key] = _reversed(self.between(goal, start))
            else:
                self._lists[key] = self.search.between(start, goal)
        return self._lists[key]

    @property
    def incomplete(self) -> tuple[DecisionList[Ints], ...]:
        """The lists made so far that a bound on the work cut short."""
        return tuple(found for found in self._lists.values() if not found.complete)


def _reversed(forth: DecisionList[Ints]) -> DecisionList[Ints]:
    back = tuple(ParetoPath(cost=w.cost, mask=w.mask, path=np.ascontiguousarray(w.path[::-1])) for w in forth.paths)
    return DecisionList(paths=back, complete=forth.complete, left_out=forth.left_out, not_expanded=forth.not_expanded)
