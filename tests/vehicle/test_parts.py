"""Frames, addresses, modes, fail-safes, what is heard, and the double's parameters."""

import math
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mintpilot.conformance.vehicle_double.autopilot import DoubleAutopilot, DoubleMode
from mintpilot.conformance.vehicle_double.body import Target
from mintpilot.conformance.vehicle_double.faults import Fault, Wire, parse_fault
from mintpilot.conformance.vehicle_double.fence import Fence
from mintpilot.conformance.vehicle_double.parameters import REAL32, Flavour, Parameters
from mintpilot.conformance.vehicle_double.room import room
from mintpilot.core.errors import InputError, UnknownNameError
from mintpilot.vehicle.address import parse_address
from mintpilot.vehicle.failsafes import apply, may_return, return_height_m, return_settings, settings_for
from mintpilot.vehicle.local_frame import LocalFrame, frame_at
from mintpilot.vehicle.modes import Autopilot, mode_of
from mintpilot.vehicle.signals import Mode, Start
from mintpilot.vehicle.telemetry import Telemetry

numbers = st.floats(-1e3, 1e3)
places = st.tuples(numbers, numbers, numbers)
angles = st.floats(-math.pi, math.pi)


def test_with_heading_zero_x_is_east_and_y_is_north():
    assert LocalFrame().to_ned((1.0, 2.0, 3.0)) == pytest.approx((2.0, 1.0, -3.0))


def test_a_map_that_is_turned_by_ninety_degrees_has_its_y_axis_in_the_east():
    frame = LocalFrame(heading_rad=math.pi / 2)
    assert frame.to_ned((0.0, 1.0, 0.0)) == pytest.approx((0.0, 1.0, 0.0))
    assert frame.to_ned((1.0, 0.0, 0.0)) == pytest.approx((-1.0, 0.0, 0.0))
    assert frame.yaw_to_ned(math.pi / 2) == pytest.approx(math.pi / 2)


@given(place=places, origin=places, heading=angles, yaw=angles)
def test_there_and_back_is_where_it_was(place, origin, heading, yaw):
    frame = LocalFrame(origin_m=origin, heading_rad=heading)
    assert frame.from_ned(frame.to_ned(place)) == pytest.approx(place, abs=1e-9)
    assert math.cos(frame.yaw_from_ned(frame.yaw_to_ned(yaw)) - yaw) == pytest.approx(1.0)


@given(place=places, heading=angles, yaw=angles)
def test_the_nose_points_where_it_flies(place, heading, yaw):
    """A step along a heading on the map is a step along that heading in the autopilot's frame."""
    frame = LocalFrame(heading_rad=heading)
    north, east, _ = frame.velocity_to_ned((math.cos(yaw), math.sin(yaw), 0.0))
    compass = frame.yaw_to_ned(yaw)
    assert (math.cos(compass), math.sin(compass)) == pytest.approx((north, east), abs=1e-9)


@given(place=places, ned=places, heading=angles)
def test_a_vehicle_stands_where_it_was_put(place, ned, heading):
    assert frame_at(place, ned, heading).from_ned(ned) == pytest.approx(place, abs=1e-9)


def test_addresses():
    udp = parse_address("mavlink://udpin:127.0.0.1:14540")
    assert (udp.connection, udp.listens) == ("udpin://127.0.0.1:14540", True)
    serial = parse_address("mavlink://serial:/dev/ttyUSB0:57600?heading=90")
    assert serial.connection == "serial:///dev/ttyUSB0:57600"
    assert serial.heading_rad == pytest.approx(math.pi / 2)


@pytest.mark.parametrize(
    "text",
    [
        "udpin:127.0.0.1:14540",
        "mavlink://127.0.0.1:14540",
        "mavlink://udpin:14540",
        "mavlink://udpin:127.0.0.1:99999",
        "mavlink://udpin:127.0.0.1:1?speed=3",
        "mavlink://udpin:127.0.0.1:1?heading=north",
    ],
)
def test_what_is_no_address_is_refused(text):
    with pytest.raises(InputError, match=text[:9]):
        parse_address(text)


