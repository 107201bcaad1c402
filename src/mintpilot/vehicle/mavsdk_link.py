"""The MAVLink connection, by MAVSDK. Every wait has an end; every failure says what it was and why, most likely."""

from __future__ import annotations

import json
import math
import queue
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from typing import TYPE_CHECKING, Any

from mintpilot.core.geometry import Vec3
from mintpilot.vehicle.address import Address
from mintpilot.vehicle.connecting import connected
from mintpilot.vehicle.modes import STANDING_BY, Autopilot
from mintpilot.vehicle.signals import Act, Action, Did
from mintpilot.vehicle.telemetry import Telemetry

if TYPE_CHECKING:
    from mavsdk.plugins.mavlink_direct import MavlinkMessage
    from mavsdk.plugins.offboard import Offboard
    from mavsdk.system import System

RATES_HZ = {0: 4.0, 30: 10.0, 32: 20.0, 33: 5.0, 245: 2.0, 147: 1.0, 242: 0.5, 1: 2.0, 49: 0.5, 230: 5.0, 193: 5.0}
"""Message id → how often it is asked for: ArduPilot sends nothing unasked. HEARTBEAT, ATTITUDE, LOCAL_POSITION_NED,
GLOBAL_POSITION_INT, EXTENDED_SYS_STATE, BATTERY_STATUS, HOME_POSITION, SYS_STATUS, GPS_GLOBAL_ORIGIN, and how good the
position is: ESTIMATOR_STATUS (PX4), EKF_STATUS_REPORT (ArduPilot)."""
MESSAGES = (
    "HEARTBEAT",
    "LOCAL_POSITION_NED",
    "GLOBAL_POSITION_INT",
    "ATTITUDE",
    "EXTENDED_SYS_STATE",
    "BATTERY_STATUS",
    "STATUSTEXT",
    "GPS_GLOBAL_ORIGIN",
    "ESTIMATOR_STATUS",
    "EKF_STATUS_REPORT",
)
_SET_MODE, _SET_INTERVAL, _REQUEST, _GRIPPER = 176, 511, 512, 211
_HEARTBEAT, _ORIGIN = 0, 49
LATE_BEAT_S = 1.3
"""A heartbeat that is so late is asked for, seconds ..."""
BEAT_AGAIN_S = 0.4
"""... and again after this time."""
_CUSTOM_MODE = 1
RATES_AGAIN_S = 5.0
"""Other ground stations set rates, too. So often, seconds, it is seen whether the position comes at less than half of
the best rate so far; then all rates are asked for again."""
_RESULTS = {1: "temporarily rejected", 2: "denied", 3: "not supported", 4: "failed", 6: "cancelled"}


