"""Through the real library, over UDP on this machine, against the vehicle double."""

from __future__ import annotations

import math
import os
import signal
import socket
import time
from contextlib import contextmanager
from pathlib import Path

import pytest
from tests.driving import ended, land

from mintpilot.conformance import check_vehicle
from mintpilot.conformance.vehicle_double.faults import Fault, TimedFault
from mintpilot.conformance.vehicle_double.parameters import Flavour
from mintpilot.conformance.vehicle_double.room import PAD, room
from mintpilot.conformance.vehicle_double.serving import DoubleSetup, VehicleDouble, free_port
from mintpilot.core.errors import DeviceError
from mintpilot.core.inputs import Link, LinkChanged
from mintpilot.core.motion import FollowTrajectory, MotionEnd, TakeOff
from mintpilot.vehicle import connecting
from mintpilot.vehicle.address import parse_address
from mintpilot.vehicle.course import straight
from mintpilot.vehicle.mavlink_vehicle import MavlinkVehicle
from mintpilot.vehicle.mavsdk_link import MavsdkLink

pytest.importorskip("mavsdk", reason="needs mavsdk")
pytest.importorskip("pymavlink", reason="needs pymavlink")
pytestmark = pytest.mark.xdist_group("mavlink")

FLAVOURS = list(Flavour)
REPOSITORY = Path(__file__).parents[2]


@contextmanager
def both(flavour: Flavour, *faults: TimedFault, **options):
    """A double, and the vehicle at its other end, on the ground."""
    port = free_port()
    setup = DoubleSetup(flavour=flavour, port=port, faults=faults)
    with VehicleDouble(setup) as double, linked(port, **options) as vehicle:
        yield double, vehicle


@contextmanager
def linked(port: int, **options):
    """A vehicle on the ground, at the other end of what sends to that port."""
    vehicle = MavlinkVehicle(f"mavlink://udpin:127.0.0.1:{port}", **{"envelope": room(), **options})
    try:
        yield vehicle
    finally:
        vehicle.close()


def take_off(vehicle: MavlinkVehicle) -> None:
    assert ended(vehicle, TakeOff(id=1, height_m=PAD[2])).end is MotionEnd.ARRIVED


def set_out(vehicle: MavlinkVehicle, goal_m=(7.0, 6.0, 1.5)) -> None:
    state = vehicle.state()
    way = straight(state.position_m, goal_m, state.yaw_rad, 1.0)
    vehicle.command(FollowTrajectory(id=2, trajectory=way))


def waited(holds, seconds: float) -> bool:
    """Whether it holds within so many seconds."""
    end_s = time.monotonic() + seconds
    while time.monotonic() < end_s:
        if holds():
            return True
        time.sleep(0.1)
    return False


@pytest.mark.long
def test_it_takes_off_flies_and_lands():
    with both(Flavour.PX4) as (double, vehicle):
        take_off(vehicle)
        set_out(vehicle, (4.0, 3.0, 1.5))
        while not (events := vehicle.advance(vehicle.state().time_s + 0.5)):
            pass
        assert events[0].end is MotionEnd.ARRIVED
        north, east, _ = double.state().ned_m
        assert math.dist((PAD[0] + east, PAD[1] + north), (4.0, 3.0)) < 0.3
        assert land(vehicle).end is MotionEnd.ARRIVED
        state = double.state()
        assert not state.armed
        assert state.parameters["COM_OBL_RC_ACT"] == 4
        assert state.fence_corners == 4


@pytest.mark.slow
def test_it_takes_off_flies_and_lands_on_ardupilot_too():
    with both(Flavour.ARDUPILOT) as (double, vehicle):
        take_off(vehicle)
        set_out(vehicle, (4.0, 3.0, 1.5))
        while not (events := vehicle.advance(vehicle.state().time_s + 0.5)):
            pass
        assert events[0].end is MotionEnd.ARRIVED
        assert land(vehicle).end is MotionEnd.ARRIVED
        state = double.state()
        assert not state.armed
        assert state.parameters["FS_GCS_ENABLE"] == 5
        assert state.parameters["MAV_GCS_SYSID"] == 245


@pytest.mark.slow
@pytest.mark.parametrize("flavour", FLAVOURS)
def test_the_next_mission_flies_after_the_last_landing(flavour):
    """ArduPilot stays in LAND, PX4 goes back to OFFBOARD: neither is armed there."""
    port = free_port()
    with VehicleDouble(DoubleSetup(flavour=flavour, port=port)) as double:
        for _ in range(2):
            with linked(port) as vehicle:
                take_off(vehicle)
                assert land(vehicle).end is MotionEnd.ARRIVED
            assert not double.state().armed


@pytest.mark.slow
@pytest.mark.parametrize("flavour", FLAVOURS)
def test_it_flies_where_there_are_no_satellites(flavour):
    with both(flavour, TimedFault(fault=Fault.NO_GPS)) as (double, vehicle):
        take_off(vehicle)
        set_out(vehicle, (4.0, 3.0, 1.5))
        while not (events := vehicle.advance(vehicle.state().time_s + 0.5)):
            pass
        assert events[0].end is MotionEnd.ARRIVED
        north, east, _ = double.state().ned_m
        assert math.dist((PAD[0] + east, PAD[1] + north), (4.0, 3.0)) < 0.3
        assert land(vehicle).end is MotionEnd.ARRIVED
        assert double.state().fence_corners == 0


