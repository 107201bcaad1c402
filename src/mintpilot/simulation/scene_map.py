"""The map that a perfect survey of a scene would give: for the kinematic simulator, fast tests and big benchmarks.

It knows where matter is, where clouds are, and where closed doors are. It does not know what cannot be seen:

* whether a cloud is toxic (its region is open, with the scene's prior),
* whether a room is occupied (open, with the scene's prior); what is behind its walls is unknown, occupants are not on
  the map,
* what a box holds (`Solid.attributes`), or which one is meant,
* solids that come later than ``time_s``.

Solids are rasterised conservatively: a voxel is occupied as soon as any part of the solid is in it. The lowest layer
counts as floor. All else in the volume is free; clouds change no voxel.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mintpilot.core.errors import LimitError
from mintpilot.core.geometry import Bools, Box, Floats, GridFrame
from mintpilot.core.observation import Attribute, RegionKind
from mintpilot.core.semantic_map import Cell, MapObject, Region, Room, SemanticMap
from mintpilot.simulation.scene import ClosedRoom, Person, Scene, Shape, Solid

UNNAMED = frozenset({"wall", "partition"})
"""Kinds that are mere matter to the map: nobody points at them as objects."""
COLOURED = frozenset({"box", "barrel"})
SHAPE_WORDS = {Shape.BOX: "cubic", Shape.CYLINDER: "cylindrical", Shape.SPHERE: "spherical"}
_SLACK_M = 1e-6
_PERSON_M = (1.0, 0.5, 0.3)
"""Half length, half width and height of somebody lying."""


def size_word(extent_m: Box) -> str:
    """``small``, ``medium`` or ``large`` by the longest edge: below 0.4 m, below 0.65 m, above."""
    longest = max(extent_m.size_m)
    return "small" if longest < 0.4 else "medium" if longest < 0.65 else "large"


MAX_CELLS = 20_000_000
"""Voxels of a map at most: as many as are read of a given one."""


def map_of_scene(scene: Scene, resolution_m: float, *, time_s: float = 0.0) -> SemanticMap:
    """The map of a perfect survey at ``time_s`` seconds of mission flight; see the module for what it knows.

    Raises:
        MapError: the resolution is not above 0.
        LimitError: the map would have more than `MAX_CELLS` voxels.
    """
    lo, size = scene.volume.lo_m, scene.volume.size_m
    nx, ny, nz = (max(1, int(np.ceil(edge / resolution_m - _SLACK_M))) for edge in size)
    if nx * ny * nz > MAX_CELLS:
        raise LimitError(
            f"a volume of {size[0]:g} x {size[1]:g} x {size[2]:g} m in voxels of {resolution_m:g} m has "
            f"{nx * ny * nz} voxels, more than the {MAX_CELLS} that are held; make the volume smaller or them larger"
        )
    frame = GridFrame(origin_m=lo, resolution_m=resolution_m, shape=(nz, ny, nx))
    cells = np.full(frame.shape, Cell.FREE, np.uint8)
    cells[0] = Cell.OCCUPIED
    for room in scene.rooms:
        _draw_room(cells, frame, room)
    solids = tuple(s for s in scene.solids if s.appears_s <= time_s)
    for solid in solids:
        _paint(cells, frame, solid.extent_m, Cell.OCCUPIED, shape=solid.shape)
    objects = (
        *(_object_of(solid) for solid in solids if solid.kind not in UNNAMED),
        *(_lying(person) for person in scene.persons),
    )
    regions = tuple(
        Region(
            id=smoke.id,
            kind=RegionKind.SMOKE,
            cells=np.flatnonzero(_touched(frame, smoke.extent_m) & (cells != Cell.OCCUPIED)).astype(np.int64),
            prior_passable=smoke.prior_safe,
        )
        for smoke in scene.smokes
    )
    rooms = tuple(
        Room(id=r.id, door_m=r.door_m, viewpoint_m=r.viewpoint_m, prior_occupied=r.prior_occupied) for r in scene.rooms
    )
    return SemanticMap(frame=frame, cells=cells, objects=objects, regions=regions, rooms=rooms)


def _object_of(solid: Solid) -> MapObject:
    """What perception would say of it: colour, size and shape of boxes and barrels, for others the kind alone."""
    said: tuple[Attribute, ...] = ()
    if solid.kind in COLOURED and solid.colour:
        said = (
            Attribute(name="colour", value=solid.colour),
            Attribute(name="size", value=size_word(solid.extent_m)),
            Attribute(name="shape", value=SHAPE_WORDS[solid.shape]),
        )
    return MapObject(id=solid.id, label=solid.kind, box_m=solid.extent_m, attributes=said)


def _lying(person: Person) -> MapObject:
    x, y, z = person.position_m
    long, wide, high = _PERSON_M
    across, along = abs(np.cos(person.yaw_rad)), abs(np.sin(person.yaw_rad))
    dx, dy = float(across * long + along * wide), float(along * long + across * wide)
    return MapObject(id=person.id, label="person", box_m=Box(lo_m=(x - dx, y - dy, z), hi_m=(x + dx, y + dy, z + high)))


def _draw_room(cells: NDArray[np.uint8], frame: GridFrame, room: ClosedRoom) -> None:
    """Walls, roof and shut door are matter; what they enclose is unknown."""
    outer = _touched(frame, room.extent_m)
    t = room.wall_m
    (x0, y0, z0), (x1, y1, z1) = room.extent_m.lo_m, room.extent_m.hi_m
    inner = Box(lo_m=(x0 + t, y0 + t, z0), hi_m=(x1 - t, y1 - t, z1 - t))
    cells[outer] = Cell.OCCUPIED
    within = outer & _within(frame, inner)
    within[0] = False
    cells[within] = Cell.UNKNOWN


def _edges(frame: GridFrame, axis: int) -> tuple[Floats, Floats]:
    """Lower and upper edges of the cells along world axis 0, 1 or 2, metres."""
    count = frame.shape[2 - axis]
    low: Floats = np.asarray(frame.origin_m[axis] + np.arange(count) * frame.resolution_m, float)
    return low, np.asarray(low + frame.resolution_m, float)


def _spread(lines: list[Bools]) -> Bools:
    """Product of one line of flags per world axis x, y, z, as (nz, ny, nx)."""
    x, y, z = lines
    spread: Bools = z[:, None, None] & y[None, :, None] & x[None, None, :]
    return spread


def _touched(frame: GridFrame, box: Box) -> Bools:
    """Cells of which any part, more than a surface, is in the box."""
    edges = (_edges(frame, axis) for axis in range(3))
    return _spread(
        [(low < box.hi_m[a] - _SLACK_M) & (high > box.lo_m[a] + _SLACK_M) for a, (low, high) in enumerate(edges)]
    )


def _within(frame: GridFrame, box: Box) -> Bools:
    """Cells that lie wholly in the box."""
    edges = (_edges(frame, axis) for axis in range(3))
    return _spread(
        [(low >= box.lo_m[a] - _SLACK_M) & (high <= box.hi_m[a] + _SLACK_M) for a, (low, high) in enumerate(edges)]
    )


def _paint(cells: NDArray[np.uint8], frame: GridFrame, box: Box, value: Cell, *, shape: Shape) -> None:
    """Sets all cells that a solid touches."""
    touched = _touched(frame, box)
    if shape is not Shape.BOX and touched.any():
        centre, size = np.asarray(box.centre_m), box.size_m
        radius = min(size[:2]) / 2 if shape is Shape.CYLINDER else min(size) / 2
        squares = []
        for axis in range(3):
            low, high = _edges(frame, axis)
            nearest = np.clip(centre[axis], low, high) - centre[axis]
            squares.append(nearest**2 if shape is Shape.SPHERE or axis < 2 else 0.0 * nearest)
        x, y, z = squares
        touched &= (z[:, None, None] + y[None, :, None] + x[None, None, :]) < radius**2
    cells[touched] = value
