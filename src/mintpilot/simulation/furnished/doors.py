"""Shut doors of several forms, and where they are in the walls."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from mintpilot.core.geometry import Box
from mintpilot.simulation.furnished.shapes import Assembly, Part, Shown
from mintpilot.simulation.furnished.style import Rgb, Style

STEEL: Rgb = (0.7, 0.7, 0.7)
GLASS: Rgb = (0.62, 0.72, 0.76)
HANDLE_M = (1.0, 1.03)


@dataclass(frozen=True, slots=True, kw_only=True)
class Doorway:
    """A shut door in a wall."""

    wall: int
    """0: y = 0, 1: y = depth, 2: x = 0, 3: x = width."""
    at_m: float
    """Its middle along the wall."""
    width_m: float
    height_m: float
    relief_m: float
    colour: Rgb
    form: str = "plain"
    """Name of `FORMS`."""
    ajar_rad: float = 0.0
    """How far it is open, into the room: a hand's breadth."""


def doorway(wall: int, style: Style, size: tuple[float, float], rng: np.random.Generator) -> Doorway:
    """Draws a door of the style in a wall of a room of that size."""
    width, height = (float(rng.uniform(*span)) for span in style.door_m)
    along = size[0] if wall < 2 else size[1]
    at, relief = float(rng.uniform(1.2, along - 1.2)), float(rng.uniform(*style.relief_m))
    colour = style.doors[int(rng.integers(len(style.doors)))]
    form = style.door_forms[0] if len(style.door_forms) == 1 else str(rng.choice(style.door_forms))
    return Doorway(
        wall=wall,
        at_m=at,
        width_m=width * 1.7 if form == "double" else width,
        height_m=height,
        relief_m=-0.05 if form == "sliding" else relief,
        colour=colour,
        form=form,
        ajar_rad=float(rng.uniform(0.06, 0.18)) if form == "ajar" else 0.0,
    )


def before(door: Doorway, size: tuple[float, float], off: float) -> tuple[float, float]:
    """The place so far before a door."""
    return ((door.at_m, off), (door.at_m, size[1] - off), (off, door.at_m), (size[0] - off, door.at_m))[door.wall]


def in_wall(wall: int, size: tuple[float, float], a: Sequence[float], b: Sequence[float]) -> Box:
    """A block given by (along the wall, into the room, up) as a box; inside the wall the second is below 0."""
    (u0, n0, z0), (u1, n1, z1) = a, b
    lo, hi = {
        0: ((u0, n0), (u1, n1)),
        1: ((u0, size[1] - n1), (u1, size[1] - n0)),
        2: ((n0, u0), (n1, u1)),
        3: ((size[0] - n1, u0), (size[0] - n0, u1)),
    }[wall]
    return Box(lo_m=(*lo, z0), hi_m=(*hi, z1))


def shown_door(door: Doorway, size: tuple[float, float]) -> Shown:
    """The door as it is seen in a room of that size."""
    drawn = Assembly()
    FORMS[door.form](drawn, door)
    made = Assembly()
    for part in drawn.parts:
        own = part.box()
        box = in_wall(
            door.wall, size, (door.at_m + own.lo_m[0], *own.lo_m[1:]), (door.at_m + own.hi_m[0], *own.hi_m[1:])
        )
        made.block(box.lo_m, box.hi_m, part.colour)
    parts = tuple(_ajar(part, door, size) for part in made.parts) if door.ajar_rad else tuple(made.parts)
    return Shown(kind="door", name="door", labels=frozenset({"door"}), parts=parts)


def _ajar(part: Part, door: Doorway, size: tuple[float, float]) -> Part:
    """Turned into the room about its hinge."""
    x, y, _ = in_wall(door.wall, size, (door.at_m - door.width_m / 2, 0, 0), (door.at_m - door.width_m / 2, 0, 0)).lo_m
    turn = door.ajar_rad * (1 if door.wall in (0, 3) else -1)
    return part.moved((-x, -y, 0.0)).moved((x, y, 0.0), turn)


def _plain(made: Assembly, door: Doorway) -> None:
    half, face = door.width_m / 2, -door.relief_m
    made.block((-half, face - 0.04, 0.0), (half, face, door.height_m), door.colour)
    made.block((half - 0.16, face, HANDLE_M[0]), (half - 0.06, face + 0.04, HANDLE_M[1]), STEEL)


def _double(made: Assembly, door: Doorway) -> None:
    half, face = door.width_m / 2, -door.relief_m
    for side in (-1, 1):
        lo, hi = sorted((side * 0.006, side * half))
        made.block((lo, face - 0.04, 0.0), (hi, face, door.height_m), door.colour)
        bar = sorted((side * 0.05, side * 0.08))
        made.block((bar[0], face, 0.9), (bar[1], face + 0.05, 1.25), STEEL)


def _glazed(made: Assembly, door: Doorway) -> None:
    """The upper half is a pane, set back in its leaf."""
    half, face, high = door.width_m / 2, -door.relief_m, door.height_m
    for lo, hi in (
        ((-half, 0.0), (half, 0.95)),
        ((-half, high - 0.14), (half, high)),
        ((-half, 0.95), (-half + 0.13, high - 0.14)),
        ((half - 0.13, 0.95), (half, high - 0.14)),
    ):
        made.block((lo[0], face - 0.04, lo[1]), (hi[0], face, hi[1]), door.colour)
    made.block((-half + 0.13, face - 0.03, 0.95), (half - 0.13, face - 0.02, high - 0.14), GLASS)
    made.block((half - 0.13, face, HANDLE_M[0]), (half - 0.03, face + 0.04, HANDLE_M[1]), STEEL)


def _panelled(made: Assembly, door: Doorway) -> None:
    """Four raised panels."""
    _plain(made, door)
    half, face = door.width_m / 2, -door.relief_m
    lighter: Rgb = tuple(min(1.0, 1.08 * c) for c in door.colour)  # type: ignore[assignment]
    for x in (-half + 0.1, 0.05):
        for low, high in ((0.15, 0.85), (1.12, door.height_m - 0.14)):
            made.block((x, face, low), (x + half - 0.15, face + 0.012, high), lighter)


def _kickplate(made: Assembly, door: Doorway) -> None:
    """A steel plate below, a narrow pane above, as where beds are pushed through."""
    _plain(made, door)
    half, face = door.width_m / 2, -door.relief_m
    made.block((-half + 0.02, face, 0.02), (half - 0.02, face + 0.004, 0.38), STEEL)
    made.block((half - 0.3, face, 1.2), (half - 0.12, face + 0.004, 1.75), (0.25, 0.30, 0.34))


def _sliding(made: Assembly, door: Doorway) -> None:
    """Hangs from a rail before the wall."""
    _plain(made, door)
    half = door.width_m / 2
    made.block((-half - 0.3, 0.0, door.height_m), (half + 0.3, 0.06, door.height_m + 0.07), (0.3, 0.3, 0.3))
    for z in (0.15, door.height_m - 0.3):
        made.block((-half, -door.relief_m, z), (half, -door.relief_m + 0.02, z + 0.14), door.colour)


FORMS: MappingProxyType[str, Callable[[Assembly, Doorway], None]] = MappingProxyType(
    {
        "plain": _plain,
        "double": _double,
        "glazed": _glazed,
        "panelled": _panelled,
        "kickplate": _kickplate,
        "sliding": _sliding,
        "ajar": _plain,
    }
)
