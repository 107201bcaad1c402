"""Way-points and fence of a ground station's flight plan, as goals and fence of a mission file."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Final

from pydantic import ValidationError

from mintpilot.core.errors import MapError, MissionError
from mintpilot.core.georeference import GeodeticPoint, Georeference
from mintpilot.ground_station.flight_plan import FlightPlan, ItemKind
from mintpilot.ground_station.qgroundcontrol import read_plan
from mintpilot.ground_station.waypoints import read_waypoints
from mintpilot.mission_file.geodetic_places import georeference_of
from mintpilot.mission_file.schema_world import GeoreferenceSpec
from mintpilot.mission_file.yaml_places import Fault

KEY: Final = "flight_plan"
SUFFIXES: Final = (".plan", ".waypoints", ".wpl")
MAX_BYTES: Final = 5_000_000
_STOPS: Final = (ItemKind.WAYPOINT, ItemKind.HOVER, ItemKind.LAND)


def read_flight_plan(path: Path) -> FlightPlan:
    """The flight plan in that file.

    Raises:
        MissionError: it cannot be read, or is none.
    """
    try:
        if path.stat().st_size > MAX_BYTES:
            raise MissionError(f"{path} has more than {MAX_BYTES:,} bytes; it is no flight plan")
        text = path.read_text(encoding="utf-8")
    except OSError as error:
        raise MissionError(f"cannot read {path}: {error.strerror}; give a .plan or .waypoints file") from error
    except UnicodeDecodeError as error:
        raise MissionError(f"{path} is no text; give a .plan or .waypoints file") from error
    return read_plan(text, path.name) if path.suffix == ".plan" else read_waypoints(text, path.name)


def refused_as_mission(path: Path) -> Fault:
    """What to say of a flight plan that is given as a mission: it has no map, so nothing in it is known to be free."""
    try:
        plan = read_flight_plan(path)
    except MissionError as error:
        return Fault(path=(), line=1, message=str(error))
    stops = sum(item.kind in _STOPS for item in plan.items)
    fence = f"a fence of {len(plan.fence)} corners" if plan.fence else "no fence"
    message = (
        f"this is a flight plan of a ground station with {stops} way-points and {fence}; it has no map, so nothing is "
        f"known to be free. Write a mission file with a map, its georeference, and '{KEY}: {path.name}'"
    )
    return Fault(path=(), line=1, message=message)


def with_plan_stops(value: dict[str, Any], base: Path) -> tuple[dict[str, Any], list[Fault]]:
    """The contents of a mission file with the goals and the fence of the flight plan that it names.

    Args:
        value: the file as YAML gives it.
        base: folder that the plan's name is relative to.

    Returns:
        The same with ``goals`` and ``world.fence``, and what stands against it.
    """
    name, world = value.get(KEY), value.get("world")
    if not isinstance(name, str) or not isinstance(world, dict):
        return value, []
    try:
        reference = _georeference(world)
        if "goals" in value:
            raise MissionError(f"'goals' and '{KEY}' both say where to fly; remove one of them")
        plan = read_flight_plan(base / name)
        goals = _goals(plan, reference, flat=not str(world["map"]).endswith(".3dmap"))
        fence = [list(_local(reference, latitude, longitude, 0.0)[:2]) for latitude, longitude in plan.fence]
        if fence and "fence" in world:
            raise MissionError(f"'world.fence' and {name} both have a fence; remove one of them")
    except (MissionError, MapError) as error:
        return value, [Fault(path=(KEY,), line=None, message=str(error))]
    return {**value, "goals": goals, "world": {**world, **({"fence": fence} if fence else {})}}, []


def _georeference(world: dict[str, Any]) -> Georeference:
    if "map" not in world:
        raise MissionError("a flight plan needs a world with a 'map'")
    try:
        return georeference_of(GeoreferenceSpec.model_validate(world.get("georeference")))
    except ValidationError as error:
        raise MissionError("a flight plan needs world.georeference: where the map lies on the earth") from error


def _goals(plan: FlightPlan, reference: Georeference, *, flat: bool) -> list[dict[str, Any]]:
    goals: list[dict[str, Any]] = []
    for number, item in enumerate(plan.items, start=1):
        if item.kind in (ItemKind.GRAB, ItemKind.RELEASE):
            raise MissionError(
                f"item {number} is a gripper command; say in 'goals' what is picked up and brought where"
            )
        if item.kind is ItemKind.RETURN:
            place = _local(reference, plan.home.latitude_deg, plan.home.longitude_deg, plan.home.altitude_m)
            goals.append({"action": "go", "position_m": list(place[:2])})
        elif item.kind in _STOPS and item.place is not None:
            altitude_m = plan.home.altitude_m + item.place.altitude_m
            place = _local(reference, item.place.latitude_deg, item.place.longitude_deg, altitude_m)
            position = [*place[:2]] if flat else [*place]
            goals.append({"action": "go", "position_m": position, "dwell_s": item.hold_s})
    if not goals:
        raise MissionError("the flight plan has no way-points; there is nowhere to fly to")
    return goals


def _local(reference: Georeference, latitude: float, longitude: float, altitude_m: float) -> tuple[float, float, float]:
    return reference.local(GeodeticPoint(latitude_deg=latitude, longitude_deg=longitude, altitude_m=altitude_m))
