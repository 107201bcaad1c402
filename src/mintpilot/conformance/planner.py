"""Checks of planners and of distances between paths."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from mintpilot.conformance.sample import require, sample_problem
from mintpilot.core.errors import ConformanceError, InfeasibleError
from mintpilot.core.gap import BLOCKED, PASSABLE, Assumptions, GapKind
from mintpilot.core.geometry import Bools, Floats, Ints
from mintpilot.core.plan import Plan, PlanningProblem
from mintpilot.core.ports import ImpactMetric, Planner
from mintpilot.core.semantic_map import Cell

_NEAR_S = 1e-6


def check_planner(make: Callable[[], Planner]) -> None:
    """The plans of a small hall: complete, through free cells only, honest about what they rely on (method, section 2).

    Args:
        make: makes a fresh planner; called more than once.

    Raises:
        ConformanceError: it breaks the contract of `mintpilot.core.ports.Planner`.
    """
    problem, planner = sample_problem(), make()
    space = planner.open(problem)
    smoke, target = _gap_id(problem, GapKind.OBSTACLE), _gap_id(problem, GapKind.TARGET)
    # What a phrase means cannot be hedged: a cautious plan exists only where that is settled.
    settled = Assumptions.exactly({target: problem.gap(target).values[0]})
    hopeful, careful = _plan(space.optimistic(settled), planner), _plan(space.cautious(settled), planner)
    for plan in (hopeful, careful):
        _check_way(plan, problem, planner)
    for plan in (hopeful, _plan(space.optimistic(Assumptions()), planner)):
        _check_reliance(plan, problem, planner)
    require(
        not careful.relies_on, planner, f"the cautious plan relies on {sorted(careful.relies_on)}; on nothing it must"
    )
    require(smoke not in careful.enters, planner, f"the cautious plan enters '{smoke}', which may be blocked")
    require(hopeful.cost_s <= careful.cost_s + _NEAR_S, planner, "the optimistic plan costs more than the cautious one")

    shut = _plan(space.optimistic(Assumptions.exactly({smoke: BLOCKED})), planner)
    clear = _plan(space.optimistic(Assumptions.exactly({smoke: PASSABLE})), planner)
    require(smoke not in shut.enters, planner, f"the plan for a blocked '{smoke}' enters it")
    require(clear.cost_s <= shut.cost_s + _NEAR_S, planner, f"a passable '{smoke}' makes the best plan dearer")
    require(smoke not in clear.relies_on, planner, f"'{smoke}' is assumed passable, yet the plan says it relies on it")
    for value in problem.gap(target).values:
        bound = _plan(space.optimistic(Assumptions.exactly({target: value})), planner)
        reached = [leg.site.value for leg in bound.legs if leg.stop.gap == target]
        require(reached == [value], planner, f"'{target}' is assumed to be '{value}', but the plan goes to {reached}")

    again = _plan(make().open(problem).optimistic(settled), planner)
    require(again.signature == hopeful.signature, planner, "equal problems give different plans")
    require(space.searches >= 0, planner, f"searches = {space.searches}: a count is not below 0")
    require(isinstance(space.notes, tuple), planner, f"notes = {space.notes!r}: must be a tuple of sentences")
    _check_refusal(problem, planner)


def check_metric(make: Callable[[], ImpactMetric]) -> None:
    """A distance: nothing between equals, symmetric, more for what lies farther apart, blind to added way-points.

    Args:
        make: makes a fresh metric; called more than once.

    Raises:
        ConformanceError: it breaks the contract of `mintpilot.core.ports.ImpactMetric`.
    """
    metric = make()
    line: Floats = np.array([[0.0, 0.0, 1.0], [10.0, 0.0, 1.0]])
    near, far = line + np.array([0.0, 1.0, 0.0]), line + np.array([0.0, 4.0, 0.0])
    finer: Floats = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [7.0, 0.0, 1.0], [10.0, 0.0, 1.0]])
    bent: Floats = np.array([[0.0, 0.0, 1.0], [5.0, 3.0, 1.0], [10.0, 0.0, 1.0]])
    for path in (line, bent, line[:1]):
        own = metric.divergence(path, path)
        require(own == 0, metric, f"a path of {len(path)} points is {own} m from itself; 0 it must be")
    for a, b in ((line, near), (line, bent), (bent, far), (line[:1], bent)):
        there, back = metric.divergence(a, b), metric.divergence(b, a)
        require(
            math.isfinite(there) and there > 0,
            metric,
            f"{there} m between different paths; above 0 and finite it must be",
        )
        require(
            math.isclose(there, back, rel_tol=1e-9),
            metric,
            f"{there} m one way, {back} m the other; symmetric it must be",
        )
    require(
        metric.divergence(line, near) < metric.divergence(line, far),
        metric,
        "a parallel 1 m off is farther than one 4 m off",
    )
    moved = metric.divergence(line, finer)
    require(moved < 1e-6, metric, f"way-points added on a straight line move it by {moved} m; they must not matter")
    fresh = make().divergence(line, bent)
    require(fresh == metric.divergence(line, bent), metric, "the same paths give different distances")


def _gap_id(problem: PlanningProblem, kind: GapKind) -> str:
    return next(gap.id for gap in problem.gaps if gap.kind is kind)


def _plan(found: Plan | None, planner: Planner) -> Plan:
    if found is None:
        raise ConformanceError(f"{type(planner).__name__}: found no plan, though there is one")
    return found


def _check_way(plan: Plan, problem: PlanningProblem, planner: Planner) -> None:
    """Every ordered stop, in order; near enough; through free cells; at a cost that the way can be flown in."""
    wanted = [stop.id for stop in problem.stops if not stop.optional]
    served = [leg.stop.id for leg in plan.legs if not leg.stop.optional]
    require(served == wanted, planner, f"the plan serves {served}; the stops are {wanted}, in this order")
    cell_m = problem.map.frame.resolution_m
    start_off_m = math.dist(plan.path_m[0], problem.start_m)
    require(start_off_m <= 2 * cell_m, planner, f"the way begins {start_off_m:.2f} m from where the drone is")
    for leg in plan.legs:
        away_m = math.dist(leg.path_m[-1], leg.site.position_m)
        rule = f"leg '{leg.stop.id}' ends {away_m:.2f} m from its site; within {leg.site.reach_m:g} m it must"
        require(away_m <= leg.site.reach_m + cell_m, planner, rule)
    bad = plan.path_m[~_free(plan, problem)]
    require(not len(bad), planner, f"the way leaves the cells that were seen free at {bad[:1].round(2).tolist()}")
    least_s = plan.length_m / problem.limits.cruise_mps
    require(
        plan.cost_s >= least_s - _NEAR_S,
        planner,
        f"cost {plan.cost_s:.2f} s for {plan.length_m:.2f} m; {least_s:.2f} s at least",
    )
    for gap in problem.gaps:
        if gap.kind is GapKind.OBSTACLE and gap.id not in plan.enters:
            inside = _in_region(plan, problem, gap.subject)
            require(
                not inside, planner, f"the way leads through '{gap.subject}', but `enters` does not name '{gap.id}'"
            )


def _check_reliance(plan: Plan, problem: PlanningProblem, planner: Planner) -> None:
    unknown = plan.relies_on - {gap.id for gap in problem.gaps}
    require(not unknown, planner, f"`relies_on` names {sorted(unknown)}, which are no gaps of the problem")
    silent = plan.enters - plan.relies_on
    require(not silent, planner, f"the plan enters the open {sorted(silent)}, but `relies_on` does not say so")


def _check_refusal(problem: PlanningProblem, planner: Planner) -> None:
    walled = np.argwhere(problem.map.cells == Cell.OCCUPIED)
    x, y, z = problem.map.frame.centres_of(walled[len(walled) // 2])[0]
    try:
        planner.open(replace(problem, start_m=(float(x), float(y), float(z))))
    except InfeasibleError:
        return
    raise ConformanceError(f"{type(planner).__name__}: a start inside matter must raise InfeasibleError from `open`")


def _cells(plan: Plan, problem: PlanningProblem) -> Ints:
    """Cells (n, 3) of the way-points: what lies between them the loop checks before each flight."""
    return problem.map.frame.cells_of(plan.path_m)


def _free(plan: Plan, problem: PlanningProblem) -> Bools:
    cells = _cells(plan, problem)
    inside = problem.map.frame.contains(cells)
    bounded = np.clip(cells, 0, np.array(problem.map.frame.shape) - 1)
    free: Bools = inside & (problem.map.cells[tuple(bounded.T)] == Cell.FREE)
    return free


def _in_region(plan: Plan, problem: PlanningProblem, region_id: str) -> bool:
    region = next(r for r in problem.map.regions if r.id == region_id)
    cells = _cells(plan, problem)
    flat = np.ravel_multi_index(tuple(cells.T), problem.map.frame.shape, mode="clip")
    return bool(np.isin(flat, region.cells).any())
