"""The link's control: one motion after the other, the deadman, and whose hands the vehicle is in."""

import math
from dataclasses import replace

import numpy as np
import pytest

from mintpilot.conformance.vehicle_double.autopilot import DoubleMode
from mintpilot.conformance.vehicle_double.body import Body
from mintpilot.conformance.vehicle_double.faults import Fault
from mintpilot.conformance.vehicle_double.parameters import Flavour
from mintpilot.conformance.vehicle_double.rig import Rig
from mintpilot.conformance.vehicle_double.room import PAD, room
from mintpilot.core.inputs import Link
from mintpilot.core.motion import FollowTrajectory, Land, MotionEnd, PerformAction, TakeOff
from mintpilot.core.plan import Site, Stop
from mintpilot.core.task import Action as StopAction
from mintpilot.core.trajectory import Trajectory
from mintpilot.vehicle.control_state import Phase
from mintpilot.vehicle.course import SetPoint, straight
from mintpilot.vehicle.signals import Act, Action, Brake, Fed, Settle, Tick

FLAVOURS = list(Flavour)


def flying(**options) -> Rig:
    """A rig that hovers above the pad."""
    faults = options.pop("faults", ())
    rig = Rig(**{"envelope": room(), **options})
    for fault in faults:
        rig.autopilot.switch_on(fault)
    rig.run(1.0)
    rig.tell(TakeOff(id=1, height_m=PAD[2]))
    assert rig.until_ended(1).end is MotionEnd.ARRIVED
    return rig


def set_out(rig: Rig, goal_m=(7.0, 6.0, 1.5), motion=2, speed_mps=1.0) -> Trajectory:
    """Sends it on a straight way."""
    way = straight(rig.state.seen.position_m, goal_m, 0.0, speed_mps)
    rig.tell(FollowTrajectory(id=motion, trajectory=way))
    return way


def acts(rig: Rig) -> list[Action]:
    return [order.action for order in rig.of(Act)]


@pytest.mark.parametrize("faults", [(), (Fault.NO_GPS,)])
@pytest.mark.parametrize("flavour", FLAVOURS)
def test_it_takes_off_flies_acts_and_lands(flavour, faults):
    rig = flying(flavour=flavour, faults=faults)
    assert math.dist(rig.position_m, PAD) < 0.3
    set_out(rig)
    ended = rig.until_ended(2)
    assert ended.end is MotionEnd.ARRIVED
    assert ended.log is not None
    assert float(np.linalg.norm(ended.log.position_m - ended.log.reference_m, axis=1).max()) < 0.5
    assert math.dist(rig.position_m, (7.0, 6.0, 1.5)) < 0.3
    rig.tell(PerformAction(id=3, stop=stop(StopAction.PICK), dwell_s=1.0))
    assert rig.until_ended(3).end is MotionEnd.ARRIVED
    assert Action.GRAB in acts(rig)
    rig.tell(Land(id=4))
    assert rig.until_ended(4).end is MotionEnd.ARRIVED
    assert not rig.autopilot.armed
    assert not rig.autopilot.airborne
    assert rig.state.phase is Phase.DOWN


def stop(action: StopAction) -> Stop:
    return Stop(id="s", action=action, sites=(Site(position_m=(7.0, 6.0, 1.0), label="box-1"),))


def test_without_a_global_position_it_climbs_after_set_points_and_never_takes_a_leap():
    rig = flying(faults=(Fault.NO_GPS,))
    assert Action.TAKE_OFF not in acts(rig)
    heights = [point.position_m[2] for point in rig.of(SetPoint)]
    assert heights[0] == 0.0
    assert max(np.diff(heights)) < 0.1


def test_px4_may_end_its_take_off_too_low_and_is_brought_up():
    rig = Rig(envelope=room())
    rig.run(1.0)
    rig.tell(TakeOff(id=1, height_m=PAD[2]))
    rig.run(20.0, lambda rig: rig.position_m[2] > 0.9)
    rig.autopilot.change_mode(DoubleMode.HOLD)
    assert rig.until_ended(1).end is MotionEnd.ARRIVED
    assert math.dist(rig.position_m, PAD) < 0.3


def test_a_loop_that_is_silent_starts_no_motors():
    rig = Rig(envelope=room())
    rig.run(1.0)
    rig.tell(TakeOff(id=1, height_m=PAD[2]))
    rig.feeding = False
    rig.run(10.0)
    assert not rig.autopilot.airborne
    assert not rig.autopilot.armed
    assert rig.until_ended(1).end is MotionEnd.STOPPED


