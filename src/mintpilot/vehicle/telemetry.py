"""From MAVLink messages to what was seen of the vehicle. Old messages that arrive late are dropped."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

from mintpilot.core.geometry import Vec3
from mintpilot.vehicle.local_frame import LocalFrame
from mintpilot.vehicle.modes import AUTOPILOT_IDS, Autopilot, mode_of
from mintpilot.vehicle.signals import Mode, Seen, Start

ARMED_FLAG: Final = 128
"""In `base_mode` of a heartbeat."""
ON_GROUND: Final = 1
"""`landed_state` of a vehicle on the ground."""
WARNING: Final = 4
"""Severities up to this one are warnings or worse."""
ESTIMATED: Final = 8 | 16
"""In the flags of the estimator: a horizontal position, relative or absolute, is known ..."""
PREDICTED: Final = 256 | 512
"""... or will be once it flies, which counts on the ground ..."""
GUESSED: Final = 128
"""... and is no mere assumption."""
RESTARTED_MS: Final = 10_000
"""A clock that goes back by more than this belongs to an autopilot that has restarted."""

GLOBAL_S: Final = 2.0
"""A global position that lags so far behind the local one is none, seconds."""
FLIES_US: Final = (0, 1, 2)
"""`battery_function` of batteries that keep it in the air: unknown, all, propulsion."""

Fields = Mapping[str, object]


@dataclass(slots=True)
class Health:
    """What the autopilot says of its own readiness."""

    armable: bool = False
    sensors: bool = False
    """Whether its gyroscope and its accelerometer are well; of a compass indoors nothing need be told."""
    local_position: bool = False
    global_position: bool = False
    home: bool = False


class Telemetry:
    """Gathers what the autopilot sends. Filled by the library's threads, read by one.

    Attributes:
        health: its readiness.
        autopilot: the firmware; None until its first heartbeat.
        positions: how often its local position came.
        heartbeat_s: when its heartbeat came last.
    """

    def __init__(self) -> None:
        self.health = Health()
        self.autopilot: Autopilot | None = None
        self.origin: tuple[float, float, float] | None = None
        self.ned_m: Vec3 | None = None
        self._velocity_ned: Vec3 = (0.0, 0.0, 0.0)
        self._heading_rad = 0.0
        self._tilt_rad = (0.0, 0.0)
        self.positions = 0
        self._message_s = self.heartbeat_s = self._position_s = self._global_s = -1e9
        self._every_s = 1.0
        self._boot_ms = -1
        self._custom_mode = 0
        self._armed = False
        self._on_ground = True
        self._status = ""
        self._batteries: dict[int, float] = {}
        self._estimator: int | None = None

    @property
    def knows_position(self) -> bool:
        """Whether the autopilot knows where it is: by its estimator, or where that is silent by its sensors."""
        if self.ned_m is None:
            return False
        if self._estimator is None:
            return self.health.local_position
        wanted = ESTIMATED if self._armed else ESTIMATED | PREDICTED
        return bool(self._estimator & wanted) and not self._estimator & GUESSED

    @property
    def knows_global(self) -> bool:
        """Whether the autopilot knows where it is on the earth, and where home is."""
        return self.health.global_position and self.health.home

    @property
    def start(self) -> Start:
        """How its motors are started."""
        if self.autopilot is Autopilot.ARDUPILOT:
            return Start.GUIDED
        return Start.HOLD if self._global_s > self._position_s - GLOBAL_S else Start.SET_POINTS

    def take(self, name: str, fields: Fields, time_s: float) -> None:
        """Takes in one message that arrived then. Fields that are missing or not finite leave all as it was."""
        self._message_s = time_s
        match name:
            case "HEARTBEAT":
                self._heartbeat(fields, time_s)
            case "LOCAL_POSITION_NED":
                self._position(fields, time_s)
            case "ATTITUDE":
                self._heading_rad = _number(fields, "yaw", self._heading_rad)
                self._tilt_rad = (_number(fields, "roll", 0.0), _number(fields, "pitch", 0.0))
            case "EXTENDED_SYS_STATE":
                self._on_ground = _number(fields, "landed_state", 0) == ON_GROUND
            case "BATTERY_STATUS" if _number(fields, "battery_function", 0) in FLIES_US:
                left = _number(fields, "battery_remaining", -1)
                if 0 <= left <= 100:
                    self._batteries[int(_number(fields, "id", 0))] = left / 100
            case "GLOBAL_POSITION_INT" if _number(fields, "lat", 0) or _number(fields, "lon", 0):
                self._global_s = time_s
            case "ESTIMATOR_STATUS" | "EKF_STATUS_REPORT":
                self._estimator = int(_number(fields, "flags", 0))
            case "STATUSTEXT" if _number(fields, "severity", 7) <= WARNING and not _number(fields, "chunk_seq", 0):
                self._status = str(fields.get("text", "")).strip("\0 ")
            case "GPS_GLOBAL_ORIGIN":
                latitude, longitude = _number(fields, "latitude", 0), _number(fields, "longitude", 0)
                self.origin = (latitude / 1e7, longitude / 1e7, _number(fields, "altitude", 0) / 1e3)
            case _:
                pass

    def seen(self, frame: LocalFrame, *, georeferenced: bool) -> Seen:
        """What is known now, on the map. ``georeferenced``: whether a global position is needed as well."""
        autopilot = self.autopilot or Autopilot.PX4
        mode, name = mode_of(autopilot, self._custom_mode)
        return Seen(
            message_s=self._message_s,
            heartbeat_s=self.heartbeat_s,
            heartbeat_every_s=self._every_s,
            position_s=self._position_s,
            position_m=frame.from_ned(self.ned_m or (0.0, 0.0, 0.0)),
            velocity_mps=frame.velocity_from_ned(self._velocity_ned),
            yaw_rad=frame.yaw_from_ned(self._heading_rad),
            tilt_rad=self._tilt_rad,
            position_known=self.knows_position,
            mode=mode,
            mode_name=name,
            start=self.start,
            armed=self._armed,
            on_ground=self._on_ground,
            not_ready=self._not_ready(georeferenced),
            status=self._status,
            battery=min(self._batteries.values(), default=None),
        )

    def _not_ready(self, georeferenced: bool) -> str:
        health = self.health
        if not self.knows_position:
            return "it has no local position"
        if georeferenced and not health.global_position:
            return "it has no global position"
        if georeferenced and not health.home:
            return "it has no home position"
        # PX4 tells only whether it may be armed in the mode that it is in.
        waits = self.start is Start.SET_POINTS and mode_of(Autopilot.PX4, self._custom_mode)[0] is not Mode.OURS
        return "" if health.armable or waits else "its own checks before arming do not pass"

    def _heartbeat(self, fields: Fields, time_s: float) -> None:
        firmware = AUTOPILOT_IDS.get(int(_number(fields, "autopilot", -1)))
        if firmware is None:
            return
        if self.autopilot is not None and self.heartbeat_s > 0:
            gap_s = time_s - self.heartbeat_s
            self._every_s += 0.3 * (min(gap_s, 1.5) - self._every_s)
        self.autopilot = firmware
        self.heartbeat_s = time_s
        self._custom_mode = int(_number(fields, "custom_mode", self._custom_mode))
        self._armed = bool(int(_number(fields, "base_mode", 0)) & ARMED_FLAG)

    def _position(self, fields: Fields, time_s: float) -> None:
        boot_ms = int(_number(fields, "time_boot_ms", -1))
        values = [_number(fields, key, math.nan) for key in ("x", "y", "z", "vx", "vy", "vz")]
        late = self._boot_ms - RESTARTED_MS < boot_ms <= self._boot_ms
        if late or not all(math.isfinite(value) for value in values):
            return
        x, y, z, vx, vy, vz = values
        self.positions += 1
        self._boot_ms, self._position_s = boot_ms, time_s
        self.ned_m, self._velocity_ned = (x, y, z), (vx, vy, vz)


def _number(fields: Fields, key: str, default: float) -> float:
    """A field as a number; the default where it is none."""
    value = fields.get(key)
    if isinstance(value, int | float) and math.isfinite(value):
        return float(value)
    return default
