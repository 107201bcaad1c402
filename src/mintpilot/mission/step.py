"""One step of a mission: a pure function of state and event (method, section 8)."""

from __future__ import annotations

from dataclasses import replace

from mintpilot.core.decisions import (
    AskQuestion,
    Decision,
    Explore,
    FlyPlan,
    FlyTrajectory,
    GoBack,
    Meanwhile,
    NoPlan,
    RefuseFlight,
)
from mintpilot.core.gap import obstacle_id
from mintpilot.core.geometry import Floats
from mintpilot.core.inputs import (
    Answered,
    DeliberationEnded,
    FactConfirmed,
    FactTold,
    FactUndone,
    Input,
    LinkChanged,
    MapObserved,
    MissionBegun,
    MoreTimeWanted,
    MotionEnded,
    Ordered,
    QuestionReworded,
    QuestionShown,
    Ticked,
)
from mintpilot.core.message import message, verbatim
from mintpilot.core.mission import Outcome
from mintpilot.core.motion import MotionEnd
from mintpilot.core.semantic_map import Knowledge
from mintpilot.core.trajectory import VehicleState
from mintpilot.mission import asking, clearing, flying, meanwhile, ordering, surveying, telling
from mintpilot.mission.belief_state import BeliefState
from mintpilot.mission.directives import Directive
from mintpilot.mission.grants import granted
from mintpilot.mission.path_monitor import with_passable
from mintpilot.mission.requests import Purpose
from mintpilot.mission.rule_progress import flown
from mintpilot.mission.state import Activity, Goal, MissionState, PendingRequest, Setup, uncertain_things
from mintpilot.mission.transition import Transition
from mintpilot.planning.checks import check_trajectory
from mintpilot.reasoning.belief import prior_belief

MAX_REFUSALS = 3
"""A vehicle that refuses so many motions in one mission cannot go on."""
MAX_DROPS = 2
"""After so many decisions that came too late for what had changed meanwhile, the cautious plan is flown."""


def initial_state(setup: Setup, vehicle: VehicleState) -> MissionState:
    """The state before anything has happened."""
    return MissionState(setup=setup, clock_s=vehicle.time_s, vehicle=vehicle, goal=Goal.SURVEY, resume=Goal.SURVEY)


def step(state: MissionState, event: Input) -> tuple[MissionState, tuple[Directive, ...]]:
    """The state after an event, and what is to be done now. Equal arguments give equal results; nothing is changed.

    Args:
        state: of the mission.
        event: what has happened. Times before the state's clock count as now: the clock never goes back.
    """
    if state.ended:
        return state, ()
    t = Transition(replace(state, clock_s=max(state.clock_s, event.time_s)))
    match event:
        case MissionBegun():
            t.set(vehicle=event.vehicle)
            briefing = t.state.setup.briefing
            t.climb() if briefing is None else clearing.brief(t, briefing)
        case Ticked():
            _tick(t, event)
        case MapObserved():
            _observed(t, event)
        case MotionEnded():
            _motion_ended(t, event)
        case QuestionShown():
            asking.shown(t, event)
        case QuestionReworded():
            asking.reworded(t, event)
        case Answered() if t.state.grounded:
            clearing.answered(t, event)
        case Ordered() if t.state.grounded:
            clearing.ordered(t, event)
        case LinkChanged() if t.state.grounded and not event.up and event.link in clearing.NEEDED:
            clearing.link_lost(t, event)
        case Answered():
            asking.somebody_spoke(t)
            asking.answered(t, event)
        case MoreTimeWanted():
            asking.more_time(t, event)
        case Ordered():
            asking.somebody_spoke(t)
            ordering.ordered(t, event)
        case FactTold():
            asking.somebody_spoke(t)
            telling.told(t, event)
        case FactConfirmed():
            asking.somebody_spoke(t)
            telling.confirmed(t, event)
        case FactUndone():
            asking.somebody_spoke(t)
            telling.undone(t, event)
        case LinkChanged():
            ordering.link_changed(t, event)
        case DeliberationEnded():
            _deliberated(t, event)
    if t.state.told:
        telling.lapse(t)
    _proceed(t)
    return t.state, tuple(t.out)


def _proceed(t: Transition) -> None:
    """At rest, with nothing open: begins what the goal wants next. Whatever was broken off is taken up here."""
    state = t.state
    busy = state.motion is not None or state.request is not None or state.question is not None
    if state.question is not None and not state.grounded:
        meanwhile.consider(t)
    if state.ended or busy or state.activity is not Activity.NONE:
        return
    if state.beliefs is None:
        _proceed_without_map(t)
        return
    match state.goal:
        case Goal.SURVEY:
            surveying.next_place(t) if state.survey is not None else surveying.begin_survey(t)
        case Goal.TASK if state.task_begun_s is not None and state.ready:
            t.request(Purpose.MISSION)
        case Goal.HOLD:
            ordering.begin_hold(t)
        case Goal.RETURN | Goal.LAND:
            flying.proceed_back(t)
        case _:
            pass