@pytest.mark.slow
@pytest.mark.parametrize("flavour", FLAVOURS)
def test_rates_that_somebody_else_has_lowered_are_asked_for_again(flavour):
    with both(flavour) as (double, vehicle):
        vehicle.advance(vehicle.state().time_s + 6.0)
        double.switch_on(Fault.SLOW_STREAMS)
        assert waited(lambda: double.state().rates_hz[32] < 5, 2.0)
        assert waited(lambda: double.state().rates_hz[32] > 15, 15.0)


def test_nothing_on_the_port_is_told_by_its_name(monkeypatch):
    monkeypatch.setattr(connecting, "HEARD_S", 0.5)
    port = free_port()
    with pytest.raises(DeviceError, match=f"no heartbeat on udpin://127.0.0.1:{port} within 0.5 s: most likely"):
        MavsdkLink(parse_address(f"mavlink://udpin:127.0.0.1:{port}"))


def test_a_port_that_somebody_uses_is_told_by_its_name():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as taken:
        taken.bind(("127.0.0.1", 0))
        port = taken.getsockname()[1]
        with pytest.raises(DeviceError, match=f"udpin://127.0.0.1:{port} cannot be opened"):
            MavsdkLink(parse_address(f"mavlink://udpin:127.0.0.1:{port}"))


def test_a_serial_device_that_is_not_there_is_told_at_once():
    with pytest.raises(DeviceError, match="nothing:57600 cannot be opened"):
        MavsdkLink(parse_address("mavlink://serial:/dev/nothing:57600"))


@pytest.mark.slow
@pytest.mark.parametrize("flavour", FLAVOURS)
def test_it_is_a_vehicle(flavour):
    made = []

    def make() -> MavlinkVehicle:
        port = free_port()
        double = VehicleDouble(DoubleSetup(flavour=flavour, port=port))
        vehicle = MavlinkVehicle(f"mavlink://udpin:127.0.0.1:{port}", room())
        made.append((double, vehicle))
        take_off(vehicle)
        return vehicle

    try:
        check_vehicle(make)
    finally:
        for double, vehicle in made:
            double.close()
            vehicle.close()


@pytest.mark.slow
@pytest.mark.parametrize("flavour", FLAVOURS)
def test_a_loop_that_hangs_does_not_hold_the_deadman_up(flavour):
    """Nothing is read or written by the loop any more; its pipe runs full."""
    with both(flavour) as (double, vehicle):
        take_off(vehicle)
        set_out(vehicle)
        vehicle.advance(vehicle.state().time_s + 2.0)
        assert waited(lambda: not double.state().armed, 30.0)
        events = []
        while not events:
            events = [e for e in vehicle.advance(vehicle.state().time_s + 0.2) if isinstance(e, LinkChanged)]
        assert events[0].link is Link.CONTROL


@pytest.mark.slow
@pytest.mark.parametrize("flavour", FLAVOURS)
def test_a_killed_link_process_leaves_it_to_the_autopilots_own_fail_safe(flavour):
    with both(flavour) as (double, vehicle):
        take_off(vehicle)
        set_out(vehicle)
        vehicle.advance(vehicle.state().time_s + 2.0)
        os.kill(vehicle.pid, signal.SIGKILL)
        with pytest.raises(DeviceError, match="link process is gone"):
            vehicle.advance(vehicle.state().time_s + 10.0)
        assert waited(lambda: not double.state().armed, 30.0)


@pytest.mark.slow
@pytest.mark.parametrize("flavour", FLAVOURS)
@pytest.mark.parametrize("fault", [Fault.DELAY, Fault.REORDER, Fault.DUPLICATE, Fault.CORRUPT])
def test_bad_packets_do_not_keep_it_from_flying(flavour, fault):
    with both(flavour) as (double, vehicle):
        take_off(vehicle)
        double.switch_on(fault)
        set_out(vehicle)
        ends = []
        while not ends:
            ends = [e for e in vehicle.advance(vehicle.state().time_s + 0.5) if not isinstance(e, LinkChanged)]
        assert ends[0].end in (MotionEnd.ARRIVED, MotionEnd.STOPPED)
        vehicle.close()
        assert waited(lambda: not double.state().armed, 30.0)


@pytest.mark.slow
@pytest.mark.parametrize("flavour", FLAVOURS)
def test_the_pilots_switch_wins(flavour):
    with both(flavour) as (double, vehicle):
        take_off(vehicle)
        set_out(vehicle)
        vehicle.advance(vehicle.state().time_s + 1.0)
        double.switch_on(Fault.PILOT)
        events = []
        while not events:
            events = [e for e in vehicle.advance(vehicle.state().time_s + 0.2) if isinstance(e, LinkChanged)]
        assert events[0].link is Link.CONTROL
        assert "pilot" in events[0].reason
        count = len(double.state().set_points_s)
        time.sleep(1.0)
        assert len(double.state().set_points_s) == count
        assert double.state().mode == "pilot"
        double.switch_on(Fault.SILENCE)


@pytest.mark.slow
@pytest.mark.parametrize("flavour", FLAVOURS)
def test_an_autopilot_that_refuses_is_told_in_its_own_words(flavour, monkeypatch):
    with both(flavour, TimedFault(fault=Fault.REFUSE_ARM)) as (_, vehicle):
        found = ended(vehicle, TakeOff(id=1, height_m=PAD[2]))
        assert found.end is MotionEnd.FAILED
        assert "compass variance" in found.reason
