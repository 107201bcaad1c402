"""What each phase does when time passes, and when the autopilot has answered."""

from __future__ import annotations

import math
from dataclasses import replace

from mintpilot.core.inputs import Link
from mintpilot.core.motion import Land, MotionEnd, PerformAction, TakeOff
from mintpilot.core.task import Action as StopAction
from mintpilot.vehicle.control_state import Phase, Turn
from mintpilot.vehicle.course import FAR_M, Course, SetPoint, advanced, straight
from mintpilot.vehicle.signals import Act, Action, Did, Mode, Start

ANSWER_S = 10.0
"""Longest wait for an answer of the autopilot, seconds."""
HEARD_S = 0.5
"""A loop that was not heard for so long starts no motors, seconds."""
READY_S = 60.0
"""Longest wait for an autopilot that is not ready to be armed, seconds."""
ARM_S = 30.0
"""For so long an autopilot that refuses to be armed is asked again ..."""
AGAIN_S = 2.0
"""... after this time each, seconds."""
ANEW_S = 0.1
"""A position that came so long after its motors were started was measured after that, seconds."""
CLIMB_S = 30.0
"""Longest take-off, seconds, besides that of its height at `SLOWEST_CLIMB_MPS`."""
SLOWEST_CLIMB_MPS = 0.3
HELD_S = 3.0
"""PX4 calls a take-off done 0.8 m too low, and climbs on in Hold: where it stands still so long after, it is done."""
STREAM_S = 1.3
"""Set-points are sent for so long before the autopilot is asked to follow them, seconds."""
ENGAGE_S = 8.0
"""For so long it is asked again, seconds."""
LAND_S = 120.0
"""Longest landing, seconds."""
NEAR_M = 0.25
"""A vehicle this near to its set-point has arrived, metres ..."""
STILL_MPS = 0.25
"""... when it is slower than this ..."""
SETTLE_S = 4.0
"""... or after this time, seconds; it then must be within `OFF_M`."""
OFF_M = 0.5
STUCK_S = 5.0
"""A vehicle that does not come after its set-point for so long is stopped, seconds."""
APPROACH_MPS = 0.4
APPROACH_M = 1.5
"""After take-off the hover point must not be further off than this, metres."""


def tick(turn: Turn, elapsed_s: float) -> None:
    """Time has passed."""
    if turn.state.asked is not None and turn.state.now_s - turn.state.asked_s > ANSWER_S:
        did(turn, Did(time_s=turn.state.now_s, action=turn.state.asked, error="it did not answer"))
    match turn.state.phase:
        case Phase.ARMING:
            _arming(turn)
        case Phase.CLIMBING:
            _climbing(turn)
        case Phase.ENGAGING:
            _engaging(turn)
        case Phase.FLYING:
            _flying(turn, elapsed_s)
        case Phase.LANDING | Phase.RETURNING:
            _landing(turn)
        case _:
            pass


def did(turn: Turn, event: Did) -> None:
    """The autopilot has answered; late answers to what nobody waits for are ignored."""
    state = turn.state
    if event.action is not state.asked:
        return
    turn.set(asked=None, refusal=event.error)
    agreed = not event.error
    match event.action:
        case Action.ARM if agreed:
            turn.set(running_s=turn.state.now_s)
        case Action.TAKE_OFF if agreed:
            turn.enter(Phase.CLIMBING)
            turn.set(mode_since_s=turn.state.now_s)
        case Action.TAKE_OFF:
            turn.give(Act(action=Action.DISARM))
            turn.stay_down(MotionEnd.FAILED, f"the autopilot refused to take off: {event.error}")
        case Action.ENGAGE if agreed:
            _engaged(turn)
        case Action.LAND | Action.RETURN if agreed:
            turn.set(mode_since_s=turn.state.now_s)
        case Action.LAND | Action.RETURN if state.phase in (Phase.LANDING, Phase.RETURNING):
            turn.end(MotionEnd.REFUSED, f"the autopilot refused to {event.action.value}: {event.error}")
            turn.hover_here()
            turn.enter(Phase.ENGAGING)
        case Action.GRAB | Action.RELEASE:
            _gripped(turn, event)
        case _:
            pass


