"""Leaves in walls: shut doors of any colour, told by a door's outline in colour or in relief."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy.ndimage import gaussian_filter, label, sobel

from mintpilot.core.geometry import Bools, Floats
from mintpilot.core.observation import Attribute, Detection
from mintpilot.perception.bodies import Body, BodyKind, Scene
from mintpilot.perception.boxes import box_around, pixel_box
from mintpilot.perception.colours import colour_word
from mintpilot.perception.morphology import closed, opened
from mintpilot.perception.settings import PerceptionSettings
from mintpilot.perception.view import Singles, View, as_floats, mean_around

WIDTH_M, HEIGHT_M = (0.6, 2.0), (1.8, 2.3)
"""Doors, those of two leaves included."""
FOOT_M = 0.15
"""A leaf begins no higher above the floor."""
FILLS = 0.85
"""A leaf fills this share of its rectangle."""
PIXELS_A_CELL = 8
"""A leaf's rectangle is parted into cells of about so many pixels, at most 12 by 24."""
BESIDE = 0.6
"""So much of what is right beside a leaf must be wall."""
RELIEF_M = 0.02
"""Leaves are set back, or stand out, by at least this besides the sensor's noise."""
DIFFERENT = 0.16
"""A leaf's colour differs from its wall's median by at least this share of the full range in one channel."""
STRIP_M = 0.25
ALIKE_M, ALIKE_SHARE = 0.12, 0.3
"""Panels of one cladding end at the same height within this, and are as wide within this share."""
AVERAGED = 5
"""Relief is averaged over a square of so many pixels."""
BAND_M, BANDS = 0.3, 16
"""Height and number of the bands in which a wall's colour is measured."""
AROUND = 4
"""So many pixels around what is close to a wall are looked at with it: masks grow by no more."""
LEAST_SHARE, MOST_SHARE = 0.004, 0.4
"""A leaf has at least, and at most, these shares of the picture."""
LINE, LINE_NOISE = 2.5, 4.0
"""Where the picture changes by more grey levels a pixel, and by more than this many times the usual, is a line."""
SURE, LIKELY = 0.92, 0.75
"""Score of a leaf with wall to both sides, and of another one."""


def find_leaves(view: View, scene: Scene, index: int, settings: PerceptionSettings) -> list[Detection]:
    """Shut doors in the walls of a view. Each wall's outliers in colour, and in relief, are held against a door."""
    found: list[Detection] = []
    least = LEAST_SHARE * view.valid.size
    walls = [b for b in scene.bodies if b.kind is BodyKind.WALL and abs(float(b.patch.normal[2])) <= 0.2]
    walls = [b for b in walls if b.patch.pixels >= least and b.patch.hi_m[2] - settings.floor_m > HEIGHT_M[0] / 2]
    lines = _lines(view) if walls else None
    for wall in walls:
        assert lines is not None
        patches = list(_outliers(view, scene, wall, lines))
        panels = [_extent(scene, wall, patch) for patch, by_outline in patches if by_outline]
        for patch, by_outline in patches:
            leaf = _as_leaf(view, scene, wall, patch, by_outline, index, settings)
            if leaf is None or any(_same(leaf, other) for other in found):
                continue
            if by_outline and any(_in_a_row(_extent(scene, wall, patch), other) for other in panels):
                continue
            found.append(leaf)
    return found


@dataclass(frozen=True, slots=True)
class _Extent:
    """Where a patch of a wall lies along the wall, and its height, metres."""

    left: float
    right: float
    high: float


def _extent(scene: Scene, wall: Body, patch: Bools) -> _Extent:
    points = as_floats(scene.surfaces.points_m[patch])
    left, right = np.percentile(points @ _along(wall), (1.5, 98.5))
    return _Extent(float(left), float(right), float(np.percentile(points[:, 2], 98.5)))


def _along(wall: Body) -> Floats:
    """The horizontal direction of a wall."""
    normal = wall.patch.normal
    return np.array([-normal[1], normal[0], 0.0]) / max(1e-9, math.hypot(normal[0], normal[1]))


def _in_a_row(one: _Extent, other: _Extent) -> bool:
    """Whether two outlined patches are panels of one cladding: right beside each other, as wide and as high.

    Things in front may hide where the other one begins.
    """
    gap = max(other.left - one.right, one.left - other.right)
    as_wide = abs((other.right - other.left) / (one.right - one.left) - 1) < ALIKE_SHARE
    return as_wide and abs(gap) < STRIP_M and abs(one.high - other.high) < ALIKE_M


def _outliers(view: View, scene: Scene, wall: Body, lines: Bools) -> Iterator[tuple[Bools, bool]]:
    """Patches in or next to a wall's plane: of another colour, set back or standing out; or, True, outlined."""
    points = scene.surfaces.points_m
    off = points @ wall.patch.normal.astype(np.float32) - np.float32(wall.patch.offset_m)
    close = view.valid & (np.abs(off) < 0.2 + 2.0 * view.sigma_m)
    if not close.any():
        return
    left, top, right, bottom = pixel_box(close)
    part = slice(max(0, top - AROUND), bottom + AROUND), slice(max(0, left - AROUND), right + AROUND)
    close, off, valid = close[part], off[part], view.valid[part]
    rgb = view.frame.rgb.astype(np.float32)
    usual = np.median(rgb[wall.mask], axis=0)
    coloured = close & (np.abs(rgb[part] - usual).max(axis=-1) > 255 * DIFFERENT)
    banded = close & (np.abs(rgb[part] - _bands(rgb, points, wall, usual)[part]).max(axis=-1) > 255 * DIFFERENT)
    level = mean_around(off.astype(np.float32), close, AVERAGED)
    relief = close & (np.abs(level) > RELIEF_M + 2.0 * view.sigma_m[part] / AVERAGED)
    outlined = close & ~lines[part]
    masks = [(coloured, 2), (relief, 2), (outlined, 0)]
    if (banded != coloured).sum() > LEAST_SHARE * view.valid.size:
        masks.append((banded, 2))
    for mask, closing in masks:
        labels, count = label(opened(closed(mask, closing), 2) & valid)
        sizes = np.bincount(labels.ravel(), minlength=count + 1)
        few, many = LEAST_SHARE * view.valid.size, MOST_SHARE * view.valid.size
        for number in np.flatnonzero((sizes > few) & (sizes < many)):
            if number:
                patch = np.zeros(view.valid.shape, bool)
                patch[part] = labels == number
                yield patch, mask is outlined


