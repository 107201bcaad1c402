"""Closed rooms and people lying on the floor, put together from geoms."""

from __future__ import annotations

import math
from typing import Any

from mintpilot.core.geometry import Box
from mintpilot.simulation.props import Maker, quaternion, replaced
from mintpilot.simulation.scene import ClosedRoom, Person

PANE_Z_M = (0.8, 1.9)
"""Lower and upper edge of the pane in a room's door, metres above the floor."""
PANE_WIDTH_M = 0.55


def add_room(maker: Maker, room: ClosedRoom) -> None:
    """Walls with an opening for the door, roof, and a shut door with pane and handle.

    The pane's geom is named ``pane:<room id>``: the renderer draws it mirroring from afar and clear from near.
    """
    (x0, y0, z0), (x1, y1, z1) = room.extent_m.lo_m, room.extent_m.hi_m
    t = room.wall_m
    maker.box(Box(lo_m=(x0, y0, z1 - t), hi_m=(x1, y1, z1)), "plaster")
    walls = (
        ((x0, y0), (x0 + t, y1)),
        ((x1 - t, y0), (x1, y1)),
        ((x0 + t, y0), (x1 - t, y0 + t)),
        ((x0 + t, y1 - t), (x1 - t, y1)),
    )
    for lo, hi in walls:
        _wall_with_door(maker, Box(lo_m=(*lo, z0), hi_m=(*hi, z1 - t)), room.door_m)
    _add_door(maker, room)


def _wall_with_door(maker: Maker, wall: Box, door: Box) -> None:
    """The wall, cut open where the door's middle lies in it."""
    if not wall.contains(door.centre_m)[0]:
        maker.box(wall, "plaster")
        return
    along = 0 if wall.size_m[0] > wall.size_m[1] else 1

    def part(start: float, end: float, bottom: float) -> None:
        lo, hi = replaced(wall.lo_m, {along: start, 2: bottom}), replaced(wall.hi_m, {along: end})
        maker.box(Box(lo_m=lo, hi_m=hi), "plaster")

    part(wall.lo_m[along], door.lo_m[along], wall.lo_m[2])
    part(door.hi_m[along], wall.hi_m[along], wall.lo_m[2])
    part(door.lo_m[along], door.hi_m[along], door.hi_m[2])


def _add_door(maker: Maker, room: ClosedRoom) -> None:
    """Leaf around a pane, and a handle on the side of the viewpoint."""
    door = room.door_m
    along = 0 if door.size_m[0] > door.size_m[1] else 1
    across = 1 - along
    middle = door.centre_m[along]
    bottom, top = door.lo_m[2] + PANE_Z_M[0], min(door.lo_m[2] + PANE_Z_M[1], door.hi_m[2] - 0.08)

    def part(start: float, end: float, low: float, high: float) -> Box:
        return Box(lo_m=replaced(door.lo_m, {along: start, 2: low}), hi_m=replaced(door.hi_m, {along: end, 2: high}))

    left, right = middle - PANE_WIDTH_M / 2, middle + PANE_WIDTH_M / 2
    lo, hi = door.lo_m, door.hi_m
    for leaf in (
        part(lo[along], left, lo[2], hi[2]),
        part(right, hi[along], lo[2], hi[2]),
        part(left, right, lo[2], bottom),
        part(left, right, top, hi[2]),
    ):
        maker.box(leaf, "door")
    pane = part(left, right, bottom, top)
    maker.body.add_geom(
        name=f"pane:{room.id}",
        type=maker.mujoco.mjtGeom.mjGEOM_BOX,
        pos=list(pane.centre_m),
        size=[edge / 2 * (0.4 if axis == across else 1.0) for axis, edge in enumerate(pane.size_m)],
        material="pane",
    )
    side = math.copysign(1.0, room.viewpoint_m[across] - door.centre_m[across])
    place = list(door.centre_m)
    place[along], place[2] = hi[along] - 0.1, lo[2] + 1.0
    place[across] += side * (door.size_m[across] / 2 + 0.03)
    maker.geom("SPHERE", place, [0.04], "handle", solid=False)


def add_person(spec: Any, mujoco: Any, person: Person, seed: int) -> None:
    """A person lying on the floor: head, trunk, bent limbs; all within 1.1 m of the middle and 0.3 m of the floor."""
    x, y, z = person.position_m
    body = spec.worldbody.add_body(
        name=f"person:{person.id}", pos=[x, y, z + 0.13], quat=quaternion(person.yaw_rad, 0.0)
    )
    maker = Maker(mujoco=mujoco, body=body, prefix=f"person:{person.id}")
    shirt = "shirt-orange" if seed % 2 == 0 else "shirt-green"
    maker.geom("ELLIPSOID", (0.73, 0, 0), (0.12, 0.095, 0.11), "skin")
    maker.geom("ELLIPSOID", (0.78, 0, -0.01), (0.095, 0.1, 0.105), "hair")
    maker.geom("ELLIPSOID", (0.33, 0, 0.02), (0.30, 0.19, 0.12), shirt)
    maker.geom("ELLIPSOID", (0.0, 0, 0), (0.15, 0.17, 0.11), "trousers")
    for a, b, radius, material in (
        ((-0.05, 0.09, 0), (-0.47, 0.16, 0.03), 0.075, "trousers"),
        ((-0.47, 0.16, 0.03), (-0.88, 0.12, -0.06), 0.055, "trousers"),
        ((-0.05, -0.09, 0), (-0.40, -0.25, 0.08), 0.075, "trousers"),
        ((-0.40, -0.25, 0.08), (-0.65, -0.10, -0.06), 0.055, "trousers"),
        ((-0.88, 0.12, -0.06), (-0.98, 0.16, -0.05), 0.05, "shoe"),
        ((-0.65, -0.10, -0.06), (-0.76, -0.08, -0.05), 0.05, "shoe"),
        ((0.53, 0.19, 0), (0.35, 0.42, -0.06), 0.05, shirt),
        ((0.35, 0.42, -0.06), (0.10, 0.50, -0.08), 0.04, "skin"),
        ((0.53, -0.19, 0), (0.80, -0.35, -0.06), 0.05, shirt),
        ((0.80, -0.35, -0.06), (0.98, -0.25, -0.08), 0.04, "skin"),
    ):
        maker.geom("CAPSULE", (0, 0, 0), (radius,), material, fromto=[*a, *b])
    maker.geom("CYLINDER", (0.05, -0.35, -0.127), (0.2, 0.003), "blood", solid=False)