def _proceed_without_map(t: Transition) -> None:
    match t.state.goal:
        case Goal.SURVEY | Goal.TASK:
            t.observe(Activity.FIRST_LOOK)
        case Goal.RETURN:
            t.end(message("It holds where it is."))
        case Goal.LAND:
            t.descend()
        case _:
            pass


def _tick(t: Transition, event: Ticked) -> None:
    if event.vehicle is not None:
        t.set(vehicle=event.vehicle, ready=t.state.task_begun_s is not None)
    question = t.state.question
    if question is not None and t.state.clock_s >= question.deadline_s:
        clearing.unanswered(t) if t.state.grounded else asking.unanswered(t)
    request = t.state.request  # what was worked out for that question has ended with it
    if request is not None and t.state.clock_s >= request.deadline_s:
        _without_decision(t, request, "the deliberation is overdue")
    if t.state.beliefs is not None:
        asking.check_permissions(t)
    ordering.pass_time(t)


def _observed(t: Transition, event: MapObserved) -> None:
    beliefs, map = t.state.beliefs, telling.on_map(event.map, t.state)
    if beliefs is None:
        known = frozenset(obstacle_id(r.id) for r in map.regions if r.passable is Knowledge.YES)
        t.set(beliefs=BeliefState(map=map, belief=prior_belief(())), known_passable=known)
    else:
        seen = _seen_passable(t, event)  # like a yes: it covers the outline that was seen, and ages
        t.set(beliefs=granted(replace(beliefs, map=map), seen, map, t.state.clock_s))
        asking.check_permissions(t)
    match t.state.activity:
        case Activity.FIRST_LOOK:
            t.set(activity=Activity.NONE)
        case Activity.SWEPT:
            t.set(activity=Activity.NONE)
            if t.state.goal is Goal.SURVEY:
                surveying.swept(t)
        case Activity.ACTED:
            t.set(activity=Activity.NONE)
            if t.state.goal is Goal.TASK:
                flying.fulfilled(t)
        case Activity.ACTED_MEANWHILE:
            t.set(activity=Activity.NONE)
            if t.state.goal is Goal.TASK:
                meanwhile.looked(t)
        case _:
            flying.watch(t, event)


def _follow_rules(t: Transition, way_m: Floats) -> None:
    """Takes what was flown since the task began into how far the rules have come."""
    task, limits = t.state.setup.task, t.state.setup.mission.limits
    if task is not None and task.rules and t.state.beliefs is not None and t.state.task_begun_s is not None:
        after = flown(task, t.beliefs.progress, t.beliefs.map, limits, way_m)
        t.set(beliefs=replace(t.beliefs, progress=after))


def _seen_passable(t: Transition, event: MapObserved) -> frozenset[str]:
    """The obstacle gap that was just looked at, where its region was open and is seen to be passable."""
    plan, regions = t.state.plan, {obstacle_id(r.id): r.passable for r in event.map.regions}
    if t.state.activity is not Activity.ACTED or plan is None:
        return frozenset()
    stop = plan.legs[t.state.leg].stop
    was = {obstacle_id(r.id): r.passable for r in t.beliefs.map.regions}.get(stop.gap)
    seen = stop.informs and was is Knowledge.OPEN and regions.get(stop.gap) is Knowledge.YES
    return frozenset({stop.gap}) if seen else frozenset()


