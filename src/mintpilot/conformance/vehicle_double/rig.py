"""The control machine with a double's autopilot at its other end, on a clock that is turned by hand."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any, TypeVar

from mintpilot.conformance.vehicle_double.autopilot import DoubleAutopilot, DoubleMode
from mintpilot.conformance.vehicle_double.body import Target
from mintpilot.conformance.vehicle_double.faults import Fault
from mintpilot.conformance.vehicle_double.parameters import Flavour
from mintpilot.core.inputs import Link
from mintpilot.vehicle.control import link_step
from mintpilot.vehicle.control_state import ControlState
from mintpilot.vehicle.course import SetPoint
from mintpilot.vehicle.envelope import SafetyEnvelope
from mintpilot.vehicle.signals import (
    Act,
    Action,
    Changed,
    Command,
    Did,
    Ended,
    Fed,
    LinkEvent,
    Mode,
    Seen,
    Start,
    Tick,
    Told,
)

_Kind = TypeVar("_Kind")
TICK_S = 0.05
BEAT_S = 0.5
MODES = {
    DoubleMode.HOLD: Mode.HOLD,
    DoubleMode.TAKE_OFF: Mode.TAKE_OFF,
    DoubleMode.FOLLOW: Mode.OURS,
    DoubleMode.RETURN: Mode.RETURN,
    DoubleMode.LAND: Mode.LAND,
    DoubleMode.PILOT: Mode.OTHER,
}
GOOD = {
    Flavour.PX4: {"COM_OBL_RC_ACT": 4, "NAV_DLL_ACT": 3, "COM_LOW_BAT_ACT": 2, "RTL_RETURN_ALT": 4},
    Flavour.ARDUPILOT: {
        "MAV_GCS_SYSID": 245,
        "FS_GCS_ENABLE": 5,
        "GUID_TIMEOUT": 1,
        "BATT_FS_LOW_ACT": 1,
        "RTL_ALT_M": 4,
    },
}


@dataclass
class Rig:
    """Turns the clock; keeps what the machine gave out."""

    envelope: SafetyEnvelope
    flavour: Flavour = Flavour.PX4
    return_clear: bool = False
    answer_s: float = 0.1
    """How late the autopilot answers; infinity: never."""
    late_ticks: int = 0
    """How late what it sends arrives."""
    now_s: float = 0.0
    feeding: bool = True
    given: list[tuple[float, object]] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.autopilot = DoubleAutopilot(self.flavour)
        self.autopilot.parameters.values.update(GOOD[self.flavour])
        self.state = ControlState(envelope=self.envelope, return_clear=self.return_clear)
        self.seen = Seen(message_s=0.0, heartbeat_s=0.0, position_s=0.0)
        self._on_the_way: list[Seen] = []
        self._answers: list[Did] = []

    @property
    def position_m(self) -> tuple[float, float, float]:
        """Where it really is, on the map: north is y."""
        n, e, d = self.autopilot.body.ned_m
        pad = self.envelope.hover_m
        return (pad[0] + e, pad[1] + n, self.envelope.ground_m - d)

    def of(self, kind: type[_Kind]) -> list[_Kind]:
        """What the machine gave out of that kind."""
        return [order for _, order in self.given if isinstance(order, kind)]

    def tell(self, command: Command) -> None:
        """The loop gives a command."""
        self._step(Told(time_s=self.now_s, command=command))

    def run(self, seconds: float, until: Callable[[Rig], bool] = lambda _: False) -> None:
        """Time passes."""
        for _ in range(round(seconds / TICK_S)):
            self._turn()
            if until(self):
                return

    def until_ended(self, motion: int, seconds: float = 60.0) -> Ended:
        """Time passes until that motion has ended."""
        self.run(seconds, lambda rig: any(e.motion == motion for e in rig.of(Ended)))
        return next(e for e in self.of(Ended) if e.motion == motion)

    def _turn(self) -> None:
        self.now_s = round(self.now_s + TICK_S, 6)
        deaf = Fault.SILENCE in self.autopilot.faults
        beats = math.isclose(self.now_s % BEAT_S, 0.0, abs_tol=1e-6) or math.isclose(self.now_s % BEAT_S, BEAT_S)
        if beats and not deaf and Link.TELEMETRY not in self.state.down:
            self.autopilot.heard_ground(245)
        self.autopilot.step(self.now_s)
        if not deaf:
            self._look(beats)
        self._on_the_way.append(self.seen)
        if self.feeding:
            self._step(Fed(time_s=self.now_s))
        for answer in [a for a in self._answers if a.time_s <= self.now_s]:
            self._answers.remove(answer)
            self._step(replace(answer, time_s=self.now_s))
        if len(self._on_the_way) > self.late_ticks:
            seen = self._on_the_way[-1 - self.late_ticks]
            shift = self.late_ticks * TICK_S
            arrived = {name: getattr(seen, name) + shift for name in ("message_s", "heartbeat_s", "position_s")}
            self._step(Tick(time_s=self.now_s, seen=replace(seen, **arrived)))

    def _look(self, beats: bool) -> None:
        a = self.autopilot
        n, e, d = a.reported_ned()
        vn, ve, vd = a.body.velocity
        pad = self.envelope.hover_m
        changes: dict[str, Any] = {
            "message_s": self.now_s,
            "on_ground": not a.airborne,
            "position_known": a.knows_position,
            "start": self._start(),
        }
        if a.knows_position:
            place = (pad[0] + e, pad[1] + n, self.envelope.ground_m - d)
            changes |= {"position_s": self.now_s, "position_m": place, "velocity_mps": (ve, vn, -vd)}
        if beats and Fault.HEARTBEAT not in a.faults:
            changes |= {"heartbeat_s": self.now_s, "armed": a.armed, "mode": MODES[a.mode], "mode_name": a.mode.value}
        self.seen = replace(self.seen, heartbeat_every_s=BEAT_S, **changes)

    def _start(self) -> Start:
        if self.flavour is Flavour.ARDUPILOT:
            return Start.GUIDED
        return Start.SET_POINTS if Fault.NO_GPS in self.autopilot.faults else Start.HOLD

    def _step(self, event: LinkEvent) -> None:
        self.state, orders = link_step(self.state, event)
        for order in orders:
            self.given.append((self.now_s, order))
            if isinstance(order, SetPoint) and Fault.SILENCE not in self.autopilot.faults:
                (x, y, z), pad = order.position_m, self.envelope.hover_m
                vx, vy, vz = order.velocity_mps
                ned = (y - pad[1], x - pad[0], self.envelope.ground_m - z)
                self.autopilot.set_point(Target(ned_m=ned, velocity=(vy, vx, -vz)))
            elif isinstance(order, Act) and order.action is not Action.SILENCE:
                error = "it is not heard" if Fault.SILENCE in self.autopilot.faults else self._carry_out(order)
                if math.isfinite(self.answer_s):
                    self._answers.append(Did(time_s=self.now_s + self.answer_s, action=order.action, error=error))

    def _carry_out(self, order: Act) -> str:
        a = self.autopilot
        match order.action:
            case Action.STAND_BY:
                return a.change_mode(DoubleMode.HOLD if self.flavour is Flavour.PX4 else DoubleMode.FOLLOW)
            case Action.ARM:
                return a.arm()
            case Action.DISARM:
                return a.disarm()
            case Action.TAKE_OFF:
                if self.flavour is Flavour.ARDUPILOT:
                    a.change_mode(DoubleMode.FOLLOW)
                return a.take_off(order.height_m)
            case Action.ENGAGE:
                return a.change_mode(DoubleMode.FOLLOW)
            case Action.LAND:
                return a.change_mode(DoubleMode.LAND)
            case Action.RETURN:
                return a.change_mode(DoubleMode.RETURN)
            case _:
                return "not supported" if Fault.NO_GRIPPER in a.faults else ""

    def changes(self) -> list[Changed]:
        """Which links went down or came up."""
        return self.of(Changed)
