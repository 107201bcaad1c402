"""The control of a real link on a clock turned by hand: faults, commands, delays, silences, and its laws."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Final, TypeAlias

from mintpilot.conformance.faults.drawing import Draw
from mintpilot.conformance.faults.monitors import Breach
from mintpilot.conformance.faults.records import BreachRecord, FaultRecord
from mintpilot.conformance.vehicle_double.faults import Fault
from mintpilot.conformance.vehicle_double.parameters import Flavour
from mintpilot.conformance.vehicle_double.rig import Rig
from mintpilot.conformance.vehicle_double.room import PAD, room
from mintpilot.core.geometry import Floats, Vec3
from mintpilot.core.inputs import Link
from mintpilot.core.motion import FollowTrajectory, Land, PerformAction, TakeOff
from mintpilot.core.plan import Site, Stop
from mintpilot.core.task import Action as StopAction
from mintpilot.vehicle.control_state import Phase
from mintpilot.vehicle.course import SetPoint, straight
from mintpilot.vehicle.signals import Act, Action, Brake, Changed, Ended, Settle

FAULTS: Final = (Fault.SILENCE, Fault.HEARTBEAT, Fault.REFUSE_ARM, Fault.POSITION_LOST, Fault.POSITION_JUMP,
                 Fault.PILOT, Fault.BATTERY, Fault.NO_GRIPPER)  # fmt: skip
COMMANDS: Final = (
    "fly", "act", "land", "brake", "take-off", "settle", "mute", "speak", "deaf", "slow", "lag"
)  # fmt: skip
"""``mute``: the loop hangs; ``deaf``: the autopilot answers nothing; ``slow``, ``lag``: late answers and messages."""
PLACES: Final[tuple[Vec3, ...]] = (
    (1.0, 1.0, 1.0), (3.0, 6.0, 2.0), (8.0, 2.0, 1.2), (9.0, 9.0, 2.5), (14.0, 2.0, 1.0)
)  # fmt: skip
FLIGHT_S: Final = 20.0
AFTER_S: Final = 40.0
MOST_HAPPENINGS: Final = 8
"""Things that happen in one flight."""

What: TypeAlias = Fault | str | Vec3


@dataclass(frozen=True, slots=True, kw_only=True)
class Happening:
    """Something that happens."""

    at_s: float
    what: What


@dataclass(slots=True)
class LinkFlight:
    """A flight with happenings; keeps what the loop had said when each order was given."""

    flavour: Flavour
    landable: bool | str
    """Whether the ground is known free; ``west``: half of it."""
    returns: bool
    """Whether a straight return clears everything."""
    rig: Rig = field(init=False)
    ways: list[Floats] = field(init=False)
    landing_wanted: bool = False
    _number: int = 100

    def __post_init__(self) -> None:
        envelope = room(landable=self.landable, outdoors=self.returns)
        self.rig = Rig(envelope=envelope, flavour=self.flavour, return_clear=self.returns)
        self.ways = [straight(PAD, PAD, 0.0, 1.0).position_m]

    def fly(self, happened: list[Happening]) -> None:
        """Flies; in the end nothing is heard of the loop any more."""
        rig = self.rig
        rig.run(0.5)
        rig.tell(TakeOff(id=1, height_m=PAD[2]))
        for item in happened:
            rig.run(max(item.at_s - rig.now_s, 0.0))
            self._happen(item.what)
        rig.run(FLIGHT_S - rig.now_s)
        rig.feeding = False
        rig.run(AFTER_S)

    def breaches(self) -> Iterator[Breach]:
        """What was done that no fault excuses."""
        rig = self.rig
        released_s = next((at for at, o in rig.given if isinstance(o, Act) and o.action is Action.SILENCE), math.inf)
        yield from _hands_off(rig, released_s)
        told = [ended.motion for ended in rig.of(Ended)]
        if len(told) != len(set(told)):
            yield Breach(rule="ended twice", what=f"ends were told of {told}")
        yield from _set_points(rig)
        yield from self._landings()
        if Fault.SILENCE in rig.autopilot.faults and rig.state.airborne:
            yield Breach(rule="link", what="nothing is heard of it, and it is flown on")
        yield from self._left_safe()

    def _happen(self, what: What) -> None:
        rig = self.rig
        self._number += 1
        match what:
            case Fault():
                rig.autopilot.switch_on(what)
            case (x, y, z):
                way = straight(rig.state.seen.position_m, (x, y, z), 0.0, 1.0)
                self.ways.append(way.position_m)
                rig.tell(FollowTrajectory(id=self._number, trajectory=way))
            case "act":
                stop = Stop(id="s", action=StopAction.PICK, sites=(Site(position_m=PAD),))
                rig.tell(PerformAction(id=self._number, stop=stop, dwell_s=1.0))
            case "land":
                self.landing_wanted = True
                rig.tell(Land(id=self._number))
            case "take-off":
                rig.tell(TakeOff(id=self._number, height_m=PAD[2]))
            case "brake":
                rig.tell(Brake())
            case "settle":
                rig.tell(Settle())
            case "mute":
                rig.feeding = False
            case "speak":
                rig.feeding = True
            case "deaf":
                rig.answer_s = math.inf
            case "slow":
                rig.answer_s = 1.5
            case "lag":
                rig.late_ticks = 6
            case _:
                pass

    def _landings(self) -> Iterator[Breach]:
        for at, order in self.rig.given:
            if not isinstance(order, Act):
                continue
            if order.action is Action.RETURN and not self.returns:
                yield Breach(rule="return", what=f"at {at} s it returned where that clears not everything")
            if order.action is Action.LAND and self.landable is False:
                failed = any(e.motion == 1 and e.end.value == "failed" for e in self.rig.of(Ended))
                if not (self.landing_wanted or failed):
                    yield Breach(rule="landing", what=f"at {at} s it landed where the ground is not known free")

    def _left_safe(self) -> Iterator[Breach]:
        """Long after the loop's last sign of life: on the ground, hovering, in a pilot's hands, or its fail-safe's."""
        rig, a = self.rig, self.rig.autopilot
        if not a.airborne:
            return
        still = math.hypot(*a.body.velocity) < 0.2
        released = rig.state.phase is Phase.RELEASED
        where = f"phase {rig.state.phase.value}, mode {a.mode.value}, velocity {a.body.velocity}"
        if not released and not (rig.state.phase is Phase.FLYING and still):
            yield Breach(rule="left flying", what=where)
        if released and Fault.PILOT not in a.faults and not still and a.mode.value not in ("land", "return"):
            yield Breach(rule="left flying", what=where)