@pytest.mark.parametrize(
    ("autopilot", "number", "mode", "name"),
    [
        (Autopilot.PX4, 6 << 16, Mode.OURS, "OFFBOARD"),
        (Autopilot.PX4, 4 << 16 | 3 << 24, Mode.HOLD, "AUTO.LOITER"),
        (Autopilot.PX4, 4 << 16 | 6 << 24, Mode.LAND, "AUTO.LAND"),
        (Autopilot.PX4, 3 << 16, Mode.OTHER, "POSCTL"),
        (Autopilot.ARDUPILOT, 4, Mode.OURS, "GUIDED"),
        (Autopilot.ARDUPILOT, 9, Mode.LAND, "LAND"),
        (Autopilot.ARDUPILOT, 2, Mode.OTHER, "ALT_HOLD"),
        (Autopilot.ARDUPILOT, 99, Mode.OTHER, "mode 99"),
    ],
)
def test_modes(autopilot, number, mode, name):
    assert mode_of(autopilot, number) == (mode, name)


def test_a_return_is_set_only_outdoors_and_above_everything():
    inside, outside = room(), room(outdoors=True, tallest_m=12.0)
    assert not may_return(inside, 100.0)
    assert not may_return(outside, 13.0)
    assert not may_return(outside, None)
    assert not may_return(replace(outside, tallest_m=None), 100.0)
    assert may_return(outside, 15.0)
    for autopilot, name, land, back in [
        (Autopilot.PX4, "COM_OBL_RC_ACT", 4, 3),
        (Autopilot.ARDUPILOT, "FS_GCS_ENABLE", 5, 1),
    ]:
        for returns, value in [(False, land), (True, back)]:
            wanted = {s.names[0]: s.value for s in settings_for(autopilot, outside, returns=returns)}
            assert wanted[name] == value


def test_fail_safes_are_written_and_read_back():
    held = {"COM_OF_LOSS_T": 5.0, "COM_OBL_RC_ACT": 0.0, "NAV_DLL_ACT": 3.0}
    stuck = {"COM_OBL_RC_ACT"}

    def put(name, value, whole):
        if name not in stuck:
            held[name] = value
        return ""  # "written", says the autopilot

    settings = [s for s in settings_for(Autopilot.PX4, room(), returns=False) if s.names[0] in held or "GF" in s.why]
    checks = {c.check.split()[0]: c for c in apply(tuple(settings), held.get, put, only_read=False)}
    assert checks["COM_OF_LOSS_T"].ok
    assert held["COM_OF_LOSS_T"] == 1.0
    assert not checks["COM_OBL_RC_ACT"].ok, "what it says was written is not what counts"
    stuck.clear()
    apply(tuple(settings), held.get, put, only_read=True)
    assert held["COM_OBL_RC_ACT"] == 0.0


def test_no_loss_of_a_remote_control_returns_where_a_return_may_hit_something():
    for autopilot, names in [
        (Autopilot.PX4, {"NAV_RCL_ACT": 2, "COM_FLTT_LOW_ACT": 3}),
        (Autopilot.ARDUPILOT, {"FS_THR_ENABLE": 1, "FS_DR_ENABLE": 2}),
    ]:
        wanted = {s.names[0]: s for s in settings_for(autopilot, room(), returns=False)}
        for name, returning in names.items():
            assert returning not in (wanted[name].value, *wanted[name].also)


def test_what_is_as_safe_is_left_as_it_is():
    held = {"NAV_RCL_ACT": 1.0}
    settings = [s for s in settings_for(Autopilot.PX4, room(), returns=False) if s.names[0] == "NAV_RCL_ACT"]
    (check,) = apply(tuple(settings), held.get, lambda *_: "never asked", only_read=False)
    assert check.ok
    assert held == {"NAV_RCL_ACT": 1.0}


@pytest.mark.parametrize(
    ("autopilot", "cone"), [(Autopilot.PX4, "RTL_CONE_ANG"), (Autopilot.ARDUPILOT, "RTL_CONE_SLOPE")]
)
def test_a_return_keeps_its_altitude_up_to_home_and_below_the_fence(autopilot, cone):
    wanted = {s.names[0]: s.value for s in return_settings(autopilot, room(outdoors=True), 30.0)}
    assert wanted[cone] == 0
    assert max(wanted.get("FENCE_ALT_MAX", 0), wanted.get("GF_MAX_VER_DIST", 0)) >= 32.0


