"""Perception by geometry and colour: no trained model, no list of what is there."""

from __future__ import annotations

import numpy as np
from scipy.ndimage import label

from mintpilot.core.geometry import Bools
from mintpilot.core.observation import Detection, Frame
from mintpilot.core.ports import Perception
from mintpilot.perception.boxes import box_around, pixel_box
from mintpilot.perception.doors import find_doors
from mintpilot.perception.morphology import closed
from mintpilot.perception.settings import PerceptionSettings
from mintpilot.perception.smoke import find_glow, find_smoke, smoke_mask
from mintpilot.perception.solids import standing_patches
from mintpilot.perception.things import name_patch
from mintpilot.perception.view import View, as_floats, look_at

FLAME_HUES = 9.0
"""Degrees of hue, at least, from the tenth to the ninetieth percentile of flames."""
EMBERS_M = 0.9
"""What lies this near to flames is what burns."""
LEAST_SIDE = 16
"""Smaller pictures show nothing."""


class GeometricPerception(Perception):
    """Finds boxes, people lying, fire, smoke and shut doors in one RGB-D frame.

    Args:
        settings: sensor model and sizes; None for the defaults.
    """

    def __init__(self, settings: PerceptionSettings | None = None) -> None:
        self._settings = settings or PerceptionSettings()

    def detect(self, frame: Frame, index: int) -> tuple[Detection, ...]:
        """What the frame shows. A picture without usable depth, or a very small one, shows nothing."""
        if min(frame.depth_m.shape) < LEAST_SIDE:
            return ()
        view = look_at(frame, self._settings)
        if not view.valid.any():
            return ()
        hazy = smoke_mask(view, self._settings)
        fires, burning = find_fire(view, index, self._settings)
        found = find_smoke(view, hazy & ~burning, index, self._settings) + fires
        found += find_glow(view, hazy & ~burning, index, self._settings)
        found += find_doors(view, hazy, index, self._settings)
        for patch in standing_patches(view, hazy | burning, self._settings):
            thing = name_patch(view, patch, index, self._settings)
            if thing is not None and not any(_beside(thing, fire) for fire in fires):
                found.append(thing)
        return tuple(found)


def find_fire(view: View, index: int, settings: PerceptionSettings) -> tuple[list[Detection], Bools]:
    """One detection per patch of flames, and all their pixels (h, w)."""
    glowing = (view.value > 215) & (view.saturation > 0.55) & (view.hue > 8) & (view.hue < 62)
    labels, count = label(closed(glowing, 2))
    found, burning = [], np.zeros(view.valid.shape, bool)
    for number in range(1, count + 1):
        patch = (labels == number) & view.valid & (view.depth_m < settings.reach_m)
        points = as_floats(view.points_m[patch])
        if len(points) < settings.least_pixels or not _flickers(view, patch):
            continue
        if float(np.percentile(points[:, 2], 5)) - settings.floor_m > 0.7:
            continue
        burning |= labels == number
        found.append(
            Detection(
                label="fire",
                score=0.9,
                box_m=box_around(points, stray=3.0),
                pixels=pixel_box(patch),
                points_m=points[::9],
                frame_index=index,
            )
        )
    return found, burning


def _flickers(view: View, patch: Bools) -> bool:
    """Flames go from red to yellow within one patch; a painted thing in the light keeps its hue."""
    low, high = np.percentile(view.hue[patch], (10, 90))
    return bool(high - low > FLAME_HUES)


def _beside(thing: Detection, fire: Detection) -> bool:
    """Whether a thing is embers or char: at the foot of flames."""
    a, b = thing.position_m, fire.position_m
    return float(np.hypot(a[0] - b[0], a[1] - b[1])) < EMBERS_M
