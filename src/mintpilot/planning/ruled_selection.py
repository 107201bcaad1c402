"""Which stops are done in which order where rules in time must be kept (method, section 14): stops x automaton."""

from __future__ import annotations

import heapq
import itertools
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from mintpilot.core.geometry import Floats, Ints
from mintpilot.core.message import Message, message
from mintpilot.core.plan import LeftUndone, Shortage, Site, Stop
from mintpilot.core.rule import Ruling
from mintpilot.core.task import Action
from mintpilot.core.tolerances import TOLERANCE
from mintpilot.planning.decision_list import ParetoPath
from mintpilot.planning.legs import Cell3
from mintpilot.planning.route import Route
from mintpilot.planning.rule_labels import RuleGrid
from mintpilot.planning.rule_search import RuledWays
from mintpilot.planning.ruled_legs import RuledLegs
from mintpilot.planning.selection import Selection, Selector
from mintpilot.planning.wanted_stops import WantedStops, wanted_stops

MAX_LABELS = 20_000
"""So many (stops done, place, state of the rules) are followed before the best plan found so far is taken."""
MOST_BOUNDED = 8
"""Up to so many stops what is left to fly is bounded by the best order of them without rules."""
DECIMALS_S = 6
"""Decimal places to which seconds are compared."""
AHEAD = 16.0
"""Ways are grown so much further than the least that may be better, edges, then twice that: that costs less time."""
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


@dataclass(slots=True, kw_only=True, eq=False)
class _Onward:
    """The ways on from a label, as far as they are grown."""

    ways: RuledWays
    ended: bool
    """Whether it is settled how the flight may end after the label."""
    ahead: float = AHEAD
    """They are grown so much further than they must be, edges."""
    told: set[tuple[int, int]] = field(default_factory=set)
    """Stops and sets that were reached."""


