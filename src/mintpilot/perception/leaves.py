"""Leaves in walls: shut doors of any colour, told by a door's outline in colour or in relief."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from scipy.ndimage import binary_closing, binary_opening, label

from mintpilot.core.geometry import Bools, Floats
from mintpilot.core.observation import Attribute, Detection
from mintpilot.perception.bodies import Body, BodyKind, Scene
from mintpilot.perception.boxes import box_around, pixel_box
from mintpilot.perception.colours import colour_word
from mintpilot.perception.settings import PerceptionSettings
from mintpilot.perception.view import View, as_floats

WIDTH_M, HEIGHT_M = (0.6, 1.35), (1.8, 2.3)
"""Leaves of doors."""
FOOT_M = 0.15
"""A leaf begins no higher above the floor."""
FILLS = 0.85
"""A leaf fills this share of its rectangle."""
BESIDE = 0.6
"""So much of what is right beside a leaf must be wall."""
RELIEF_M = 0.02
"""Leaves are set back, or stand out, by at least this besides the sensor's noise."""
DIFFERENT = 0.16
"""A leaf's colour differs from its wall's median by at least this share of the full range in one channel."""
STRIP_M = 0.25


def find_leaves(view: View, scene: Scene, index: int, settings: PerceptionSettings) -> list[Detection]:
    """Shut doors in the walls of a view. Each wall's outliers in colour, and in relief, are held against a door."""
    found: list[Detection] = []
    for wall in scene.bodies:
        if wall.kind is not BodyKind.WALL or abs(float(wall.patch.normal[2])) > 0.2:
            continue
        for patch in _outliers(view, scene, wall):
            leaf = _as_leaf(view, scene, wall, patch, index, settings)
            if leaf is not None and not any(_same(leaf, other) for other in found):
                found.append(leaf)
    return found


def _outliers(view: View, scene: Scene, wall: Body) -> Iterator[Bools]:
    """Patches of another colour than the wall, or set back from it, in or next to its plane."""
    points = scene.surfaces.points_m
    off = points @ wall.patch.normal.astype(np.float32) - np.float32(wall.patch.offset_m)
    noise = 2.0 * view.sigma_m
    close = view.valid & (np.abs(off) < 0.2 + noise)
    rgb = view.frame.rgb.astype(np.float32) / 255
    usual = np.median(rgb[wall.mask], axis=0)
    coloured = close & (np.abs(rgb - usual).max(axis=-1) > DIFFERENT)
    relief = close & (np.abs(off) > RELIEF_M + noise)
    for mask in (coloured, relief):
        clean = binary_opening(binary_closing(mask, iterations=2), iterations=2)
        labels, count = label(clean & view.valid)
        sizes = np.bincount(labels.ravel(), minlength=count + 1)
        for number in np.flatnonzero(sizes > 0.004 * mask.size):
            if number:
                yield labels == number


def _as_leaf(
    view: View, scene: Scene, wall: Body, patch: Bools, index: int, settings: PerceptionSettings
) -> Detection | None:
    points = as_floats(scene.surfaces.points_m[patch])
    normal = wall.patch.normal
    along = np.array([-normal[1], normal[0], 0.0]) / max(1e-9, math.hypot(normal[0], normal[1]))
    left, right = np.percentile(points @ along, (1.5, 98.5))
    low, high = np.percentile(points[:, 2], (1.5, 98.5)) - settings.floor_m
    pixels = pixel_box(patch)
    if not WIDTH_M[0] <= right - left <= WIDTH_M[1] or low > FOOT_M or not HEIGHT_M[0] <= high <= HEIGHT_M[1]:
        return None
    if pixels[0] < 2 or pixels[2] > patch.shape[1] - 2:
        return None
    if _filled(points @ along, points[:, 2]) < FILLS or _flat(points) > 0.02 + float(np.median(view.sigma_m[patch])):
        return None
    if _beside(scene, wall, points, along, left, right) < BESIDE:
        return None
    colour = colour_word(view.hue[patch], view.saturation[patch], view.value[patch])
    return Detection(
        label="door",
        score=0.75,
        box_m=box_around(points),
        attributes=(Attribute(name="colour", value=colour),),
        pixels=pixels,
        points_m=points[:: max(1, len(points) // 400)],
        frame_index=index,
    )


def _filled(across: Floats, up: Floats) -> float:
    """Share of a coarse grid over the rectangle of the points that holds any."""
    x = np.clip(((across - across.min()) / max(np.ptp(across), 1e-6) * 12).astype(int), 0, 11)
    y = np.clip(((up - up.min()) / max(np.ptp(up), 1e-6) * 24).astype(int), 0, 23)
    return len(np.unique(y * 12 + x)) / (12 * 24)


def _flat(points: Floats) -> float:
    """Standard deviation of most points from their plane, metres."""
    centred = points - points.mean(axis=0)
    normal = np.linalg.eigh(centred.T @ centred)[1][:, 0]
    off = np.abs(centred @ normal)
    return float(off[off <= np.percentile(off, 90)].std())


def _beside(scene: Scene, wall: Body, points: Floats, along: Floats, left: float, right: float) -> float:
    """Share of the heights of a leaf at which the wall is seen right beside it, the better side of the two."""
    own = as_floats(scene.surfaces.points_m[wall.mask])
    across, up = own @ along, own[:, 2]
    low, high = float(points[:, 2].min()), float(points[:, 2].max())
    rows = np.clip(((up - low) / max(high - low, 1e-6) * 10).astype(int), -1, 10)
    sides = []
    for near in ((across > left - STRIP_M) & (across < left), (across > right) & (across < right + STRIP_M)):
        inside = near & (rows >= 0) & (rows < 10)
        sides.append(len(np.unique(rows[inside])) / 10)
    return max(sides)


def _same(a: Detection, b: Detection) -> bool:
    return math.dist(a.position_m, b.position_m) < 0.4
