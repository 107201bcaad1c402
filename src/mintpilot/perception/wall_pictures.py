"""Walls seen straight on: what a picture shows of each wall's plane, and where lines run upright and level on it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mintpilot.core.compiled import compiled
from mintpilot.core.geometry import Bools, Floats, Ints
from mintpilot.perception.bodies import Body, BodyKind, Scene
from mintpilot.perception.patches import SAMPLE, Patch, plane_of
from mintpilot.perception.view import Singles, View, as_floats

CELL_M = 0.03
"""Edge of a cell of a wall's picture."""
HIGH_M = 2.7
"""Walls are looked at up to this height above the floor."""
LAYER_M = 0.25
"""What lies no further before or behind a wall's plane is in the wall."""
TILTED = 0.2
"""Walls are upright but for this height of their normal."""
LEAST_M2 = 0.25
"""Patches of less area make no wall of their own."""
ALIKE_COSINE = math.cos(math.radians(8.0))
"""Patches whose normals agree so well may be one wall …"""
APART_M = 0.2
"""… where they also lie no further from its plane."""
MARGIN_M, NEAREST_M = 0.15, 0.2
"""A wall's picture reaches so much further than what is seen of it; and shows nothing nearer than this."""
LEAST_COLUMNS, MOST_COLUMNS = 8, 2000
"""Shorter walls have no door, and longer ones are none."""
LEAST_STEP, LEAST_STEP_M = 5.0, 0.012
"""A line is where colour changes by at least so many grey levels, or depth by so much …"""
NOISE = 4.0
"""… and by at least so many times what is usual on that wall."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class WallPicture:
    """One wall; arrays are (rows from the floor up, columns along the wall) of cells of `CELL_M`."""

    normal: Floats
    """Horizontal unit vector (3,) towards the camera."""
    along: Floats
    """Horizontal unit vector (3,) along the wall, in which columns count."""
    offset_m: float
    """Place of its plane along the normal."""
    begin_m: float
    """Place of the first column along the wall."""
    seen: Bools
    """Cells that the picture shows, and nothing in front of them."""
    rgb: Singles
    """(rows, columns, 3), 0 to 255; what is not seen is black."""
    off_m: Singles
    """How far before the plane the surface is."""
    upright: Singles
    """Strength, 0 to 1, of an upright line at the left edge of each cell."""
    level: Singles
    """Strength, 0 to 1, of a level line at the lower edge of each cell."""
    pixels: Singles
    """Pixels of the camera's picture that one cell has."""
    pixel: Ints
    """Which pixel of the camera's picture a cell shows, row after row; -1 for none."""


def wall_pictures(view: View, scene: Scene, floor_m: float) -> list[WallPicture]:
    """The walls of a view, the largest first."""
    upright = [b for b in scene.bodies if b.kind is BodyKind.WALL and abs(float(b.patch.normal[2])) <= TILTED]
    groups: list[list[Body]] = []
    for body in sorted(upright, key=lambda b: -b.patch.pixels):
        mine = next((g for g in groups if _continues(g[0].patch, body.patch)), None)
        if mine is not None:
            mine.append(body)
        elif body.patch.area_m2 > LEAST_M2:
            groups.append([body])
    return [made for group in groups if (made := _straight_on(view, scene, group, floor_m)) is not None]


def _continues(wall: Patch, other: Patch) -> bool:
    middle = (other.lo_m + other.hi_m) / 2
    return (
        float(wall.normal @ other.normal) > ALIKE_COSINE and abs(float(wall.normal @ middle) - wall.offset_m) < APART_M
    )