def _motion_ended(t: Transition, event: MotionEnded) -> None:
    t.set(vehicle=event.vehicle)
    motion, activity = t.state.motion, t.state.activity
    if motion is None or event.motion != motion.id:
        return
    t.set(motion=None, activity=Activity.NONE)
    if event.log is not None and len(event.log.position_m):
        t.set(track=(*t.state.track, event.log.position_m[::10]))
        _follow_rules(t, event.log.position_m)
    if event.end is MotionEnd.REFUSED:
        t.set(refusals=t.state.refusals + 1)
    if event.end is MotionEnd.FAILED or t.state.refusals >= MAX_REFUSALS:
        t.finish(Outcome.VEHICLE_FAILED, verbatim(event.reason) or message("The vehicle could not go on."))
        return
    stopped = event.end is not MotionEnd.ARRIVED
    t.set(view=event.view)
    match activity:
        case Activity.SWEEP if t.state.goal is Goal.SURVEY and not stopped:
            t.observe(Activity.SWEPT, look=False)
        case Activity.EXPLORE if t.state.goal is Goal.SURVEY:
            surveying.sweep(t)
        case Activity.SURVEY_BACK if t.state.goal is Goal.SURVEY:
            surveying.came_back(t)
        case Activity.LEG if t.state.goal is Goal.TASK:
            flying.plan_again(t) if stopped else flying.arrived(t)
        case Activity.MEANWHILE if t.state.question is not None:
            meanwhile.arrived(t, held=stopped)
        case Activity.ACT_MEANWHILE if t.state.question is not None and not stopped:
            t.observe(Activity.ACTED_MEANWHILE)
        case Activity.ACT if t.state.goal is Goal.TASK and event.by_hand and not stopped:
            flying.done_by_hand(t)
            ordering.wait_for_hand(t, verbatim(event.by_hand))
        case Activity.ACT if t.state.goal is Goal.TASK:
            flying.plan_again(t) if stopped else t.observe(Activity.ACTED)
        case Activity.HOMEWARD | Activity.TO_LANDING if t.state.goal in (Goal.RETURN, Goal.LAND) and not stopped:
            flying.proceed_back(t)
        case Activity.DESCENT if t.state.goal is Goal.LAND and not stopped:
            t.end(message("It stands on the ground."))
        case _:
            pass  # broken off: the goal says what is next


def _deliberated(t: Transition, event: DeliberationEnded) -> None:
    request = t.state.request
    if request is None or event.request != request.id:
        return
    t.set(request=None)
    decision = event.decision
    if request.purpose is Purpose.MEANWHILE:
        usable = isinstance(decision, Meanwhile) and not _is_outdated(t, request, decision)
        meanwhile.decided(t, decision if usable and isinstance(decision, Meanwhile) else None)
        return
    if decision is None:
        _without_decision(t, request, event.reason)
        return
    if _is_outdated(t, request, decision):
        t.set(drops=t.state.drops + 1)
        if t.state.drops >= MAX_DROPS:
            _without_decision(t, request, "new things kept being seen meanwhile")
        elif request.purpose is Purpose.LEG:
            flying.next_leg(t)
        return
    t.set(drops=0)
    match decision:
        case AskQuestion():
            asking.take_over(t, decision.reasoning)
            meanwhile.count(t, decision)
            asking.put(t, decision, request.begun_s)
        case FlyPlan():
            asking.take_over(t, decision.reasoning)
            meanwhile.count(t, decision)
            flying.chosen(t, decision)
        case NoPlan():
            flying.nothing(t, decision.left)
            t.give_up(decision.reason)
        case FlyTrajectory():
            if t.state.goal is Goal.HOLD:
                t.set(home_s=0.0)  # it is asked how far home is, not to go there
            else:
                flying.fly_leg(t, decision)
        case Explore():
            surveying.go_on(t, decision)
        case GoBack():
            flying.go_back(t, decision)
        case RefuseFlight():
            flying.refused(t, decision) if request.purpose is Purpose.LEG else flying.no_way_back(t, decision)


def _is_outdated(t: Transition, request: PendingRequest, decision: Decision) -> bool:
    """Whether the map that has come meanwhile makes the decision void.

    A decision on the mission is void where things that it could not know of are uncertain now, a flight where its
    trajectory does not pass the check any more. The way back out of a doubtful place always counts.
    """
    map = t.beliefs.map
    if map is request.map:
        return False
    if isinstance(decision, AskQuestion | FlyPlan | NoPlan):
        return not set(uncertain_things(map)) <= set(uncertain_things(request.map))
    trajectory = getattr(decision, "trajectory", None)
    if trajectory is None or getattr(decision, "retreat", False):
        return False
    believed = with_passable(map, t.state.assume_passable if request.purpose is Purpose.LEG else frozenset())
    return bool(check_trajectory(trajectory, believed, t.state.setup.mission.limits))


def _without_decision(t: Transition, request: PendingRequest, reason: str) -> None:
    """The cautious plan that was checked last; where there is none, back to the start."""
    t.set(request=None, drops=0)
    t.note("deliberation", message("No decision ({reason}).", reason=reason))
    fallback = t.state.fallback
    match request.purpose:
        case Purpose.MISSION if fallback is not None:
            t.set(fallback=None)
            flying.fly_plan(t, fallback)
        case Purpose.MISSION | Purpose.LEG:
            t.give_up(message("No plan could be worked out: {reason}.", reason=reason))
        case Purpose.SURVEY:
            surveying.begin_task(t)
        case Purpose.MEANWHILE:
            meanwhile.decided(t, None)
        case Purpose.RETURN | Purpose.LAND:
            flying.no_way_back(t, RefuseFlight(reason=verbatim(reason)))
