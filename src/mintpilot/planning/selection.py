"""Which stops are done, in which order, within the battery; and why others are left undone (method, section 9)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from mintpilot.core.gap import NOWHERE
from mintpilot.core.geometry import Floats
from mintpilot.core.message import Message, message
from mintpilot.core.plan import LeftUndone, Shortage, Stop
from mintpilot.core.task import Action
from mintpilot.core.tolerances import TOLERANCE
from mintpilot.planning.insertion import insert
from mintpilot.planning.itinerary import Itinerary
from mintpilot.planning.legs import Cell3, LegTable
from mintpilot.planning.route import Route, Tour, best_route
from mintpilot.planning.subsets import MAX_STOPS, best_set, members, set_costs

NOT_SETTLED = ""
"""Value of a target gap that is not known, for plans that must not guess it."""
MAX_FREE = 6
"""With more optional stops, one best order is taken without comparing all that cost the same."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Selection:
    """What is done, and what is not."""

    stops: tuple[Stop, ...]
    """Those that are done; the route's numbers mean these."""
    route: Route
    left: tuple[LeftUndone, ...]
    """Those that are not, in the order of the problem."""
    left_s: float
    """Their prices, those of optional stops by their chance, seconds."""
    homeward: int = 0
    """Bit set of the regions that the way home enters."""
    home_s: float = 0.0
    """Flight time of the way home, seconds."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Reachable:
    """The stops that can be reached, with what lies between them; n of them."""

    stops: tuple[Stop, ...]
    places: tuple[Cell3, ...]
    ordered: int
    """The first so many keep their order."""
    start_s: Floats
    """(n,) flight from the start, and the stay."""
    apart_s: Floats
    """(n, n) flight from each to each other, and the stay there."""
    home_s: Floats
    """(n,) flight home; 0 where none is wanted, infinite where there is no way."""
    needs: tuple[int, ...]
    """(n,) bit sets of the stops that must come before."""

    @property
    def weights_s(self) -> Floats:
        """Prices (n,), those of optional stops by their chance."""
        return np.array([stop.price_s * stop.chance for stop in self.stops])

    @property
    def least_s(self) -> float:
        """No route through all stops takes less, seconds: that through the ordered ones, or to the farthest one."""
        alone = self.start_s[0] + sum(self.apart_s[i, i + 1] for i in range(self.ordered - 1)) if self.ordered else 0.0
        return float(max(alone, self.start_s.max()))

    @property
    def later(self) -> tuple[int, ...]:
        """(n,) bit sets of the ordered stops that come after each ordered one."""
        every = (1 << self.ordered) - 1
        return tuple(every & ~((2 << i) - 1) if i < self.ordered else 0 for i in range(len(self.stops)))


class Selector:
    """Chooses among the stops of one problem.

    Up to `MAX_STOPS` stops the choice is exact over all sets and orders; beyond, the dearest so many are chosen
    exactly and the others are put in where they cost least. `notes` says so.

    Args:
        itinerary: the stops with their places.
        legs: the ways between them.
    """

    def __init__(self, itinerary: Itinerary, legs: LegTable) -> None:
        self.itinerary, self.legs = itinerary, legs
        self._limits = itinerary.problem.limits
        self.notes: set[Message] = set()
        self._flights: dict[tuple[Cell3, Cell3, int], float] = {}
        middle = itinerary.terrain.frame.centres_of(np.array([itinerary.start]))[0]
        # From the true start to the middle of its cell.
        self.start_s = float(np.linalg.norm(middle - itinerary.problem.start_m)) / self._limits.cruise_mps

    @property
    def battery_s(self) -> float:
        """Flight time that a plan may use, the way home included, seconds."""
        return self._limits.endurance_s - self._limits.reserve_s

    def fits_alone(self, stop: Stop, blocked: int) -> bool:
        """Whether this stop can be reached, and the battery suffices for it if nothing else is done."""
        place = self.itinerary.place(stop, {})
        if place is None or not np.isfinite(self.battery_s):
            return place is not None
        there_s = self.start_s + self.flight_s(self.itinerary.start, place, blocked) + stop.dwell_s
        return there_s + self._home_s(place, blocked) <= self.battery_s + TOLERANCE

    def select(
        self, values: Mapping[str, str], visits: Sequence[Stop], blocked: int, uncertain: int
    ) -> Selection | None:
        """The best that can be done; None where not one stop can be.

        Args:
            values: of the target gaps.
            visits: optional stops that may be needed.
            blocked: bit set of the regions to keep out of.
            uncertain: those still open: at equal cost, fewer of them are entered.
        """
        wanted = (*self.itinerary.ordered, *visits)
        if not wanted:
            return Selection(stops=(), route=Route(cost=0.0, mask=0, order=(), paths=()), left=(), left_s=0.0)
        found = self._reachable(wanted, values, blocked)
        if not found.stops:
            return None
        made = self._everything(found, blocked, uncertain)
        if made is None:
            made = self._best_set(found, blocked, uncertain)
        if made is None:
            return None
        numbers, route, reasons = made
        done = {found.stops[i].id for i in numbers}
        homeward, home_s = self._homeward(found, numbers, route, blocked, uncertain)
        left = tuple(reasons.get(stop.id) or self._unreachable(stop, values) for stop in wanted if stop.id not in done)
        return Selection(
            stops=tuple(found.stops[i] for i in numbers),
            route=route,
            left=left,
            left_s=float(sum(one.stop.price_s * one.stop.chance for one in left)),
            homeward=homeward,
            home_s=home_s,
        )

    def _homeward(
        self, found: _Reachable, numbers: Sequence[int], route: Route, blocked: int, uncertain: int
    ) -> tuple[int, float]:
        """The regions that the way home enters, as few uncertain ones as the battery allows; and its seconds."""
        if self.itinerary.problem.home_m is None or self.itinerary.home is None or not route.order:
            return 0, 0.0
        left_s = self.battery_s - self._route_s(found, numbers, route)
        last = found.places[numbers[route.order[-1]]]
        ways = [
            way
            for way in self.legs.between(last, self.itinerary.home).paths
            if not way.mask & blocked and way.cost * self.itinerary.edge_s <= left_s + TOLERANCE
        ]
        rank = lambda way: ((way.mask & uncertain).bit_count(), round(way.cost, 9), way.mask)  # noqa: E731
        if not ways:
            return 0, 0.0
        way = min(ways, key=rank)
        return way.mask, way.cost * self.itinerary.edge_s

    def _reachable(self, wanted: Sequence[Stop], values: Mapping[str, str], blocked: int) -> _Reachable:
        here = self.itinerary.start
        places = {stop.id: self.itinerary.place(stop, values) for stop in wanted}
        stops: list[Stop] = []
        needs: list[int] = []
        for stop in wanted:
            place = places[stop.id]
            pick = picked_for(stop, self.itinerary.ordered)
            ids = [s.id for s in stops]
            if place is None or not np.isfinite(self.flight_s(here, place, blocked)):
                continue
            if pick is not None and pick.id not in ids:
                continue
            needs.append(0 if pick is None else 1 << ids.index(pick.id))
            stops.append(stop)
        cells = [place for stop in stops if (place := places[stop.id]) is not None]
        stay = np.array([stop.dwell_s for stop in stops])
        start = np.array([self.start_s + self.flight_s(here, cell, blocked) for cell in cells]) + stay
        apart = np.full((len(cells), len(cells)), np.inf)
        for i, one in enumerate(cells):
            for j, other in enumerate(cells):
                if i != j:
                    apart[i, j] = self.flight_s(one, other, blocked) + stay[j]
        return _Reachable(
            stops=tuple(stops),
            places=tuple(cells),
            ordered=sum(not stop.optional for stop in stops),
            start_s=start,
            apart_s=apart,
            home_s=np.array([self._home_s(cell, blocked) for cell in cells]),
            needs=tuple(needs),
        )

    def _everything(
        self, found: _Reachable, blocked: int, uncertain: int
    ) -> tuple[tuple[int, ...], Route, dict[str, LeftUndone]] | None:
        """All stops, where the battery suffices and none can be worth leaving out."""
        if len(found.stops) - found.ordered > MAX_FREE or found.least_s > found.weights_s.min() + TOLERANCE:
            return None
        numbers = tuple(range(len(found.stops)))
        route = self._route(found, numbers, blocked, uncertain)
        if route is None or self._route_s(found, numbers, route) > found.weights_s.min():
            return None
        return numbers, route, {}

    def _best_set(
        self, found: _Reachable, blocked: int, uncertain: int
    ) -> tuple[tuple[int, ...], Route, dict[str, LeftUndone]] | None:
        few = tuple(range(len(found.stops)))
        if len(few) > MAX_STOPS:
            self.notes.add(
                message(
                    "{count} stops are more than the {most} that are weighed against each other exactly; the others "
                    "were put in where they fit",
                    count=len(few),
                    most=MAX_STOPS,
                )
            )
            few = _dearest(found, MAX_STOPS)
        small = _only(found, few)
        best = set_costs(small.apart_s, small.start_s, np.array(small.later, np.int64), np.array(small.needs, np.int64))
        round_trip = (best + small.home_s).min(axis=1, initial=np.inf)
        flight = np.where(best + small.home_s <= self.battery_s + TOLERANCE, best, np.inf).min(axis=1, initial=np.inf)
        supposed = np.array([stop.optional for stop in small.stops])
        chosen = best_set(flight, members(len(few)), small.weights_s, supposed)
        if chosen is None:
            return None
        order = [few[i] for i in _order(best, small, chosen, self.battery_s)]
        spent_s = float(round_trip[chosen])
        reasons = {
            stop.id: self._short(stop, float(round_trip[chosen | 1 << i]) - spent_s, self.battery_s - spent_s)
            for i, stop in enumerate(small.stops)
            if not chosen >> i & 1
        }
        rest = [i for i in _dearest(found, len(found.stops)) if i not in few]
        for i in rest:
            reasons |= self._put_in(found, order, i)
        reasons = {k: v for k, v in reasons.items() if k not in {found.stops[i].id for i in order}}
        numbers = tuple(sorted(order))
        free = sum(i >= found.ordered for i in numbers)
        if free <= MAX_FREE and not rest:
            route = self._route(found, numbers, blocked, uncertain)
        else:
            numbers = tuple(order)
            route = self._route(found, numbers, blocked, uncertain, fixed=True)
        return None if route is None else (numbers, route, reasons)

    def _put_in(self, found: _Reachable, order: list[int], i: int) -> dict[str, LeftUndone]:
        """Puts one more stop into an order where it fits and pays; else the reason why not."""
        stop = found.stops[i]
        place, extra_s, left_s = insert(order, i, found.start_s, found.apart_s, found.home_s, self.battery_s,
                                        later=found.later, needs=found.needs)  # fmt: skip
        if place is not None and extra_s <= left_s + TOLERANCE and extra_s < stop.price_s * stop.chance:
            order.insert(place, i)
            return {}
        return {stop.id: self._short(stop, extra_s, left_s)}

    def _short(self, stop: Stop, needed_s: float, available_s: float) -> LeftUndone:
        if not np.isfinite(needed_s):
            return LeftUndone(stop=stop, resource=Shortage.THING)
        if needed_s > available_s + TOLERANCE:
            return LeftUndone(stop=stop, resource=Shortage.BATTERY, needed_s=needed_s, available_s=available_s)
        price_s = stop.price_s * stop.chance
        return LeftUndone(stop=stop, resource=Shortage.PRICE, needed_s=needed_s, available_s=price_s)

    def _unreachable(self, stop: Stop, values: Mapping[str, str]) -> LeftUndone:
        resource = Shortage.WAY
        if values.get(stop.gap) == NOT_SETTLED:
            resource = Shortage.ANSWER
        elif values.get(stop.gap) in NOWHERE:
            resource = Shortage.UNSEEN
        elif picked_for(stop, self.itinerary.ordered) is not None and self.itinerary.place(stop, values):
            resource = Shortage.THING
        return LeftUndone(stop=stop, resource=resource)

    def _route(
        self, found: _Reachable, numbers: Sequence[int], blocked: int, uncertain: int, *, fixed: bool = False
    ) -> Route | None:
        ordered = len(numbers) if fixed else sum(i < found.ordered for i in numbers)
        tour = Tour(start=self.itinerary.start, places=tuple(found.places[i] for i in numbers), ordered=ordered)
        stay_s = self.start_s + sum(found.stops[i].dwell_s for i in numbers)
        home_s = {found.places[i]: float(found.home_s[i]) for i in numbers}

        def most(last: Cell3) -> float:
            return (self.battery_s - stay_s - home_s[last]) / self.itinerary.edge_s

        return best_route(self.legs, tour, blocked, uncertain, most)

    def _route_s(self, found: _Reachable, numbers: Sequence[int], route: Route) -> float:
        return self.start_s + route.cost * self.itinerary.edge_s + sum(found.stops[i].dwell_s for i in numbers)

    def _home_s(self, cell: Cell3, blocked: int) -> float:
        if self.itinerary.problem.home_m is None:
            return 0.0
        home = self.itinerary.home
        return float("inf") if home is None else self.flight_s(cell, home, blocked)

    def flight_s(self, one: Cell3, other: Cell3, blocked: int) -> float:
        """Seconds of the shortest way between two cells that keeps out of those regions; infinite where none leads."""
        key = (one, other, blocked)
        if key not in self._flights:
            way = self.legs.between(one, other).best(blocked)
            self._flights[key] = float("inf") if way is None else way.cost * self.itinerary.edge_s
        return self._flights[key]


def picked_for(stop: Stop, ordered: Sequence[Stop]) -> Stop | None:
    """What must have been picked up for a delivery: the last pick before it, None where there is none."""
    if stop.action is not Action.DELIVER or stop.optional:
        return None
    before = ordered[: [s.id for s in ordered].index(stop.id)]
    return next((s for s in reversed(before) if s.action is Action.PICK), None)


def _dearest(found: _Reachable, count: int) -> tuple[int, ...]:
    """So many stops: those seen first, of those the dearest, then the nearest; in the order of the problem.

    A delivery is never among them without its pick.
    """
    ranked = sorted(
        range(len(found.stops)),
        key=lambda i: (found.stops[i].optional, -found.weights_s[i], round(float(found.start_s[i]), 6), i),
    )
    chosen = set(ranked[:count])
    chosen = {i for i in chosen if all(j in chosen for j in range(len(found.stops)) if found.needs[i] >> j & 1)}
    return tuple(sorted(chosen))


def _only(found: _Reachable, numbers: Sequence[int]) -> _Reachable:
    """Those stops and nothing else."""
    at = np.array(numbers, np.int64)
    needs = [sum(1 << new for new, old in enumerate(numbers) if found.needs[i] >> old & 1) for i in numbers]
    return _Reachable(
        stops=tuple(found.stops[i] for i in numbers),
        places=tuple(found.places[i] for i in numbers),
        ordered=sum(i < found.ordered for i in numbers),
        start_s=found.start_s[at],
        apart_s=found.apart_s[np.ix_(at, at)],
        home_s=found.home_s[at],
        needs=tuple(needs),
    )


def _order(best: Floats, small: _Reachable, chosen: int, battery_s: float) -> list[int]:
    """One best order of a set of stops, from the table of `set_costs`."""
    costs = np.where(best[chosen] + small.home_s <= battery_s + TOLERANCE, best[chosen], np.inf)
    last, order = int(np.argmin(costs)), []
    while True:
        order.append(last)
        rest = chosen & ~(1 << last)
        if not rest:
            return order[::-1]
        before = int(np.argmin(best[rest] + small.apart_s[:, last]))
        chosen, last = rest, before
