"""One step of the link's control: a pure function of state and event. It flies, and it is the deadman.

The link process is a shell around it: it brings in what the loop says and what the autopilot sends, and carries out
the orders. Whatever the loop does (a hung planner, a compiling kernel, a held interpreter lock, a crash), ticks come.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from mintpilot.core.inputs import Link
from mintpilot.core.motion import FollowTrajectory, Land, Motion, MotionEnd, PerformAction, TakeOff
from mintpilot.core.task import Action as StopAction
from mintpilot.vehicle import phases, watching
from mintpilot.vehicle.control_state import ControlState, Phase, Turn
from mintpilot.vehicle.course import Course
from mintpilot.vehicle.signals import Action, Brake, Did, Fed, LinkEvent, Order, Settle, Tick, Told

START_M = 0.5
"""A trajectory must begin at most this far from the vehicle, metres."""
HOLD_S = 0.5
"""After this time without a sign of life from the loop the vehicle brakes and hovers, seconds."""
LATE_S = 0.3
"""A tick that comes so long after the one before is late, seconds."""
SENDING = frozenset({Phase.ARMING, Phase.ENGAGING, Phase.FLYING})
"""Phases in which set-points are sent, where there is one."""
END_S = 3.0
"""After this time it lands where that is known free, or returns where that clears everything mapped, seconds."""


def link_step(state: ControlState, event: LinkEvent) -> tuple[ControlState, tuple[Order, ...]]:
    """The state after an event, and what is to be done now. Equal arguments give equal results."""
    turn = Turn(replace(state, now_s=max(state.now_s, event.time_s)))
    match event:
        case Fed():
            turn.set(fed_s=turn.state.now_s, starved=False)
        case Told():
            turn.set(fed_s=turn.state.now_s, starved=False)
            _told(turn, event)
        case Did():
            phases.did(turn, event)
        case Tick():
            elapsed_s = turn.state.now_s - state.ticked_s
            if elapsed_s > LATE_S:
                turn.set(late_s=turn.state.now_s)
            turn.set(ticked_s=turn.state.now_s)
            watching.take_in(turn, event.seen)
            watching.watch(turn)
            _deadman(turn)
            phases.tick(turn, elapsed_s)
            if turn.state.phase in SENDING and turn.state.hover is not None:
                turn.give(turn.state.hover)
    return turn.state, tuple(turn.out)


def _told(turn: Turn, event: Told) -> None:
    match event.command:
        case Brake():
            _brake(turn)
        case Settle():
            turn.set(leaving=True)
            _brake(turn)
        case motion:
            _begin(turn, motion)


def _brake(turn: Turn) -> None:
    state = turn.state
    match state.phase:
        case Phase.ARMING:
            turn.stay_down(MotionEnd.STOPPED)
        case Phase.FLYING if state.course is not None:
            turn.set(course=replace(state.course, braking=True))
        case Phase.FLYING:
            turn.end(MotionEnd.STOPPED)
        case Phase.LANDING if state.motion is not None and not state.leaving and not state.seen.on_ground:
            turn.hover_here()
            turn.enter(Phase.ENGAGING)
        case _:
            pass


def _begin(turn: Turn, motion: Motion) -> None:
    state = turn.state
    turn.set(motion=motion, rows=())
    if state.motion is not None:
        turn.end(MotionEnd.REFUSED, "another motion is under way")
        turn.set(motion=state.motion, rows=state.rows)
        return
    if isinstance(motion, TakeOff) and state.phase is Phase.GROUND:
        turn.set(refusal="", hover=None, running_s=None)
        turn.enter(Phase.ARMING)
        return
    if isinstance(motion, TakeOff) and state.phase is Phase.FLYING:
        turn.end(MotionEnd.ARRIVED)
        return
    blind = Link.POSITION in state.down and not isinstance(motion, Land)
    if state.phase is not Phase.FLYING or state.leaving or blind:
        why = "its position is not known" if blind else f"it is {state.phase.value}"
        turn.end(MotionEnd.FAILED if state.phase is Phase.RELEASED else MotionEnd.REFUSED, why)
        return
    match motion:
        case FollowTrajectory():
            refusal = _refusal(motion, state)
            if refusal:
                turn.end(MotionEnd.REFUSED, refusal)
                return
            turn.set(course=Course(trajectory=motion.trajectory), rest_s=None, slow_s=None)
        case PerformAction():
            wanted = {StopAction.PICK: Action.GRAB, StopAction.DELIVER: Action.RELEASE}.get(motion.stop.action)
            turn.set(act_done=wanted is None, rest_s=turn.state.now_s)
            if wanted is not None:
                turn.ask(wanted)
        case Land():
            turn.land()


def _refusal(motion: FollowTrajectory, state: ControlState) -> str:
    """Why a trajectory is not begun; empty: it is."""
    way = motion.trajectory
    arrays = (way.time_s, way.position_m, way.velocity_mps, way.yaw_rad)
    if not len(way.time_s) or not all(bool(np.isfinite(array).all()) for array in arrays):
        return "the trajectory is empty or not finite: plan it again"
    off_m = float(np.linalg.norm(way.position_m[0] - np.asarray(state.seen.position_m)))
    if off_m > START_M:
        return f"the trajectory begins {off_m:.2f} m from the vehicle, at most {START_M} m is allowed: plan it again"
    if not bool(state.envelope.volume.contains(way.position_m).all()):
        return "the trajectory leaves the volume where the vehicle may fly"
    return ""


def _deadman(turn: Turn) -> None:
    """No sign of life from the loop: hold, then land or return where that is known to be free."""
    state = turn.state
    silent_s = state.now_s - state.fed_s
    if state.phase is Phase.ARMING and silent_s >= END_S:
        turn.stay_down(MotionEnd.STOPPED, f"nothing was heard of the mission for {silent_s:.1f} s before the take-off")
    if not state.airborne or (silent_s < HOLD_S and not state.leaving):
        return
    if state.phase is not Phase.FLYING:
        return
    if not state.starved and silent_s >= HOLD_S:
        turn.set(starved=True)
        _brake(turn)
    rests = turn.state.course is None
    if silent_s >= END_S or (state.leaving and rests):
        _end_flight(turn, f"nothing was heard of the mission for {silent_s:.1f} s")


def _end_flight(turn: Turn, why: str) -> None:
    state = turn.state
    if not state.leaving and not state.given_up:
        turn.set(given_up=True, leaving=True)
        turn.lose(Link.CONTROL, f"{why}: the vehicle ends its flight by itself")
    lost = Link.POSITION in state.down and state.hover is not None
    place_m = state.hover.position_m if lost and state.hover is not None else state.seen.position_m
    if state.envelope.may_land(place_m):
        turn.end(MotionEnd.STOPPED, why)
        turn.set(course=None)
        turn.land()
    elif state.return_clear:
        turn.end(MotionEnd.STOPPED, why)
        turn.set(course=None)
        turn.enter(Phase.RETURNING)
        turn.ask(Action.RETURN)
