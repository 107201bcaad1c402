"""MAVLink mission commands of the items that flight plans are made of."""

from __future__ import annotations

from typing import Final

from mintpilot.core.errors import MissionError
from mintpilot.core.georeference import GeodeticPoint
from mintpilot.ground_station.flight_plan import Item, ItemKind

TAKE_OFF: Final = 22
WAYPOINT: Final = 16
HOVER: Final = 17
LOITER_TIME: Final = 19
RETURN: Final = 20
LAND: Final = 21
GRIPPER: Final = 211
RELEASE, GRAB = 0.0, 1.0
"""Second parameter of `GRIPPER`."""
NO_EFFECT: Final = {178: "change speed", 206: "camera trigger", 2000: "take pictures", 2001: "stop taking pictures"}
"""Commands that change nothing about where is flown; they are left out when a plan is read."""
ACCEPTANCE_M: Final = 0.1
"""A way-point counts as reached within this distance, metres: a corner that is cut may lead through a wall."""
RELATIVE_ALTITUDE: Final = 3
"""MAV_FRAME_GLOBAL_RELATIVE_ALT."""
MISSION_FRAME: Final = 2
"""MAV_FRAME_MISSION: the command has no place."""
READ_FRAMES: Final = (3, 6)
"""Frames whose altitude is above home."""
Parameters = tuple[float, float, float, float, float, float, float]


def command_of(item: Item) -> tuple[int, int, Parameters]:
    """Command, frame, and the seven parameters (the last three: latitude, longitude, altitude above home)."""
    at = (0.0, 0.0, 0.0)
    if item.place is not None:
        at = (item.place.latitude_deg, item.place.longitude_deg, item.place.altitude_m)
    frame = RELATIVE_ALTITUDE if item.place is not None else MISSION_FRAME
    match item.kind:
        case ItemKind.TAKE_OFF:
            return TAKE_OFF, frame, (0.0, 0.0, 0.0, 0.0, *at)
        case ItemKind.WAYPOINT:
            return WAYPOINT, frame, (item.hold_s, ACCEPTANCE_M, 0.0, 0.0, *at)
        case ItemKind.HOVER:
            return HOVER, frame, (0.0, 0.0, 0.0, 0.0, *at)
        case ItemKind.LAND:
            return LAND, frame, (0.0, 0.0, 0.0, 0.0, *at)
        case ItemKind.RETURN:
            return RETURN, frame, (0.0, 0.0, 0.0, 0.0, *at)
        case ItemKind.GRAB | ItemKind.RELEASE:
            action = GRAB if item.kind is ItemKind.GRAB else RELEASE
            return GRIPPER, frame, (1.0, action, 0.0, 0.0, 0.0, 0.0, 0.0)


def item_of(command: int, frame: int, parameters: Parameters, where: str) -> Item | None:
    """The item of a command; None for one that changes nothing about where is flown.

    Args:
        command: number of the MAVLink command.
        frame: number of the MAVLink frame.
        parameters: its seven parameters.
        where: names the entry in errors.

    Raises:
        MissionError: the command, its frame or a number cannot be flown by MintPilot.
    """
    if command in NO_EFFECT:
        return None
    if command == GRIPPER:
        return Item(kind=ItemKind.GRAB if parameters[1] == GRAB else ItemKind.RELEASE)
    if command == RETURN:
        return Item(kind=ItemKind.RETURN)
    kinds = {
        TAKE_OFF: ItemKind.TAKE_OFF,
        WAYPOINT: ItemKind.WAYPOINT,
        LOITER_TIME: ItemKind.WAYPOINT,
        HOVER: ItemKind.HOVER,
        LAND: ItemKind.LAND,
    }
    if command not in kinds:
        known = ", ".join(str(number) for number in sorted((*kinds, RETURN, GRIPPER, *NO_EFFECT)))
        raise MissionError(f"{where}: MAVLink command {command} is not read; those that are: {known}")
    if frame not in READ_FRAMES:
        raise MissionError(f"{where}: frame {frame}: altitudes must be above home (frame 3 or 6)")
    latitude, longitude, altitude = parameters[4:]
    if not (abs(latitude) <= 90 and abs(longitude) <= 180 and abs(altitude) < 1e5):
        raise MissionError(f"{where}: latitude {latitude}, longitude {longitude}, altitude {altitude}: no such place")
    place = GeodeticPoint(latitude_deg=latitude, longitude_deg=longitude, altitude_m=altitude)
    hold_s = parameters[0] if command in (WAYPOINT, LOITER_TIME) else 0.0
    return Item(kind=kinds[command], place=place, hold_s=max(0.0, hold_s))
