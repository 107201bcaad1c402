"""Laws of the link's control under random faults, commands, delays and silences of the loop."""

import math
from dataclasses import dataclass

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from tests.vehicle.places import PAD, room
from tests.vehicle.rig import Rig

from mintpilot.conformance.vehicle_double.faults import Fault
from mintpilot.conformance.vehicle_double.parameters import Flavour
from mintpilot.core.inputs import Link
from mintpilot.core.motion import FollowTrajectory, Land, PerformAction, TakeOff
from mintpilot.core.plan import Site, Stop
from mintpilot.core.task import Action as StopAction
from mintpilot.vehicle.control_state import Phase
from mintpilot.vehicle.course import SetPoint, straight
from mintpilot.vehicle.signals import Act, Action, Brake, Changed, Ended, Settle

FAULTS = (Fault.SILENCE, Fault.HEARTBEAT, Fault.REFUSE_ARM, Fault.POSITION_LOST, Fault.POSITION_JUMP, Fault.PILOT,
          Fault.BATTERY, Fault.NO_GRIPPER)  # fmt: skip
FLIGHT_S = 20.0
AFTER_S = 40.0
PLACES = [(1.0, 1.0, 1.0), (3.0, 6.0, 2.0), (8.0, 2.0, 1.2), (9.0, 9.0, 2.5), (14.0, 2.0, 1.0)]


@dataclass(frozen=True)
class Happening:
    """Something that happens."""

    at_s: float
    what: object


times = st.floats(0.0, FLIGHT_S).map(lambda t: round(t, 2))
COMMANDS = ("fly", "act", "land", "brake", "take-off", "settle", "mute", "speak", "deaf", "slow", "lag")
happenings = st.lists(
    st.builds(Happening, at_s=times, what=st.sampled_from([*FAULTS, Fault.PILOT, Fault.SILENCE, *COMMANDS, *PLACES])),
    min_size=1,
    max_size=8,
).map(lambda items: sorted(items, key=lambda item: item.at_s))


class Flight:
    """A flight with happenings; keeps what the loop had said when each order was given."""

    def __init__(self, flavour: Flavour, landable: bool | str, returns: bool) -> None:
        self.rig = Rig(envelope=room(landable=landable, outdoors=returns), flavour=flavour, return_clear=returns)
        self.ways = [straight(PAD, PAD, 0.0, 1.0).position_m]
        self.landing_wanted = False
        self._number = 100

    def fly(self, happened: list[Happening]) -> None:
        rig = self.rig
        rig.run(0.5)
        rig.tell(TakeOff(id=1, height_m=PAD[2]))
        for item in happened:
            rig.run(max(item.at_s - rig.now_s, 0.0))
            self._happen(item.what)
        rig.run(FLIGHT_S - rig.now_s)
        rig.feeding = False
        self.quiet_s = rig.now_s
        rig.run(AFTER_S)

    def _happen(self, what: object) -> None:
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


def check_laws(flavour, happened, landable, returns):
    flight = Flight(flavour, landable, returns)
    flight.fly(happened)
    rig = flight.rig
    released_s = next((at for at, o in rig.given if isinstance(o, Act) and o.action is Action.SILENCE), math.inf)
    hands_off(rig, released_s)
    ends_are_told_once(rig)
    set_points_are_safe(flight)
    landings_are_safe(flight, landable, returns)
    a_lost_link_is_told(rig, released_s)
    it_is_left_safe(flight, released_s)


def hands_off(rig: Rig, released_s: float) -> None:
    """After letting go nothing is sent any more, and letting go is said."""
    after = [o for at, o in rig.given if at > released_s and isinstance(o, Act | SetPoint)]
    assert not after, f"sent after hands off: {after[0]}"
    if released_s < math.inf:
        assert {c.link for c in rig.of(Changed) if not c.up} & {Link.CONTROL, Link.TELEMETRY}
    if Fault.PILOT in rig.autopilot.faults and rig.autopilot.airborne:
        assert rig.state.phase is Phase.RELEASED


def ends_are_told_once(rig: Rig) -> None:
    told = [ended.motion for ended in rig.of(Ended)]
    assert len(told) == len(set(told))


def set_points_are_safe(flight: Flight) -> None:
    """Each lies on a way that was commanded, or where the vehicle was; inside the volume; never far; never a leap."""
    rig, last = flight.rig, None
    volume = rig.envelope.volume
    for at, order in rig.given:
        if not isinstance(order, SetPoint):
            continue
        assert volume.contains([order.position_m]).all() or not volume.contains([rig.position_m]).all()
        assert math.hypot(*order.velocity_mps) < 4.0
        if last is not None and at - last[0] < 0.06:
            leap = math.dist(order.position_m, last[1].position_m)
            assert leap <= 0.3 or Fault.POSITION_JUMP in rig.autopilot.faults or leap <= 1.5, leap
        last = (at, order)


def landings_are_safe(flight: Flight, landable: bool | str, returns: bool) -> None:
    for at, order in flight.rig.given:
        if not isinstance(order, Act):
            continue
        if order.action is Action.RETURN:
            assert returns
        if order.action is Action.LAND and landable is False:
            failed = any(e.motion == 1 and e.end.value == "failed" for e in flight.rig.of(Ended))
            assert flight.landing_wanted or failed, f"landed at {at} where it is not known free"


def a_lost_link_is_told(rig: Rig, released_s: float) -> None:
    if Fault.SILENCE in rig.autopilot.faults and rig.state.airborne:
        raise AssertionError("nothing is heard of it, and it is flown on")


def it_is_left_safe(flight: Flight, released_s: float) -> None:
    """Long after the loop's last sign of life: on the ground, hovering, in a pilot's hands, or its fail-safe's."""
    rig = flight.rig
    a = rig.autopilot
    if not a.airborne:
        return
    still = math.hypot(*a.body.velocity) < 0.2
    held = rig.state.phase is Phase.FLYING and still
    assert held or rig.state.phase is Phase.RELEASED, (rig.state.phase, a.mode, a.body.velocity)
    if rig.state.phase is Phase.RELEASED and Fault.PILOT not in a.faults:
        assert still or a.mode.value in ("land", "return"), a.mode


worlds = {
    "flavour": st.sampled_from(list(Flavour)),
    "happened": happenings,
    "landable": st.sampled_from([True, False, "west"]),
    "returns": st.booleans(),
}


@settings(max_examples=30, deadline=None, suppress_health_check=list(HealthCheck))
@given(**worlds)
def test_no_fault_makes_it_do_what_is_unsafe(flavour, happened, landable, returns):
    check_laws(flavour, happened, landable, returns)


@pytest.mark.slow
@settings(max_examples=1000, deadline=None, suppress_health_check=list(HealthCheck))
@given(**worlds)
def test_no_fault_makes_it_do_what_is_unsafe_a_thousand_times(flavour, happened, landable, returns):
    check_laws(flavour, happened, landable, returns)
