"""The best order of stops: ordered ones in order, needed optional ones put in where they cost least."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from mintpilot.core.geometry import Ints
from mintpilot.planning.decision_list import ParetoPath
from mintpilot.planning.legs import Cell3, LegTable

TIE = 1e-9
"""Difference of costs, edges, up to which they are equal."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Route:
    """A way through all stops."""

    cost: float
    """In edges."""
    mask: int
    """Regions entered."""
    order: tuple[int, ...]
    """Numbers of the stops, in the order of the visits."""
    paths: tuple[ParetoPath[Ints], ...]
    """The way to each of them."""

    def rank(self, uncertain: int) -> tuple[float, int, int, int, tuple[int, ...]]:
        """Sorting key: cheap first, then few uncertain regions, then few regions, then by number."""
        return (
            round(self.cost, 9),
            (self.mask & uncertain).bit_count(),
            self.mask.bit_count(),
            self.mask,
            self.order,
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class Tour:
    """What is to be visited: stop i is served at ``places[i]``."""

    start: Cell3
    places: tuple[Cell3, ...]
    ordered: int
    """The first so many stops keep their order; the rest may be put anywhere."""


def best_route(
    legs: LegTable, tour: Tour, blocked: int, uncertain: int, most: Callable[[Cell3], float] | None = None
) -> Route | None:
    """The cheapest route that enters no blocked region; among equals the one that enters the fewest uncertain ones.

    With ``most``, a route that ends at a place costs no more than that, edges; dearer ones do not exist.

    Exact: the state is (ordered stops done, others done, place). As costs add up, a cheapest route consists of
    cheapest ones to each state; of those all are kept that differ in the uncertain regions entered.
    """
    rest = range(tour.ordered, len(tour.places))
    ways: dict[tuple[Cell3, Cell3], list[ParetoPath[Ints]]] = {}
    layer: dict[tuple[int, int, int], list[Route]] = {(0, 0, -1): [Route(cost=0.0, mask=0, order=(), paths=())]}
    for _ in tour.places:
        coming: dict[tuple[int, int, int], list[Route]] = {}
        for (done, others, last), routes in layer.items():
            here = tour.start if last < 0 else tour.places[last]
            moves = [(done + 1, others, done)] if done < tour.ordered else []
            moves += [(done, others | 1 << s, s) for s in rest if not others >> s & 1]
            for state in moves:
                pair = (here, tour.places[state[2]])
                if pair not in ways:
                    ways[pair] = cheapest(legs.between(*pair).paths, blocked)
                kept = coming.setdefault(state, [])
                for route in routes:
                    for way in ways[pair]:
                        # All that is kept costs the same: most offers are dearer, and need not be made.
                        if not kept or route.cost + way.cost <= kept[0].cost + TIE:
                            _offer(kept, _longer(route, way, state[2]), uncertain)
        layer = {state: routes for state, routes in coming.items() if routes}
    ends = [
        route
        for (_, _, last), routes in layer.items()
        for route in routes
        if most is None or route.cost <= most(tour.start if last < 0 else tour.places[last]) + TIE
    ]
    return min(ends, key=lambda r: r.rank(uncertain), default=None)


def cheapest(paths: Sequence[ParetoPath[Ints]], blocked: int) -> list[ParetoPath[Ints]]:
    """The paths of least cost that enter no blocked region: several where they enter different ones at equal cost."""
    usable = [w for w in paths if not w.mask & blocked]
    return [w for w in usable if w.cost <= usable[0].cost + TIE]


def _longer(route: Route, way: ParetoPath[Ints], stop: int) -> Route:
    return Route(
        cost=route.cost + way.cost,
        mask=route.mask | way.mask,
        order=(*route.order, stop),
        paths=(*route.paths, way),
    )


def _offer(kept: list[Route], new: Route, uncertain: int) -> None:
    """Keeps the new route unless one as cheap enters no other uncertain region; drops what it beats."""
    beats: Callable[[Route, Route], bool] = lambda a, b: (  # noqa: E731
        a.cost < b.cost - TIE or (a.cost <= b.cost + TIE and not a.mask & uncertain & ~b.mask)
    )
    if any(beats(old, new) for old in kept):
        return
    kept[:] = [old for old in kept if not beats(new, old)]
    kept.append(new)
