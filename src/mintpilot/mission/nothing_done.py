"""Why nothing can be flown: for each stop what it would need alone, and what there is (method, section 9)."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import replace

from mintpilot.core.errors import InfeasibleError
from mintpilot.core.gap import Assumptions
from mintpilot.core.message import Message, joined, message
from mintpilot.core.mission import Left
from mintpilot.core.plan import LeftUndone, PlanningProblem, Shortage
from mintpilot.core.ports import Planner

MOST_STOPS = 12
"""So many stops are planned for alone; of more, the rest counts as without a way that is known to be safe."""


def nothing_done(problem: PlanningProblem, planner: Planner) -> tuple[LeftUndone, ...]:
    """All stops of a problem of which nothing is flown, each with the resource that runs short for it alone."""
    battery_s = problem.limits.endurance_s - problem.limits.reserve_s
    ample = replace(problem, limits=replace(problem.limits, endurance_s=math.inf, reserve_s=0.0))
    found = []
    for number, stop in enumerate(problem.stops):
        alone = replace(ample, stops=(stop,))
        needed_s = _alone_s(alone, planner) if number < MOST_STOPS else None
        if needed_s is None and problem.ruling is not None and number < MOST_STOPS:
            without_s = _alone_s(replace(alone, ruling=None), planner)
            if without_s is not None and without_s <= battery_s:
                rules = tuple(rule.text for rule in problem.ruling.rules)
                found.append(LeftUndone(stop=stop, resource=Shortage.RULE, rules=rules))
                continue
        if needed_s is None or needed_s <= battery_s:
            found.append(LeftUndone(stop=stop, resource=Shortage.WAY))
        else:
            short = LeftUndone(stop=stop, resource=Shortage.BATTERY, needed_s=needed_s, available_s=max(0.0, battery_s))
            found.append(short)
    return tuple(found)


def sentence(left: Iterable[Left | LeftUndone]) -> Message:
    """What is left, with what ran short, as one plain sentence; empty where nothing is."""
    told = [
        message("{what} ({why})", what=one.text if isinstance(one, Left) else one.stop.said, why=one.reason)
        for one in left
    ]
    return message("Left undone: {what}.", what=joined(told, "; ")) if told else Message()


def _alone_s(problem: PlanningProblem, planner: Planner) -> float | None:
    """Flight time for the one stop if all that is open turns out well, the way home included; None: no way."""
    (stop,) = problem.stops
    needed = {stop.gap: (stop.sites[0].value,)} if stop.optional and stop.sites[0].value else {}
    try:
        plan = planner.open(problem).optimistic(Assumptions.of(needed))
    except InfeasibleError:
        return None
    return None if plan is None or not plan.legs else plan.cost_s + plan.home_s
