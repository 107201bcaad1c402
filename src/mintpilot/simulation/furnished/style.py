"""Styles of furnished rooms: textures, lights, colours of doors, clothes, shapes of furniture, what lies about.

`mintpilot.simulation.furnished.styles` lists those there are.
"""

from __future__ import annotations

from dataclasses import dataclass

from mintpilot.core.geometry import Vec3

Rgb = tuple[float, float, float]


@dataclass(frozen=True, slots=True, kw_only=True)
class Style:
    """What rooms of one style look like. Lengths are ranges in metres, colours red, green, blue from 0 to 1."""

    name: str
    floor: tuple[Rgb, Rgb]
    """The two colours of its pattern."""
    floor_tile_m: float
    walls: tuple[Rgb, Rgb]
    wall_tile_m: float
    light: Rgb
    """Of the lamps."""
    ambient: float
    """Share of the light that comes from everywhere."""
    doors: tuple[Rgb, ...]
    relief_m: tuple[float, float]
    """How far a door leaf is set back from the face of its wall; negative: it stands out."""
    door_m: tuple[tuple[float, float], tuple[float, float]]
    """Width and height."""
    framed: bool
    """Whether doors have frames that stand out."""
    clothes: tuple[Rgb, ...]
    skin: tuple[Rgb, ...]
    stature: tuple[float, float]
    """Heights of grown-ups."""
    girth: tuple[float, float]
    """Widths of limbs against the usual ones."""
    round_limbs: bool
    """Whether limbs are rods with round ends; else tapered."""
    table_m: tuple[tuple[float, float], tuple[float, float], tuple[float, float]]
    """Length, depth, height."""
    round_tables: bool
    wood: tuple[Rgb, ...]
    """Of furniture."""
    clutter: tuple[str, ...]
    """Kinds of things that lie about: names of `mintpilot.simulation.furnished.things.MAKERS`."""
    furniture: tuple[str, ...]
    """Kinds of furniture besides tables: names of `mintpilot.simulation.furnished.furniture.MAKERS`."""
    eye_m: tuple[float, float]
    """Heights from which it is looked at."""
    room_m: tuple[tuple[float, float], tuple[float, float]] = ((6.5, 8.5), (5.5, 7.0))
    """Inner width and depth."""
    floor_pattern: str = "checker"
    """Name of `mintpilot.simulation.furnished.room.PATTERNS`."""
    wall_pattern: str = "checker"
    ceiling: Rgb = (0.85, 0.85, 0.85)
    lamps: tuple[Vec3, ...] = ((0.3, 0.3, 2.6), (0.7, 0.7, 2.6))
    """Where they hang: shares of width and depth, height in metres."""
    door_forms: tuple[str, ...] = ("plain",)
    """Names of `mintpilot.simulation.furnished.doors.FORMS`."""
    fittings: tuple[str, ...] = ()
    """What belongs to floor and walls: names of `mintpilot.simulation.furnished.fittings.MAKERS`."""
    cloth: tuple[Rgb, ...] = ((0.5, 0.5, 0.5),)
    """Of carpets, curtains and what is painted on walls."""
    postures: tuple[str, ...] = ("standing", "sitting", "crouching", "lying", "covered", "child")
    """Of people: names of `mintpilot.simulation.furnished.people.POSTURES` or `MORE_POSTURES`."""
    hair: tuple[Rgb, ...] = ((0.15, 0.10, 0.07),)
    wear: tuple[str, ...] = ("",)
    """What people have on besides: names of `mintpilot.simulation.furnished.people.WEAR`, or nothing."""
    long_sleeves: bool = False
    lying_on: tuple[str, ...] = ()
    """Kinds of furniture on which those lie that lie, whenever there is room for it."""
    people: tuple[int, int] = (1, 4)
    """At least the first, fewer than the second; so below."""
    pieces: tuple[int, int] = (1, 4)
    """Of furniture."""
    things: tuple[int, int] = (1, 5)
    """On the floor."""