def _straight_on(view: View, scene: Scene, group: Sequence[Body], floor_m: float) -> WallPicture | None:
    points = scene.surfaces.points_m
    main = points[group[0].mask]
    own = as_floats(main[:: max(1, len(main) // SAMPLE)])
    normal, offset = _upright_plane(own, view.frame.world_from_camera[:3, 3])
    along = np.array([-normal[1], normal[0], 0.0])
    every = np.concatenate([points[b.mask] for b in group])[::3] @ along.astype(np.float32)
    begin, end = float(every.min()) - MARGIN_M, float(every.max()) + MARGIN_M
    columns, rows = int((end - begin) / CELL_M), int(HIGH_M / CELL_M)
    if not LEAST_COLUMNS <= columns <= MOST_COLUMNS:
        return None
    lens, pose = view.frame.camera, view.frame.world_from_camera
    corner = offset * normal + (begin + CELL_M / 2) * along + [0.0, 0.0, floor_m + CELL_M / 2] - pose[:3, 3]
    axes = np.stack([corner, CELL_M * along, [0.0, 0.0, CELL_M], normal]) @ pose[:3, :3]
    pixel, rgb, off, pixels = _projected(
        (rows, columns), axes, (lens.fx, lens.fy, lens.cx, lens.cy), view.depth_m, points, view.sigma_m,
        view.frame.rgb, normal.astype(np.float32), np.float32(offset),
    )  # fmt: skip
    seen = pixel >= 0
    if not seen.any():
        return None
    upright, level = _lines(seen, rgb, off), _lines(seen.T, rgb.transpose(1, 0, 2), off.T).T
    return WallPicture(
        normal=normal, along=along, offset_m=offset, begin_m=begin, seen=seen, rgb=rgb, off_m=off,
        upright=upright, level=level, pixels=pixels, pixel=pixel,
    )  # fmt: skip


def _upright_plane(points: Floats, eye: Floats) -> tuple[Floats, float]:
    """Horizontal normal (3,) towards the eye, and place along it, of the upright plane through points (n, 3)."""
    flat = points.copy()
    flat[:, 2] = np.linspace(-1.0, 1.0, len(points))  # heights do not matter
    normal, _, _ = plane_of(flat)
    normal = np.array([normal[0], normal[1], 0.0]) / max(1e-9, math.hypot(normal[0], normal[1]))
    offset = float(np.median(points @ normal))
    return (normal, offset) if eye @ normal > offset else (-normal, -offset)


@compiled(error_model="numpy")
def _projected(
    shape: tuple[int, int],
    axes: Floats,
    lens: tuple[float, float, float, float],
    depth_m: Singles,
    points: Singles,
    sigma_m: Singles,
    colours: NDArray[np.uint8],
    normal: Singles,
    offset: np.float32,
) -> tuple[Ints, Singles, Singles, Singles]:
    """For each cell its pixel, colour, place before the plane, and how many pixels it has."""
    rows, columns = shape
    fx, fy, cx, cy = lens
    height, width = depth_m.shape
    pixel = np.full((rows, columns), -1, np.int64)
    rgb = np.zeros((rows, columns, 3), np.float32)
    off = np.zeros((rows, columns), np.float32)
    pixels = np.zeros((rows, columns), np.float32)
    corner, right, up, out = axes[0], axes[1], axes[2], axes[3]
    towards = abs(corner[0] * out[0] + corner[1] * out[1] + corner[2] * out[2])
    area = CELL_M * CELL_M * fx * fy * towards
    for r in range(rows):
        for c in range(columns):
            x = corner[0] + c * right[0] + r * up[0]
            y = corner[1] + c * right[1] + r * up[1]
            z = corner[2] + c * right[2] + r * up[2]
            if z < NEAREST_M:
                continue
            u, v = math.floor(x / z * fx + cx), math.floor(y / z * fy + cy)
            if u < 0 or v < 0 or u >= width or v >= height or depth_m[v, u] <= 0:
                continue
            p = points[v, u]
            before = p[0] * normal[0] + p[1] * normal[1] + p[2] * normal[2] - offset
            if abs(before) > LAYER_M + 2.0 * sigma_m[v, u]:
                continue
            pixel[r, c] = v * width + u
            off[r, c] = before
            pixels[r, c] = area / (z * z * math.sqrt(x * x + y * y + z * z))
            for k in range(3):
                rgb[r, c, k] = colours[v, u, k]
    return pixel, rgb, off, pixels


def _lines(seen: Bools, rgb: Singles, off: Singles) -> Singles:
    """Strength, 0 to 1, of a line between each column and the one before it, of colour or of depth."""
    colour, depth, known = _steps(seen, np.ascontiguousarray(rgb), np.ascontiguousarray(off))
    if not known.any():
        return np.zeros(off.shape, np.float32)
    usual = np.median(np.stack([colour[known], depth[known]])[:, :: 1 + int(known.sum()) // SAMPLE], axis=1)
    c, d = max(LEAST_STEP, NOISE * float(usual[0])), max(LEAST_STEP_M, NOISE * float(usual[1]))
    strength = np.clip(np.maximum(colour / np.float32(c), depth / np.float32(d)) - np.float32(0.5), 0.0, 1.0)
    wide = strength.copy()
    wide[:, 1:] = np.maximum(wide[:, 1:], strength[:, :-1])
    wide[:, :-1] = np.maximum(wide[:, :-1], strength[:, 1:])
    made: Singles = np.where(seen, wide, np.float32(0))
    return made


@compiled(error_model="numpy")
def _steps(seen: Bools, rgb: Singles, off: Singles) -> tuple[Singles, Singles, Bools]:
    """Differences, over three rows, of colour and of depth between the two columns from each on and the two before it.

    And whether enough of both is seen.
    """
    rows, columns = off.shape
    colour, depth = np.zeros((rows, columns), np.float32), np.zeros((rows, columns), np.float32)
    known = np.zeros((rows, columns), np.bool_)
    sums = np.zeros((columns, 5))
    for r in range(rows):
        sums[:] = 0
        for y in range(max(0, r - 1), min(rows, r + 2)):
            for c in range(columns):
                if seen[y, c]:
                    for k in range(3):
                        sums[c, k] += rgb[y, c, k]
                    sums[c, 3] += off[y, c]
                    sums[c, 4] += 1
        for c in range(2, columns - 1):
            before, after = sums[c - 2, 4] + sums[c - 1, 4], sums[c, 4] + sums[c + 1, 4]
            if before > 2 and after > 2:
                known[r, c] = True
                depth[r, c] = abs((sums[c - 2, 3] + sums[c - 1, 3]) / before - (sums[c, 3] + sums[c + 1, 3]) / after)
                for k in range(3):
                    step = abs((sums[c - 2, k] + sums[c - 1, k]) / before - (sums[c, k] + sums[c + 1, k]) / after)
                    colour[r, c] = max(colour[r, c], step)
    return colour, depth, known