class MavsdkLink:
    """One autopilot. Only the link process makes one.

    Args:
        address: where it is reached.
        clock: seconds, never going back.

    Raises:
        DeviceError: the port cannot be opened, or nothing is heard.
        MissingPartError: MAVSDK is not installed.
    """

    def __init__(self, address: Address, clock: Callable[[], float] = time.monotonic) -> None:
        self.telemetry = Telemetry()
        self._clock = clock
        self._answers: queue.SimpleQueue[Did] = queue.SimpleQueue()
        self._workers = ThreadPoolExecutor(2, thread_name_prefix="mavlink-command")
        self._streams = False
        self._offboard: Offboard | None = None
        self._beat_asked_s = clock()
        self._rates_s, self._counted, self._best_hz = clock(), 0, 0.0
        self._mavsdk, self._system = connected(address)
        self._system_id = int(self._system.get_system_id())
        self._open_plugins(self._system)
        self._subscribe()

    def answers(self) -> list[Did]:
        """What the autopilot has answered since the last call."""
        found = []
        while not self._answers.empty():
            found.append(self._answers.get())
        return found

    def set_point(self, ned_m: Vec3, velocity_ned: Vec3, heading_rad: float) -> None:
        """Sends a set-point now. The library goes on sending it until the next one, or until `silence`."""
        from mavsdk.exceptions import MavsdkError
        from mavsdk.plugins.offboard import PositionNedYaw, VelocityNedYaw

        heading = math.degrees(heading_rad)
        if self._offboard is None:
            self._offboard = self._open_offboard(self._system)
        with suppress(MavsdkError):
            self._offboard.set_position_velocity_ned(
                PositionNedYaw(*ned_m, heading),
                VelocityNedYaw(*velocity_ned, heading),
            )
        self._streams = True

    def act(self, order: Act) -> None:
        """Begins to ask the autopilot for something; `answers` brings what it says."""
        if order.action is Action.SILENCE:
            self.silence()
        else:
            self._workers.submit(self._carry_out, order)

    def silence(self) -> None:
        """Sends no set-points any more, and leaves the mode as it is: the plug-in's own stop would change it."""
        if self._offboard is not None and self._streams:
            self._offboard.destroy()
            self._offboard, self._streams = None, False

    def stand_by(self) -> str:
        """Puts it into the mode in which it is armed; the reason why not, or nothing."""
        main, sub = STANDING_BY[self.telemetry.autopilot or Autopilot.PX4]
        return self._command(_SET_MODE, _CUSTOM_MODE, main, sub)

    def request_origin(self) -> None:
        """Asks where its local origin lies on the earth: PX4 tells it once, long before we listen."""
        self._command(_REQUEST, _ORIGIN)

    def keep_beating(self) -> None:
        """Asks for a heartbeat that is late, which alone tells who flies; never waits. PX4 sends but one a second."""
        from mavsdk.exceptions import MavsdkError

        now_s = self._clock()
        if now_s - max(self.telemetry.heartbeat_s + LATE_BEAT_S, self._beat_asked_s + BEAT_AGAIN_S) > 0:
            self._beat_asked_s = now_s
            with suppress(MavsdkError, RuntimeError):  # closed, or broken: that is told by what is not heard
                self._direct.send_message(self._long(_REQUEST, _HEARTBEAT))

    def keep_rates(self) -> None:
        """Asks for the rates again where they have fallen; never waits."""
        elapsed_s = self._clock() - self._rates_s
        if elapsed_s < RATES_AGAIN_S:
            return
        rate_hz = (self.telemetry.positions - self._counted) / elapsed_s
        self._rates_s, self._counted = self._clock(), self.telemetry.positions
        self._best_hz = max(self._best_hz, rate_hz)
        if 0 < rate_hz < self._best_hz / 2:
            with suppress(RuntimeError):  # closed meanwhile
                self._workers.submit(self._set_rates)

    def get_parameter(self, name: str) -> float | None:
        """A parameter's value; None where the autopilot has none of that name or does not answer."""
        from mavsdk.exceptions import MavsdkError

        for read in (self._param.get_param_int, self._param.get_param_float):
            try:
                return float(read(name))
            except MavsdkError:
                continue
        return None

    def set_parameter(self, name: str, value: float, whole: bool) -> str:
        """Writes a parameter in the type that it has; the reason why not, or nothing."""
        from mavsdk.exceptions import MavsdkError

        why = ""
        kinds: tuple[tuple[Callable[[str, Any], object], Any], ...] = (
            (self._param.set_param_int, round(value)),
            (self._param.set_param_float, float(value)),
        )
        for write, converted in kinds if whole else kinds[::-1]:
            try:
                write(name, converted)
                return ""
            except MavsdkError as error:
                why = why or str(error)
        return why

    def upload_fence(self, corners_deg: list[tuple[float, float]]) -> str:
        """Uploads a fence that keeps the vehicle in; the reason why not, or nothing."""
        from mavsdk.exceptions import MavsdkError
        from mavsdk.plugins.geofence import FenceType, GeofenceData, Point, Polygon

        try:
            corners = [Point(latitude, longitude) for latitude, longitude in corners_deg]
            self._geofence.upload_geofence(GeofenceData([Polygon(corners, FenceType.INCLUSION)], []))
        except MavsdkError as error:
            return str(error)
        return ""

    def close(self) -> None:
        """Ends the connection: no heartbeats any more."""
        self.silence()
        self._workers.shutdown(wait=False, cancel_futures=True)
        self._mavsdk.destroy()

    def _open_plugins(self, system: System) -> None:
        from mavsdk.plugins.action import Action as ActionPlugin
        from mavsdk.plugins.geofence import Geofence
        from mavsdk.plugins.mavlink_direct import MavlinkDirect
        from mavsdk.plugins.param import Param
        from mavsdk.plugins.telemetry import Telemetry as TelemetryPlugin

        self._action, self._param = ActionPlugin(system), Param(system)
        self._offboard = self._open_offboard(system)
        self._geofence, self._direct = Geofence(system), MavlinkDirect(system)
        self._health = TelemetryPlugin(system)

    @staticmethod
    def _open_offboard(system: System) -> Offboard:
        from mavsdk.plugins.offboard import Offboard

        return Offboard(system)

    def _subscribe(self) -> None:
        for name in MESSAGES:
            self._direct.subscribe_message(name, self._heard)
        self._health.subscribe_health(self._healthy)
        self._set_rates()

    def _set_rates(self) -> None:
        for message, rate_hz in RATES_HZ.items():
            self._command(_SET_INTERVAL, message, 1e6 / rate_hz)

    def _heard(self, message: Any, _: object) -> None:
        if message.system_id == self._system_id and message.component_id == 1:
            self.telemetry.take(message.message_name, json.loads(message.fields_json), self._clock())

    def _healthy(self, health: Any, _: object) -> None:
        now = self.telemetry.health
        now.sensors = health.is_gyrometer_calibration_ok and health.is_accelerometer_calibration_ok
        now.armable, now.local_position = health.is_armable, health.is_local_position_ok
        now.global_position, now.home = health.is_global_position_ok, health.is_home_position_ok

    def _carry_out(self, order: Act) -> None:
        from mavsdk.exceptions import MavsdkError

        try:
            error = self._asked(order)
        except MavsdkError as failure:
            error = str(failure)
        except Exception as failure:  # an answer must come whatever happens
            error = repr(failure)
        self._answers.put(Did(time_s=self._clock(), action=order.action, error=error))

    def _asked(self, order: Act) -> str:
        match order.action:
            case Action.STAND_BY:
                return self.stand_by()
            case Action.ARM:
                self._action.arm()
            case Action.DISARM:
                self._action.disarm()
            case Action.TAKE_OFF:
                self._action.set_takeoff_altitude(order.height_m)
                self._action.takeoff()
            case Action.ENGAGE if self._offboard is not None:
                self._offboard.start()
            case Action.LAND:
                self._action.land()
            case Action.RETURN:
                self._action.return_to_launch()
            case Action.GRAB | Action.RELEASE:
                return self._command(_GRIPPER, 1, 1 if order.action is Action.GRAB else 0)
            case _:
                pass
        return ""

    def _command(self, command: int, *parameters: float) -> str:
        """Sends one command; why it was not done, or nothing."""
        from mavsdk.exceptions import MavsdkError

        try:
            answer = self._direct.send_command(self._long(command, *parameters))
        except MavsdkError as error:
            return str(error)
        result = int(json.loads(answer.fields_json).get("result", 4))
        return "" if result == 0 else _RESULTS.get(result, f"result {result}")

    def _long(self, command: int, *parameters: float) -> MavlinkMessage:
        from mavsdk.plugins.mavlink_direct import MavlinkMessage

        values = {f"param{i}": 0.0 for i in range(1, 8)}
        values |= {f"param{i}": float(v) for i, v in enumerate(parameters, start=1)}
        target = {"target_system": self._system_id, "target_component": 1, "confirmation": 0}
        fields = json.dumps({**target, "command": command, **values})
        return MavlinkMessage("COMMAND_LONG", 0, 0, self._system_id, 1, fields)
