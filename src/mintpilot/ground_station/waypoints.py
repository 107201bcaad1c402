"""``QGC WPL 110``: the way-point lists of Mission Planner, MAVProxy and QGroundControl."""

from __future__ import annotations

import math
from typing import Final

from mintpilot.core.errors import MissionError
from mintpilot.core.georeference import GeodeticPoint
from mintpilot.ground_station.commands import WAYPOINT, Parameters, command_of, item_of
from mintpilot.ground_station.flight_plan import FlightPlan

HEAD: Final = "QGC WPL 110"
COLUMNS: Final = 12


def waypoints_text(plan: FlightPlan) -> str:
    """The way-point list of a flight plan: the home place first. It has no fence and no rally places."""
    home = (0.0, 0.0, 0.0, 0.0, plan.home.latitude_deg, plan.home.longitude_deg, plan.home.altitude_m)
    lines = [HEAD, _line(0, 1, 0, WAYPOINT, home)]
    for number, item in enumerate(plan.items, start=1):
        command, frame, parameters = command_of(item)
        lines.append(_line(number, 0, frame, command, parameters))
    return "\n".join(lines) + "\n"


def read_waypoints(text: str, name: str) -> FlightPlan:
    """The flight plan in a way-point list.

    Raises:
        MissionError: it is not such a list, or has something that MintPilot cannot fly: it is named.
    """
    lines = text.splitlines()
    if not lines or lines[0].strip() != HEAD:
        raise MissionError(f"{name} does not begin with '{HEAD}'; it is no way-point list")
    rows = [(n, line.split()) for n, line in enumerate(lines[1:], start=2) if line.strip()]
    if not rows:
        raise MissionError(f"{name} has no way-points; its first one is the home place")
    items = []
    for number, words in rows:
        where = f"{name}:{number}"
        if len(words) != COLUMNS:
            raise MissionError(f"{where}: {len(words)} columns; a way-point has {COLUMNS}")
        try:
            frame, command = int(words[2]), int(words[3])
            a, b, c, d, e, f, g = (float(word) for word in words[4:11])
        except ValueError as error:
            raise MissionError(f"{where}: {error}; every column is a number") from error
        parameters: Parameters = (a, b, c, d, e, f, g)
        if not all(math.isfinite(value) for value in parameters):
            raise MissionError(f"{where}: every number must be finite")
        if number == rows[0][0]:
            home = GeodeticPoint(latitude_deg=e, longitude_deg=f, altitude_m=g)
            continue
        item = item_of(command, frame, parameters, where)
        if item is not None:
            items.append(item)
    return FlightPlan(home=home, items=tuple(items))


def _line(number: int, current: int, frame: int, command: int, parameters: Parameters) -> str:
    seven = (*(f"{value:.6f}" for value in parameters[:4]), *(f"{value:.8f}" for value in parameters[4:6]))
    return "\t".join((str(number), str(current), str(frame), str(command), *seven, f"{parameters[6]:.6f}", "1"))
