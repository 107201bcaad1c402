"""What the double sends: the messages that a flight library is content with, each at the rate that was asked for."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import Any

from mintpilot.conformance.vehicle_double.autopilot import DoubleAutopilot, DoubleMode
from mintpilot.conformance.vehicle_double.body import Ned
from mintpilot.conformance.vehicle_double.faults import Fault
from mintpilot.conformance.vehicle_double.fence import HOME_ALTITUDE_M, HOME_DEG, METRES_A_DEGREE, ORIGIN_M
from mintpilot.conformance.vehicle_double.parameters import Flavour

_PX4_MODES = {
    DoubleMode.HOLD: (4, 3), DoubleMode.TAKE_OFF: (4, 2), DoubleMode.FOLLOW: (6, 0), DoubleMode.RETURN: (4, 5),
    DoubleMode.LAND: (4, 6), DoubleMode.PILOT: (3, 0),
}  # fmt: skip
_COPTER_MODES = {
    DoubleMode.HOLD: 5, DoubleMode.TAKE_OFF: 4, DoubleMode.FOLLOW: 4, DoubleMode.RETURN: 6, DoubleMode.LAND: 9,
    DoubleMode.PILOT: 2,
}  # fmt: skip
UNASKED_HZ = {
    Flavour.PX4: {0: 1.0, 1: 1.0, 30: 20.0, 32: 20.0, 33: 5.0, 24: 1.0, 245: 1.0, 147: 1.0, 242: 0.5, 230: 1.0},
    Flavour.ARDUPILOT: {0: 1.0},
}
"""Message id → how often it is sent though nobody asked: ArduPilot sends its heartbeat only."""
ORIGIN = 49
"""PX4 sends this message only when it is asked for: else once, before anybody listens."""
SLOWED_HZ = 4.0
EARTHLY = (24, 33, 49, 242)
"""What tells places on the earth."""


def custom_mode(flavour: Flavour, mode: DoubleMode) -> int:
    """The mode as its firmware numbers it."""
    if flavour is Flavour.ARDUPILOT:
        return _COPTER_MODES[mode]
    main, sub = _PX4_MODES[mode]
    return main << 16 | sub << 24


def mode_numbered(flavour: Flavour, number: int) -> DoubleMode | None:
    """The mode with that number; None where the double has none."""
    return next((m for m in DoubleMode if m is not DoubleMode.TAKE_OFF and custom_mode(flavour, m) == number), None)


class Speaker:
    """Makes messages of the autopilot's state.

    Args:
        autopilot: the state.
        dialect: pymavlink's module of messages.
    """

    def __init__(self, autopilot: DoubleAutopilot, dialect: Any) -> None:
        self._autopilot, self._m = autopilot, dialect
        self.rates_hz = dict(UNASKED_HZ[autopilot.flavour])
        self._due_s: dict[int, float] = {}
        self._slowed = False
        self._makers: dict[int, Callable[[int], Any]] = {
            0: self._heartbeat, 1: self._sys_status, 24: self._gps, 30: self._attitude, 32: self._local,
            33: self._global, 49: self._origin, 147: self._battery, 148: self._version, 242: self._home,
            245: self._extended, 230 if autopilot.flavour is Flavour.PX4 else 193: self._estimator,
        }  # fmt: skip

    def has(self, number: int) -> bool:
        """Whether it has such a message."""
        return number in self._makers

    def message(self, number: int, now_s: float) -> Any | None:
        """The message with that id; None where the double has none."""
        maker = self._makers.get(number)
        if number in EARTHLY and not self._autopilot.knows_global:
            return None
        if number == 0 and Fault.HEARTBEAT in self._autopilot.faults:
            return None
        return maker(int(now_s * 1000)) if maker is not None else None

    def due(self, now_s: float) -> Iterator[Any]:
        """What is to be sent now."""
        if Fault.SLOW_STREAMS in self._autopilot.faults and not self._slowed:
            self._slowed = True
            self.rates_hz = {number: min(rate_hz, SLOWED_HZ) for number, rate_hz in self.rates_hz.items()}
        for number, rate_hz in self.rates_hz.items():
            if now_s < self._due_s.get(number, 0.0) or self._withheld(number):
                continue
            self._due_s[number] = max(self._due_s.get(number, now_s) + 1 / rate_hz, now_s)
            message = self.message(number, now_s)
            if message is not None:
                yield message
        while self._autopilot.texts:
            yield self._m.MAVLink_statustext_message(2, self._autopilot.texts.pop(0).encode()[:50])

    def _withheld(self, number: int) -> bool:
        px4 = self._autopilot.flavour is Flavour.PX4
        blind = not self._autopilot.knows_position and number == 32 and not px4  # PX4 goes on guessing
        blind |= px4 and number == ORIGIN
        return blind

    def _heartbeat(self, _: int) -> Any:
        m, a = self._m, self._autopilot
        px4 = a.flavour is Flavour.PX4
        base = m.MAV_MODE_FLAG_CUSTOM_MODE_ENABLED | m.MAV_MODE_FLAG_GUIDED_ENABLED
        base |= m.MAV_MODE_FLAG_SAFETY_ARMED if a.armed else 0
        firmware = m.MAV_AUTOPILOT_PX4 if px4 else m.MAV_AUTOPILOT_ARDUPILOTMEGA
        status = m.MAV_STATE_ACTIVE if a.armed else m.MAV_STATE_STANDBY
        return m.MAVLink_heartbeat_message(
            m.MAV_TYPE_QUADROTOR, firmware, base, custom_mode(a.flavour, a.mode), status, 3
        )

    def _sys_status(self, _: int) -> Any:
        m, a = self._m, self._autopilot
        sensors = m.MAV_SYS_STATUS_SENSOR_3D_GYRO | m.MAV_SYS_STATUS_SENSOR_3D_ACCEL | m.MAV_SYS_STATUS_SENSOR_3D_MAG
        every = sensors | m.MAV_SYS_STATUS_SENSOR_GPS | m.MAV_SYS_STATUS_PREARM_CHECK
        # ArduPilot's checks pass some time before it has a position, in a pilot's mode.
        good = sensors | (m.MAV_SYS_STATUS_PREARM_CHECK if a.may_arm else 0)
        good |= m.MAV_SYS_STATUS_SENSOR_GPS if a.knows_global else 0
        return m.MAVLink_sys_status_message(
            every, every, good, 200, 15200, 900, round(a.battery * 100), 0, 0, 0, 0, 0, 0
        )

    def _estimator(self, ms: int) -> Any:
        flags = 1 | 2 | 4 | 32 | (8 | 16 | 256 | 512 if self._autopilot.knows_position else 128)
        if self._autopilot.flavour is Flavour.PX4:
            return self._m.MAVLink_estimator_status_message(ms * 1000, flags, *[0.1] * 6, 0.3, 0.5)
        return self._m.MAVLink_ekf_status_report_message(flags, 0.1, 0.1, 0.1, 0.1, 0.0)

    def _battery(self, _: int) -> Any:
        cells = [4000] * 4 + [65535] * 6
        left = round(self._autopilot.battery * 100)
        return self._m.MAVLink_battery_status_message(0, 1, 1, 2500, cells, 900, 100, -1, left)

    def _extended(self, _: int) -> Any:
        m, a = self._m, self._autopilot
        state = m.MAV_LANDED_STATE_IN_AIR if a.airborne else m.MAV_LANDED_STATE_ON_GROUND
        if a.airborne and a.mode is DoubleMode.LAND:
            state = m.MAV_LANDED_STATE_LANDING
        elif a.airborne and a.mode is DoubleMode.TAKE_OFF:
            state = m.MAV_LANDED_STATE_TAKEOFF
        return m.MAVLink_extended_sys_state_message(0, state)

    def _local(self, ms: int) -> Any:
        a = self._autopilot
        place = [p - o for p, o in zip(a.reported_ned(), ORIGIN_M, strict=True)]
        return self._m.MAVLink_local_position_ned_message(ms, *place, *a.body.velocity)

    def _attitude(self, ms: int) -> Any:
        return self._m.MAVLink_attitude_message(ms, 0.0, 0.0, self._autopilot.body.heading_rad, 0.0, 0.0, 0.0)

    def _global(self, ms: int) -> Any:
        latitude, longitude, _ = self._place()
        down = self._autopilot.reported_ned()[2]
        speed = [int(v * 100) for v in self._autopilot.body.velocity]
        altitude_mm = int((HOME_ALTITUDE_M - down) * 1000)
        return self._m.MAVLink_global_position_int_message(
            ms, latitude, longitude, altitude_mm, int(-down * 1000), *speed, 0
        )

    def _gps(self, ms: int) -> Any:
        latitude, longitude, down = self._place()
        altitude_mm = int((HOME_ALTITUDE_M - down) * 1000)
        return self._m.MAVLink_gps_raw_int_message(ms * 1000, 6, latitude, longitude, altitude_mm, 80, 80, 0, 0, 14)

    def _home(self, _: int) -> Any:
        latitude, longitude = (int(v * 1e7) for v in HOME_DEG)
        return self._m.MAVLink_home_position_message(
            latitude, longitude, int(HOME_ALTITUDE_M * 1000), 0.0, 0.0, 0.0, [1.0, 0.0, 0.0, 0.0], 0.0, 0.0, 0.0
        )

    def _origin(self, _: int) -> Any:
        latitude, longitude, down = self._on_earth(ORIGIN_M)
        return self._m.MAVLink_gps_global_origin_message(latitude, longitude, int((HOME_ALTITUDE_M - down) * 1000))

    def _version(self, _: int) -> Any:
        m = self._m
        bytewise, cast = m.MAV_PROTOCOL_CAPABILITY_PARAM_ENCODE_BYTEWISE, m.MAV_PROTOCOL_CAPABILITY_PARAM_ENCODE_C_CAST
        able = m.MAV_PROTOCOL_CAPABILITY_MAVLINK2 | m.MAV_PROTOCOL_CAPABILITY_MISSION_INT
        able |= m.MAV_PROTOCOL_CAPABILITY_COMMAND_INT | m.MAV_PROTOCOL_CAPABILITY_MISSION_FENCE
        able |= m.MAV_PROTOCOL_CAPABILITY_SET_POSITION_TARGET_LOCAL_NED
        able |= bytewise if self._autopilot.flavour is Flavour.PX4 else cast
        none = [0] * 8
        return m.MAVLink_autopilot_version_message(able, 0x010F0000, 0, 0, 0, none, none, none, 0, 0, 42)

    def _place(self) -> tuple[int, int, float]:
        return self._on_earth(self._autopilot.reported_ned())

    @staticmethod
    def _on_earth(place: Ned) -> tuple[int, int, float]:
        n, e, d = place
        latitude, longitude = HOME_DEG
        east_deg = e / (METRES_A_DEGREE * math.cos(math.radians(latitude)))
        return int((latitude + n / METRES_A_DEGREE) * 1e7), int((longitude + east_deg) * 1e7), d