def _bands(rgb: Singles, points: Singles, wall: Body, usual: Singles) -> Singles:
    """For each pixel (h, w, 3) the wall's usual colour at its height: walls are often painted in bands."""
    band = np.clip(((points[..., 2] - wall.patch.lo_m[2]) / BAND_M).astype(np.int64), 0, BANDS - 1)
    colours = np.tile(usual, (BANDS, 1))
    own, seen = band[wall.mask], rgb[wall.mask]
    for number in np.unique(own):
        colours[number] = np.median(seen[own == number], axis=0)
    of_pixel: Singles = colours[band]
    return of_pixel


def _lines(view: View) -> Bools:
    """Pixels at which the picture changes: outlines of leaves and frames, whatever their colours."""
    change = np.zeros(view.valid.shape, np.float32)
    for channel in range(3):
        smooth = gaussian_filter(view.frame.rgb[..., channel].astype(np.float32), 0.7)
        np.maximum(change, np.hypot(sobel(smooth, 0), sobel(smooth, 1)) / 8, out=change)
    return np.asarray(change > max(LINE, LINE_NOISE * float(np.median(change))), bool)


def _as_leaf(
    view: View, scene: Scene, wall: Body, patch: Bools, by_outline: bool, index: int, settings: PerceptionSettings
) -> Detection | None:
    points = as_floats(scene.surfaces.points_m[patch])
    along = _along(wall)
    if np.ptp(points @ along) < WIDTH_M[0] or points[:, 2].max() - settings.floor_m < HEIGHT_M[0]:
        return None
    left, right = np.percentile(points @ along, (1.5, 98.5))
    low, high = np.percentile(points[:, 2], (1.5, 98.5)) - settings.floor_m
    pixels = pixel_box(patch)
    if not WIDTH_M[0] <= right - left <= WIDTH_M[1] or low > FOOT_M or not HEIGHT_M[0] <= high <= HEIGHT_M[1]:
        return None
    if pixels[0] < 2 or pixels[2] > patch.shape[1] - 2:
        return None
    if _filled(points @ along, points[:, 2]) < FILLS or _flat(points) > 0.02 + float(np.median(view.sigma_m[patch])):
        return None
    sides = _beside(scene, wall, points, along, left, right)
    if max(sides) < BESIDE or (by_outline and (min(sides) < BESIDE or pixels[1] < 2)):
        return None  # what is nothing but outlined must have wall to both sides, and end below the picture's edge
    colour = colour_word(view.hue[patch], view.saturation[patch], view.value[patch])
    return Detection(
        label="door",
        score=SURE if min(sides) >= BESIDE and pixels[1] >= 2 else LIKELY,
        box_m=box_around(points),
        attributes=(Attribute(name="colour", value=colour),),
        pixels=pixels,
        points_m=points[:: max(1, len(points) // 400)],
        frame_index=index,
    )


def _filled(across: Floats, up: Floats) -> float:
    """Share of a coarse grid over the rectangle of the points that holds any."""
    width = int(np.clip(math.sqrt(len(up) / PIXELS_A_CELL / 2), 4, 12))  # far away there are few pixels
    x = np.clip(((across - across.min()) / max(np.ptp(across), 1e-6) * width).astype(int), 0, width - 1)
    y = np.clip(((up - up.min()) / max(np.ptp(up), 1e-6) * 2 * width).astype(int), 0, 2 * width - 1)
    return len(np.unique(y * width + x)) / (2 * width**2)


def _flat(points: Floats) -> float:
    """Standard deviation of most points from their plane, metres."""
    centred = points - points.mean(axis=0)
    normal = np.linalg.eigh(centred.T @ centred)[1][:, 0]
    off = np.abs(centred @ normal)
    return float(off[off <= np.percentile(off, 90)].std())


def _beside(scene: Scene, wall: Body, points: Floats, along: Floats, left: float, right: float) -> list[float]:
    """Share of the heights of a leaf at which the wall is seen right beside it, to either side."""
    own = as_floats(scene.surfaces.points_m[wall.mask])
    across, up = own @ along, own[:, 2]
    low, high = float(points[:, 2].min()), float(points[:, 2].max())
    rows = np.clip(((up - low) / max(high - low, 1e-6) * 10).astype(int), -1, 10)
    sides = []
    for near in ((across > left - STRIP_M) & (across < left), (across > right) & (across < right + STRIP_M)):
        inside = near & (rows >= 0) & (rows < 10)
        sides.append(len(np.unique(rows[inside])) / 10)
    return sides


def _same(a: Detection, b: Detection) -> bool:
    return math.dist(a.position_m, b.position_m) < 0.4
