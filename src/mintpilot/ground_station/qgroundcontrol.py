"""QGroundControl's ``.plan``: JSON with mission, fence and rally places."""

from __future__ import annotations

import json
from typing import Annotated, Any, Final, Literal

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from mintpilot.core.errors import MissionError
from mintpilot.core.georeference import GeodeticPoint
from mintpilot.ground_station.commands import Parameters, command_of, item_of
from mintpilot.ground_station.flight_plan import FlightPlan

FIRMWARE: Final = {"px4": 12, "ardupilot": 3}
MULTIROTOR: Final = 2
Firmware = Literal["px4", "ardupilot"]


class _Part(BaseModel):
    model_config = ConfigDict(extra="ignore", frozen=True, allow_inf_nan=False, defer_build=True)


class _SimpleItem(_Part):
    type: Literal["SimpleItem"]
    command: int
    frame: int
    params: Annotated[list[float | None], Field(min_length=7, max_length=7)]


class _Mission(_Part):
    cruiseSpeed: float = 5.0  # noqa: N815 - the file's own names
    plannedHomePosition: tuple[float, float, float]  # noqa: N815
    items: list[dict[str, Any]]


class _Polygon(_Part):
    inclusion: bool = True
    polygon: Annotated[list[tuple[float, float]], Field(min_length=3)]


class _Fence(_Part):
    polygons: list[_Polygon] = []
    circles: list[dict[str, Any]] = []


class _Rally(_Part):
    points: list[tuple[float, float, float]] = []


class _Plan(_Part):
    fileType: Literal["Plan"]  # noqa: N815
    mission: _Mission
    geoFence: _Fence  # noqa: N815
    rallyPoints: _Rally  # noqa: N815


def plan_text(plan: FlightPlan, firmware: Firmware = "px4") -> str:
    """The ``.plan`` file of a flight plan."""
    items = []
    for number, item in enumerate(plan.items, start=1):
        command, frame, parameters = command_of(item)
        items.append(
            {
                "AMSLAltAboveTerrain": None,
                "Altitude": parameters[6],
                "AltitudeMode": 1,
                "autoContinue": True,
                "command": command,
                "doJumpId": number,
                "frame": frame,
                "params": list(parameters),
                "type": "SimpleItem",
            }
        )
    fence = [{"inclusion": True, "polygon": [list(corner) for corner in plan.fence], "version": 1}]
    document = {
        "fileType": "Plan",
        "version": 1,
        "groundStation": "QGroundControl",
        "mission": {
            "version": 2,
            "firmwareType": FIRMWARE[firmware],
            "vehicleType": MULTIROTOR,
            "cruiseSpeed": plan.cruise_mps,
            "hoverSpeed": plan.cruise_mps,
            "globalPlanAltitudeMode": 1,
            "plannedHomePosition": [plan.home.latitude_deg, plan.home.longitude_deg, plan.home.altitude_m],
            "items": items,
        },
        "geoFence": {"version": 2, "circles": [], "polygons": fence if plan.fence else []},
        "rallyPoints": {
            "version": 2,
            "points": [[place.latitude_deg, place.longitude_deg, place.altitude_m] for place in plan.rally],
        },
    }
    return json.dumps(document, indent=2) + "\n"


def read_plan(text: str, name: str) -> FlightPlan:
    """The flight plan in a ``.plan`` file.

    Args:
        text: its contents.
        name: names it in errors.

    Raises:
        MissionError: it is not such a file, or has something that MintPilot cannot fly: it is named.
    """
    try:
        plan = _Plan.model_validate(json.loads(text))
    except (ValueError, RecursionError) as error:
        if isinstance(error, ValidationError):
            first = error.errors(include_url=False)[0]
            place = ".".join(str(step) for step in first["loc"])
            raise MissionError(f"{name}: {place}: {first['msg']}; write it with QGroundControl again") from error
        raise MissionError(f"{name} is no JSON ({str(error) or 'nested too deeply'}); a .plan file is") from error
    if plan.geoFence.circles or any(not polygon.inclusion for polygon in plan.geoFence.polygons):
        raise MissionError(f"{name}: circular and exclusion fences are not read; draw one inclusion polygon")
    if len(plan.geoFence.polygons) > 1:
        raise MissionError(f"{name}: {len(plan.geoFence.polygons)} fences; draw one inclusion polygon")
    items = []
    for number, raw in enumerate(plan.mission.items, start=1):
        where = f"{name}: item {number}"
        if raw.get("type") != "SimpleItem":
            raise MissionError(f"{where}: '{raw.get('complexItemType', raw.get('type'))}' is not read; use way-points")
        try:
            simple = _SimpleItem.model_validate(raw)
        except ValidationError as error:
            first = error.errors(include_url=False)[0]
            raise MissionError(f"{where}: {'.'.join(map(str, first['loc']))}: {first['msg']}") from error
        a, b, c, d, e, f, g = (0.0 if value is None else value for value in simple.params)
        parameters: Parameters = (a, b, c, d, e, f, g)
        item = item_of(simple.command, simple.frame, parameters, where)
        if item is not None:
            items.append(item)
    latitude, longitude, altitude = plan.mission.plannedHomePosition
    return FlightPlan(
        home=GeodeticPoint(latitude_deg=latitude, longitude_deg=longitude, altitude_m=altitude),
        items=tuple(items),
        fence=tuple(plan.geoFence.polygons[0].polygon) if plan.geoFence.polygons else (),
        rally=tuple(
            GeodeticPoint(latitude_deg=lat, longitude_deg=lon, altitude_m=alt)
            for lat, lon, alt in plan.rallyPoints.points
        ),
        cruise_mps=plan.mission.cruiseSpeed,
    )
