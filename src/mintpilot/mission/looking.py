"""Looks that settle a gap: each as a flight there, with what it costs beside the plan (method, section 11)."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import replace

import numpy as np

from mintpilot.core.errors import InfeasibleError
from mintpilot.core.gap import Assumptions
from mintpilot.core.message import Named, message
from mintpilot.core.plan import Leg, Look, Plan, PlanningProblem, Site, Stop
from mintpilot.core.ports import LookOption, Planner, PlanSpace
from mintpilot.core.task import Action
from mintpilot.core.tolerances import TOLERANCE
from mintpilot.planning.reach import way_to
from mintpilot.uncertainty.gaps import LOOK_REACH_M

_PREFIX = "sense:"
MOST_WEIGHED = 6
"""So many looks are weighed at a time, those stated first."""


def look_options(
    problem: PlanningProblem, space: PlanSpace, planner: Planner, looks: Collection[Look], finished: Collection[str]
) -> tuple[LookOption, ...]:
    """The looks at open gaps that leave battery for the plan that is safe whatever holds.

    What one costs is the flight there, the stay, and by how much the best plan is dearer from there than from here.

    Args:
        problem: as it is planned from here.
        space: its plans.
        planner: plans from the viewpoints.
        looks: those that the mission knows.
        finished: ids of stops that were done: a look is tried once.
    """
    wanted = [one for one in looks if look_stop_id(one) not in finished and any(g.id == one.gap for g in problem.gaps)]
    return tuple(_options(problem, space, planner, wanted[:MOST_WEIGHED]))


def look_stop_id(look: Look) -> str:
    """Id of the stop at which it is looked."""
    return f"{_PREFIX}{look.gap}"


def looked_at(finished: Collection[str]) -> frozenset[str]:
    """Ids of the gaps that were looked at."""
    return frozenset(name.removeprefix(_PREFIX) for name in finished if name.startswith(_PREFIX))


def _options(
    problem: PlanningProblem, space: PlanSpace, planner: Planner, looks: Collection[Look]
) -> Iterator[LookOption]:
    best, sure = space.optimistic(Assumptions()), space.cautious(Assumptions())
    for look in looks:
        there = _flight(problem, look)
        if there is None or best is None:
            continue
        limits = problem.limits
        left_s = limits.endurance_s - there.cost_s
        if left_s <= limits.reserve_s:
            continue
        x, y, z = (float(v) for v in there.path_m[-1])
        moved = replace(problem, start_m=(x, y, z), limits=replace(limits, endurance_s=left_s))
        try:
            beyond = planner.open(moved)
        except InfeasibleError:
            continue
        after, still_sure = beyond.optimistic(Assumptions()), beyond.cautious(Assumptions())
        lost = sure is not None and (still_sure is None or _left_s(still_sure) > _left_s(sure) + TOLERANCE)
        if after is None or lost or _left_s(after) > _left_s(best) + TOLERANCE:
            continue
        seconds = max(look.dwell_s, there.cost_s + after.cost_s - best.cost_s)
        yield LookOption(look=look, seconds=seconds, plan=there)


def _left_s(plan: Plan) -> float:
    return plan.undone_s + sum(price_s for _, _, price_s in plan.stakes)


def _flight(problem: PlanningProblem, look: Look) -> Plan | None:
    """The way to the viewpoint through known free space; None where there is none."""
    path = way_to(problem.map, problem.limits, start_m=problem.start_m, goal_m=look.viewpoint_m)
    if path is None:
        return None
    gap = problem.gap(look.gap)
    site = Site(position_m=look.viewpoint_m, reach_m=LOOK_REACH_M, label=gap.subject)
    stop = Stop(
        id=look_stop_id(look),
        action=Action.REPORT,
        sites=(site,),
        gap=gap.id,
        dwell_s=look.dwell_s,
        text=message("look at {place}", place=Named(gap.description)),
        informs=True,
    )
    length_m = float(np.linalg.norm(np.diff(path, axis=0), axis=1).sum())
    duration_s = length_m / problem.limits.cruise_mps + look.dwell_s
    leg = Leg(stop=stop, site=site, path_m=path, length_m=length_m, duration_s=duration_s)
    return Plan(legs=(leg,), cost_s=duration_s, relies_on=frozenset(), enters=frozenset())
