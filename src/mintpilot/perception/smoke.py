"""Smoke: where the depth is rougher than the sensor makes it, and the picture has no contrast.

Inside a cloud every return comes from another depth, and many get lost; walls and floors are smooth whatever their
pattern, edges are rough but full of contrast.
"""

from __future__ import annotations

import numpy as np
from scipy.ndimage import binary_dilation, binary_opening, label, uniform_filter

from mintpilot.core.geometry import Bools
from mintpilot.core.observation import Detection
from mintpilot.perception.boxes import box_around, pixel_box
from mintpilot.perception.settings import PerceptionSettings
from mintpilot.perception.view import View, as_floats, mean_around

_THIN = 7
"""Every n-th point of a cloud is enough for the map."""


def smoke_mask(view: View, settings: PerceptionSettings) -> Bools:
    """Pixels (h, w) whose return comes from inside a cloud."""
    depth, valid = view.depth_m, view.valid
    smooth = mean_around(depth, valid, 3)
    off = np.minimum(np.abs(depth - smooth) / view.sigma_m, 12.0).astype(np.float32)
    rough = mean_around(off, valid, 9)
    grey = view.frame.rgb.astype(np.float32).mean(axis=-1)
    mean = uniform_filter(grey, 7)
    contrast = np.sqrt(np.maximum(uniform_filter(grey * grey, 7) - mean * mean, 0))
    lost = uniform_filter((~valid).astype(np.float32), 9)
    # Where many returns get lost too, the roughness of the few that are left is not needed as well.
    soft = contrast <= settings.flat_contrast
    hazy = soft & ((rough >= settings.rough) | ((lost > 0.25) & (rough >= 0.8 * settings.rough)))
    hazy &= view.saturation < 0.75
    opened = binary_opening(hazy, iterations=2)
    return np.asarray(binary_dilation(opened, iterations=3) & soft, bool)


def find_smoke(view: View, mask: Bools, index: int, settings: PerceptionSettings) -> list[Detection]:
    """One detection per connected patch of smoke."""
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
                label="smoke",
                score=min(0.99, 0.5 + size / 4000),
                box_m=box_around(points),
                pixels=pixel_box(patch),
                points_m=points,
                frame_index=index,
            )
        )
    return found
