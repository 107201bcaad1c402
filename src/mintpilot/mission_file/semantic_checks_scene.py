"""Contradictions in an explicit scene."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from mintpilot.core.errors import MapError
from mintpilot.core.geometry import Box, Vec3
from mintpilot.mission_file.form_checks import nearest, show
from mintpilot.mission_file.schema_base import BoxSpec
from mintpilot.mission_file.schema_scene import SceneSpec
from mintpilot.mission_file.yaml_places import Fault, Path_

_ROOT: Path_ = ("world", "scene")


def box_fault(spec: BoxSpec, path: Path_) -> Iterator[Fault]:
    """Whether the corners of a box are on the right sides."""
    for axis, (low, high) in enumerate(zip(spec.lo_m, spec.hi_m, strict=True)):
        if not low <= high:
            message = f"{high:g} is below {low:g}, that of lo_m; swap them"
            yield Fault(path=(*path, "hi_m", axis), line=None, message=message)


def repeated_ids(ids: Iterable[tuple[str, Path_]]) -> Iterator[Fault]:
    """Ids that were given before."""
    seen: dict[str, Path_] = {}
    for name, path in ids:
        if name in seen:
            where = "".join(f"[{x}]" if isinstance(x, int) else f".{x}" for x in seen[name]).lstrip(".")
            message = f"'{name}' is the id of {where} already; each id is given once"
            yield Fault(path=(*path, "id"), line=None, message=message)
        seen.setdefault(name, path)


def scene_faults(scene: SceneSpec) -> Iterator[Fault]:
    """Every contradiction in that scene."""
    bad = list(_box_faults(scene))
    yield from bad
    yield from repeated_ids(_ids(scene))
    solids = [solid.id for solid in scene.solids]
    for index, name in enumerate(scene.goal_objects):
        if name not in solids:
            message = f"there is no solid '{name}'; {nearest(name, solids)}"
            yield Fault(path=(*_ROOT, "goal_objects", index), line=None, message=message)
    if not bad:
        yield from _place_faults(scene)


def _box_faults(scene: SceneSpec) -> Iterator[Fault]:
    yield from box_fault(scene.volume, (*_ROOT, "volume"))
    for index, solid in enumerate(scene.solids):
        yield from box_fault(solid.extent_m, (*_ROOT, "solids", index, "extent_m"))
    for index, smoke in enumerate(scene.smokes):
        yield from box_fault(smoke.extent_m, (*_ROOT, "smokes", index, "extent_m"))
    for index, room in enumerate(scene.rooms):
        yield from box_fault(room.extent_m, (*_ROOT, "rooms", index, "extent_m"))
        yield from box_fault(room.door_m, (*_ROOT, "rooms", index, "door_m"))


def _ids(scene: SceneSpec) -> Iterator[tuple[str, Path_]]:
    for key in ("solids", "smokes", "rooms", "persons"):
        for index, thing in enumerate(getattr(scene, key)):
            yield thing.id, (*_ROOT, key, index)
    for index, room in enumerate(scene.rooms):
        if room.occupant is not None:
            yield room.occupant.id, (*_ROOT, "rooms", index, "occupant")


def _place_faults(scene: SceneSpec) -> Iterator[Fault]:
    """Places outside the volume, and a start inside something. Needs boxes in order."""
    volume = scene.volume.box()
    if min(volume.size_m) <= 0:
        message = f"{show(list(volume.size_m))} m is no space to fly in; give a volume larger than 0 along each axis"
        yield Fault(path=(*_ROOT, "volume"), line=None, message=message)
        return
    yield from _outside(volume, scene.start_m, (*_ROOT, "start_m"))
    for solid in scene.solids:
        if solid.appears_s == 0 and _inside(solid.extent_m, scene.start_m):
            message = f"{show(list(scene.start_m))} is inside '{solid.id}'; start in free space"
            yield Fault(path=(*_ROOT, "start_m"), line=None, message=message)
    for index, person in enumerate(scene.persons):
        yield from _outside(volume, person.position_m, (*_ROOT, "persons", index, "position_m"))
    for index, room in enumerate(scene.rooms):
        path: Path_ = (*_ROOT, "rooms", index)
        yield from _outside(volume, room.viewpoint_m, (*path, "viewpoint_m"))
        if room.occupant is not None and not _inside(room.extent_m, room.occupant.position_m):
            message = f"{show(list(room.occupant.position_m))} is not inside the room; move the occupant into it"
            yield Fault(path=(*path, "occupant", "position_m"), line=None, message=message)


def _outside(volume: Box, point: Vec3, path: Path_) -> Iterator[Fault]:
    if not volume.contains(point)[0]:
        lo, hi = show(list(volume.lo_m)), show(list(volume.hi_m))
        message = f"{show(list(point))} is outside the volume, {lo} to {hi}; give a place inside"
        yield Fault(path=path, line=None, message=message)


def _inside(spec: BoxSpec, point: Vec3) -> bool:
    try:
        return bool(spec.box().contains(point)[0])
    except MapError:
        return False