def test_the_fence_that_was_not_uploaded_is_not_asked_for():
    types = [
        {s.names[0]: s.value for s in settings_for(Autopilot.ARDUPILOT, room(), returns=False, polygon=polygon)}
        for polygon in (False, True)
    ]
    assert [found["FENCE_TYPE"] for found in types] == [1, 5]


def test_the_estimator_says_whether_the_position_is_known():
    heard = Telemetry()
    heard.health.local_position = True  # its sensors are well
    heard.take("LOCAL_POSITION_NED", position(2000, 1.0), 1.0)
    assert heard.knows_position
    heard.take("ESTIMATOR_STATUS", {"flags": 1 | 2 | 4 | 128}, 1.1)
    assert not heard.knows_position
    heard.take("ESTIMATOR_STATUS", {"flags": 1 | 8 | 16}, 1.2)
    assert heard.knows_position
    heard.take("EKF_STATUS_REPORT", {"flags": 1 | 256}, 1.3)
    assert heard.knows_position, "on the ground it need not be moving"
    heard.take("HEARTBEAT", {"autopilot": 3, "custom_mode": 4, "base_mode": 128}, 1.4)
    assert not heard.knows_position


def test_the_double_is_as_strict_as_px4():
    px4 = DoubleAutopilot(Flavour.PX4)
    px4.parameters.values["NAV_DLL_ACT"] = 3
    px4.step(20.0)
    px4.heard_ground(245, station=False)
    assert "manual control" in px4.arm()
    assert px4.change_mode(DoubleMode.HOLD) == ""
    assert "No connection to the GCS" in px4.arm()
    px4.heard_ground(245)
    assert px4.arm() == ""
    assert px4.change_mode(DoubleMode.FOLLOW) == "no offboard signal"
    px4.step(31.0)
    assert not px4.armed, "nothing came of it"


def test_neither_firmware_is_armed_in_the_mode_of_its_last_landing():
    for flavour in Flavour:
        double = DoubleAutopilot(flavour)
        double.step(1.0)
        double.change_mode(DoubleMode.LAND)
        assert not double.may_arm
        assert "not armable" in double.arm()


def test_px4_goes_back_to_offboard_after_a_landing_and_then_misses_its_set_points():
    px4 = DoubleAutopilot(Flavour.PX4)
    for tick in range(60):
        px4.step(0.05 * tick)
        px4.set_point(Target(ned_m=(0.0, 0.0, 0.0)))
    assert px4.change_mode(DoubleMode.FOLLOW) == ""
    assert px4.arm() == ""
    px4.change_mode(DoubleMode.LAND)
    for tick in range(60):
        px4.step(3.0 + 0.05 * tick)
    assert not px4.armed
    assert px4.mode is DoubleMode.FOLLOW
    assert "offboard signal" in px4.arm()


def test_without_a_place_on_the_earth_px4_has_no_hold():
    px4 = DoubleAutopilot(Flavour.PX4)
    px4.switch_on(Fault.NO_GPS)
    px4.step(1.0)
    px4.change_mode(DoubleMode.HOLD)
    assert not px4.may_arm
    assert "global position" in px4.arm()


def test_the_double_is_as_strict_as_ardupilot():
    copter = DoubleAutopilot(Flavour.ARDUPILOT)
    copter.parameters.values |= {"FENCE_ENABLE": 1, "FENCE_TYPE": 5, "FENCE_ALT_MAX": 4.0}
    copter.step(20.0)
    assert "fence" in copter.arm()
    copter.fence = Fence(corners_m=((-5.0, -5.0), (5.0, -5.0), (5.0, 5.0), (-5.0, 5.0)))
    assert copter.arm() == ""
    assert copter.change_mode(DoubleMode.FOLLOW) == ""
    copter.set_point(Target(ned_m=(0.0, 0.0, -2.0)))
    for tick in range(100):
        copter.step(20.0 + 0.05 * tick)
    assert not copter.airborne, "set-points before a take-off"
    assert copter.take_off(2.0) == ""
    for tick in range(100):
        copter.step(25.0 + 0.05 * tick)
    for place in [(9.0, 0.0, -2.0), (0.0, 0.0, -6.0)]:
        copter.set_point(Target(ned_m=place))
        copter.step(copter._now_s + 0.05)
        assert math.dist(copter.body.ned_m, (0.0, 0.0, -2.0)) < 0.3, "set-points outside of the fence"