def _gripped(turn: Turn, event: Did) -> None:
    motion = turn.state.motion
    turn.set(act_done=True)
    if not event.error or not isinstance(motion, PerformAction):
        return
    label = motion.stop.sites[0].label if motion.stop.sites else ""
    what = "what is to be carried" if motion.stop.action is StopAction.PICK or not label else label
    verb = "attach" if motion.stop.action is StopAction.PICK else "take"
    carried = what if verb == "attach" else "what it carries"
    turn.set(by_hand=f"The drone has no gripper that works ({event.error}): {verb} {carried} by hand")


def _arming(turn: Turn) -> None:
    state, seen = turn.state, turn.state.seen
    waited_s, again = state.now_s - state.since_s, state.now_s - state.asked_s >= AGAIN_S
    streams = seen.start is Start.SET_POINTS
    if state.asked is not None or state.now_s - state.fed_s >= HEARD_S:
        return
    if state.running_s is not None:
        _lift(turn, state.running_s)
        return
    if streams and state.hover is None:
        turn.hover_here()
    ready = seen.mode is (Mode.HOLD if seen.start is Start.HOLD else Mode.OURS)
    why = seen.not_ready or ("" if ready else f"it stays in mode {seen.mode_name}")
    if why and waited_s < READY_S:
        if not ready and again and (not streams or waited_s >= STREAM_S):
            turn.ask(Action.ENGAGE if streams else Action.STAND_BY)
    elif why or waited_s > READY_S + ARM_S or (state.refusal and waited_s > ARM_S):
        said = f"; it says: {seen.status}" if seen.status else ""
        words = f"the autopilot cannot be armed after {waited_s:.0f} s: {state.refusal or why}{said}"
        turn.stay_down(MotionEnd.FAILED, words)
    elif again or not state.refusal:
        turn.ask(Action.ARM)


def _lift(turn: Turn, running_s: float) -> None:
    """Its motors run: up to the hover point, once it was heard where it stands now. Arming may set its height anew."""
    here, envelope = turn.state.hover, turn.state.envelope
    if turn.state.seen.position_s < running_s + ANEW_S:
        return
    if here is None:
        turn.ask(Action.TAKE_OFF, envelope.hover_m[2] - envelope.ground_m)
        return
    turn.enter(Phase.FLYING)
    way = straight(here.position_m, envelope.hover_m, here.yaw_rad, APPROACH_MPS)
    turn.set(mode_since_s=turn.state.now_s, rest_s=None, slow_s=None, course=Course(trajectory=way))


def _climbing(turn: Turn) -> None:
    state, seen = turn.state, turn.state.seen
    height_m = state.envelope.hover_m[2] - state.envelope.ground_m
    risen_m = seen.position_m[2] - state.envelope.ground_m
    through = seen.mode is Mode.HOLD and seen.heartbeat_s > state.mode_since_s + HELD_S  # it has ended its take-off
    high = risen_m >= (height_m / 2 if through else height_m - max(0.1 * height_m, 0.2))
    if high and abs(seen.velocity_mps[2]) < STILL_MPS:
        turn.hover_here()
        turn.enter(Phase.ENGAGING)
    elif state.now_s - state.since_s > CLIMB_S + height_m / SLOWEST_CLIMB_MPS:
        turn.end(MotionEnd.FAILED, f"the take-off reached {risen_m:.1f} m of {height_m:.1f} m only")
        turn.set(leaving=True)
        turn.land()


