"""Contradictions between a mission and the map that it is flown on."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

from mintpilot.core.errors import MintPilotError
from mintpilot.core.semantic_map import Cell, SemanticMap
from mintpilot.mapping.listed_objects import with_solid_objects
from mintpilot.mission_file.form_checks import show
from mintpilot.mission_file.schema import MissionFile
from mintpilot.mission_file.schema_base import place_of
from mintpilot.mission_file.schema_core import limits_of
from mintpilot.mission_file.schema_map import ROS_SUFFIXES, is_flat, load_bare_map, object_of, regions_of
from mintpilot.mission_file.schema_world import MapWorld, RegionSpec, RoomSpec
from mintpilot.mission_file.semantic_checks_scene import box_fault, repeated_ids
from mintpilot.mission_file.yaml_places import Fault, Path_
from mintpilot.planning.clearance import TOLERANCE_M, surroundings


def map_faults(mission: MissionFile, world: MapWorld, base: Path) -> Iterator[Fault]:
    """Every contradiction; loads the map."""
    if world.resolution_m is not None and world.map.endswith(ROS_SUFFIXES):
        yield _fault(("world", "resolution_m"), "a ROS map names its own resolution; remove this one")
    yield from repeated_ids(
        (thing.id, ("world", key, i))
        for key in ("regions", "rooms", "objects")
        for i, thing in enumerate(getattr(world, key))
    )
    for index, room in enumerate(world.rooms):
        yield from _room_faults(room, ("world", "rooms", index))
    for index, thing in enumerate(world.objects):
        for axis, edge in enumerate(thing.size_m):
            if edge < 0:
                yield _fault(("world", "objects", index, "size_m", axis), f"{edge:g} must not be below 0")
    shapes = [list(_region_faults(r, ("world", "regions", i))) for i, r in enumerate(world.regions)]
    yield from (fault for faults in shapes for fault in faults)
    try:
        bare = load_bare_map(world, base)
    except MintPilotError as error:
        yield _fault(("world", "map"), str(error))
        return
    faults = list(_place_faults(mission, world, bare))
    yield from faults
    sized = [thing for thing in world.objects if min(thing.size_m) >= 0]
    if not any(fault.path[:2] == ("world", "start_m") for fault in faults):
        objects = tuple(object_of(spec, world.height_m) for spec in sized)
        yield from _start_faults(mission, world, replace(bare, objects=objects))
    for index, (spec, faults) in enumerate(zip(world.regions, shapes, strict=True)):
        if not faults:
            yield from _coverage_faults(mission, spec, bare, base, ("world", "regions", index))


def _start_faults(mission: MissionFile, world: MapWorld, bare: SemanticMap) -> Iterator[Fault]:
    """Whether the vehicle's body fits where it starts, among walls and solid objects."""
    limits = limits_of(mission)
    start = place_of(world.start_m, world.height_m)
    filled = with_solid_objects(bare, limits.radius_m)
    near = surroundings(filled, [start], limits.radius_m)
    gap_m = near.gap_at(start) * bare.frame.resolution_m
    if gap_m < limits.radius_m - TOLERANCE_M:
        what = "something occupied or unknown"
        if near.gap_at(start) < surroundings(bare, [start], limits.radius_m).gap_at(start):
            what = "an object"
        yield _fault(
            ("world", "start_m"),
            f"{show(list(world.start_m))} is {gap_m:.2f} m from {what}, nearer than the vehicle's radius of "
            f"{limits.radius_m:g} m; start further away",
        )


def _fault(path: Path_, message: str) -> Fault:
    return Fault(path=path, line=None, message=message)


def _region_faults(region: RegionSpec, path: Path_) -> Iterator[Fault]:
    ways = [key for key in ("box", "polygon", "mask") if getattr(region, key) is not None]
    if len(ways) != 1:
        given = " and ".join(ways) or "none"
        yield _fault(path, f"its outline must be exactly one of box, polygon and mask, not {given}")
    if region.box is not None:
        yield from box_fault(region.box, (*path, "box"))
    if region.heights_m is not None:
        low, high = region.heights_m
        if region.polygon is None:
            yield _fault((*path, "heights_m"), "heights go with a polygon only; a box has its own, remove them")
        elif not low < high:
            yield _fault((*path, "heights_m"), f"[{low:g}, {high:g}] must rise: lowest height first")
    if region.passable is not None and region.truth is not None and region.passable != (region.truth == "passable"):
        fact = str(region.passable).lower()
        yield _fault(
            (*path, "truth"), f"'{region.truth}' contradicts the known fact 'passable: {fact}'; keep one of them"
        )


def _room_faults(room: RoomSpec, path: Path_) -> Iterator[Fault]:
    yield from box_fault(room.door, (*path, "door"))
    if room.occupied is not None and room.truth is not None and room.occupied != (room.truth == "present"):
        fact = str(room.occupied).lower()
        yield _fault(
            (*path, "truth"), f"'{room.truth}' contradicts the known fact 'occupied: {fact}'; keep one of them"
        )


def _coverage_faults(
    mission: MissionFile, spec: RegionSpec, bare: SemanticMap, base: Path, path: Path_
) -> Iterator[Fault]:
    way = "mask" if spec.mask is not None else "polygon" if spec.polygon is not None else "box"
    try:
        regions_of(spec, bare, base, mission.priors)
    except MintPilotError as error:
        yield _fault((*path, way), str(error))


def _places(mission: MissionFile, world: MapWorld) -> Iterator[tuple[tuple[float, ...], Path_, bool]]:
    """Every place that is given, where, and whether the drone itself must be able to be there."""
    yield world.start_m, ("world", "start_m"), True
    for index, room in enumerate(world.rooms):
        yield room.viewpoint_m, ("world", "rooms", index, "viewpoint_m"), True
    for index, thing in enumerate(world.objects):
        yield thing.position_m, ("world", "objects", index, "position_m"), False
    for index, look in enumerate(mission.looks):
        yield look.viewpoint_m, ("looks", index, "viewpoint_m"), True
    for index, goal in enumerate(mission.goals or ()):
        if goal.position_m is not None:
            yield goal.position_m, ("goals", index, "position_m"), False


def _place_faults(mission: MissionFile, world: MapWorld, bare: SemanticMap) -> Iterator[Fault]:
    flat = is_flat(world)
    box = bare.frame.box
    for place, path, flown in _places(mission, world):
        if len(place) == 2 and not flat:
            yield _fault(path, f"{show(list(place))}: a voxel map needs three numbers [x, y, z]")
            continue
        x, y, z = place_of(place, world.height_m)
        # On a flat map things may stand below or above its one layer; the drone is always in it.
        cell = bare.frame.cells_of((x, y, world.height_m if flat else z))
        if not bare.frame.contains(cell)[0]:
            lo, hi = show([round(v, 3) for v in box.lo_m]), show([round(v, 3) for v in box.hi_m])
            yield _fault(
                path, f"{show(list(place))} is outside the map, which reaches from {lo} to {hi}; use its metres"
            )
            continue
        state = Cell(int(bare.cells[tuple(cell[0])]))
        if flown and state is not Cell.FREE:
            what = "occupied" if state is Cell.OCCUPIED else "unknown"
            yield _fault(path, f"{show(list(place))} is in an {what} cell; give a place that the map shows free")
