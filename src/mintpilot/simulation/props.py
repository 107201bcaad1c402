"""What stands in the building: how each kind of solid is put together from geoms.

Nothing leaves the extent of its solid, and what is visible is what the drone can hit.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

import numpy as np

from mintpilot.core.geometry import Box, Vec3
from mintpilot.simulation.materials import COLOURS
from mintpilot.simulation.scene import Shape, Solid

CEILING_GROUP = 3
"""Left out of pictures from above."""
UNSEEN_GROUP = 4
"""Collides, is not drawn."""
SHELF_GAP_M = 0.68
"""Between shelves: less than a drone with its margin needs, so that nothing flies through a rack."""


@dataclass(kw_only=True)
class Maker:
    """Adds geoms to one body, naming them ``<prefix>:<n>``."""

    mujoco: Any
    body: Any
    prefix: str
    count: int = field(default=0)

    def box(self, box: Box, material: str, *, group: int = 0, solid: bool = True) -> None:
        """An axis-aligned block; ``solid`` False: seen, not felt."""
        x, y, z = (max(edge / 2, 1e-3) for edge in box.size_m)
        # Flat textures lie in the geom's own x-y plane: its z axis goes through the thin side, its y axis up.
        if x < min(y, z):
            size, turn = (y, z, x), (0.5, 0.5, 0.5, 0.5)
        elif y < min(x, z):
            size, turn = (x, z, y), (math.sqrt(0.5), math.sqrt(0.5), 0.0, 0.0)
        else:
            size, turn = (x, y, z), (1.0, 0.0, 0.0, 0.0)
        self.geom("BOX", box.centre_m, size, material, group=group, solid=solid, quat=list(turn))

    def geom(
        self,
        kind: str,
        position: Sequence[float],
        size: Sequence[float],
        material: str,
        *,
        group: int = 0,
        solid: bool = True,
        **more: Any,
    ) -> None:
        """A geom of MuJoCo type ``mjGEOM_<kind>``; further arguments go to MuJoCo as they are."""
        touch = {} if solid else {"contype": 0, "conaffinity": 0}
        self.body.add_geom(
            name=f"{self.prefix}:{self.count}",
            type=getattr(self.mujoco.mjtGeom, f"mjGEOM_{kind}"),
            pos=list(position),
            size=[*size, *([0.0] * (3 - len(size)))],
            material=material,
            group=group,
            **touch,
            **more,
        )
        self.count += 1


def replaced(corner: Vec3, values: dict[int, float]) -> Vec3:
    """The corner with the coordinates of some axes replaced."""
    x, y, z = (values.get(axis, old) for axis, old in enumerate(corner))
    return (x, y, z)


def add_solid(maker: Maker, solid: Solid, seed: int) -> None:
    """Adds a solid as its kind looks; ``seed`` decides random details (goods, rubble)."""
    _DRESSERS.get(solid.kind, _plain)(maker, solid, np.random.default_rng(seed))


def _plain(maker: Maker, solid: Solid, rng: np.random.Generator) -> None:  # noqa: ARG001
    """A body of the solid's shape in its colour."""
    material = f"colour-{solid.colour}" if solid.colour in COLOURS else _USUAL.get(solid.kind, "cardboard")
    x, y, z = solid.extent_m.size_m
    centre = solid.extent_m.centre_m
    if solid.shape is Shape.CYLINDER:
        maker.geom("CYLINDER", centre, [min(x, y) / 2, z / 2], material)
    elif solid.shape is Shape.SPHERE:
        maker.geom("SPHERE", centre, [min(x, y, z) / 2], material)
    else:
        maker.box(solid.extent_m, material)


def _partition(maker: Maker, solid: Solid, rng: np.random.Generator) -> None:  # noqa: ARG001
    """A brick fire wall with a hazard stripe at each end, where gates are."""
    lo, hi = solid.extent_m.lo_m, solid.extent_m.hi_m
    along = 0 if hi[0] - lo[0] > hi[1] - lo[1] else 1
    stripe = min(0.25, (hi[along] - lo[along]) / 4)
    cuts = (lo[along], lo[along] + stripe, hi[along] - stripe, hi[along])
    for (start, end), material in zip(pairwise(cuts), ("hazard", "brick", "hazard"), strict=True):
        maker.box(Box(lo_m=replaced(lo, {along: start}), hi_m=replaced(hi, {along: end})), material)