def test_the_return_altitude_is_read_in_metres():
    assert return_height_m(Autopilot.PX4, {"RTL_RETURN_ALT": 30.0}.get) == 30.0
    assert return_height_m(Autopilot.ARDUPILOT, {"RTL_ALT": 1500.0}.get) == 15.0
    assert return_height_m(Autopilot.ARDUPILOT, {"RTL_ALT_M": 15.0}.get) == 15.0
    assert return_height_m(Autopilot.PX4, {}.get) is None


def position(boot_ms, x):
    return {"time_boot_ms": boot_ms, "x": x, "y": 0.0, "z": 0.0, "vx": 0.0, "vy": 0.0, "vz": 0.0}


def test_old_doubled_and_broken_messages_change_nothing():
    heard = Telemetry()
    heard.take("HEARTBEAT", {"autopilot": 12, "custom_mode": 6 << 16, "base_mode": 128}, 1.0)
    heard.take("LOCAL_POSITION_NED", position(2000, 1.0), 1.0)
    heard.take("LOCAL_POSITION_NED", position(1950, 9.0), 1.1)  # overtaken on its way
    heard.take("LOCAL_POSITION_NED", position(2000, 9.0), 1.2)  # twice
    heard.take("LOCAL_POSITION_NED", position(2100, math.nan), 1.3)
    heard.take("LOCAL_POSITION_NED", {"time_boot_ms": 2200}, 1.4)
    heard.take("HEARTBEAT", {"autopilot": 8, "custom_mode": 0, "base_mode": 0}, 1.5)  # a gimbal's
    seen = heard.seen(LocalFrame(), georeferenced=False)
    assert seen.position_m == (0.0, 1.0, 0.0)
    assert seen.position_s == 1.0
    assert (seen.mode, seen.armed, seen.message_s) == (Mode.OURS, True, 1.5)
    heard.take("LOCAL_POSITION_NED", position(50, 3.0), 20.0)
    heard.take("LOCAL_POSITION_NED", position(90_000, 3.0), 20.1)
    assert heard.seen(LocalFrame(), georeferenced=False).position_m == (0.0, 3.0, 0.0)


def test_ready_means_a_position_and_where_the_map_lies_on_the_earth_a_home_too():
    heard = Telemetry()
    heard.take("LOCAL_POSITION_NED", position(10, 0.0), 1.0)
    health = heard.health
    health.armable = True
    assert "local position" in heard.seen(LocalFrame(), georeferenced=False).not_ready
    health.local_position = True
    assert not heard.seen(LocalFrame(), georeferenced=False).not_ready
    assert "global position" in heard.seen(LocalFrame(), georeferenced=True).not_ready
    health.global_position = True
    assert "home" in heard.seen(LocalFrame(), georeferenced=True).not_ready
    health.home, health.armable = True, False
    heard.take("GLOBAL_POSITION_INT", {"lat": 474_000_000, "lon": 85_000_000}, 1.0)
    assert "checks" in heard.seen(LocalFrame(), georeferenced=True).not_ready


def test_how_its_motors_are_started():
    heard = Telemetry()
    heard.take("HEARTBEAT", {"autopilot": 3, "custom_mode": 0, "base_mode": 0}, 1.0)
    assert heard.start is Start.GUIDED
    heard.take("HEARTBEAT", {"autopilot": 12, "custom_mode": 0, "base_mode": 0}, 2.0)
    heard.take("LOCAL_POSITION_NED", position(10, 0.0), 2.0)
    heard.take("GLOBAL_POSITION_INT", {"lat": 0, "lon": 0}, 2.0)
    assert heard.start is Start.SET_POINTS, "Hold needs a place on the earth"
    heard.take("GLOBAL_POSITION_INT", {"lat": 474_000_000, "lon": 85_000_000}, 2.1)
    assert heard.start is Start.HOLD
    heard.take("LOCAL_POSITION_NED", position(20, 0.0), 9.0)
    assert heard.start is Start.SET_POINTS, "it was lost"


