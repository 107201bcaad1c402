"""Shut doors: brown leaves of a door's size, upright and flat, standing on the floor."""

from __future__ import annotations

import numpy as np
from scipy.ndimage import binary_dilation, label

from mintpilot.core.geometry import Bools, Floats
from mintpilot.core.observation import Attribute, Detection
from mintpilot.perception.boxes import box_around, pixel_box
from mintpilot.perception.morphology import closed, dilated
from mintpilot.perception.settings import PerceptionSettings
from mintpilot.perception.view import View, as_floats

HEIGHT_M = (1.7, 2.3)
LEAST_SEEN_M = 1.5
"""A leaf whose top or bottom is outside the picture shows at least this much of its height."""
WIDTH_M = (0.6, 1.35)
THICK_M = 0.06
"""A leaf is flat; bricks are too, goods on shelves are not."""
PAINTED = 0.45
"""Least saturation, median: paint and stained wood are well above brick in its mortar."""
SURE_M = 6.0
"""Nearer than this a leaf of a full colour is told for certain."""
SURE, UNSURE = 0.92, 0.33
"""Score of a leaf that is told for certain, and of another one: four sightings of it make a door."""
LEAST_PIXELS = 60
IN_WALL = 0.8
"""Share of what is right beside a leaf that must be wall."""
HAZE = 0.1
"""Seen through smoke everything is brown: patches with more haze than this are not looked at."""


def brown_mask(view: View) -> Bools:
    """Pixels of the colour of wood or brown paint."""
    hue, value = view.hue, view.value
    brown = (hue > 15) & (hue < 42) & (view.saturation > 0.28) & (value > 30) & (value < 190)
    return np.asarray(brown & view.valid, bool)


def find_doors(view: View, hazy: Bools, index: int, settings: PerceptionSettings) -> list[Detection]:
    """One detection per brown patch that has the shape of a leaf; a pane or a handle in it does not matter."""
    near = view.valid & (view.depth_m < settings.reach_m)
    mask = closed(brown_mask(view), 2) & near
    labels, count = label(mask)
    haze = dilated(hazy, 4)
    sizes = np.bincount(labels.ravel(), minlength=count + 1)
    found = []
    for number in np.flatnonzero(sizes >= LEAST_PIXELS):
        patch = np.asarray(labels == number, bool)
        if number == 0 or float(haze[patch].mean()) > HAZE:
            continue
        door = _as_door(view, patch, index, settings)
        if door is not None:
            found.append(door)
    return found


def _as_door(view: View, patch: Bools, index: int, settings: PerceptionSettings) -> Detection | None:
    points = as_floats(view.points_m[patch])
    normal, thick, wide = _flatness(points)
    noise = float(np.median(view.sigma_m[patch]))
    low, high = (float(h) - settings.floor_m for h in np.percentile(points[:, 2], (2, 98)))
    pixels = pixel_box(patch)
    if not _door_high(low, high, pixels, patch.shape) or not WIDTH_M[0] <= wide <= WIDTH_M[1]:
        return None
    if thick > THICK_M + 1.5 * noise or abs(float(normal[2])) > 0.2 or np.median(view.saturation[patch]) < PAINTED:
        return None
    # A patch of goods on a shelf is brown too, but it has gaps, and no wall around it.
    rows = float(np.asarray(patch.any(axis=1))[pixels[1] : pixels[3]].mean())
    if rows < 0.97 or _wall_around(view, patch, points, normal) < IN_WALL:
        return None
    sure = np.median(view.depth_m[patch]) < SURE_M and _one_paint(view, patch)
    return Detection(
        label="door",
        score=SURE if sure else UNSURE,
        box_m=box_around(points),
        attributes=(Attribute(name="colour", value="brown"),),
        pixels=pixels,
        points_m=points[:: max(1, len(points) // 400)],
        frame_index=index,
    )


def _one_paint(view: View, patch: Bools) -> bool:
    """Whether a patch is of one full colour, as paint is and stacked goods are not."""
    low, high = np.percentile(view.hue[patch], (20, 80))
    return bool(high - low < 6.0 and np.median(view.saturation[patch]) > 0.6)


def _door_high(low: float, high: float, pixels: tuple[int, int, int, int], shape: tuple[int, ...]) -> bool:
    """Whether a patch reaches from the floor to a door's height, as far as the picture shows it."""
    left, top, right, bottom = pixels
    if left < 2 or right > shape[1] - 2 or high > HEIGHT_M[1] or high - low < LEAST_SEEN_M:
        return False
    return (low < 0.4 or bottom > shape[0] - 3) and (high >= HEIGHT_M[0] or top < 3)


def _wall_around(view: View, patch: Bools, points: Floats, normal: Floats) -> float:
    """Share of the pixels right beside a patch, above the floor, that lie in its plane."""
    beside = binary_dilation(patch, structure=np.ones((1, 3), bool), iterations=8) & ~patch & view.valid
    beside &= view.points_m[..., 2] > 0.3
    if not beside.any():
        return 0.0
    off = np.abs((as_floats(view.points_m[beside]) - points.mean(axis=0)) @ normal)
    return float((off < 0.15 + 3 * view.sigma_m[beside]).mean())


def _flatness(points: Floats) -> tuple[Floats, float, float]:
    """Normal (3,) of the plane nearest to the points; how thick (std) and how wide (level extent) they are, metres."""
    centred = points - points.mean(axis=0)
    vectors: Floats = np.linalg.eigh(centred.T @ centred)[1]
    normal = vectors[:, 0]
    along = np.array([-normal[1], normal[0], 0.0])
    length = float(np.linalg.norm(along))
    if length < 1e-6:
        return normal, np.inf, np.inf
    spread = centred @ (along / length)
    lo, hi = np.percentile(spread, (1.5, 98.5))
    return normal, float((centred @ normal).std()), float(hi - lo)
