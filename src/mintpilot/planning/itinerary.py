"""Stops and their sites as places on the grid, and routes through them as plans."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from mintpilot.core.errors import InfeasibleError, MissionError
from mintpilot.core.gap import PRESENT, GapKind
from mintpilot.core.geometry import Floats, Ints, Vec3
from mintpilot.core.message import message
from mintpilot.core.plan import LeftUndone, Leg, Plan, PlanningProblem, Site, Stop
from mintpilot.planning.approach import approach_cell
from mintpilot.planning.legs import Cell3
from mintpilot.planning.narrow import narrow_passages
from mintpilot.planning.route import Route
from mintpilot.planning.terrain import Terrain


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Itinerary:
    """The stops of a problem with the place of every site."""

    problem: PlanningProblem
    terrain: Terrain
    ordered: tuple[Stop, ...]
    """In order."""
    optional: tuple[Stop, ...]
    """Sorted by id."""
    targets: tuple[str, ...]
    """Gaps that choose sites of ordered stops, sorted."""
    places: Mapping[tuple[str, str], Cell3 | None]
    """Cell at which each (stop id, value of its site) is served; None where it cannot be reached."""
    home: Cell3 | None
    """Cell to return to; None where there is none, or nobody wants to."""

    @property
    def start(self) -> Cell3:
        """The cell where all routes begin."""
        z, y, x = (int(i) for i in self.terrain.start)
        return (z, y, x)

    @property
    def edge_s(self) -> float:
        """Flight along one edge of a cell, seconds."""
        return self.terrain.frame.resolution_m / self.problem.limits.cruise_mps

    def site(self, stop: Stop, values: Mapping[str, str]) -> Site | None:
        """The site of a stop when its target gap has that value; None for a value without a site."""
        if stop.gap not in values:
            return stop.sites[0]
        return next((s for s in stop.sites if s.value == values[stop.gap]), None)

    def sites(self, values: Mapping[str, str]) -> tuple[tuple[object, ...], ...]:
        """Where the ordered stops are under those values: equal for values that make no difference."""
        chosen = (self.site(stop, values) for stop in self.ordered)
        return tuple((s.position_m, s.reach_m) if s else ("nowhere",) for s in chosen)

    def place(self, stop: Stop, values: Mapping[str, str]) -> Cell3 | None:
        """The cell at which a stop is served; None where it cannot be reached or does not exist."""
        site = self.site(stop, values)
        return self.places[stop.id, site.value] if site else None

    def plan(
        self,
        route: Route,
        stops: Sequence[Stop],
        left: tuple[LeftUndone, ...],
        values: Mapping[str, str],
        *,
        homeward: int = 0,
        home_s: float = 0.0,
    ) -> Plan:
        """A route through these stops as a plan in metres and seconds, which relies on nothing yet.

        Args:
            route: its numbers mean ``stops``.
            stops: those that are done.
            left: those that are not, though they are needed or may be.
            values: of the target gaps.
            homeward: bit set of the regions that the way home enters.
            home_s: flight time of the way home.
        """
        cruise = self.problem.limits.cruise_mps
        done = {stop.id for stop in stops}
        looked_at = done | {one.stop.id for one in left}
        presence = {g.id for g in self.problem.gaps if len(g.values) > 1} & {s.gap for s in self.optional}
        legs: list[Leg] = []
        for number, way in zip(route.order, route.paths, strict=True):
            stop = stops[number]
            site = self.site(stop, values)
            assert site is not None, "a tour has a site for every stop"
            path = self.terrain.frame.centres_of(way.path)
            length = way.cost * self.terrain.frame.resolution_m
            if not legs:
                path, hop = _from_start(path, self.problem.start_m)
                length += hop
            duration = length / cruise + stop.dwell_s
            legs.append(Leg(stop=stop, site=site, path_m=path, length_m=length, duration_s=duration))
        return Plan(
            legs=tuple(legs),
            cost_s=float(sum(leg.duration_s for leg in legs)),
            relies_on=frozenset(),
            home_s=home_s,
            enters=frozenset(g.id for r, g in enumerate(self.terrain.gaps) if (route.mask | homeward) >> r & 1),
            binds=tuple(sorted((t, v) for t, v in values.items() if any(s.gap == t for s in stops))),
            skips=frozenset(s.gap for s in self.optional if s.id not in looked_at),
            leaves_undone=left,
            undone_s=float(sum(one.stop.price_s for one in left if one.stop.gap not in presence)),
            stakes=tuple(
                sorted(
                    (s.gap, needed_value(s), s.price_s) for s in self.optional if s.id not in done and s.gap in presence
                )
            ),
        )


def itinerary_of(problem: PlanningProblem, terrain: Terrain) -> Itinerary:
    """Finds the place of every site.

    Raises:
        InfeasibleError: not one stop can be reached under any hypothesis.
        MissionError: a stop has several sites and no gap to choose among them.
    """
    kinds = {g.id: g.kind for g in problem.gaps}
    ordered = tuple(s for s in problem.stops if not s.optional)
    places = {
        (stop.id, site.value): _cell(approach_cell(terrain, site)) for stop in problem.stops for site in stop.sites
    }
    for stop in ordered:
        if len(stop.sites) != 1 and stop.gap not in kinds:
            raise MissionError(
                f"stop '{stop.id}' has {len(stop.sites)} sites and its gap '{stop.gap}' is not open; give it one site"
            )
    if ordered and all(place is None for place in places.values()):
        for stop in ordered:
            site = stop.sites[0]
            why = narrow_passages(problem, terrain, site) or message(
                "no flyable cell within {reach_m:g} m of it is connected to the start; map its surroundings, or allow "
                "a wider reach",
                reach_m=site.reach_m,
            )
            raise InfeasibleError(
                message(
                    "stop '{stop}' at {place} can be reached under no hypothesis: {why}",
                    stop=stop.said,
                    place=str(site.position_m),
                    why=why,
                )
            )
    return Itinerary(
        problem=problem,
        terrain=terrain,
        ordered=ordered,
        optional=tuple(sorted((s for s in problem.stops if s.optional), key=lambda s: s.id)),
        targets=tuple(sorted({s.gap for s in ordered if kinds.get(s.gap, GapKind.PRESENCE) is not GapKind.PRESENCE})),
        places=places,
        home=None if problem.home_m is None else _home(terrain, problem.home_m),
    )


def needed_value(stop: Stop) -> str:
    """The value of its presence gap under which an optional stop must be visited."""
    return stop.sites[0].value or PRESENT


def _home(terrain: Terrain, home_m: Vec3) -> Cell3 | None:
    """The very cell of the place to return to, inside an open region too; one beside it where it cannot be flown to."""
    cell = terrain.frame.cells_of(np.array([home_m]))[0]
    if terrain.frame.is_flat:
        cell[0] = 0
    if terrain.frame.contains(cell[None])[0] and terrain.reachable[tuple(cell)]:
        return _cell(cell)
    return _cell(approach_cell(terrain, Site(position_m=home_m)))


def _cell(cell: Sequence[int] | Ints | None) -> Cell3 | None:
    if cell is None:
        return None
    z, y, x = (int(i) for i in cell)
    return (z, y, x)


def _from_start(path_m: Floats, start_m: tuple[float, float, float]) -> tuple[Floats, float]:
    """The path from the true start on, and the length of the way to its first cell's centre."""
    hop = float(np.linalg.norm(path_m[0] - start_m))
    if hop < 1e-9:
        return path_m, 0.0
    return np.concatenate([np.array([start_m], float), path_m]), hop