def fly_link(draw: Draw) -> FaultRecord:
    """The trial with that number."""
    rng = draw.rng
    kinds: list[What] = [*FAULTS, Fault.PILOT, Fault.SILENCE, *COMMANDS, *PLACES]
    happened = [
        Happening(at_s=round(float(rng.uniform(0, FLIGHT_S)), 2), what=kinds[int(rng.integers(len(kinds)))])
        for _ in range(1 + int(rng.integers(MOST_HAPPENINGS)))
    ]
    flight = LinkFlight(
        flavour=list(Flavour)[int(rng.integers(2))],
        landable=(True, False, "west")[int(rng.integers(3))],
        returns=bool(rng.random() < 0.5),
    )
    flight.fly(sorted(happened, key=lambda item: item.at_s))
    breaches = tuple(BreachRecord(rule=one.rule, what=one.what) for one in flight.breaches())
    return FaultRecord(
        adapter=draw.adapter,
        number=draw.number,
        world=flight.flavour.value,
        faults=(),
        outcome=flight.rig.state.phase.value,
        breaches=breaches,
        mission_s=flight.rig.now_s,
        events=len(flight.rig.given),
    )


def _hands_off(rig: Rig, released_s: float) -> Iterator[Breach]:
    """After letting go nothing is sent any more, and letting go is said."""
    if any(at > released_s and isinstance(order, Act | SetPoint) for at, order in rig.given):
        yield Breach(rule="hands off", what=f"something was sent after {released_s} s, when it was let go")
    said = {changed.link for changed in rig.of(Changed) if not changed.up}
    if released_s < math.inf and not said & {Link.CONTROL, Link.TELEMETRY}:
        yield Breach(rule="hands off", what="letting go was not said")
    if Fault.PILOT in rig.autopilot.faults and rig.autopilot.airborne and rig.state.phase is not Phase.RELEASED:
        yield Breach(rule="hands off", what="a pilot flies, and it was not let go")


def _set_points(rig: Rig) -> Iterator[Breach]:
    """Each inside the volume; never fast; never a leap."""
    last: tuple[float, SetPoint] | None = None
    volume = rig.envelope.volume
    for at, order in rig.given:
        if not isinstance(order, SetPoint):
            continue
        if not volume.contains([order.position_m]).all() and volume.contains([rig.position_m]).all():
            yield Breach(rule="set-point", what=f"at {at} s {order.position_m} lies outside of the volume")
        if math.hypot(*order.velocity_mps) >= 4.0:
            yield Breach(rule="set-point", what=f"at {at} s a velocity of {order.velocity_mps}")
        if last is not None and at - last[0] < 0.06:
            leap = math.dist(order.position_m, last[1].position_m)
            if leap > 1.5 and Fault.POSITION_JUMP not in rig.autopilot.faults:
                yield Breach(rule="set-point", what=f"at {at} s a leap of {leap:.2f} m")
        last = (at, order)
