"""Smoke and fire where depth itself says so: neither is a surface.

What is smooth is neither smoke nor flames, whatever its colour: a sunlit wall and a floor of parquet lie in a plane.
"""

from __future__ import annotations

import numpy as np

from mintpilot.core.geometry import Bools
from mintpilot.core.observation import Detection
from mintpilot.perception.bodies import Scene
from mintpilot.perception.geometric import find_fire
from mintpilot.perception.settings import PerceptionSettings
from mintpilot.perception.smoke import find_smoke, smoke_mask
from mintpilot.perception.view import View

BROKEN = 0.5
"""So much of a patch of smoke or flames is no surface: depth jumps there, or is missing."""
DEPTH_M = 0.06
"""Depth inside of a cloud varies by at least this from pixel to pixel, metres, besides the sensor's noise."""


def find_hazards(view: View, scene: Scene, index: int, settings: PerceptionSettings) -> tuple[list[Detection], Bools]:
    """Smoke and flames, and the pixels (h, w) that they cover."""
    broken = scene.surfaces.edges | ~view.valid
    rough = broken | (np.abs(view.depth_m - scene.surfaces.depth_m) > DEPTH_M + 3 * view.sigma_m)
    covered = np.zeros(view.valid.shape, bool)
    found = []
    fires, burning = find_fire(view, index, settings)
    for fire in fires:
        if _share(rough & burning, fire.pixels, burning) >= BROKEN:
            found.append(fire)
            left, top, right, bottom = fire.pixels
            covered[top:bottom, left:right] |= burning[top:bottom, left:right]
    hazy = smoke_mask(view, settings) & ~burning
    for smoke in find_smoke(view, hazy, index, settings):
        if _share(rough & hazy, smoke.pixels, hazy) >= BROKEN:
            found.append(smoke)
            left, top, right, bottom = smoke.pixels
            covered[top:bottom, left:right] |= hazy[top:bottom, left:right]
    return found, covered


def _share(broken: Bools, pixels: tuple[int, int, int, int], own: Bools) -> float:
    left, top, right, bottom = pixels
    window = (slice(top, bottom), slice(left, right))
    return float(broken[window].sum()) / max(1, int(own[window].sum()))
