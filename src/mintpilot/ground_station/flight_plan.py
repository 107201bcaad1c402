"""A flight plan on the earth: way-points with what is done there, a fence, and places to land at."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum

from mintpilot.core.errors import MapError, MissionError
from mintpilot.core.geometry import Box, Vec3
from mintpilot.core.georeference import GeodeticPoint, Georeference
from mintpilot.core.mission import Mission
from mintpilot.core.plan import Plan
from mintpilot.core.task import Action

STRAIGHT_RAD = 1e-3
"""A way-point at which the way turns by less than this is left out, radians."""


class ItemKind(StrEnum):
    """What a way-point is for."""

    TAKE_OFF = "take-off"
    WAYPOINT = "waypoint"
    """Flown through; with a stay where `Item.hold_s` is above 0."""
    GRAB = "grab"
    """The gripper closes."""
    RELEASE = "release"
    """The gripper opens."""
    HOVER = "hover"
    """Until somebody orders something else."""
    LAND = "land"
    RETURN = "return"
    """To the launch place, in a straight line."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Item:
    """One entry of a flight plan."""

    kind: ItemKind
    place: GeodeticPoint | None = None
    """Where; None where the command has no place. ``altitude_m`` is above the home place here, not above the sea."""
    hold_s: float = 0.0
    """Time spent there, seconds."""

    def __post_init__(self) -> None:
        if not (math.isfinite(self.hold_s) and self.hold_s >= 0):
            raise MissionError(f"hold_s = {self.hold_s}: must be finite and 0 or more")


@dataclass(frozen=True, slots=True, kw_only=True)
class FlightPlan:
    """What a ground station uploads."""

    home: GeodeticPoint
    """Launch place; its altitude is above mean sea level."""
    items: tuple[Item, ...]
    fence: tuple[tuple[float, float], ...] = ()
    """Corners (latitude, longitude), degrees, of what must not be left; empty: no fence."""
    rally: tuple[GeodeticPoint, ...] = ()
    """Places to land at; altitudes above home."""
    cruise_mps: float = 5.0


def flight_plan_of(plan: Plan, mission: Mission) -> FlightPlan:
    """A plan of MintPilot as a flight plan: take-off, the turning points of its way, and what is done at its stops.

    It ends hovering at the last stop: a straight way home may lead through walls.

    Args:
        plan: what is flown; its way keeps clear of everything by itself, so its turning points are kept as they are.
        mission: where it starts, its volume (the fence), and where the map lies on the earth.

    Raises:
        MapError: the mission has no georeference.
        MissionError: there is nothing to fly.
    """
    reference = mission.georeference
    if reference is None:
        raise MapError("the map has no place on the earth: give world.georeference in the mission file")
    if not plan.legs:
        raise MissionError("the plan has no legs; there is nothing to export")
    ground_m = mission.volume.lo_m[2]
    home = reference.geodetic((mission.start_m[0], mission.start_m[1], ground_m))
    items = [Item(kind=ItemKind.TAKE_OFF, place=_above(reference, mission.start_m, ground_m))]
    for leg in plan.legs:
        path: list[Vec3] = [(float(x), float(y), float(z)) for x, y, z in leg.path_m]
        turns = [
            here for before, here, after in zip(path, path[1:], path[2:], strict=False) if _turns(before, here, after)
        ]
        items += [Item(kind=ItemKind.WAYPOINT, place=_above(reference, place, ground_m)) for place in turns]
        items.append(Item(kind=ItemKind.WAYPOINT, place=_above(reference, path[-1], ground_m), hold_s=leg.stop.dwell_s))
        if leg.stop.action in _GRIPPER:
            items.append(Item(kind=_GRIPPER[leg.stop.action]))
    items.append(Item(kind=ItemKind.HOVER, place=items[-1].place or items[-2].place))
    return FlightPlan(
        home=home,
        items=tuple(items),
        fence=fence_of(reference, mission.volume),
        rally=(_above(reference, mission.start_m, ground_m),),
        cruise_mps=mission.limits.cruise_mps,
    )


def fence_of(reference: Georeference, volume: Box) -> tuple[tuple[float, float], ...]:
    """The volume's outline seen from above: corners (latitude, longitude), degrees, counter-clockwise."""
    (x0, y0, z), (x1, y1, _) = volume.lo_m, volume.hi_m
    corners = [reference.geodetic((x, y, z)) for x, y in ((x0, y0), (x1, y0), (x1, y1), (x0, y1))]
    return tuple((corner.latitude_deg, corner.longitude_deg) for corner in corners)


_GRIPPER = {Action.PICK: ItemKind.GRAB, Action.DELIVER: ItemKind.RELEASE}


def _above(reference: Georeference, place_m: Vec3, ground_m: float) -> GeodeticPoint:
    """A place with its altitude above the ground at home."""
    point = reference.geodetic(place_m)
    return GeodeticPoint(
        latitude_deg=point.latitude_deg, longitude_deg=point.longitude_deg, altitude_m=place_m[2] - ground_m
    )


def _turns(before: Vec3, here: Vec3, after: Vec3) -> bool:
    """Whether the way bends there."""
    into = [b - a for a, b in zip(before, here, strict=True)]
    out = [b - a for a, b in zip(here, after, strict=True)]
    sizes = math.hypot(*into) * math.hypot(*out)
    if sizes == 0:
        return False
    cosine = sum(a * b for a, b in zip(into, out, strict=True)) / sizes
    return math.acos(max(-1.0, min(1.0, cosine))) > STRAIGHT_RAD
