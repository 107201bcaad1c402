"""What the double answers: commands, parameters, missions and fences, set-points."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from mintpilot.conformance.vehicle_double.autopilot import DoubleAutopilot, DoubleMode
from mintpilot.conformance.vehicle_double.body import Target
from mintpilot.conformance.vehicle_double.faults import Fault
from mintpilot.conformance.vehicle_double.fence import HOME_ALTITUDE_M, ORIGIN_M, fence_of
from mintpilot.conformance.vehicle_double.parameters import Flavour
from mintpilot.conformance.vehicle_double.speaking import Speaker, mode_numbered

Send = Callable[[Any], None]
ANSWER_S = 0.1
"""A command is answered after this time, seconds ..."""
SLOW_S = {22: 0.5, 211: 1.5}
"""... but these (take-off, gripper) are first said to be in progress, and answered after this one."""
LOCAL_NED = 1
"""The only frame of set-points that it takes."""


class Hearer:
    """Takes messages in and answers them.

    Args:
        autopilot: whose they are.
        speaker: whose rates are set.
        dialect: pymavlink's module of messages.
        send: sends a message.
    """

    def __init__(self, autopilot: DoubleAutopilot, speaker: Speaker, dialect: Any, send: Send) -> None:
        self._autopilot, self._speaker, self._m, self._send = autopilot, speaker, dialect, send
        self._items: dict[int, list[Any]] = {0: [], 1: [], 2: []}
        self._coming: tuple[int, int, list[Any]] | None = None
        self._answers: list[tuple[float, Any]] = []
        self._now_s = 0.0

    def due(self, now_s: float) -> None:
        """Sends the answers that are due."""
        ready = [item for item in self._answers if item[0] <= now_s]
        self._answers = [item for item in self._answers if item[0] > now_s]
        for _, answer in ready:
            self._send(answer)

    def hear(self, message: Any, now_s: float) -> None:
        """One message came."""
        self._now_s = now_s
        match message.get_type():
            case "HEARTBEAT":
                self._autopilot.heard_ground(message.get_srcSystem(), station=message.type == self._m.MAV_TYPE_GCS)
            case "COMMAND_LONG" | "COMMAND_INT":
                self._command(message)
            case "SET_POSITION_TARGET_LOCAL_NED":
                self._set_point(message)
            case "PARAM_REQUEST_READ" | "PARAM_REQUEST_LIST" | "PARAM_SET":
                self._parameter(message)
            case (
                "MISSION_COUNT"
                | "MISSION_ITEM_INT"
                | "MISSION_CLEAR_ALL"
                | "MISSION_REQUEST_LIST"
                | "MISSION_REQUEST_INT"
            ):
                self._mission(message)
            case "TIMESYNC" if message.tc1 == 0:
                self._send(self._m.MAVLink_timesync_message(int(now_s * 1e9) + 1, message.ts1))
            case _:
                pass

    def _set_point(self, message: Any) -> None:
        values = (message.x, message.y, message.z, message.vx, message.vy, message.vz, message.yaw)
        if message.coordinate_frame != LOCAL_NED or not all(math.isfinite(v) for v in values):
            return
        (n, e, d), place = ORIGIN_M, self._autopilot.body.ned_m
        if not message.type_mask & 7:
            place = (message.x + n, message.y + e, message.z + d)
        velocity = (message.vx, message.vy, message.vz) if not message.type_mask & 56 else (0.0, 0.0, 0.0)
        heading = None if message.type_mask & 1024 else message.yaw
        self._autopilot.set_point(Target(ned_m=place, velocity=velocity, heading_rad=heading))

    def _command(self, message: Any) -> None:
        m = self._m
        refusal: str | None = None
        match message.command:
            case m.MAV_CMD_COMPONENT_ARM_DISARM:
                refusal = self._autopilot.arm() if message.param1 > 0.5 else self._autopilot.disarm()
            case m.MAV_CMD_DO_SET_MODE:
                refusal = self._set_mode(message)
            case m.MAV_CMD_NAV_TAKEOFF:
                refusal = self._autopilot.take_off(self._take_off_height(message))
            case m.MAV_CMD_NAV_LAND:
                refusal = self._autopilot.change_mode(DoubleMode.LAND)
            case m.MAV_CMD_NAV_RETURN_TO_LAUNCH:
                refusal = self._autopilot.change_mode(DoubleMode.RETURN)
            case m.MAV_CMD_DO_GRIPPER if Fault.NO_GRIPPER not in self._autopilot.faults:
                self._autopilot.gripper, refusal = ("closed" if message.param2 > 0.5 else "open"), ""
            case m.MAV_CMD_DO_GRIPPER if self._autopilot.flavour is Flavour.PX4:
                return  # nobody in PX4 answers for a gripper that is not there
            case m.MAV_CMD_SET_MESSAGE_INTERVAL:
                refusal = self._set_rate(int(message.param1), message.param2)
            case m.MAV_CMD_REQUEST_MESSAGE:
                wanted = self._speaker.message(int(message.param1), self._now_s)
                self._acknowledge(message, m.MAV_RESULT_UNSUPPORTED if wanted is None else m.MAV_RESULT_ACCEPTED)
                if wanted is not None:
                    self._send(wanted)
                return
            case _:
                pass
        if refusal and message.command != m.MAV_CMD_SET_MESSAGE_INTERVAL:
            self._autopilot.texts.append(refusal)
        results = {None: m.MAV_RESULT_UNSUPPORTED, "": m.MAV_RESULT_ACCEPTED}
        self._acknowledge(message, results.get(refusal, m.MAV_RESULT_TEMPORARILY_REJECTED))

    def _acknowledge(self, message: Any, result: int) -> None:
        m, back = self._m, (message.get_srcSystem(), message.get_srcComponent())
        late_s = SLOW_S.get(message.command) if result == m.MAV_RESULT_ACCEPTED else None
        if late_s is not None:
            self._send(m.MAVLink_command_ack_message(message.command, m.MAV_RESULT_IN_PROGRESS, 10, 0, *back))
        ack = m.MAVLink_command_ack_message(message.command, result, 0, 0, *back)
        self._answers.append((self._now_s + (late_s or ANSWER_S), ack))

    def _set_mode(self, message: Any) -> str | None:
        number = int(message.param2)
        if self._autopilot.flavour is Flavour.PX4:
            number = int(message.param2) << 16 | int(message.param3) << 24
        mode = mode_numbered(self._autopilot.flavour, number)
        return None if mode is None else self._autopilot.change_mode(mode)

    def _take_off_height(self, message: Any) -> float:
        asked = message.z if message.get_type() == "COMMAND_INT" else message.param7
        if self._autopilot.flavour is Flavour.ARDUPILOT:
            return float(asked)
        height = asked - HOME_ALTITUDE_M
        return float(
            height if math.isfinite(height) and 0 < height < 500 else self._autopilot.parameters["MIS_TAKEOFF_ALT"]
        )

    def _set_rate(self, number: int, interval_us: float) -> str:
        """Why not: a message that it has not, and PX4 keeps its heartbeat at one a second."""
        if not self._speaker.has(number) or (number == 0 and self._autopilot.flavour is Flavour.PX4):
            return "that rate cannot be set"
        if interval_us > 0:
            self._speaker.rates_hz[number] = min(1e6 / interval_us, 50.0)
        elif interval_us < 0:
            self._speaker.rates_hz.pop(number, None)
        return ""

    def _parameter(self, message: Any) -> None:
        parameters = self._autopilot.parameters
        if message.get_type() == "PARAM_REQUEST_LIST":
            for name in parameters.names:
                self._send_parameter(name)
            return
        name = message.param_id
        if message.get_type() == "PARAM_SET":
            parameters.put(name, message.param_value, message.param_type)
        elif 0 <= message.param_index < len(parameters.names):
            name = parameters.names[message.param_index]
        if name in parameters.values:
            self._send_parameter(name)

    def _send_parameter(self, name: str) -> None:
        parameters = self._autopilot.parameters
        names = parameters.names
        self._send(
            self._m.MAVLink_param_value_message(
                name.encode(), parameters.encoded(name), parameters.types[name], len(names), names.index(name)
            )
        )

    def _mission(self, message: Any) -> None:
        m, kind, back = self._m, message.mission_type, (message.get_srcSystem(), message.get_srcComponent())
        match message.get_type():
            case "MISSION_COUNT" if message.count:
                self._coming = (kind, message.count, [])
                self._send(m.MAVLink_mission_request_int_message(*back, 0, kind))
            case "MISSION_ITEM_INT" if self._coming is not None and self._coming[0] == kind:
                _, count, items = self._coming
                if message.seq == len(items):
                    items.append(message)
                if len(items) < count:
                    self._send(m.MAVLink_mission_request_int_message(*back, len(items), kind))
                    return
                self._take(kind, items)
                self._send(m.MAVLink_mission_ack_message(*back, m.MAV_MISSION_ACCEPTED, kind))
            case "MISSION_COUNT" | "MISSION_CLEAR_ALL":
                self._take(kind, [])
                self._send(m.MAVLink_mission_ack_message(*back, m.MAV_MISSION_ACCEPTED, kind))
            case "MISSION_REQUEST_LIST":
                self._send(m.MAVLink_mission_count_message(*back, len(self._items[kind]), kind))
            case "MISSION_REQUEST_INT" if message.seq < len(self._items[kind]):
                i = self._items[kind][message.seq]
                values = (i.frame, i.command, i.current, i.autocontinue, i.param1, i.param2, i.param3, i.param4)
                self._send(m.MAVLink_mission_item_int_message(*back, message.seq, *values, i.x, i.y, i.z, kind))
            case _:
                pass

    def _take(self, kind: int, items: list[Any]) -> None:
        self._items[kind], self._coming = items, None
        if kind == self._m.MAV_MISSION_TYPE_FENCE:
            self._autopilot.fence = fence_of([(item.x, item.y) for item in items])

    @property
    def mission_commands(self) -> tuple[int, ...]:
        """The commands of the uploaded mission, in order."""
        return tuple(item.command for item in self._items[0])

    @property
    def fence_corners(self) -> int:
        """How many corners the uploaded fence has."""
        return len(self._items[1])