def test_a_pilot_who_keeps_the_mode_keeps_it_on_the_ground():
    rig = Rig(envelope=room())
    rig.autopilot.switch_on(Fault.PILOT)
    rig.run(1.0)
    rig.tell(TakeOff(id=1, height_m=PAD[2]))
    ended = rig.until_ended(1, 120.0)
    assert ended.end is MotionEnd.FAILED
    assert "switch decides" in ended.reason
    assert Action.ARM not in acts(rig)


def test_without_a_gripper_a_person_is_asked():
    rig = flying()
    rig.autopilot.switch_on(Fault.NO_GRIPPER)
    rig.tell(PerformAction(id=3, stop=stop(StopAction.PICK), dwell_s=0.5))
    ended = rig.until_ended(3)
    assert ended.end is MotionEnd.ARRIVED
    assert "attach" in ended.by_hand


def test_it_brakes_along_its_way_and_ends_as_stopped():
    rig = flying()
    set_out(rig)
    rig.run(3.0)
    rig.tell(Brake())
    ended = rig.until_ended(2)
    assert ended.end is MotionEnd.STOPPED
    rig.run(2.0)
    assert math.hypot(*rig.autopilot.body.velocity) < 0.05
    assert 1.0 < math.dist(rig.position_m, PAD) < 5.5


def test_a_landing_that_is_broken_off_hovers():
    rig = flying()
    rig.tell(Land(id=2))
    rig.run(1.0)
    rig.tell(Brake())
    assert rig.until_ended(2).end is MotionEnd.STOPPED
    rig.run(2.0)
    assert rig.autopilot.airborne
    set_out(rig, (3.0, 2.0, 1.2), motion=3)
    assert rig.until_ended(3).end is MotionEnd.ARRIVED


@pytest.mark.parametrize(
    ("way", "words"),
    [
        (straight((8.0, 8.0, 1.5), (9.0, 8.0, 1.5), 0.0, 1.0), "from the vehicle"),
        (straight(PAD, (12.0, 2.0, 1.5), 0.0, 1.0), "leaves the volume"),
        (replace(straight(PAD, (3.0, 2.0, 1.5), 0.0, 1.0), yaw_rad=np.full(21, np.nan)), "not finite"),
    ],
)
def test_what_cannot_be_flown_is_refused_where_it_hovers(way, words):
    rig = flying()
    rig.tell(FollowTrajectory(id=2, trajectory=way))
    ended = rig.until_ended(2)
    assert ended.end is MotionEnd.REFUSED
    assert words in ended.reason
    rig.run(1.0)
    assert math.dist(rig.position_m, PAD) < 0.3


def test_a_loop_that_is_silent_for_half_a_second_makes_it_brake_and_hover():
    rig = flying()
    set_out(rig)
    rig.run(2.0)
    rig.feeding = False
    rig.run(2.5)
    assert math.hypot(*rig.autopilot.body.velocity) < 0.1
    assert rig.autopilot.mode.value == "follow"
    rig.feeding = True
    rig.run(2.0)
    assert rig.until_ended(2).end is MotionEnd.STOPPED
    set_out(rig, motion=3)
    assert rig.until_ended(3).end is MotionEnd.ARRIVED


@pytest.mark.parametrize("flavour", FLAVOURS)
def test_a_loop_that_is_gone_makes_it_land_where_that_is_known_free(flavour):
    rig = flying(flavour=flavour)
    set_out(rig)
    rig.run(2.0)
    rig.feeding = False
    rig.run(15.0)
    assert rig.state.phase is Phase.DOWN
    assert not rig.autopilot.armed
    assert [change.link for change in rig.changes()] == [Link.CONTROL]


def test_where_the_ground_is_not_known_free_it_hovers():
    rig = flying(envelope=room(landable="west"))
    set_out(rig)
    rig.until_ended(2)
    rig.feeding = False
    rig.run(30.0)
    assert rig.state.phase is Phase.FLYING
    assert math.dist(rig.position_m, (7.0, 6.0, 1.5)) < 0.3
    assert Action.LAND not in acts(rig)
    assert Action.RETURN not in acts(rig)


def test_it_returns_only_where_that_clears_everything_mapped():
    rig = flying(envelope=room(landable="west", outdoors=True), return_clear=True)
    set_out(rig)
    rig.until_ended(2)
    rig.feeding = False
    rig.run(90.0)
    assert Action.RETURN in acts(rig)
    assert rig.state.phase is Phase.DOWN
    assert math.dist(rig.position_m[:2], PAD[:2]) < 1.0


