"""Decision lists: the best way under every set of blocked regions, from one sorted list."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Generic, TypeVar

P = TypeVar("P")


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Way(Generic[P]):
    """One way, and what must be passable for it."""

    cost: float
    """In the unit of the planner that made it."""
    mask: int
    """Bit r is set when region r must be passable."""
    path: P
    """The way itself."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class DecisionList(Generic[P]):
    """Ways sorted by cost, none beaten by another that costs no more and needs no other region.

    Under any set of blocked regions the first way that needs none of them is the best one.
    """

    ways: tuple[Way[P], ...]
    complete: bool = True
    """False when a bound on the work was hit: every way is sound, but a better one may be missing."""
    left_out: tuple[int, ...] = ()
    """Regions that were taken as blocked because there were too many."""
    not_expanded: int = 0
    """Sets of assumptions that were still to be planned for when the work ended."""

    def best(self, blocked: int) -> Way[P] | None:
        """The cheapest way while the regions of that bit set are blocked; None where there is none."""
        for way in self.ways:
            if not way.mask & blocked:
                return way
        return None


def sorted_ways(ways: Iterable[Way[P]]) -> tuple[Way[P], ...]:
    """Sorts ways by cost, then by fewer and lower regions, and drops those beaten by an earlier one."""
    kept: list[Way[P]] = []
    for way in sorted(ways, key=lambda w: (round(w.cost, 9), w.mask.bit_count(), w.mask)):
        if not any(other.mask & ~way.mask == 0 for other in kept):
            kept.append(way)
    return tuple(kept)
