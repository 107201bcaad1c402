"""A furnished room drawn at random in a style: what is in it, its world, and where it is looked at from."""

from __future__ import annotations

import math
import zlib
from collections.abc import Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

import numpy as np

from mintpilot.core.geometry import Vec3
from mintpilot.simulation.furnished.doors import Doorway, before, doorway, in_wall, shown_door
from mintpilot.simulation.furnished.fittings import fittings
from mintpilot.simulation.furnished.furniture import furniture, lie_m, table
from mintpilot.simulation.furnished.people import LYING, person
from mintpilot.simulation.furnished.shapes import Assembly, Part, Shown
from mintpilot.simulation.furnished.style import Rgb, Style
from mintpilot.simulation.furnished.things import SMALL, TABLEWARE, thing

HEIGHT_M = 2.8
VIEWS = 8
FREE_M = 0.9
"""So much space is left around where it is looked at from, and between wall and camera."""
PATTERNS = MappingProxyType(
    {
        "checker": ("CHECKER", "NONE", 2),
        "tiles": ("FLAT", "EDGE", 1),
        "speckles": ("FLAT", "RANDOM", 1),
    }
)
"""Of floors and walls: MuJoCo's texture, its marks, and how many tiles wide it is."""
TRIES = 60
"""A thing for which no place is found in so many tries is left out."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Look:
    """Where a picture is taken from."""

    eye_m: Vec3
    yaw_rad: float
    pitch_down_rad: float


@dataclass(frozen=True, slots=True, kw_only=True)
class FurnishedRoom:
    """A room and the truth about it."""

    style: Style
    size_m: tuple[float, float]
    """Inner width and depth; it is `HEIGHT_M` high, with its south-west corner at the origin."""
    shown: tuple[Shown, ...]
    """Everything in it, doors included."""
    doors: tuple[Doorway, ...]
    looks: tuple[Look, ...]
    fittings: tuple[Part, ...]
    """What belongs to floor and walls, as carpets and pictures do."""


def furnished_room(style: Style, seed: int) -> FurnishedRoom:
    """Draws a room: doors, people, tables with things on them, furniture along the walls, things on the floor."""
    rng = np.random.default_rng((zlib.crc32(style.name.encode()), seed))
    size = (float(rng.uniform(*style.room_m[0])), float(rng.uniform(*style.room_m[1])))
    doors = [doorway(int(wall), style, size, rng) for wall in rng.permutation(4)[: int(rng.integers(1, 3))]]
    looks = _looks(style, size, rng)
    keep: list[tuple[float, float, float]] = [(x, y, FREE_M - 0.4) for x, y, _ in (look.eye_m for look in looks)]
    keep += [(*before(door, size, 0.6), 0.9) for door in doors]
    shown = [shown_door(door, size) for door in doors]

    def put(made: Shown, radius: float, *, at_wall: bool = False) -> Vec3 | None:
        for _ in range(TRIES):
            x, y, turn = _place(size, radius, at_wall, rng)
            if all(math.hypot(x - a, y - b) > radius + r for a, b, r in keep):
                keep.append((x, y, radius))
                shown.append(made.moved((x, y, 0.0), turn))
                return (x, y, turn)
        return None

    for posture in rng.permutation(style.postures)[: int(rng.integers(*style.people))]:
        made = person(str(posture), style, rng)
        placed = None
        if posture in LYING and style.lying_on:
            rest = furniture(str(rng.choice(style.lying_on)), style, rng)
            placed = put(rest, 1.05, at_wall=True)
            if placed is not None:
                shown.append(made.moved(lie_m(shown[-1]), placed[2]))
        if placed is None:
            put(made, 1.05 if posture in LYING else 0.6)
    for _ in range(int(rng.integers(1, 3))):
        made, half, top = table(style, rng)
        placed = put(made, math.hypot(*half))
        if placed is not None:
            shown += [one.moved((placed[0], placed[1], top), 0.0) for one in _on_table(style, half, placed[2], rng)]
    for kind in rng.permutation(style.furniture)[: int(rng.integers(*style.pieces))]:
        made = furniture(str(kind), style, rng)
        lo, hi = made.box_m.lo_m, made.box_m.hi_m
        put(made, max(hi[0] - lo[0], hi[1] - lo[1]) / 2, at_wall=True)
    for _ in range(int(rng.integers(*style.things))):
        kind = str(rng.choice([k for k in style.clutter if k not in TABLEWARE]))
        put(thing(kind, rng, largest_m=0.6), 0.45)
    return FurnishedRoom(
        style=style, size_m=size, shown=tuple(shown), doors=tuple(doors), looks=looks,
        fittings=fittings(style, size, doors, rng),
    )  # fmt: skip


def world_of(room: FurnishedRoom, mujoco: Any) -> Any:
    """The room as an editable ``mujoco.MjSpec``: geoms of the n-th thing shown are named ``shown:<n>:<part>``.

    Cameras are called ``look-0`` to ``look-7``, as `FurnishedRoom.looks`.
    """
    spec = mujoco.MjSpec()
    (width, depth), style = room.size_m, room.style
    spec.visual.global_.offwidth, spec.visual.global_.offheight = 1280, 960
    spec.visual.map.znear, spec.visual.map.zfar = 0.005, 4.0
    spec.stat.extent, spec.stat.center = max(width, depth), (width / 2, depth / 2, 1.0)
    spec.visual.headlight.ambient = [style.ambient] * 3
    spec.visual.headlight.diffuse = [0.3] * 3
    spec.visual.headlight.specular = [0.0] * 3
    _add_pattern(spec, mujoco, "floor", style.floor_pattern, style.floor, style.floor_tile_m)
    _add_pattern(spec, mujoco, "wall", style.wall_pattern, style.walls, style.wall_tile_m)
    shell = _shell(room)
    for number, (part, material) in enumerate(shell):
        _add(spec, mujoco, f"shell:{number}", part, material)
    for number, part in enumerate(room.fittings):
        _add(spec, mujoco, f"fitting:{number}", part, "")
    for number, one in enumerate(room.shown):
        for index, part in enumerate(one.parts):
            _add(spec, mujoco, f"shown:{number}:{index}", part, "")
    for i, (x, y, z) in enumerate(style.lamps):
        spec.worldbody.add_light(
            name=f"lamp:{i}", pos=[x * width, y * depth, z], dir=[0, 0, -1], castshadow=False,
            diffuse=list(style.light), specular=[0.03] * 3, attenuation=[1, 0.03, 0.02],
            type=mujoco.mjtLightType.mjLIGHT_POINT,
        )  # fmt: skip
    for i, look in enumerate(room.looks):
        c, s = math.cos(look.yaw_rad), math.sin(look.yaw_rad)
        down, level = math.sin(look.pitch_down_rad), math.cos(look.pitch_down_rad)
        axes = [s, -c, 0.0, c * down, s * down, level]
        spec.worldbody.add_camera(name=f"look-{i}", pos=list(look.eye_m), fovy=58.1, xyaxes=axes)
    return spec


def _looks(style: Style, size: tuple[float, float], rng: np.random.Generator) -> tuple[Look, ...]:
    """From places around the room, across it, a little down."""
    looks = []
    for i in range(VIEWS):
        angle = 2 * math.pi * i / VIEWS + float(rng.uniform(-0.2, 0.2))
        x = size[0] / 2 + (size[0] / 2 - FREE_M) * math.cos(angle)
        y = size[1] / 2 + (size[1] / 2 - FREE_M) * math.sin(angle)
        yaw = math.atan2(size[1] / 2 - y, size[0] / 2 - x) + float(rng.uniform(-0.35, 0.35))
        eye = (x, y, float(rng.uniform(*style.eye_m)))
        looks.append(Look(eye_m=eye, yaw_rad=yaw, pitch_down_rad=float(rng.uniform(0.15, 0.45))))
    return tuple(looks)


def _place(
    size: tuple[float, float], radius: float, at_wall: bool, rng: np.random.Generator
) -> tuple[float, float, float]:
    if not at_wall:
        x, y = (float(rng.uniform(radius + 0.1, edge - radius - 0.1)) for edge in size)
        return x, y, float(rng.uniform(0, 2 * math.pi))
    wall, gap = int(rng.integers(4)), min(radius, 0.3) + 0.05
    along = float(rng.uniform(radius + 0.1, (size[0] if wall < 2 else size[1]) - radius - 0.1))
    x, y = ((along, gap), (along, size[1] - gap), (gap, along), (size[0] - gap, along))[wall]
    return x, y, (0.0, math.pi, -math.pi / 2, math.pi / 2)[wall]


def _on_table(style: Style, half: tuple[float, float], turn: float, rng: np.random.Generator) -> list[Shown]:
    """Things on a table at the origin, apart from each other."""
    put: list[tuple[float, float]] = []
    made = []
    for _ in range(int(rng.integers(1, 5))):
        kind = str(rng.choice([k for k in style.clutter if k in SMALL]))
        one = thing(kind, rng, largest_m=0.3)
        for _ in range(TRIES):
            x, y = (float(rng.uniform(-h + 0.2, h - 0.2)) if h > 0.2 else 0.0 for h in half)
            if all(math.hypot(x - a, y - b) > 0.36 for a, b in put):
                put.append((x, y))
                c, s = math.cos(turn), math.sin(turn)
                made.append(one.moved((c * x - s * y, s * x + c * y, 0.0), float(rng.uniform(0, 2 * math.pi))))
                break
    return made


def _shell(room: FurnishedRoom) -> list[tuple[Any, str]]:
    """Floor, ceiling and walls around the doors, with frames, as parts with their materials."""
    (width, depth), parts = room.size_m, []

    def block(lo: Sequence[float], hi: Sequence[float], colour: Rgb, material: str) -> None:
        made = Assembly()
        made.block(lo, hi, colour)
        parts.append((made.parts[0], material))

    block((-0.4, -0.4, -0.1), (width + 0.4, depth + 0.4, 0.0), room.style.floor[0], "floor")
    block((-0.4, -0.4, HEIGHT_M), (width + 0.4, depth + 0.4, HEIGHT_M + 0.1), room.style.ceiling, "")
    for wall in range(4):
        along = width if wall < 2 else depth
        at = -0.3
        for door in sorted((d for d in room.doors if d.wall == wall), key=lambda d: d.at_m):
            a, b = door.at_m - door.width_m / 2, door.at_m + door.width_m / 2
            pieces = [((at, -0.3, 0.0), (a, 0.0, HEIGHT_M)), ((a, -0.3, door.height_m), (b, 0.0, HEIGHT_M))]
            for lo, hi in pieces:
                box = in_wall(wall, room.size_m, lo, hi)
                block(box.lo_m, box.hi_m, room.style.walls[0], "wall")
            if door.form == "ajar":
                box = in_wall(wall, room.size_m, (a, -0.3, 0.0), (b, -0.25, door.height_m))
                block(box.lo_m, box.hi_m, (0.12, 0.11, 0.10), "")
            if room.style.framed:
                trim = tuple(0.7 * c for c in door.colour)
                for lo, hi in (
                    ((a - 0.07, 0.0, 0.0), (a, 0.015, door.height_m + 0.07)),
                    ((b, 0.0, 0.0), (b + 0.07, 0.015, door.height_m + 0.07)),
                    ((a, 0.0, door.height_m), (b, 0.015, door.height_m + 0.07)),
                ):
                    box = in_wall(wall, room.size_m, lo, hi)
                    block(box.lo_m, box.hi_m, (trim[0], trim[1], trim[2]), "")
            at = b
        box = in_wall(wall, room.size_m, (at, -0.3, 0.0), (along + 0.3, 0.0, HEIGHT_M))
        block(box.lo_m, box.hi_m, room.style.walls[0], "wall")
    return parts


def _add_pattern(spec: Any, mujoco: Any, name: str, pattern: str, colours: tuple[Rgb, Rgb], tile_m: float) -> None:
    builtin, mark, cells = PATTERNS[pattern]
    spec.add_texture(
        name=f"texture:{name}", type=mujoco.mjtTexture.mjTEXTURE_2D,
        builtin=getattr(mujoco.mjtBuiltin, f"mjBUILTIN_{builtin}"), mark=getattr(mujoco.mjtMark, f"mjMARK_{mark}"),
        rgb1=list(colours[0]), rgb2=list(colours[1]), markrgb=list(colours[1]), random=0.15, width=64, height=64,
    )  # fmt: skip
    repeat = 1 / (cells * tile_m)
    material = spec.add_material(name=name, texuniform=True, texrepeat=[repeat, repeat], shininess=0.1, specular=0.1)
    material.textures[mujoco.mjtTextureRole.mjTEXROLE_RGB] = f"texture:{name}"


def _add(spec: Any, mujoco: Any, name: str, part: Any, material: str) -> None:
    axes = np.array(part.axes).T
    quat = np.zeros(4)
    mujoco.mju_mat2Quat(quat, axes.ravel())
    look = {"material": material} if material else {"rgba": [*part.colour, 1.0]}
    spec.worldbody.add_geom(
        name=name, type=getattr(mujoco.mjtGeom, f"mjGEOM_{part.form}"), pos=list(part.centre_m),
        size=list(part.half_m), quat=list(quat), contype=0, conaffinity=0, **look,
    )  # fmt: skip