def test_px4_tells_only_whether_it_may_be_armed_in_the_mode_that_it_is_in():
    heard = Telemetry()
    heard.health.local_position = True
    heard.take("HEARTBEAT", {"autopilot": 12, "custom_mode": 4 << 16 | 3 << 24, "base_mode": 0}, 2.0)
    heard.take("LOCAL_POSITION_NED", position(10, 0.0), 2.0)
    assert heard.seen(LocalFrame(), georeferenced=False).not_ready == ""
    heard.take("HEARTBEAT", {"autopilot": 12, "custom_mode": 6 << 16, "base_mode": 0}, 3.0)
    assert "checks" in heard.seen(LocalFrame(), georeferenced=False).not_ready


def test_of_several_batteries_the_emptiest_that_flies_counts():
    heard = Telemetry()
    heard.take("BATTERY_STATUS", {"id": 0, "battery_function": 0, "battery_remaining": 80}, 1.0)
    heard.take("BATTERY_STATUS", {"id": 1, "battery_function": 2, "battery_remaining": 60}, 1.0)
    heard.take("BATTERY_STATUS", {"id": 2, "battery_function": 4, "battery_remaining": 5}, 1.0)  # the camera's
    heard.take("BATTERY_STATUS", {"id": 3, "battery_function": 0, "battery_remaining": -1}, 1.0)
    assert heard.seen(LocalFrame(), georeferenced=False).battery == 0.6


def test_of_a_long_text_the_beginning_is_kept():
    heard = Telemetry()
    heard.take("STATUSTEXT", {"severity": 2, "text": "PreArm: the beginning", "id": 7, "chunk_seq": 0}, 1.0)
    heard.take("STATUSTEXT", {"severity": 2, "text": "and the end", "id": 7, "chunk_seq": 1}, 1.0)
    assert heard.seen(LocalFrame(), georeferenced=False).status == "PreArm: the beginning"


def test_whole_parameters_go_as_bytes_on_px4_and_as_numbers_on_ardupilot():
    px4, ardupilot = Parameters(Flavour.PX4), Parameters(Flavour.ARDUPILOT)
    assert px4.put("COM_OBL_RC_ACT", 4.0, px4.types["COM_OBL_RC_ACT"])
    assert px4["COM_OBL_RC_ACT"] != 4.0, "a number is not its bytes"
    assert not px4.put("COM_OBL_RC_ACT", 4.0, REAL32)
    assert ardupilot.put("FS_GCS_ENABLE", 5.0, REAL32)
    assert ardupilot.encoded("FS_GCS_ENABLE") == 5.0


def test_faults_are_read_by_name_and_time():
    assert parse_fault("pilot@20.5").at_s == 20.5
    assert parse_fault("silence").fault is Fault.SILENCE
    with pytest.raises(UnknownNameError, match="Did you mean 'silence'"):
        parse_fault("silent@3")
    with pytest.raises(InputError, match="seconds"):
        parse_fault("pilot@soon")


@pytest.mark.parametrize(
    ("fault", "arrive"), [(Fault.DUPLICATE, 2 * 50), (Fault.REORDER, 50), (Fault.DELAY, 50), (Fault.CORRUPT, 50)]
)
def test_packets_on_a_bad_wire(fault, arrive):
    wire, sent = Wire(1), [bytes([i, 255 - i]) for i in range(50)]
    for i, packet in enumerate(sent):
        wire.put(packet, i * 0.01, frozenset({fault}))
    now = list(wire.due(0.5)) if fault is Fault.DELAY else []
    came = now + list(wire.due(10.0))
    assert len(came) == arrive
    assert (fault is Fault.DELAY) == (0 < len(now) < 50 and came == sent)
    if fault is Fault.CORRUPT:
        assert 1 <= sum(a != b for a, b in zip(came, sent, strict=True)) <= 25
    if fault is Fault.REORDER:
        assert came != sent
        assert sorted(came) == sent


def test_an_envelope_lands_only_where_it_was_told():
    west = room(landable="west")
    assert west.may_land((2.0, 2.0, 1.5))
    assert not west.may_land((7.0, 2.0, 1.5))
    assert not west.may_land((-1.0, 2.0, 1.5))
    assert not west.may_land((2.0, 2.0, 7.0))