OFFICE = Style(
    name="office",
    floor=((0.42, 0.44, 0.46), (0.38, 0.40, 0.42)),
    floor_tile_m=0.5,
    walls=((0.82, 0.81, 0.77), (0.80, 0.79, 0.75)),
    wall_tile_m=1.2,
    light=(0.62, 0.60, 0.57),
    ambient=0.35,
    doors=((0.45, 0.30, 0.18), (0.92, 0.92, 0.90), (0.30, 0.38, 0.50), (0.80, 0.79, 0.75)),
    relief_m=(0.03, 0.08),
    door_m=((0.80, 0.95), (1.98, 2.10)),
    framed=True,
    clothes=((0.20, 0.25, 0.40), (0.75, 0.75, 0.78), (0.30, 0.30, 0.32), (0.50, 0.15, 0.15)),
    skin=((0.85, 0.64, 0.52), (0.45, 0.30, 0.22)),
    stature=(1.58, 1.88),
    girth=(0.9, 1.15),
    round_limbs=True,
    table_m=((1.2, 1.8), (0.65, 0.85), (0.70, 0.76)),
    round_tables=False,
    wood=((0.70, 0.58, 0.42), (0.85, 0.85, 0.84)),
    clutter=("carton", "mug", "bottle", "books", "bin"),
    furniture=("cabinet", "chair", "shelf"),
    eye_m=(1.3, 1.7),
)
CLINIC = Style(
    name="clinic",
    floor=((0.62, 0.70, 0.66), (0.56, 0.64, 0.61)),
    floor_tile_m=1.1,
    walls=((0.93, 0.94, 0.95), (0.72, 0.84, 0.86)),
    wall_tile_m=3.0,
    light=(0.80, 0.84, 0.90),
    ambient=0.45,
    doors=((0.93, 0.94, 0.95), (0.95, 0.80, 0.25), (0.16, 0.55, 0.50), (0.70, 0.70, 0.74)),
    relief_m=(0.01, 0.05),
    door_m=((0.90, 1.20), (2.00, 2.20)),
    framed=False,
    clothes=((0.92, 0.93, 0.95), (0.40, 0.68, 0.70), (0.88, 0.70, 0.72), (0.25, 0.55, 0.40)),
    skin=((0.93, 0.74, 0.63), (0.62, 0.44, 0.33), (0.33, 0.22, 0.17)),
    stature=(1.50, 1.95),
    girth=(0.85, 1.3),
    round_limbs=False,
    table_m=((0.9, 2.1), (0.5, 0.9), (0.55, 0.95)),
    round_tables=True,
    wood=((0.88, 0.90, 0.92), (0.55, 0.62, 0.68)),
    clutter=("carton", "tin", "bag", "bottle", "ball", "mug"),
    furniture=("bed", "cabinet", "stool", "screen"),
    eye_m=(1.1, 1.9),
)
CELLAR = Style(
    name="cellar",
    floor=((0.24, 0.22, 0.20), (0.30, 0.27, 0.24)),
    floor_tile_m=0.25,
    walls=((0.46, 0.30, 0.24), (0.55, 0.50, 0.44)),
    wall_tile_m=0.4,
    light=(0.55, 0.45, 0.32),
    ambient=0.18,
    doors=((0.16, 0.14, 0.13), (0.48, 0.12, 0.10), (0.50, 0.42, 0.36), (0.22, 0.34, 0.22)),
    relief_m=(-0.05, 0.10),
    door_m=((0.70, 0.95), (1.85, 2.05)),
    framed=True,
    clothes=((0.85, 0.45, 0.05), (0.15, 0.15, 0.16), (0.35, 0.30, 0.22), (0.20, 0.30, 0.22)),
    skin=((0.78, 0.58, 0.47), (0.40, 0.27, 0.20)),
    stature=(1.55, 1.90),
    girth=(0.95, 1.4),
    round_limbs=True,
    table_m=((1.0, 2.4), (0.6, 1.0), (0.75, 1.0)),
    round_tables=False,
    wood=((0.36, 0.24, 0.14), (0.28, 0.26, 0.24)),
    clutter=("carton", "crate", "tin", "bag", "bucket", "bottle"),
    furniture=("shelf", "drum", "pile", "bench"),
    eye_m=(1.2, 1.8),
)