@pytest.mark.parametrize("flavour", FLAVOURS)
def test_a_pilot_who_switches_has_it(flavour):
    rig = flying(flavour=flavour)
    set_out(rig)
    rig.run(2.0)
    rig.autopilot.switch_on(Fault.PILOT)
    begun = len(rig.given)
    rig.run(1.2)
    assert rig.state.phase is Phase.RELEASED
    change = rig.changes()[-1]
    assert (change.link, change.up) == (Link.CONTROL, False)
    assert "hands off" in change.reason
    rig.tell(Settle())
    rig.tell(Land(id=9))
    rig.feeding = False
    rig.run(20.0)
    after = [order for _, order in rig.given[begun:] if isinstance(order, Act)]
    assert [order.action for order in after] == [Action.SILENCE]
    late = [at for at, order in rig.given if isinstance(order, SetPoint)]
    assert max(late) <= rig.given[begun][0] + 1.2


@pytest.mark.parametrize("flavour", FLAVOURS)
@pytest.mark.parametrize(("fault", "limit_s"), [(Fault.SILENCE, 2.0), (Fault.HEARTBEAT, 2.0)])
def test_a_lost_link_is_known_within_two_seconds(flavour, fault, limit_s):
    rig = flying(flavour=flavour)
    at_s = rig.now_s
    rig.autopilot.switch_on(fault)
    rig.run(5.0, lambda rig: Link.TELEMETRY in [change.link for change in rig.changes()])
    assert rig.now_s - at_s <= limit_s
    rig.run(40.0)
    assert not rig.autopilot.airborne, "the autopilot's own fail-safe lands"


def test_a_process_that_was_held_up_does_not_call_the_autopilot_silent():
    """It was deaf itself: what came meanwhile is heard after the first tick. Real silence is told all the same."""
    rig = flying()
    rig.autopilot.parameters.values["COM_OF_LOSS_T"] = 10.0  # the library goes on sending the last set-point
    held_up = replace(rig.seen, message_s=rig.now_s, heartbeat_s=rig.now_s, position_s=rig.now_s)
    rig.now_s += 3.0
    rig._step(Fed(time_s=rig.now_s))
    rig._step(Tick(time_s=rig.now_s, seen=held_up))
    rig.run(2.0)
    assert Link.TELEMETRY not in [change.link for change in rig.changes()]
    rig.autopilot.switch_on(Fault.SILENCE)
    rig.run(2.0)
    assert Link.TELEMETRY in [change.link for change in rig.changes()]


def test_a_position_that_jumps_is_told_and_the_drone_may_only_land():
    rig = flying()
    set_out(rig)
    rig.run(2.0)
    rig.autopilot.switch_on(Fault.POSITION_JUMP)
    rig.run(1.5)
    assert [(c.link, c.up) for c in rig.changes()] == [(Link.POSITION, False)]
    rig.until_ended(2)
    set_out(rig, motion=3)
    assert rig.until_ended(3).end is MotionEnd.REFUSED
    rig.tell(Land(id=4))
    assert rig.until_ended(4).end is MotionEnd.ARRIVED


@pytest.mark.parametrize("flavour", FLAVOURS)
def test_a_position_that_is_lost_is_told_and_the_autopilot_may_land_by_itself(flavour):
    rig = flying(flavour=flavour)
    set_out(rig)
    rig.run(2.0)
    rig.autopilot.switch_on(Fault.POSITION_LOST)
    rig.run(20.0)
    assert [(c.link, c.up) for c in rig.changes()] == [(Link.POSITION, False), (Link.CONTROL, False)]
    assert not rig.autopilot.airborne


def test_an_autopilot_that_will_not_be_armed_is_told_with_its_own_words():
    rig = Rig(envelope=room())
    rig.autopilot.switch_on(Fault.REFUSE_ARM)
    rig.run(1.0)
    rig.tell(TakeOff(id=1, height_m=1.5))
    ended = rig.until_ended(1, 120.0)
    assert ended.end is MotionEnd.FAILED
    assert "compass variance" in ended.reason
    assert rig.state.phase is Phase.GROUND


def test_at_the_end_it_lands():
    rig = flying()
    rig.tell(Settle())
    rig.feeding = False
    rig.run(10.0)
    assert rig.state.phase is Phase.DOWN


class HeldFast(Body):
    """A body that something holds."""

    def follow(self, target, seconds):
        pass


def test_a_vehicle_that_lags_is_waited_for():
    """The course never runs away from the vehicle: no far target is ever sent."""
    rig = flying()
    rig.autopilot.body = HeldFast(ned_m=rig.autopilot.body.ned_m)
    set_out(rig, speed_mps=2.0)
    rig.run(4.0)
    points = rig.of(SetPoint)
    assert max(math.dist(p.position_m, rig.position_m) for p in points) < 1.2
    assert rig.until_ended(2).end is MotionEnd.STOPPED
