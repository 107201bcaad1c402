"""The state of the link's control machine, and one step in the making."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from enum import StrEnum
from typing import Any

import numpy as np

from mintpilot.core.geometry import Vec3
from mintpilot.core.inputs import Link
from mintpilot.core.motion import FollowTrajectory, Land, Motion, MotionEnd
from mintpilot.core.trajectory import FlightEnd, FlightLog
from mintpilot.vehicle.course import Course, SetPoint
from mintpilot.vehicle.envelope import SafetyEnvelope
from mintpilot.vehicle.signals import Act, Action, Changed, Ended, Order, Seen


class Phase(StrEnum):
    """What the link is doing with the vehicle."""

    GROUND = "on the ground"
    ARMING = "arming"
    """Waiting until it is ready, then for its motors."""
    CLIMBING = "climbing"
    """In the autopilot's own take-off."""
    ENGAGING = "engaging"
    """Sending set-points until the autopilot follows them."""
    FLYING = "flying"
    """It follows our set-points: along a course, or hovering."""
    LANDING = "landing"
    """In the autopilot's own landing."""
    RETURNING = "returning"
    """In the autopilot's own return; only where that clears everything mapped."""
    DOWN = "landed"
    RELEASED = "released"
    """Hands off: a pilot or the autopilot's fail-safe has it, or nothing is heard of it any more."""


AIRBORNE = frozenset({Phase.CLIMBING, Phase.ENGAGING, Phase.FLYING, Phase.LANDING, Phase.RETURNING})


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ControlState:
    """Everything that the next step depends on."""

    envelope: SafetyEnvelope
    return_clear: bool = False
    """Whether the autopilot's return altitude was read back and clears everything mapped."""
    now_s: float = 0.0
    ticked_s: float = 0.0
    """When time passed last."""
    late_s: float = -math.inf
    """When a tick came late last: the process itself was held up, and heard nothing meanwhile."""
    fed_s: float = 0.0
    """When the loop was last known to be alive."""
    seen: Seen = field(default_factory=Seen)
    phase: Phase = Phase.GROUND
    since_s: float = 0.0
    """Since when in that phase."""
    mode_since_s: float = 0.0
    """When the autopilot last agreed to change its mode."""
    motion: Motion | None = None
    course: Course | None = None
    hover: SetPoint | None = None
    """The set-point of now; None: none is sent."""
    asked: Action | None = None
    """What the autopilot has not answered yet."""
    asked_s: float = -math.inf
    refusal: str = ""
    """The autopilot's last refusal, for messages."""
    running_s: float | None = None
    """Since when its motors run, by its own word, before the take-off."""
    act_done: bool = True
    """Whether the gripper has answered, or has nothing to do."""
    by_hand: str = ""
    rest_s: float | None = None
    """Since when the course has been at rest; None: it is not."""
    slow_s: float | None = None
    """Since when the course has been waiting for the vehicle."""
    starved: bool = False
    """Whether the deadman has braked since the loop was heard last."""
    given_up: bool = False
    """Whether the loop was told that the drone ends the flight by itself."""
    leaving: bool = False
    """No command follows."""
    jumped: str = ""
    """How the position jumped; empty: it never did."""
    bad_position_s: float | None = None
    good_position_s: float | None = None
    down: frozenset[Link] = frozenset()
    rows: tuple[tuple[float, Vec3, Vec3], ...] = ()
    """Time, place, and where it should have been, of the motion under way."""

    @property
    def airborne(self) -> bool:
        """Whether the link is responsible for a vehicle in the air."""
        return self.phase in AIRBORNE


class Turn:
    """Collects what one step does.

    Attributes:
        state: the state so far.
        out: the orders so far, in order.
    """

    def __init__(self, state: ControlState) -> None:
        self.state = state
        self.out: list[Order] = []

    def set(self, **changes: Any) -> None:
        """Replaces fields of the state."""
        self.state = replace(self.state, **changes)

    def give(self, order: Order) -> None:
        """Gives one order."""
        self.out.append(order)

    def enter(self, phase: Phase) -> None:
        """Goes on to another phase."""
        self.set(phase=phase, since_s=self.state.now_s, asked=None, asked_s=-math.inf)

    def ask(self, action: Action, height_m: float = 0.0) -> None:
        """Asks the autopilot for something."""
        self.set(asked=action, asked_s=self.state.now_s)
        self.give(Act(action=action, height_m=height_m))

    def end(self, end: MotionEnd, reason: str = "") -> None:
        """The motion has ended, if there is one."""
        state = self.state
        if state.motion is None:
            return
        log = _log(state, end, reason) if isinstance(state.motion, FollowTrajectory | Land) and state.rows else None
        by_hand = state.by_hand if end is MotionEnd.ARRIVED else ""
        self.give(Ended(motion=state.motion.id, end=end, reason=reason, log=log, by_hand=by_hand))
        self.set(motion=None, rows=(), by_hand="", act_done=True)

    def lose(self, link: Link, reason: str) -> None:
        """A link went down; said once."""
        if link not in self.state.down:
            self.set(down=self.state.down | {link})
            self.give(Changed(link=link, up=False, reason=reason))

    def release(self, link: Link, reason: str) -> None:
        """Hands off, and says so."""
        self.lose(link, reason)
        self.give(Act(action=Action.SILENCE))
        self.end(MotionEnd.FAILED, reason)
        self.enter(Phase.RELEASED)
        self.set(course=None, hover=None)

    def stay_down(self, end: MotionEnd, reason: str = "") -> None:
        """No take-off: the motors stand still, and nothing is sent any more."""
        if self.state.seen.armed or self.state.asked is Action.ARM:
            self.give(Act(action=Action.DISARM))
        if self.state.hover is not None:
            self.give(Act(action=Action.SILENCE))
        self.end(end, reason)
        self.enter(Phase.GROUND)
        self.set(hover=None)

    def hover_here(self) -> None:
        """From now on the set-point is where the vehicle is."""
        seen = self.state.seen
        self.set(course=None, hover=SetPoint(position_m=seen.position_m, yaw_rad=seen.yaw_rad))

    def land(self) -> None:
        """The autopilot lands it right below."""
        self.enter(Phase.LANDING)
        self.ask(Action.LAND)


def _log(state: ControlState, end: MotionEnd, reason: str) -> FlightLog:
    ends = {MotionEnd.ARRIVED: FlightEnd.ARRIVED, MotionEnd.STOPPED: FlightEnd.INTERRUPTED}
    times, places, references = zip(*state.rows, strict=True)
    return FlightLog(
        end=ends.get(end, FlightEnd.FAILED),
        time_s=np.asarray(times, float),
        position_m=np.asarray(places, float),
        reference_m=np.asarray(references, float),
        reason=reason,
    )
