"""A vehicle between the mission and a simulator: it does to the mission what broken vehicles and links do."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from mintpilot.conformance.faults.drawing import Draw
from mintpilot.conformance.faults.kinds import Fault, FaultKind
from mintpilot.conformance.faults.ledger import Commanded, Ledger
from mintpilot.core.errors import DeviceError
from mintpilot.core.geometry import Vec3
from mintpilot.core.inputs import Link, LinkChanged, MotionEnded, VehicleInput
from mintpilot.core.motion import Motion, MotionEnd
from mintpilot.core.ports import Vehicle
from mintpilot.core.trajectory import FlightLog, VehicleState

STEP_S = 0.05
"""The truth is looked at this often, seconds."""
TICK_S = 1e-6
"""A clock that is asked to go on goes on by at least this: sums of jumps round."""
JUMP_M = 3.0
"""Largest jump of a position."""
SMALL_JUMP_M = 0.25
"""A jump that no link can tell from noise and wind."""
AHEAD_S, BACK_S = 40.0, 20.0
"""Largest jumps of the clock."""
DELAY_S = 3.0
"""Longest that what ended is told late."""
REFUSED = 4
"""Most motions refused."""
_LINKS = {FaultKind.POSITION_LOST: Link.POSITION, FaultKind.PILOT: Link.CONTROL}


class FaultyVehicle(Vehicle):
    """The vehicle that the mission flies.

    Args:
        inner: what really flies.
        draw: which faults come.
        ledger: is told what really happens.
        truth: where the vehicle really is; None: where it says.
    """

    def __init__(self, inner: Vehicle, draw: Draw, ledger: Ledger, *, truth: Callable[[], Vec3] | None = None) -> None:
        self._inner, self._draw, self._ledger, self._truth = inner, draw, ledger, truth
        self._rng = draw.rng
        self._begun: set[FaultKind] = set()
        self._down: set[FaultKind] = set()
        self._late: list[tuple[float, VehicleInput]] = []
        self._told: deque[MotionEnded] = deque(maxlen=3)
        self._motion: Motion | None = None
        self._refusals = 0
        self._shift_s = 0.0
        self._off_m = np.zeros(3)
        self._spent_s = 0.0
        self._dead = ""
        self._sample()

    def state(self) -> VehicleState:
        """What is reported: place, clock and battery may be wrong."""
        true = self._inner.state()
        x, y, z = (float(v) for v in np.asarray(true.position_m) + self._off_m)
        left_s = max(true.endurance_left_s - self._spent_s, 0.0)
        return replace(true, time_s=true.time_s + self._shift_s, position_m=(x, y, z), endurance_left_s=left_s)

    def command(self, motion: Motion) -> None:
        """Begins a motion, unless something is broken."""
        state = self.state()
        self._ledger.commands.append(
            Commanded(
                time_s=self._ledger.now_s,
                motion=motion,
                at_m=state.position_m,
                maps=len(self._ledger.maps),
                said=len(self._ledger.said),
                told=len(self._ledger.told),
            )
        )
        if self._dead:
            raise DeviceError(self._dead)
        self._motion = motion
        if self._refusals > 0:
            self._refusals -= 1
            self._late.append((-math.inf, self._end(motion, MotionEnd.REFUSED, "the autopilot refused")))
            return
        self._inner.command(motion)

    def brake(self) -> None:
        """Brakes."""
        if self._dead:
            raise DeviceError(self._dead)
        self._inner.brake()

    def hold(self) -> None:
        """The end of the mission."""
        self._ledger.held, self._ledger.over_s = True, self._ledger.now_s
        if not self._dead:
            self._inner.hold()

    def advance(self, until_s: float) -> tuple[VehicleInput, ...]:
        """Flies on in small steps, so that faults come when they are due."""
        until_s = max(until_s - self._shift_s, self._inner.state().time_s + TICK_S)
        events: list[VehicleInput] = []
        while not events:
            now_s = self._inner.state().time_s
            events += self._begin_and_end(now_s)
            if self._dead:
                raise DeviceError(self._dead)
            due = [event for at_s, event in self._late if at_s <= now_s]
            if due:
                self._late = [item for item in self._late if item[0] > now_s]
                events += due
            if events or now_s >= until_s:
                break
            ended = self._inner.advance(min(now_s + STEP_S, until_s))
            self._sample()
            for event in ended:
                events += self._passed_on(event)
        return tuple(events)

    def _sample(self) -> None:
        true = self._inner.state()
        self._ledger.now_s = true.time_s
        self._ledger.trace.append((true.time_s, *(self._truth() if self._truth is not None else true.position_m)))

    def _begin_and_end(self, now_s: float) -> list[VehicleInput]:
        events: list[VehicleInput] = []
        for fault in self._draw.faults:
            if fault.kind not in self._begun and fault.at_s <= now_s:
                self._begun.add(fault.kind)
                events += self._begin(fault)
            elif fault.kind in self._down and now_s >= fault.at_s + fault.lasts_s:
                self._down.discard(fault.kind)
                events += self._over(fault)
        return events

    def _begin(self, fault: Fault) -> list[VehicleInput]:
        kind, size = fault.kind, fault.size
        match kind:
            case FaultKind.POSITION_LOST | FaultKind.PILOT:
                self._down.add(kind)
                if kind is FaultKind.PILOT:
                    self._inner.hold()
                    self._motion = None
                else:
                    self._off_m = self._rng.normal(size=3) * size * JUMP_M / 2
                self._ledger.tell(kind)
                return [self._link(_LINKS[kind], up=False)]
            case FaultKind.POSE_JUMPS:
                self._down.add(kind)
                way = self._rng.normal(size=3)
                self._off_m = way / np.linalg.norm(way) * size * SMALL_JUMP_M
            case FaultKind.LINK_LOST:
                self._inner.hold()  # its own fail-safe
                self._dead = "nothing is heard of the autopilot any more"
                self._ledger.tell(kind)
            case FaultKind.MOTOR_LOST if self._motion is not None:
                motion = self._motion
                self._inner.hold()
                self._ledger.tell(kind)
                return [self._end(motion, MotionEnd.FAILED, "a motor was lost")]
            case FaultKind.STOPS:
                self._inner.brake()
            case FaultKind.REFUSALS:
                self._refusals = 1 + int(size * REFUSED)
            case FaultKind.BATTERY:
                self._spent_s = size * min(self._inner.state().endurance_left_s, 600.0)
            case FaultKind.CLOCK_JUMPS:
                self._shift_s += size * AHEAD_S if self._rng.random() < 0.5 else -size * BACK_S
            case _:
                pass
        return []

    def _over(self, fault: Fault) -> list[VehicleInput]:
        self._off_m = np.zeros(3)
        if fault.kind is FaultKind.POSITION_LOST:
            return [self._link(Link.POSITION, up=True)]
        return []

    def _passed_on(self, event: VehicleInput) -> list[VehicleInput]:
        """What the mission hears of something that really ended."""
        now_s = self._ledger.now_s
        if isinstance(event, MotionEnded):
            self._motion = None
            event = replace(event, vehicle=self.state(), time_s=event.time_s + self._shift_s, log=self._moved(event))
            self._told.append(event)
        late, again = self._draw.first(FaultKind.LATE), self._draw.first(FaultKind.DOUBLED)
        mixed = self._draw.first(FaultKind.REORDERED)
        events: list[VehicleInput] = [event]
        if again is not None and again.is_on(now_s):
            events *= 2
        if mixed is not None and mixed.is_on(now_s) and len(self._told) > 1:
            events = [*events, self._told[int(self._rng.integers(len(self._told) - 1))]]
            events.reverse()
        if late is not None and late.is_on(now_s):
            self._late += [(now_s + late.size * DELAY_S, one) for one in events]
            return []
        return events

    def _moved(self, event: MotionEnded) -> FlightLog | None:
        if event.log is None:
            return None
        return replace(
            event.log, time_s=event.log.time_s + self._shift_s, position_m=event.log.position_m + self._off_m
        )

    def _link(self, link: Link, *, up: bool) -> LinkChanged:
        return LinkChanged(time_s=self.state().time_s, link=link, up=up, reason="" if up else f"{link.value} lost")

    def _end(self, motion: Motion, end: MotionEnd, reason: str) -> MotionEnded:
        self._motion = None
        state = self.state()
        return MotionEnded(time_s=state.time_s, motion=motion.id, end=end, vehicle=state, reason=reason)
