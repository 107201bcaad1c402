"""Which stops are done in which order where rules in time must be kept (method, section 14): stops x automaton."""

from __future__ import annotations

import heapq
import itertools
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np

from mintpilot.core.geometry import Ints
from mintpilot.core.message import Message, message
from mintpilot.core.plan import LeftUndone, Shortage, Site, Stop
from mintpilot.core.rule import Ruling
from mintpilot.core.task import Action
from mintpilot.core.tolerances import TOLERANCE
from mintpilot.planning.decision_list import ParetoPath
from mintpilot.planning.legs import Cell3
from mintpilot.planning.route import Route
from mintpilot.planning.rule_labels import RuleGrid
from mintpilot.planning.ruled_legs import RuledLegs
from mintpilot.planning.selection import Selection, Selector
from mintpilot.planning.wanted_stops import WantedStops, wanted_stops

MAX_LABELS = 20_000
"""So many (stops done, place, state of the rules) are followed before the best plan found so far is taken."""
MOST_BOUNDED = 8
"""Up to so many stops what is left to fly is bounded by the best order of them without rules."""
DECIMALS_S = 6
"""Decimal places to which seconds are compared."""
END = "end"
"""Id of the stop at the place where the rules want the flight to end."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Label:
    """One way of having come somewhere."""

    cost_s: float
    done: int
    """Bit set of the stops done."""
    order: tuple[int, ...]
    place: Cell3
    rules: int
    """Number of the set of states, at the place and its stop."""
    held: int
    paths: tuple[ParetoPath[Ints], ...]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Ending:
    """What follows the last stop."""

    hop_s: float = 0.0
    """Seconds to the place where the rules want the flight to end, where that is no stop."""
    hop: ParetoPath[Ints] | None = None
    home_s: float = 0.0
    homeward: int = 0


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Made:
    """A choice that was made."""

    wanted: WantedStops
    blocked: int
    mask: int
    """Regions that it enters."""
    found: Selection


class RuledSelector:
    """Chooses as `Selector` does among the plans that keep the rules.

    What `Selector` chooses is taken where it keeps them: no plan is better. Otherwise stops and automaton are searched
    together over ways in grid x automaton: exact up to `MAX_LABELS`; `notes` says so beyond.

    Args:
        plain: chooses without rules.
        ruling: the rules.
    """

    def __init__(self, plain: Selector, ruling: Ruling) -> None:
        self._plain, self._ruling = plain, ruling
        self._itinerary = itinerary = plain.itinerary
        terrain, problem = itinerary.terrain, itinerary.problem
        self._grid = RuleGrid(ruling=ruling, map=problem.map, limits=problem.limits)
        self._legs = RuledLegs(self._grid, terrain)
        self._made: list[_Made] = []
        self.notes: set[Message] = plain.notes

    @property
    def searches(self) -> int:
        """Searches of grid and automaton made so far."""
        return self._legs.searches

    def fits_alone(self, stop: Stop, blocked: int) -> bool:
        """See `Selector.fits_alone`."""
        return self._plain.fits_alone(stop, blocked)

    def select(
        self, values: Mapping[str, str], visits: Sequence[Stop], blocked: int, uncertain: int
    ) -> Selection | None:
        """The best that can be done under the rules; None where not one stop can be. See `Selector.select`."""
        plain = self._plain.select(values, visits, blocked, uncertain)
        if plain is None or self._keeps(plain):
            return plain
        wanted = wanted_stops(self._itinerary, values, (*self._itinerary.ordered, *visits))
        for one in self._made:
            # With fewer regions closed nothing is worse: what keeps out of these, too, is the best here.
            if one.wanted == wanted and not one.blocked & ~blocked and not one.mask & blocked:
                return one.found
        found = self._searched(plain, wanted, blocked, uncertain)
        if found is not None:
            mask = found.route.mask | found.homeward
            self._made.append(_Made(wanted=wanted, blocked=blocked, mask=mask, found=found))
        return found

    def _begun(self) -> tuple[int, int]:
        """Set of states and propositions held in the middle of the plan's first cell."""
        held, start = self._ruling.held, self._itinerary.start
        middle = self._itinerary.terrain.frame.centres_of(np.array([start]))
        hop = np.vstack([np.asarray([self._itinerary.problem.start_m], float), middle])
        came = self._grid.flown(self._grid.number(self._ruling.states), hop, held)
        return self._grid.followed(came, [self._legs.flat(start)], held), held

    def _keeps(self, found: Selection) -> bool:
        """Whether a plan made without regard to rules keeps them, its way home included."""
        rules, held = self._begun()
        place = self._itinerary.start
        for number, way in zip(found.route.order, found.route.paths, strict=True):
            rules = self._grid.followed(rules, self._legs.flats(way.path), held)
            place = _cell(way.path[-1])
            rules, held = self._grid.done(rules, self._legs.flat(place), found.stops[number].id, held)
        home = self._itinerary.home
        if home is not None and found.route.order:
            back = self._plain.legs.between(place, home).best(~found.homeward)
            if back is not None:
                rules = self._grid.followed(rules, self._legs.flats(back.path), held)
        return self._grid.is_kept(rules)

    def _searched(self, plain: Selection, wanted: WantedStops, blocked: int, uncertain: int) -> Selection | None:
        """Labels in the order of the least that a route through them costs: the ways without rules bound the rest."""
        rules, held = self._begun()
        if rules < 0:
            return None
        least = self._least(wanted, blocked)
        start = self._itinerary.start
        first = _Label(cost_s=self._plain.start_s, done=0, order=(), place=start, rules=rules, held=held, paths=())
        heap: list[tuple[float, int, _Label]] = [(first.cost_s, 0, first)]
        count, seen = itertools.count(1), set[tuple[int, Cell3, int, int]]()
        best: tuple[tuple[float, ...], _Label, _Ending] | None = None
        while heap:
            bound_s, _, here = heapq.heappop(heap)
            key = (here.done, here.place, here.rules, here.held)
            if key in seen:
                continue
            if best is not None and round(bound_s, DECIMALS_S) > best[0][0]:
                break
            if len(seen) >= MAX_LABELS:
                self.notes.add(
                    message(
                        "more than {most} combinations of stops and rules; the best plan found is taken",
                        most=MAX_LABELS,
                    )
                )
                break
            seen.add(key)
            end = self._ended(here, blocked, uncertain) if here.done else None
            if end is not None:
                left_s = wanted.left_s(here.done)
                rank = (round(here.cost_s + end.hop_s + left_s, DECIMALS_S), left_s, here.cost_s)
                if best is None or rank < best[0]:
                    best = (rank, here, end)
            for after in self._onward(here, wanted, blocked, uncertain):
                heapq.heappush(heap, (after.cost_s + least(after.done, after.place), next(count), after))
        return None if best is None else self._chosen(plain, wanted.stops, best[1], best[2])

    def _least(self, wanted: WantedStops, blocked: int) -> Callable[[int, Cell3], float]:
        """The least that any route still costs after some stops at a place, what it leaves undone counted, seconds."""

        @cache
        def least(done: int, place: Cell3) -> float:
            if len(wanted.stops) > MOST_BOUNDED:
                return 0.0
            onward = [
                self._plain.flight_s(place, there, blocked) + stop.dwell_s + least(done | 1 << i, there)
                for i, stop, there in wanted.next(done)
            ]
            return min([wanted.left_s(done), *onward])

        return least

    def _onward(self, here: _Label, wanted: WantedStops, blocked: int, uncertain: int) -> Iterator[_Label]:
        """The labels after one more stop."""
        ways = self._legs.ways(here.place, here.rules, here.held, blocked, uncertain)
        for i, stop, place in wanted.next(here.done):
            for state, _ in ways.at(self._legs.lattice.node(place)):
                way = self._legs.path(ways, place, state)
                after, held = self._grid.done(int(ways.sets[state]), self._legs.flat(place), stop.id, here.held)
                cost_s = here.cost_s + way.cost * self._itinerary.edge_s + stop.dwell_s
                if after >= 0 and cost_s <= self._plain.battery_s + TOLERANCE:
                    yield _Label(
                        cost_s=cost_s,
                        done=here.done | 1 << i,
                        order=(*here.order, i),
                        place=place,
                        rules=after,
                        held=held,
                        paths=(*here.paths, way),
                    )

    def _ended(self, here: _Label, blocked: int, uncertain: int) -> _Ending | None:
        """How the flight may end after this; None: not with the rules kept."""
        spare_s = self._plain.battery_s - here.cost_s + TOLERANCE
        if self._itinerary.problem.home_m is None and self._grid.is_kept(here.rules):
            return _Ending()
        ways = self._legs.ways(here.place, here.rules, here.held, blocked, uncertain)
        kept = np.array([self._grid.is_kept(int(number)) for number in ways.sets])
        cost = np.where(np.tile(kept, self._legs.lattice.size), ways.cost, np.inf)
        if self._itinerary.problem.home_m is not None:
            if self._itinerary.home is None:
                return None
            first = self._legs.lattice.node(self._itinerary.home) * len(kept)
            row = first + int(np.argmin(cost[first : first + len(kept)]))
        else:
            row = int(np.argmin(np.round(cost, DECIMALS_S)))
        if not np.isfinite(cost[row]) or cost[row] * self._itinerary.edge_s > spare_s:
            return None
        node, state = divmod(row, len(kept))
        way = self._legs.path(ways, _cell(self._legs.lattice.cells(np.array([node]))[0]), state)
        if self._itinerary.problem.home_m is None:
            return _Ending(hop_s=way.cost * self._itinerary.edge_s, hop=way)
        return _Ending(home_s=way.cost * self._itinerary.edge_s, homeward=way.mask)

    def _chosen(
        self,
        plain: Selection,
        wanted: Sequence[Stop],
        label: _Label,
        ending: _Ending,
    ) -> Selection:
        stops, paths = [wanted[i] for i in label.order], list(label.paths)
        hop = ending.hop
        if hop is not None:
            x, y, z = (float(v) for v in self._itinerary.terrain.frame.centres_of(hop.path[-1:])[0])
            site = Site(position_m=(x, y, z), label=END)
            stops.append(Stop(id=END, action=Action.GO, sites=(site,), dwell_s=0.0, price_s=0.0,
                              text=message("end the flight where the rules want it")))  # fmt: skip
            paths.append(hop)
        done = {stop.id for stop in stops}
        why = {one.stop.id: one for one in plain.left}
        rules = tuple(rule.text for rule in self._ruling.rules)
        left = tuple(
            why.get(stop.id) or LeftUndone(stop=stop, resource=Shortage.RULE, rules=rules)
            for stop in wanted
            if stop.id not in done
        )
        mask = 0
        for way in paths:
            mask |= way.mask
        route = Route(
            cost=float(sum(way.cost for way in paths)), mask=mask, order=tuple(range(len(stops))), paths=tuple(paths)
        )
        return Selection(
            stops=tuple(stops),
            route=route,
            left=left,
            left_s=float(sum(one.stop.price_s * one.stop.chance for one in left)),
            homeward=ending.homeward,
            home_s=ending.home_s,
        )


def _cell(cell: Ints) -> Cell3:
    z, y, x = (int(i) for i in cell)
    return (z, y, x)