def _rack(maker: Maker, solid: Solid, rng: np.random.Generator) -> None:
    """Uprights, beams, shelves and goods; its long side runs along x or y."""
    lo, size = np.asarray(solid.extent_m.lo_m), np.asarray(solid.extent_m.size_m)
    long, deep = (0, 1) if size[0] >= size[1] else (1, 0)

    def block(a: tuple[float, float], b: tuple[float, float], c: tuple[float, float], material: str) -> None:
        """Block given by its spans along the length, the depth and the height, from the rack's low corner."""
        low, high = lo.copy(), lo.copy()
        for axis, span in ((long, a), (deep, b), (2, c)):
            low[axis] += span[0]
            high[axis] += span[1]
        maker.box(Box(lo_m=tuple(low), hi_m=tuple(high)), material)

    length, depth, height = float(size[long]), float(size[deep]), float(size[2])
    bays = max(1, round(length / 1.5))
    for i in range(bays + 1):
        at = min(max(i * length / bays - 0.04, 0.0), length - 0.08)
        for side in (0.0, depth - 0.08):
            block((at, at + 0.08), (side, side + 0.08), (0.0, height), "upright")
    for level in range(max(1, 1 + int((height - 0.3) / SHELF_GAP_M))):
        z = 0.12 + level * SHELF_GAP_M
        for side in (0.0, depth - 0.05):
            block((0.0, length), (side, side + 0.05), (z - 0.06, z + 0.04), "rack-beam")
        block((0.0, length), (0.05, depth - 0.05), (z + 0.01, z + 0.04), "wood")
        room = min(SHELF_GAP_M - 0.14, height - z - 0.04)
        _fill_shelf(block, rng, length, depth, z + 0.04, room)


def _fill_shelf(
    block: Callable[..., None], rng: np.random.Generator, length: float, depth: float, z: float, room: float
) -> None:
    """Goods side by side on one shelf, with small gaps; deep racks get two rows."""
    rows = 1 if depth < 1.3 else 2
    for row in range(rows):
        near, far = depth * row / rows + 0.06, depth * (row + 1) / rows - 0.06
        at = 0.12
        while at < length - 0.4:
            width = min(float(rng.uniform(0.35, 0.65)), length - 0.1 - at)
            if rng.random() < 0.9:
                inset = float(rng.uniform(0.0, 0.08))
                top = z + room * float(rng.uniform(0.45, 1.0))
                good = "cardboard" if rng.random() < 0.85 else "wood"
                block((at, at + width), (near + inset, far - inset), (z, top), good)
            at += width + float(rng.uniform(0.03, 0.14))


def _fire(maker: Maker, solid: Solid, rng: np.random.Generator) -> None:
    """Charred wreckage; the flames above it are marched by the renderer, their volume is felt as solid."""
    lo, hi = np.asarray(solid.extent_m.lo_m), np.asarray(solid.extent_m.hi_m)
    centre, half = (lo + hi) / 2, (hi - lo) / 2
    maker.box(solid.extent_m, "unseen", group=UNSEEN_GROUP)
    bed = Box(
        lo_m=tuple(lo + np.array((0.1, 0.1, 0.0))), hi_m=(float(hi[0]) - 0.1, float(hi[1]) - 0.1, float(lo[2]) + 0.14)
    )
    maker.box(bed, "char", solid=False)
    for _ in range(9):
        size = [float(edge) for edge in rng.uniform((0.08, 0.04, 0.04), (0.3, 0.1, 0.1))]
        reach = np.maximum(half[:2] - 0.3, 0.0)
        place = [*(centre[:2] + rng.uniform(-1, 1, 2) * reach), float(lo[2]) + 0.2]
        turn = quaternion(float(rng.uniform(0, math.pi)), float(rng.uniform(-0.35, 0.35)))
        maker.geom("BOX", place, size, "char", solid=False, quat=turn)


def _rubble(maker: Maker, solid: Solid, rng: np.random.Generator) -> None:
    """A heap: blocks, lower towards its edge."""
    lo, size = np.asarray(solid.extent_m.lo_m), np.asarray(solid.extent_m.size_m)
    for _ in range(26):
        edge = size * rng.uniform(0.16, 0.42, 3)
        low = lo + rng.random(3) * (size - edge) * (1.0, 1.0, 0.0)
        away = float(np.max(np.abs((low + edge / 2 - lo) / size - 0.5)[:2])) * 2
        high = low + edge
        high[2] = lo[2] + size[2] * (1.0 - 0.75 * away) * float(rng.uniform(0.6, 1.0))
        maker.box(Box(lo_m=tuple(low), hi_m=tuple(high)), "rubble" if rng.random() < 0.7 else "concrete")


def _crate(maker: Maker, solid: Solid, rng: np.random.Generator) -> None:
    """A wooden crate with corner posts."""
    _plain(maker, solid, rng)


def quaternion(yaw_rad: float, pitch_rad: float) -> list[float]:
    """Turn about z after a turn about y, as (w, x, y, z)."""
    cy, sy, cp, sp = math.cos(yaw_rad / 2), math.sin(yaw_rad / 2), math.cos(pitch_rad / 2), math.sin(pitch_rad / 2)
    return [cy * cp, -sy * sp, cy * sp, sy * cp]


_DRESSERS: dict[str, Callable[[Maker, Solid, np.random.Generator], None]] = {
    "crate": _crate,
    "fire": _fire,
    "partition": _partition,
    "rack": _rack,
    "rubble": _rubble,
}
_USUAL = {"wall": "plaster", "pillar": "concrete", "crate": "wood", "box": "cardboard"}

__all__ = ["CEILING_GROUP", "UNSEEN_GROUP", "Maker", "add_solid", "quaternion", "replaced"]
