"""Decision lists: the best path under every set of blocked regions, from one list of Pareto paths sorted by cost."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Generic, TypeVar

P = TypeVar("P")


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ParetoPath(Generic[P]):
    """A path that no other one beats in cost and in the regions that must be passable for it."""

    cost: float
    """In the unit of the planner that made it."""
    mask: int
    """Bit r is set when region r must be passable."""
    path: P
    """The path itself."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class DecisionList(Generic[P]):
    """Paths sorted by cost, none beaten by another that costs no more and needs no other region.

    Under any set of blocked regions the first path that needs none of them is the best one.
    """

    paths: tuple[ParetoPath[P], ...]
    complete: bool = True
    """False when a bound on the work was hit: every path is sound, but a better one may be missing."""
    left_out: tuple[int, ...] = ()
    """Regions that were taken as blocked because there were too many."""
    not_expanded: int = 0
    """Sets of assumptions that were still to be planned for when the work ended."""

    def best(self, blocked: int) -> ParetoPath[P] | None:
        """The cheapest path while the regions of that bit set are blocked; None where there is none."""
        for path in self.paths:
            if not path.mask & blocked:
                return path
        return None


def sorted_paths(paths: Iterable[ParetoPath[P]]) -> tuple[ParetoPath[P], ...]:
    """Sorts paths by cost, then by fewer and lower regions, and drops those beaten by an earlier one."""
    kept: list[ParetoPath[P]] = []
    for path in sorted(paths, key=lambda w: (round(w.cost, 9), w.mask.bit_count(), w.mask)):
        if not any(other.mask & ~path.mask == 0 for other in kept):
            kept.append(path)
    return tuple(kept)