def _engaging(turn: Turn) -> None:
    state = turn.state
    waited_s = state.now_s - state.since_s
    if state.asked is not None or waited_s < STREAM_S:
        return
    if waited_s > ENGAGE_S:
        why = state.refusal or "no answer"
        turn.end(MotionEnd.FAILED, f"the autopilot does not follow set-points: {why}")
        turn.set(leaving=True, hover=None)
        turn.land()
    elif state.now_s - state.asked_s >= AGAIN_S:
        turn.ask(Action.ENGAGE)


def _engaged(turn: Turn) -> None:
    state = turn.state
    if state.phase is not Phase.ENGAGING:
        return
    turn.enter(Phase.FLYING)
    turn.set(mode_since_s=state.now_s, rest_s=None, slow_s=None)
    if not isinstance(state.motion, TakeOff) or state.hover is None:
        turn.end(MotionEnd.STOPPED)
        return
    goal, here = state.envelope.hover_m, state.hover
    if math.dist(goal, here.position_m) > APPROACH_M:
        turn.end(MotionEnd.FAILED, f"the take-off ended {math.dist(goal, here.position_m):.1f} m from the start")
        turn.set(leaving=True)
        return
    turn.set(course=Course(trajectory=straight(here.position_m, goal, here.yaw_rad, APPROACH_MPS)))


def _flying(turn: Turn, elapsed_s: float) -> None:
    state = turn.state
    if isinstance(state.motion, PerformAction) and state.rest_s is not None and state.course is None:
        if state.act_done and state.now_s - state.rest_s >= state.motion.dwell_s:
            turn.end(MotionEnd.ARRIVED)
        return
    course, seen = state.course, state.seen
    if course is None or state.hover is None:
        return
    lost = Link.POSITION in state.down
    if lost:
        course = replace(course, braking=True)
    course = advanced(course, elapsed_s, FAR_M if lost else math.dist(seen.position_m, state.hover.position_m))
    point = course.set_point()
    row = (state.now_s, seen.position_m, point.position_m)
    turn.set(course=course, hover=point, rows=(*state.rows, row))
    _arrive(turn, course, point)


def _arrive(turn: Turn, course: Course, point: SetPoint) -> None:
    """Whether the motion has come to its end, or does not go on."""
    state, seen = turn.state, turn.state.seen
    if not course.at_rest:
        slow_s = (state.slow_s if state.slow_s is not None else state.now_s) if course.rate < 0.05 else None
        turn.set(rest_s=None, slow_s=slow_s)
        if slow_s is not None and state.now_s - slow_s > STUCK_S:
            turn.set(course=replace(course, braking=True))
        return
    rest_s = state.now_s if state.rest_s is None else state.rest_s
    turn.set(rest_s=rest_s, hover=replace(point, velocity_mps=(0.0, 0.0, 0.0)))
    off_m = math.dist(seen.position_m, point.position_m)
    still = math.hypot(*seen.velocity_mps) < STILL_MPS
    if (off_m <= NEAR_M and still) or state.now_s - rest_s >= SETTLE_S:
        turn.set(course=None, rest_s=None)
        arrived = not course.braking and off_m <= OFF_M
        reason = "" if arrived or course.braking else f"it hovers {off_m:.1f} m from where it should"
        turn.end(MotionEnd.ARRIVED if arrived else MotionEnd.STOPPED, reason)


def _landing(turn: Turn) -> None:
    state, seen = turn.state, turn.state.seen
    if isinstance(state.motion, Land):
        turn.set(rows=(*state.rows, (state.now_s, seen.position_m, seen.position_m)))
    fresh = seen.heartbeat_s > state.mode_since_s
    if state.asked in (Action.LAND, Action.RETURN) or not fresh:
        return
    if not seen.armed:
        turn.end(MotionEnd.ARRIVED)
        turn.enter(Phase.DOWN)
    elif seen.on_ground and state.now_s - max(state.asked_s, state.since_s + 3.0) >= AGAIN_S:
        turn.ask(Action.DISARM)
    elif state.now_s - state.since_s > LAND_S:
        turn.end(MotionEnd.FAILED, f"it has not landed after {LAND_S:.0f} s")
