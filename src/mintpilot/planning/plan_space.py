"""The plans of one problem under any assumptions (method, section 2)."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import dataclass, replace

from mintpilot.core.gap import BLOCKED, PASSABLE, Assumptions
from mintpilot.core.plan import Plan, PlanningProblem, Stop
from mintpilot.core.ports import PlanSpace
from mintpilot.core.tolerances import TOLERANCE
from mintpilot.planning.itinerary import itinerary_of, needed_value
from mintpilot.planning.legs import LegTable, PathSearch
from mintpilot.planning.route import Route, best_route
from mintpilot.planning.terrain import Terrain


@dataclass(frozen=True, slots=True)
class _Case:
    """What one plan is made for: the answers that count, and nothing else."""

    blocked: int
    """Obstacle gaps to keep out of."""
    uncertain: int
    """Those still open: at equal cost, fewer of them are entered."""
    visits: tuple[Stop, ...]
    """Optional stops to be visited."""
    values: tuple[tuple[str, tuple[str, ...]], ...]
    """For each target gap, the values to choose among."""


class GridPlanSpace(PlanSpace):
    """Plans as sequences of legs between fixed places.

    A leg's decision list answers every joint hypothesis of the obstacle gaps at once; it is made when a plan first
    needs it, so the number of map searches is at most the number of pairs of places, whatever 2^k is.

    Args:
        problem: what is to be planned.
        terrain: the problem laid on the grid.
        search: finds decision lists between cells of that grid.

    Raises:
        InfeasibleError: a stop that is not optional can be reached under no hypothesis.
        MissionError: a stop has several sites and no gap to choose among them.
    """

    def __init__(self, problem: PlanningProblem, terrain: Terrain, search: PathSearch) -> None:
        self.itinerary = itinerary_of(problem, terrain)
        self._search = search
        self._legs = LegTable(search)
        self._gaps = {g.id: g for g in problem.gaps}
        self._made: dict[_Case, Plan | None] = {}

    @property
    def searches(self) -> int:
        """Searches of the map made so far."""
        return self._search.searches

    @property
    def notes(self) -> tuple[str, ...]:
        """What a bound on the work left out, in plain sentences; empty when every plan is the best one."""
        notes = set()
        for cut in self._legs.incomplete:
            if cut.left_out:
                names = ", ".join(self.itinerary.terrain.gaps[r].id for r in cut.left_out)
                notes.add(f"more regions than one search can tell apart: {names} taken as blocked on a leg")
            if cut.not_expanded:
                notes.add(f"{cut.not_expanded} sets of assumptions were left unplanned on a leg; plans stay safe")
        return tuple(sorted(notes))

    def optimistic(self, given: Assumptions) -> Plan | None:
        """The cheapest plan with every open gap at its most favourable value; None where there is none."""
        case = _Case(
            self._regions(given, lambda values: PASSABLE not in values),
            self._regions(given, lambda values: len(values) > 1),
            tuple(s for s in self.itinerary.optional if set(self._possible(s, given)) <= {needed_value(s)}),
            tuple((t, self._values(t, given)) for t in self.itinerary.targets),
        )
        plan = self._plan(case)
        return None if plan is None else replace(plan, relies_on=self._relied_on(plan, given))

    def cautious(self, given: Assumptions) -> Plan | None:
        """The cheapest plan that succeeds whatever the open gaps turn out to be; None where there is none.

        It keeps out of every region that may be blocked and visits every room that may be occupied. Target gaps must
        be settled, or lead to the same places whatever their value.
        """
        values = tuple((t, self._values(t, given)) for t in self.itinerary.targets)
        if any(self._matters(target, given) for target in self.itinerary.targets):
            return None
        case = _Case(
            self._regions(given, lambda values: BLOCKED in values or not values),
            0,
            tuple(s for s in self.itinerary.optional if needed_value(s) in self._possible(s, given)),
            tuple((target, possible[:1]) for target, possible in values),
        )
        return self._plan(case)

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
        best: tuple[tuple[object, ...], Route, dict[str, str]] | None = None
        for choice in itertools.product(*(values for _, values in case.values)):
            values = dict(zip(names, choice, strict=True))
            tour = self.itinerary.tour(values, case.visits)
            route = best_route(self._legs, tour, case.blocked, case.uncertain) if tour else None
            if route is not None:
                rank = (*route.rank(case.uncertain), choice)
                if best is None or rank < best[0]:
                    best = (rank, route, values)
        if best is None:
            return None
        plan = self.itinerary.plan(best[1], best[2], case.visits)
        return plan if plan.cost_s <= self.itinerary.problem.limits.endurance_s + TOLERANCE else None
