"""Smoke: where the depth is rougher than the sensor makes it, and the picture has no contrast.

Inside a cloud every return comes from another depth, and many get lost; walls and floors are smooth whatever their
pattern, edges are rough but full of contrast.
"""

from __future__ import annotations

import numpy as np
from scipy.ndimage import label, maximum_filter, minimum_filter, uniform_filter

from mintpilot.core.geometry import Bools
from mintpilot.core.observation import Detection
from mintpilot.perception.boxes import box_around, pixel_box
from mintpilot.perception.settings import PerceptionSettings
from mintpilot.perception.view import Singles, View, as_floats, mean_around

_LEAST_FLOOR = 800
"""Fewer pixels of floor do not tell the sensor's noise."""
_USUAL = 0.6
"""Median deviation of a return from its neighbours' mean, in standard deviations, as the settings have them."""
_STEP_M = 0.4
"""Higher steps of the depth from pixel to pixel, besides the sensor's noise, are outlines."""
_EMBER_HUES = (8.0, 45.0)
"""Hue of smoke in the light of flames, degrees."""
_LIT = 0.5
"""Smoke of that hue is grey but for flames near by: from this saturation on they are within a metre or so."""
_IN_PLANE = 0.8
"""This share of the returns from a surface …"""
_PLANE_M = 0.04
"""… lies this near to its plane; those from a cloud come from tenths of a metre of depth."""
_SAMPLE = 500
"""About so many points tell whether a patch is flat."""
_LEAST_POINTS = 12
"""Fewer tell nothing."""
_THIN = 7
"""Every n-th point of a cloud is enough for the map."""


def smoke_mask(view: View, settings: PerceptionSettings) -> Bools:
    """Pixels (h, w) whose return comes from inside a cloud.

    What is clearly smoke is the seed; it grows over what is less clearly so but hangs together with it.
    """
    depth, valid = view.depth_m, view.valid
    off = np.minimum(np.abs(depth - mean_around(depth, valid, 3)) / view.sigma_m, 12.0).astype(np.float32)
    rough = mean_around(off, valid & ~_outlines(view), 9) / _surface_roughness(view, off, settings)
    contrast = _contrast(view)
    soft = (contrast <= settings.flat_contrast) & (view.saturation < 0.75)
    weak = (rough >= settings.perhaps_rough) & (contrast <= 2 * settings.flat_contrast) & (view.saturation < 0.75)
    # Opening with a square is separable, and so much quicker than many small steps.
    weak = np.asarray(maximum_filter(minimum_filter(weak, 5), 5), bool)
    labels, count = label(weak)
    seeds = np.bincount(labels[weak & soft & (rough >= settings.rough)], minlength=count + 1)
    seeds[0] = 0
    likely = seeds >= settings.least_smoke_pixels / 3
    for number in np.flatnonzero(likely):
        likely[number] = not _is_flat(view, (labels == number) & valid)
    grown = likely[labels]
    return np.asarray(maximum_filter(grown, 7) & (contrast <= 2 * settings.flat_contrast), bool)


def _is_flat(view: View, patch: Bools) -> bool:
    """Whether the patch is one surface seen edge-on: many returns get lost there too, but the others lie in a plane."""
    points = as_floats(view.points_m[patch])
    points = points[:: max(1, len(points) // _SAMPLE)]
    if len(points) < _LEAST_POINTS:
        return False
    near = np.ones(len(points), bool)
    for _ in range(3):  # least squares, then twice more without the strays
        centre = points[near].mean(axis=0)
        normal = np.linalg.svd(points[near] - centre, full_matrices=False)[2][2]
        off = np.abs((points - centre) @ normal)
        near = off <= np.percentile(off, 100 * _IN_PLANE)
    return bool(np.percentile(off, 100 * _IN_PLANE) < _PLANE_M)


def _outlines(view: View) -> Bools:
    """Pixels at a step of the depth that is too high for a cloud: the outlines of things are rough, but no smoke."""
    depth, step = np.where(view.valid, view.depth_m, np.float32(np.nan)), _STEP_M + 6.0 * view.sigma_m
    edges = np.zeros(depth.shape, bool)
    edges[:, 1:] |= np.abs(np.diff(depth, axis=1)) > step[:, 1:]
    edges[1:, :] |= np.abs(np.diff(depth, axis=0)) > step[1:, :]
    return np.asarray(maximum_filter(edges, 3), bool)


def _contrast(view: View) -> Singles:
    """Standard deviation of the strongest colour channel around each pixel, grey levels."""
    strongest = np.zeros(view.valid.shape, np.float32)
    for channel in range(3):
        levels = view.frame.rgb[..., channel].astype(np.float32)
        mean = uniform_filter(levels, 7)
        np.maximum(strongest, uniform_filter(levels * levels, 7) - mean * mean, out=strongest)
    return np.asarray(np.sqrt(strongest), np.float32)


def _surface_roughness(view: View, off: Singles, settings: PerceptionSettings) -> float:
    """How rough true surfaces are to this sensor, against what the settings expect: measured on the floor.

    A sensor that is noisier than thought would else see smoke everywhere. 1 where too little floor is in view.
    """
    floor = view.valid & (np.abs(view.points_m[..., 2] - settings.floor_m) < 0.03 + 1.5 * view.sigma_m)
    if int(floor.sum()) < _LEAST_FLOOR:
        return 1.0
    return max(1.0, float(np.median(off[floor])) / _USUAL)


def find_glow(view: View, mask: Bools, index: int, settings: PerceptionSettings) -> list[Detection]:
    """One detection per patch of smoke that flames inside or right behind it light up; the flames are not seen."""
    low, high = _EMBER_HUES
    lit = mask & (view.saturation >= _LIT) & (view.hue > low) & (view.hue < high)
    return _patches(view, lit, "glow", index, settings)


def find_smoke(view: View, mask: Bools, index: int, settings: PerceptionSettings) -> list[Detection]:
    """One detection per connected patch of smoke."""
    return _patches(view, mask, "smoke", index, settings)


def _patches(view: View, mask: Bools, name: str, index: int, settings: PerceptionSettings) -> list[Detection]:
    labels, count = label(mask)
    found = []
    for number in range(1, count + 1):
        patch = (labels == number) & view.valid
        size = int(patch.sum())
        if size < settings.least_smoke_pixels:
            continue
        points = as_floats(view.points_m[patch][::_THIN])
        found.append(
            Detection(
                label=name,
                score=min(0.99, 0.5 + size / 4000),
                box_m=box_around(points),
                pixels=pixel_box(patch),
                points_m=points,
                frame_index=index,
            )
        )
    return found
