"""Flying a plan, leg by leg, each checked against the newest map right before it is flown; and the ways back."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from mintpilot.core.decisions import FlyPlan, FlyTrajectory, GoBack, RefuseFlight
from mintpilot.core.inputs import Link, MapObserved
from mintpilot.core.message import Named, joined, message
from mintpilot.core.mission import Achieved, Outcome, ReturnRule, Sight
from mintpilot.core.plan import LeftUndone, Leg, Plan, Stop
from mintpilot.core.task import Action
from mintpilot.mission.outlasting import outlasted
from mintpilot.mission.requests import Purpose
from mintpilot.mission.rule_progress import done, hoped
from mintpilot.mission.sights import looked
from mintpilot.mission.state import Activity, Ending, Goal, uncertain_things
from mintpilot.mission.surveying import MAX_HOPS, SWEEP_RAD, turn
from mintpilot.mission.transition import Transition, partial_reason
from mintpilot.mission.unseen import is_search

MAX_REPLANS = 8
"""How often news in flight may send the drone back to deliberating before it goes home."""


def fly_plan(t: Transition, plan: Plan, *, unsafe: bool = False) -> None:
    """Sets out on a plan. What an unsafe baseline takes for granted counts in a simulator only."""
    entered = {gap.partition(":")[2] for gap in plan.enters} if unsafe and t.state.setup.simulated else ()
    wanted = (*(leg.stop for leg in plan.legs), *(one.stop for one in plan.leaves_undone))
    t.set(plan=plan, outdated=False, leg=0, assume_passable=frozenset(entered), wanted=wanted)
    if plan.leaves_undone:
        t.tell(
            joined(
                [
                    message("The battery or the way does not allow everything."),
                    partial_reason((), t.left()[len(plan.legs) :]),
                ]
            )
        )
    next_leg(t)


def next_leg(t: Transition) -> None:
    """Has the trajectory of the next leg made and checked; after the last one the task is done."""
    plan = t.state.plan
    if t.state.outdated:
        t.set(plan=None, outdated=False)
        t.request(Purpose.MISSION)
        return
    if plan is not None and t.state.leg < len(plan.legs):
        t.request(Purpose.LEG, plan.legs[t.state.leg])
        return
    ending = _done(t)
    returns = t.state.setup.lands or t.state.setup.mission.returns is not ReturnRule.NONE
    if t.state.is_down(Link.OPERATOR) or returns:
        t.set(ending=ending)
        t.redirect(Goal.RETURN)
        return
    t.finish(ending.outcome, ending.reason)


def _done(t: Transition) -> Ending:
    """How the mission has gone once the last leg of its plan is flown."""
    left, achieved = t.left(), t.state.achieved
    if not left:
        return Ending(outcome=Outcome.SUCCESS, reason=message("Every stop was reached."))
    outcome = Outcome.PARTIAL if achieved or t.state.looks else Outcome.NO_SAFE_PLAN
    return Ending(outcome=outcome, reason=partial_reason(achieved, left))


def chosen(t: Transition, decision: FlyPlan) -> None:
    """The asking is over: flies the plan, or goes home where there is none that may be flown."""
    if decision.plan is None:
        nothing(t, decision.left)
        t.give_up(decision.certificate.text)
    else:
        fly_plan(t, decision.plan, unsafe=decision.unsafe)


def nothing(t: Transition, left: tuple[LeftUndone, ...]) -> None:
    """Nothing of these stops can be flown: they are kept with the reasons, beside what was wanted before."""
    wanted = {stop.id: stop for stop in (*t.state.wanted, *(one.stop for one in left))}
    t.set(plan=None, undone=left, wanted=tuple(wanted.values()))


def fly_leg(t: Transition, decision: FlyTrajectory) -> None:
    """Flies a leg, or back out of a place that is not known free."""
    if t.state.is_down(Link.POSITION):
        _stay(t)
        return
    if decision.retreat:
        t.note("retreat", message("The drone went back the way it came."))
        t.set(retreats=t.state.retreats + 1)
        t.follow(decision.trajectory, Activity.RETREAT)
        return
    plan = t.state.plan
    assert plan is not None
    if outlasted(t, decision.trajectory):
        plan_again(t)
        return
    rest = np.vstack([leg.path_m for leg in plan.legs[t.state.leg :]])
    t.follow(decision.trajectory, Activity.LEG, rest, unsafe=True)


def refused(t: Transition, decision: RefuseFlight) -> None:
    """No checked trajectory: after the first leg the map has changed since the plan was made, so plan again."""
    if t.state.leg == 0:
        t.give_up(decision.reason)
        return
    t.note("news", decision.reason)
    plan_again(t)


def plan_again(t: Transition) -> None:
    """Deliberates anew from here, as often as news may ask for it."""
    t.set(replans=t.state.replans + 1, plan=None)
    if t.state.replans >= MAX_REPLANS:
        t.give_up(message("New things kept turning up in the way."))
        return
    t.request(Purpose.MISSION)


def arrived(t: Transition) -> None:
    """At the stop: does what it is for."""
    stop, vehicle = _leg(t).stop, t.state.vehicle
    if is_search(stop):
        t.follow(turn(np.asarray(vehicle.position_m), vehicle.yaw_rad, SWEEP_RAD), Activity.ACT)
    else:
        t.act(stop)


def fulfilled(t: Transition) -> None:
    """The stop is done and looked around from: on to the next one."""
    leg, beliefs = _leg(t), t.beliefs
    if leg.stop.action is Action.LOOK:
        beliefs = replace(beliefs, map=beliefs.map.with_room(leg.site.label, searched=True))
    t.set(beliefs=beliefs, leg=t.state.leg + 1)
    mark_done(t, leg.stop)
    if leg.stop.informs:
        t.set(plan=None)
        t.request(Purpose.MISSION)
    else:
        next_leg(t)


def mark_done(t: Transition, stop: Stop) -> None:
    """A stop was done."""
    task, setup = t.state.setup.task, t.state.setup
    if task is not None and task.rules:
        here = np.asarray(t.state.vehicle.position_m, float)
        progress = done(task, t.beliefs.progress, t.beliefs.map, setup.mission.limits, stop, here)
        if progress.held != hoped(task, t.beliefs.progress, t.beliefs.map, stop):
            t.set(outdated=True)  # nothing was to be seen: the plan counted on it
        t.set(beliefs=replace(t.beliefs, progress=progress))
    begun_s = t.state.clock_s if t.state.task_begun_s is None else t.state.task_begun_s
    t.set(beliefs=replace(t.beliefs, finished=t.beliefs.finished | {stop.id}))
    if (
        task is not None
        and stop.action is Action.LOOK
        and any(r.id == stop.sites[0].label for r in t.beliefs.map.rooms)
    ):
        look = looked(stop, task, t.beliefs.map, t.state.view)
        t.set(looks=(*t.state.looks, look))
        if look.result is Sight.UNSEEN:
            return
    achieved = Achieved(n=stop.step, text=stop.said, at_s=t.state.clock_s - begun_s)
    t.set(achieved=(*t.state.achieved, achieved))


def done_by_hand(t: Transition) -> None:
    """A person does what the stop is for: it counts as done, and what is next is thought of after that."""
    finished = t.beliefs.finished | {_leg(t).stop.id}
    t.set(beliefs=replace(t.beliefs, finished=finished), plan=None)


def watch(t: Transition, event: MapObserved) -> None:
    """Looks at what a new map says of the flight: brakes where the way ahead is lost or something new is uncertain."""
    motion = t.state.motion
    if motion is None or not motion.monitored or motion.braking:
        return
    things = uncertain_things(event.map)
    new = [words for name, words in things.items() if name not in motion.known]
    if event.obstruction:
        news = message("The way ahead is not known to be free any more: {obstruction}.", obstruction=event.obstruction)
    elif new and t.state.activity is Activity.LEG:
        news = message("Something new and uncertain: {what}.", what=Named(new[0]))
    else:
        return
    if t.state.activity is Activity.LEG:
        t.note("news", news)
    t.brake()


def go_back(t: Transition, decision: GoBack) -> None:
    """Flies home, or to the place to land at; or does there what was to be done."""
    if t.state.goal is Goal.HOLD:
        t.set(home_s=decision.duration_s)
        return
    if_possible = t.state.setup.mission.returns is ReturnRule.IF_POSSIBLE
    if t.state.goal is Goal.RETURN and _is_over(t) and if_possible and decision.duration_s > t.state.endurance_s():
        t.end(message("The battery does not suffice for the way back: it holds where it is."))
        return
    if decision.trajectory is None:
        there(t)
        return
    if t.state.is_down(Link.POSITION):
        _stay(t)
        return
    if outlasted(t, decision.trajectory):
        proceed_back(t)
        return
    if t.state.goal is Goal.LAND and t.state.land_here:
        t.set(land_here=False)
        t.redirect(Goal.RETURN)
        proceed_back(t)
        return
    t.set(hops=t.state.hops + 1)
    if t.state.hops > MAX_HOPS:
        t.end(message("It holds where it is."))
        return
    activity = Activity.TO_LANDING if t.state.goal is Goal.LAND else Activity.HOMEWARD
    t.follow(decision.trajectory, activity, decision.trajectory.position_m[::10])


def no_way_back(t: Transition, decision: RefuseFlight) -> None:
    """Neither home nor to a place to land at leads a way that is known to be free."""
    if t.state.goal is Goal.HOLD:
        t.set(home_s=0.0)
        return
    if t.state.goal is Goal.LAND and t.state.land_here:
        t.set(land_here=False)
        t.redirect(Goal.RETURN)
        proceed_back(t)
        return
    t.note("no-way-back", decision.reason)
    if t.state.setup.lands and t.state.goal is Goal.RETURN:
        t.redirect(Goal.LAND)
        proceed_back(t)
        return
    t.end(message("It holds where it is."))


def _stay(t: Transition) -> None:
    """Without a position nothing is flown, the way back no more than any other: it lands right here, or holds."""
    if t.state.goal is Goal.LAND:
        t.end(message("Its position is not known, nor whether the ground below is free: it holds where it is."))
        return
    t.redirect(Goal.LAND)
    proceed_back(t)


def proceed_back(t: Transition) -> None:
    """At rest, on the way home or to a landing place: has the next flight worked out."""
    t.request(Purpose.LAND if t.state.goal is Goal.LAND else Purpose.RETURN)


def there(t: Transition) -> None:
    """At the start, or above the place to land at."""
    if t.state.goal is Goal.LAND or t.state.lands or t.state.setup.lands:
        t.set(goal=Goal.LAND)
        t.descend()
    else:
        t.end(message("It is back at the start."))


def _is_over(t: Transition) -> bool:
    """Whether the drone returns because its plan is flown."""
    return t.state.plan is not None and t.state.leg >= len(t.state.plan.legs)


def _leg(t: Transition) -> Leg:
    assert t.state.plan is not None
    return t.state.plan.legs[t.state.leg]
