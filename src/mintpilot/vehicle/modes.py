"""The flight modes of PX4 and ArduPilot's copters, from the custom mode of their heartbeat."""

from __future__ import annotations

from enum import StrEnum

from mintpilot.vehicle.signals import Mode


class Autopilot(StrEnum):
    """Which firmware flies."""

    PX4 = "px4"
    ARDUPILOT = "ardupilot"


AUTOPILOT_IDS = {3: Autopilot.ARDUPILOT, 12: Autopilot.PX4}
"""`autopilot` of a heartbeat → firmware."""

PX4_AUTO = 4
STANDING_BY: dict[Autopilot, tuple[int, int]] = {Autopilot.PX4: (PX4_AUTO, 3), Autopilot.ARDUPILOT: (4, 0)}
"""Main and sub mode in which it is armed: Hold, GUIDED."""
_PX4_MAIN = {
    1: "MANUAL",
    2: "ALTCTL",
    3: "POSCTL",
    4: "AUTO",
    5: "ACRO",
    6: "OFFBOARD",
    7: "STABILIZED",
    8: "RATTITUDE",
}
_PX4_SUB = {1: "READY", 2: "TAKEOFF", 3: "LOITER", 4: "MISSION", 5: "RTL", 6: "LAND", 8: "FOLLOW", 9: "PRECLAND"}
_PX4 = {
    "OFFBOARD": Mode.OURS,
    "AUTO.TAKEOFF": Mode.TAKE_OFF,
    "AUTO.LOITER": Mode.HOLD,
    "AUTO.LAND": Mode.LAND,
    "AUTO.RTL": Mode.RETURN,
}
_COPTER = {
    0: "STABILIZE", 1: "ACRO", 2: "ALT_HOLD", 3: "AUTO", 4: "GUIDED", 5: "LOITER", 6: "RTL", 7: "CIRCLE", 9: "LAND",
    11: "DRIFT", 13: "SPORT", 14: "FLIP", 15: "AUTOTUNE", 16: "POSHOLD", 17: "BRAKE", 18: "THROW", 19: "AVOID_ADSB",
    20: "GUIDED_NOGPS", 21: "SMART_RTL", 22: "FLOWHOLD", 23: "FOLLOW", 24: "ZIGZAG", 27: "AUTO_RTL",
}  # fmt: skip
_ARDUPILOT = {
    "GUIDED": Mode.OURS,
    "LOITER": Mode.HOLD,
    "BRAKE": Mode.HOLD,
    "LAND": Mode.LAND,
    "RTL": Mode.RETURN,
    "SMART_RTL": Mode.RETURN,
    "AUTO_RTL": Mode.RETURN,
}


def mode_of(autopilot: Autopilot, custom_mode: int) -> tuple[Mode, str]:
    """What kind of mode that is, and what its firmware calls it."""
    if autopilot is Autopilot.PX4:
        main, sub = custom_mode >> 16 & 0xFF, custom_mode >> 24 & 0xFF
        name = _PX4_MAIN.get(main, f"mode {main}")
        if main == PX4_AUTO:
            name = f"AUTO.{_PX4_SUB.get(sub, sub)}"
        return _PX4.get(name, Mode.OTHER), name
    name = _COPTER.get(custom_mode, f"mode {custom_mode}")
    return _ARDUPILOT.get(name, Mode.OTHER), name
