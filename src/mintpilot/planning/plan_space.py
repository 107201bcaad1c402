"""The plans of one problem under any assumptions (method, section 2)."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import dataclass, replace

from mintpilot.core.gap import BLOCKED, PASSABLE, Assumptions
from mintpilot.core.message import Message, message
from mintpilot.core.plan import LeftUndone, Plan, PlanningProblem, Shortage, Stop
from mintpilot.core.ports import PlanSpace
from mintpilot.planning.itinerary import itinerary_of, needed_value
from mintpilot.planning.legs import LegTable, PathSearch
from mintpilot.planning.route import Route
from mintpilot.planning.ruled_selection import RuledSelector
from mintpilot.planning.selection import NOT_SETTLED, Selection, Selector
from mintpilot.planning.terrain import Terrain


@dataclass(frozen=True, slots=True)
class _Case:
    """What one plan is made for: the answers that count, and nothing else."""

    blocked: int
    """Obstacle gaps to keep out of."""
    uncertain: int
    """Those still open: at equal cost, fewer of them are entered."""
    visits: tuple[Stop, ...]
    """Optional stops that may be needed, each with its chance under what is assumed."""
    values: tuple[tuple[str, tuple[str, ...]], ...]
    """For each target gap, the values to choose among; ``NOT_SETTLED`` alone: its stops are left undone."""


class GridPlanSpace(PlanSpace):
    """Plans as sequences of legs between fixed places.

    A leg's decision list answers every joint hypothesis of the obstacle gaps at once; it is made when a plan first
    needs it, so the number of map searches is at most the number of pairs of places, whatever 2^k is.

    Args:
        problem: what is to be planned.
        terrain: the problem laid on the grid.
        search: finds decision lists between cells of that grid.

    Raises:
        InfeasibleError: not one stop can be reached under any hypothesis.
        MissionError: a stop has several sites and no gap to choose among them.
    """

    def __init__(self, problem: PlanningProblem, terrain: Terrain, search: PathSearch) -> None:
        self.itinerary = itinerary_of(problem, terrain)
        self._search = search
        self._legs = LegTable(search)
        self._selector: Selector | RuledSelector = Selector(self.itinerary, self._legs)
        if problem.ruling is not None:
            self._selector = RuledSelector(self._selector, problem.ruling)
        self._gaps = {g.id: g for g in problem.gaps}
        self._made: dict[_Case, Plan | None] = {}

    @property
    def searches(self) -> int:
        """Searches of the map made so far."""
        return self._search.searches

    @property
    def notes(self) -> tuple[Message, ...]:
        """What a bound on the work left out, in plain sentences; empty when every plan is the best one."""
        notes = set(self._selector.notes)
        for cut in self._legs.incomplete:
            if cut.left_out:
                names = ", ".join(self.itinerary.terrain.gaps[r].id for r in cut.left_out)
                notes.add(
                    message(
                        "more regions than one search can tell apart: {names} taken as blocked on a leg", names=names
                    )
                )
            if cut.not_expanded:
                notes.add(
                    message(
                        "{count} sets of assumptions were left unplanned on a leg; plans stay safe",
                        count=cut.not_expanded,
                    )
                )
        return tuple(sorted(notes, key=str))

    def optimistic(self, given: Assumptions) -> Plan | None:
        """The cheapest plan with every open gap at its most favourable value; None where not one stop can be done.

        A room that may be empty is taken for empty, unless the battery does not suffice for it anyway: then it is left
        undone, and nothing relies on what is in it. Where only such rooms could be visited the plan has no legs.
        """
        blocked = self._regions(given, lambda values: PASSABLE not in values)
        visits = tuple(self._weighed(s, given) for s in self.itinerary.optional if self._needed(s, given, blocked))
        case = _Case(
            blocked,
            self._regions(given, lambda values: len(values) > 1),
            visits,
            tuple((t, self._values(t, given)) for t in self.itinerary.targets),
        )
        plan = self._plan(case)
        if plan is None:
            plan = self._nothing_yet(visits, given)
        return None if plan is None else replace(plan, relies_on=self._relied_on(plan, given))

    def cautious(self, given: Assumptions) -> Plan | None:
        """The best plan that can be flown whatever the open gaps turn out to be; None where not one stop can be done.

        It keeps out of every region that may be blocked, visits every room that may be occupied as far as the battery
        suffices, and leaves undone what hangs on a target gap that is not settled.
        """
        case = _Case(
            self._regions(given, lambda values: BLOCKED in values or not values),
            0,
            tuple(
                self._weighed(s, given) for s in self.itinerary.optional if needed_value(s) in self._possible(s, given)
            ),
            tuple(
                (t, (NOT_SETTLED,) if self._matters(t, given) else self._values(t, given)[:1])
                for t in self.itinerary.targets
            ),
        )
        return self._plan(case)

    def _needed(self, stop: Stop, given: Assumptions, blocked: int) -> bool:
        """Whether an optional stop is to be visited even if all turns out well, or cannot be for want of battery."""
        possible = set(self._possible(stop, given))
        if possible <= {needed_value(stop)}:
            return True
        return needed_value(stop) in possible and not self._selector.fits_alone(stop, blocked)

    def _weighed(self, stop: Stop, given: Assumptions) -> Stop:
        """The stop with its chance under what is assumed: that as believed while its gap is open, else certain."""
        return replace(stop, chance=1.0) if len(self._possible(stop, given)) == 1 else stop

    def _nothing_yet(self, visits: tuple[Stop, ...], given: Assumptions) -> Plan | None:
        """The plan without legs that waits for somebody to be in a room; None where no room is left either."""
        visited = {stop.id for stop in visits}
        if all(s.id in visited or needed_value(s) not in self._possible(s, given) for s in self.itinerary.optional):
            return None
        wanted = (*self.itinerary.ordered, *visits)
        left = tuple(LeftUndone(stop=stop, resource=Shortage.BATTERY) for stop in wanted)
        return self.itinerary.plan(Route(cost=0.0, mask=0, order=(), paths=()), (), left, {})

    def _values(self, gap_id: str, given: Assumptions) -> tuple[str, ...]:
        """Possible values, sorted, so that their order in the gap never matters."""
        return tuple(sorted(given.possible(self._gaps[gap_id])))

    def _possible(self, stop: Stop, given: Assumptions) -> tuple[str, ...]:
        """Possible values of an optional stop's gap; a stop whose gap is not open any more is needed."""
        return given.possible(self._gaps[stop.gap]) if stop.gap in self._gaps else (needed_value(stop),)

    def _regions(self, given: Assumptions, test: Callable[[tuple[str, ...]], bool]) -> int:
        """Bit set of the obstacle gaps whose possible values pass the test."""
        return sum(1 << r for r, gap in enumerate(self.itinerary.terrain.gaps) if test(given.possible(gap)))

    def _matters(self, target: str, given: Assumptions) -> bool:
        """Whether the gap's possible values lead to different places."""
        return len({self.itinerary.sites({target: v}) for v in self._values(target, given)}) > 1

    def _relied_on(self, plan: Plan, given: Assumptions) -> frozenset[str]:
        """The open gaps that the plan enters, skips or binds."""
        touched = {g for g in plan.enters | plan.skips if g in self._gaps and given.is_open(self._gaps[g])}
        return frozenset(touched | {t for t, _ in plan.binds if self._matters(t, given)})

    def _plan(self, case: _Case) -> Plan | None:
        if case not in self._made:
            self._made[case] = self._best(case)
        return self._made[case]

    def _best(self, case: _Case) -> Plan | None:
        """The best plan over all choices of values, within the vehicle's endurance."""
        names = [target for target, _ in case.values]
        best: tuple[tuple[object, ...], Selection, dict[str, str]] | None = None
        for choice in itertools.product(*(values for _, values in case.values)):
            values = dict(zip(names, choice, strict=True))
            found = self._selector.select(values, case.visits, case.blocked, case.uncertain)
            if found is not None:
                lost_s = found.left_s + sum(stop.dwell_s for stop in found.stops)
                rank = (
                    round(found.route.cost + lost_s / self.itinerary.edge_s, 9),
                    *found.route.rank(case.uncertain),
                    choice,
                )
                if best is None or rank < best[0]:
                    best = (rank, found, values)
        if best is None:
            return None
        _, found, values = best
        return self.itinerary.plan(
            found.route, found.stops, found.left, values, homeward=found.homeward, home_s=found.home_s
        )
