"""Free-standing things: patches of pixels that rise from the floor, apart from walls and racks."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from scipy.ndimage import label

from mintpilot.core.geometry import Bools
from mintpilot.perception.morphology import dilated
from mintpilot.perception.settings import PerceptionSettings
from mintpilot.perception.view import Singles, View

HAZY = 0.2
"""A patch with more than this share next to smoke or flames is a scrap of them."""
COLUMN_M = 0.1
"""Edge of the columns in which something tall is looked for."""


def standing_patches(view: View, ignore: Bools, settings: PerceptionSettings) -> Iterator[Bools]:
    """Masks (h, w) of connected patches of low things.

    Args:
        view: the frame.
        ignore: pixels of smoke and fire.
        settings: sizes.
    """
    height = view.points_m[..., 2] - settings.floor_m
    above_floor = height > 0.05 + 3.0 * view.sigma_m * _tilt(view)
    low = view.valid & ~ignore & above_floor & (view.depth_m < settings.reach_m)
    low &= (height < settings.tallest_object_m + 0.1) & ~_in_tall_columns(view, height, settings)
    patches = low & ~_depth_edges(view)
    labels, count = label(patches)
    sizes = np.bincount(labels.ravel(), minlength=count + 1)
    near_haze = dilated(ignore, 3)
    for number in np.flatnonzero(sizes >= settings.least_pixels):
        core = labels == number
        if number == 0 or float(near_haze[core].mean()) > HAZY:
            continue
        # The rim that the edges took away belongs to the nearer thing.
        yield core | (dilated(core, 1) & low & (labels == 0))


def _tilt(view: View) -> float:
    """How much of an error along the optical axis is an error of height."""
    return float(min(1.0, abs(view.frame.world_from_camera[2, 2]) + 0.5))


def _in_tall_columns(view: View, height: Singles, settings: PerceptionSettings) -> Bools:
    """Pixels in columns in which this frame sees something tall."""
    x = np.floor(view.points_m[..., 0] / COLUMN_M).astype(np.int64)
    y = np.floor(view.points_m[..., 1] / COLUMN_M).astype(np.int64)
    x0, y0 = int(x[view.valid].min()), int(y[view.valid].min())
    nx, ny = int(x[view.valid].max()) - x0 + 1, int(y[view.valid].max()) - y0 + 1
    tall = np.zeros((ny, nx), bool)
    reaching = view.valid & (height > settings.tall_m)
    tall[y[reaching] - y0, x[reaching] - x0] = True
    wide = dilated(tall, 1)
    inside = np.zeros(view.valid.shape, bool)
    inside[view.valid] = wide[y[view.valid] - y0, x[view.valid] - x0]
    return inside


def _depth_edges(view: View) -> Bools:
    """Pixels at a jump of depth to the pixel on the right or below."""
    depth = view.depth_m
    jump = 0.05 + 5.0 * view.sigma_m + 0.012 * depth
    edges = np.zeros(depth.shape, bool)
    across = np.abs(np.diff(depth, axis=1)) > jump[:, 1:]
    down = np.abs(np.diff(depth, axis=0)) > jump[1:, :]
    edges[:, 1:] |= across
    edges[:, :-1] |= across
    edges[1:, :] |= down
    edges[:-1, :] |= down
    return edges
