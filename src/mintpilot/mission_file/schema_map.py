"""From a `MapWorld` of a mission file to a semantic map."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from mintpilot.core.errors import InputError, MapError
from mintpilot.core.geometry import Box, Vec3
from mintpilot.core.observation import RegionKind
from mintpilot.core.semantic_map import Knowledge, MapObject, Region, Room, SemanticMap
from mintpilot.mapping.movingai import load_movingai
from mintpilot.mapping.occupancy import load_ros_map
from mintpilot.mapping.outline import cells_in_box, cells_in_polygon, regions_from_mask, within_fence
from mintpilot.mapping.reachable import cropped, in_part
from mintpilot.mission_file.schema import PriorsSpec
from mintpilot.mission_file.schema_base import attributes_of, in_english, place_of
from mintpilot.mission_file.schema_world import MapWorld, ObjectSpec, RegionSpec, RoomSpec

REACH_M = 3.0
"""Width of the rim kept around what can be reached on a large map, metres: things stand in it that are served from
inside."""
ROS_SUFFIXES = (".yaml", ".yml")
MOVINGAI_SUFFIXES = (".map", ".3dmap")


def is_flat(world: MapWorld) -> bool:
    """Whether the map has one layer, so that places may be given as [x, y]."""
    return not world.map.endswith(".3dmap")


def load_bare_map(world: MapWorld, base: Path) -> SemanticMap:
    """The map's cells, nothing on it yet; file names are relative to ``base``. Raises `MapError` and `LimitError`."""
    whole = _whole_map(world, base)
    return whole if world.fence is None else within_fence(whole, world.fence)


def _whole_map(world: MapWorld, base: Path) -> SemanticMap:
    path = base / world.map
    if path.suffix in ROS_SUFFIXES:
        return load_ros_map(path, height_m=world.height_m)
    if path.suffix in MOVINGAI_SUFFIXES:
        return load_movingai(path, resolution_m=world.resolution_m or 1.0, height_m=world.height_m)
    raise MapError(
        f"map '{world.map}' must end in .yaml (ROS map_server), .map or .3dmap (MovingAI); "
        "for a picture alone write a map_server YAML file beside it"
    )


def map_of(
    world: MapWorld,
    base: Path,
    priors: PriorsSpec,
    *,
    bare: SemanticMap | None = None,
    goals_m: Sequence[Vec3] = (),
    clearance_m: float = 0.0,
) -> SemanticMap:
    """The whole semantic map of that world: cells, regions, rooms and objects. Objects mark no cells yet.

    Args:
        world: what the mission file says.
        base: folder that file names are relative to.
        priors: for regions and rooms without their own.
        bare: the map's cells, if they were read already.
        goals_m: places that the mission leads to besides those on the map, metres.
        clearance_m: distance that the vehicle keeps from matter, metres.

    Raises:
        MapError: the map or a mask cannot be used, or a region has no cells.
        LimitError: the map is too large.
    """
    whole = bare or load_bare_map(world, base)
    objects = tuple(object_of(spec, world.height_m) for spec in world.objects)
    rooms = tuple(room_of(spec, world.height_m, priors) for spec in world.rooms)
    start = place_of(world.start_m, world.height_m)
    places = [start, *(o.position_m for o in objects), *(r.viewpoint_m for r in rooms), *goals_m]
    part = cropped(whole, places, spare_m=clearance_m + REACH_M)
    regions = (r for spec in world.regions for r in regions_of(spec, whole, base, priors, part=part))
    return replace(part, objects=objects, regions=tuple(regions), rooms=rooms)


def regions_of(
    spec: RegionSpec, bare: SemanticMap, base: Path, priors: PriorsSpec, *, part: SemanticMap | None = None
) -> tuple[Region, ...]:
    """The region that is declared; several for a mask with several areas.

    Args:
        spec: what the mission file says.
        bare: the map's cells.
        base: folder that the mask's name is relative to.
        priors: for a region without its own.
        part: the part of the map that is planned on; regions beside it are left out. None: all of it.

    Raises:
        MapError: it has no cells on the map.
    """
    frame = bare.frame if part is None else part.frame
    prior = priors.passable if spec.prior_passable is None else spec.prior_passable
    passable = knowledge(spec.passable)
    kind = RegionKind(spec.kind)
    if spec.mask is not None:
        found = regions_from_mask(
            bare, base / spec.mask, name=spec.id, description=in_english(spec.description), prior_passable=prior
        )
        if not found:
            raise MapError(f"mask '{spec.mask}' marks no cell that is not a wall; paint the areas black")
        found = found if part is None else tuple(r for r in (in_part(r, bare, part) for r in found) if r.cells.size)
        return tuple(replace(region, kind=kind, passable=passable) for region in found)
    if spec.polygon is not None:
        cells = cells_in_polygon(frame, spec.polygon, spec.heights_m)
    elif spec.box is not None:
        cells = cells_in_box(frame, spec.box.box())
    else:
        raise InputError(f"region '{spec.id}' has no outline; give box, polygon or mask")
    if not cells.size and part is not None:
        return () if part is not bare else regions_of(spec, bare, base, priors)
    if not cells.size:
        lo, hi = bare.frame.box.lo_m, bare.frame.box.hi_m
        raise MapError(
            f"region '{spec.id}' covers no cell of the map, which reaches from {_metres(lo)} to {_metres(hi)}; "
            "give an outline in the map's metres"
        )
    return (
        Region(
            id=spec.id,
            kind=kind,
            cells=cells,
            passable=passable,
            prior_passable=prior,
            description=in_english(spec.description),
        ),
    )


def room_of(spec: RoomSpec, layer_m: float, priors: PriorsSpec) -> Room:
    """The room that is declared."""
    return Room(
        id=spec.id,
        door_m=spec.door.box(),
        viewpoint_m=place_of(spec.viewpoint_m, layer_m),
        occupied=knowledge(spec.occupied),
        prior_occupied=priors.occupied if spec.prior_occupied is None else spec.prior_occupied,
        description=in_english(spec.description),
    )


def object_of(spec: ObjectSpec, layer_m: float) -> MapObject:
    """The object that is declared."""
    x, y, z = place_of(spec.position_m, layer_m)
    dx, dy, dz = (edge / 2 for edge in spec.size_m)
    return MapObject(
        id=spec.id,
        label=spec.label,
        box_m=Box(lo_m=(x - dx, y - dy, z - dz), hi_m=(x + dx, y + dy, z + dz)),
        attributes=attributes_of(spec.attributes),
        solid=spec.solid,
    )


def knowledge(fact: bool | None) -> Knowledge:
    """A fact that may be given, as knowledge."""
    return Knowledge.OPEN if fact is None else Knowledge.YES if fact else Knowledge.NO


def _metres(point: tuple[float, ...]) -> str:
    return "[" + ", ".join(f"{x:g}" for x in point) + "]"
