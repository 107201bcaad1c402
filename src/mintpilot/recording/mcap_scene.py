"""Foxglove's messages of maps, poses, paths, pictures and words. World frame ``map``: x east, y north, z up, metres."""

from __future__ import annotations

import math
from typing import Any, Final

import numpy as np
from foxglove_schemas_protobuf.CompressedImage_pb2 import CompressedImage
from foxglove_schemas_protobuf.FrameTransform_pb2 import FrameTransform
from foxglove_schemas_protobuf.Grid_pb2 import Grid
from foxglove_schemas_protobuf.Log_pb2 import Log
from foxglove_schemas_protobuf.PackedElementField_pb2 import PackedElementField
from foxglove_schemas_protobuf.PosesInFrame_pb2 import PosesInFrame
from foxglove_schemas_protobuf.SceneUpdate_pb2 import SceneUpdate
from google.protobuf.descriptor import FileDescriptor
from google.protobuf.descriptor_pb2 import FileDescriptorSet

from mintpilot.core.geometry import Box, Floats
from mintpilot.core.semantic_map import Cell, Knowledge, Region, SemanticMap
from mintpilot.core.trajectory import VehicleState

WORLD: Final = "map"
BODY: Final = "drone"
_COLOURS: Final = {
    Knowledge.OPEN: (0.95, 0.75, 0.1, 0.45),
    Knowledge.YES: (0.2, 0.7, 0.3, 0.35),
    Knowledge.NO: (0.85, 0.15, 0.15, 0.45),
}
_THING: Final = (0.3, 0.5, 0.9, 0.9)
_DOOR: Final = (0.55, 0.35, 0.2, 0.8)


def map_message(map: SemanticMap, stamp_ns: int) -> Any:
    """Objects, regions (by what is known of them) and doors as boxes with their names."""
    update = SceneUpdate()
    for thing in map.objects:
        _add_box(update, thing.id, thing.box_m, thing.label, _THING, stamp_ns)
    for region in map.regions:
        text = f"{region.description or region.id}: {region.passable.value}"
        _add_box(update, region.id, _box_of(map, region), text, _COLOURS[region.passable], stamp_ns)
    for room in map.rooms:
        _add_box(update, room.id, room.door_m, room.description or room.id, _DOOR, stamp_ns)
    return update


def grid_message(map: SemanticMap, stamp_ns: int) -> Any:
    """The lattice seen from above: 100 where a column holds something occupied, 0 where it is free, 50 unknown."""
    occupied = (map.cells == Cell.OCCUPIED).any(axis=0)
    free = (map.cells == Cell.FREE).any(axis=0)
    column = np.where(occupied, 100, np.where(free, 0, 50)).astype(np.uint8)
    edge, origin = map.frame.resolution_m, map.frame.origin_m
    grid = Grid(
        frame_id=WORLD, column_count=column.shape[1], row_stride=column.shape[1], cell_stride=1, data=column.tobytes()
    )
    _stamp(grid.timestamp, stamp_ns)
    grid.pose.position.x, grid.pose.position.y, grid.pose.position.z = origin
    grid.pose.orientation.w = 1.0
    grid.cell_size.x = grid.cell_size.y = edge
    grid.fields.append(PackedElementField(name="occupancy", offset=0, type=PackedElementField.UINT8))
    return grid


def pose_message(vehicle: VehicleState, stamp_ns: int) -> Any:
    """Where the drone is, as a transform from ``map`` to ``drone``."""
    transform = FrameTransform(parent_frame_id=WORLD, child_frame_id=BODY)
    _stamp(transform.timestamp, stamp_ns)
    transform.translation.x, transform.translation.y, transform.translation.z = vehicle.position_m
    transform.rotation.z, transform.rotation.w = math.sin(vehicle.yaw_rad / 2), math.cos(vehicle.yaw_rad / 2)
    return transform


def path_message(path_m: Floats, stamp_ns: int) -> Any:
    """A path (n, 3), metres."""
    poses = PosesInFrame(frame_id=WORLD)
    _stamp(poses.timestamp, stamp_ns)
    for x, y, z in path_m:
        pose = poses.poses.add()
        pose.position.x, pose.position.y, pose.position.z = float(x), float(y), float(z)
        pose.orientation.w = 1.0
    return poses


def picture_message(jpeg: bytes, stamp_ns: int) -> Any:
    """A picture of the drone's camera."""
    image = CompressedImage(frame_id=BODY, format="jpeg", data=jpeg)
    _stamp(image.timestamp, stamp_ns)
    return image


def log_message(text: str, level: int, stamp_ns: int) -> Any:
    """One line; level 2 is information, 3 a warning."""
    log = Log(level=Log.Level.ValueType(level), message=text, name="mintpilot")
    _stamp(log.timestamp, stamp_ns)
    return log


def descriptors_of(message: Any) -> bytes:
    """The schema of a message with all that it refers to, serialised."""
    files: dict[str, FileDescriptor] = {}

    def add(file: FileDescriptor) -> None:
        if file.name not in files:
            for needed in file.dependencies:
                add(needed)
            files[file.name] = file

    add(message.DESCRIPTOR.file)
    found = FileDescriptorSet()
    for file in files.values():
        file.CopyToProto(found.file.add())
    return found.SerializeToString()


def _add_box(update: Any, name: str, box: Box, text: str, colour: tuple[float, ...], stamp_ns: int) -> None:
    entity = update.entities.add(id=name, frame_id=WORLD)
    _stamp(entity.timestamp, stamp_ns)
    cube = entity.cubes.add()
    label = entity.texts.add(text=text, billboard=True, font_size=0.25, scale_invariant=False)
    for part in (cube, label):
        part.pose.position.x, part.pose.position.y, part.pose.position.z = box.centre_m
        part.pose.orientation.w = 1.0
        part.color.r, part.color.g, part.color.b, part.color.a = colour
    label.pose.position.z = box.hi_m[2] + 0.2
    label.color.a = 1.0
    cube.size.x, cube.size.y, cube.size.z = box.size_m


def _box_of(map: SemanticMap, region: Region) -> Box:
    z, y, x = np.unravel_index(region.cells, map.frame.shape)
    edge, (x0, y0, z0) = map.frame.resolution_m, map.frame.origin_m
    return Box(
        lo_m=(x0 + edge * int(x.min()), y0 + edge * int(y.min()), z0 + edge * int(z.min())),
        hi_m=(x0 + edge * (int(x.max()) + 1), y0 + edge * (int(y.max()) + 1), z0 + edge * (int(z.max()) + 1)),
    )


def _stamp(field: Any, stamp_ns: int) -> None:
    field.seconds, field.nanos = divmod(stamp_ns, 1_000_000_000)