@dataclass(slots=True, kw_only=True, eq=False)
class _Least:
    """The least that flights still cost if there were no rules, what they leave undone counted."""

    wanted: WantedStops
    legs: RuledLegs
    blocked: int
    edge_s: float
    _after: dict[tuple[int, Cell3], float] = field(default_factory=dict)
    _rest: dict[int, Floats] = field(default_factory=dict)

    def after(self, done: int, place: Cell3) -> float:
        """Seconds, after some stops at a place."""
        if len(self.wanted.stops) > MOST_BOUNDED:
            return 0.0
        if (done, place) not in self._after:
            node = self.legs.lattice.node(place)
            onward = [
                float(self.legs.away(there, self.blocked)[node]) * self.edge_s
                + stop.dwell_s
                + self.after(done | 1 << i, there)
                for i, stop, there in self.wanted.next(done)
            ]
            self._after[done, place] = min([self.wanted.left_s(done), *onward])
        return self._after[done, place]

    def rest(self, done: int) -> Floats:
        """Edges (nodes,) that lie before every node, after some stops."""
        if done not in self._rest:
            rest = np.full(self.legs.lattice.size, self.wanted.left_s(done) / self.edge_s)
            if len(self.wanted.stops) > MOST_BOUNDED:
                rest[:] = 0.0
            else:
                for i, stop, there in self.wanted.next(done):
                    left_s = stop.dwell_s + self.after(done | 1 << i, there)
                    rest = np.minimum(rest, self.legs.away(there, self.blocked) + left_s / self.edge_s)
            self._rest[done] = rest
        return self._rest[done]


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

    @cached_property
    def _begun(self) -> tuple[int, int]:
        """Set of states and propositions held in the middle of the plan's first cell."""
        held, start = self._ruling.held, self._itinerary.start
        middle = self._itinerary.terrain.frame.centres_of(np.array([start]))
        hop = np.vstack([np.asarray([self._itinerary.problem.start_m], float), middle])
        came = self._grid.flown(self._grid.number(self._ruling.states), hop, held)
        return self._grid.followed(came, [self._legs.flat(start)], held), held

    def _keeps(self, found: Selection) -> bool:
        """Whether a plan made without regard to rules keeps them, its way home included."""
        rules, held = self._begun
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
        rules, held = self._begun
        if rules < 0:
            return None
        legs, edge_s = self._legs, self._itinerary.edge_s
        least = _Least(wanted=wanted, legs=legs, blocked=blocked, edge_s=edge_s)
        start = self._itinerary.start
        first = _Label(cost_s=self._plain.start_s, done=0, order=(), place=start, rules=rules, held=held, paths=())
        heap: list[tuple[float, int, _Label, _Onward | None]] = [(first.cost_s, 0, first, None)]
        count, seen = itertools.count(1), dict[tuple[int, Cell3, int], list[int]]()
        best: tuple[tuple[float, ...], _Label, _Ending] | None = None

        homeward = self._itinerary.problem.home_m is not None

        def better(label: _Label, end: _Ending) -> None:
            nonlocal best
            left_s = wanted.left_s(label.done)
            rank = (round(label.cost_s + end.hop_s + left_s, DECIMALS_S), left_s, label.cost_s)
            if best is None or rank < best[0]:
                best = (rank, label, end)

        while heap:
            bound_s, _, here, onward = heapq.heappop(heap)
            if best is not None and round(bound_s, DECIMALS_S) > best[0][0]:
                break
            if onward is None:
                before = seen.setdefault((here.done, here.place, here.held), [])
                if any(self._grid.covers(here.rules, one) for one in before):
                    continue  # it came there before, for no more, and is no worse off
                if sum(map(len, seen.values())) >= MAX_LABELS:
                    self.notes.add(
                        message(
                            "more than {most} combinations of stops and rules; the best plan found is taken",
                            most=MAX_LABELS,
                        )
                    )
                    break
                before.append(here.rules)
                worth = best is None or round(here.cost_s + wanted.left_s(here.done), DECIMALS_S) <= best[0][0]
                end = self._ended(here, blocked, uncertain) if here.done and worth else None
                if end is not None:
                    better(here, end)
                if not any(wanted.next(here.done)) and (end is not None or homeward):
                    continue
                ways = legs.ways((here.place, here.rules, here.held), blocked, uncertain, least.rest(here.done))
                onward = _Onward(ways=ways, ended=end is not None or not here.done)
            next_s = heap[0][0] if heap else bound_s
            onward.ways.grow((max(bound_s, next_s) - here.cost_s) / edge_s + onward.ahead)
            onward.ahead *= 2
            hop = self._hop(here, onward, wanted.left_s(here.done) / edge_s)
            if hop is not None:
                better(here, hop)
            for after in self._onward(here, onward, wanted):
                heapq.heappush(heap, (after.cost_s + least.after(after.done, after.place), next(count), after, None))
            if np.isfinite(onward.ways.reach):
                heapq.heappush(heap, (here.cost_s + onward.ways.reach * edge_s, next(count), here, onward))
        return None if best is None else self._chosen(plain, wanted.stops, best[1], best[2])

    def _onward(self, here: _Label, onward: _Onward, wanted: WantedStops) -> Iterator[_Label]:
        """The labels after one more stop, that are not told yet."""
        ways, lattice = onward.ways, self._legs.lattice
        for i, stop, place in wanted.next(here.done):
            for state, _ in ways.at(lattice.node(place)):
                if (i, state) in onward.told:
                    continue
                onward.told.add((i, state))
                way = self._legs.path(ways, place, state)
                number = int(ways.ground.sets[state])
                after, held = self._grid.done(number, self._legs.flat(place), stop.id, here.held)
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
        """How the flight may end here, with the way home where one is wanted; None: not with the rules kept."""
        if self._itinerary.problem.home_m is None:
            return _Ending() if self._grid.is_kept(here.rules) else None
        home = self._itinerary.home
        if home is None:
            return None
        spare = (self._plain.battery_s - here.cost_s + TOLERANCE) / self._itinerary.edge_s
        rest, node = self._legs.away(home, blocked), self._legs.lattice.node(home)
        ways = self._legs.ways((here.place, here.rules, here.held), blocked, uncertain, rest)
        ahead, ends = AHEAD, list[tuple[float, int]]()
        while not ends and ways.reach <= spare and np.isfinite(ways.reach):
            ways.grow(min(ways.reach + ahead, spare))
            ahead *= 2
            ends = [(cost, state) for state, cost in ways.at(node) if ways.ground.kept[state] and cost <= spare]
        if not ends:
            return None
        way = self._legs.path(ways, home, min(ends)[1])
        return _Ending(home_s=way.cost * self._itinerary.edge_s, homeward=way.mask)

    def _hop(self, here: _Label, onward: _Onward, left: float) -> _Ending | None:
        """The way to the nearest place where the flight may end, once it is known; None: none, or it was told."""
        ways, edge_s = onward.ways, self._itinerary.edge_s
        if onward.ended or self._itinerary.problem.home_m is not None or ways.nearest < 0:
            return None
        cost, count = float(ways.cost[ways.nearest]), len(ways.ground.sets)
        if cost + left >= ways.reach:
            return None
        onward.ended = True
        if here.cost_s + cost * edge_s > self._plain.battery_s + TOLERANCE:
            return None
        node, state = divmod(ways.nearest, count)
        way = self._legs.path(ways, _cell(self._legs.lattice.cells(np.array([node]))[0]), state)
        return _Ending(hop_s=way.cost * edge_s, hop=way)

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
