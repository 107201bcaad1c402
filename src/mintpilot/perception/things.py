"""What a free-standing patch is: a box, a person, or something else; with its attributes in plain words."""

from __future__ import annotations

import numpy as np

from mintpilot.core.geometry import Bools, Box, Floats
from mintpilot.core.observation import Attribute, Detection
from mintpilot.perception.boxes import box_around, pixel_box, touches_border
from mintpilot.perception.colours import colour_word, colour_words, size_word
from mintpilot.perception.settings import PerceptionSettings
from mintpilot.perception.shapes import shape_word
from mintpilot.perception.view import View, as_floats

PERSON_LENGTH_M = (0.9, 2.4)
PERSON_HEIGHT_M = 0.55
THIN_M = 0.2
"""Nobody is narrower than this."""
LEAST_FLOOR = 800
"""Fewer pixels of floor tell nothing of the light."""
BODY_COLOURS = 0.12
"""A person shows at least two colours, each with this share of the pixels."""


def name_patch(view: View, patch: Bools, index: int, settings: PerceptionSettings) -> Detection | None:
    """The thing that a patch shows, or None where it is nothing that has a name."""
    points = as_floats(view.points_m[patch & view.valid])
    box = box_around(points, stray=2.0)
    pixels = pixel_box(patch)
    cut = touches_border(pixels, patch.shape)
    top = box.hi_m[2] - settings.floor_m
    if box.lo_m[2] - settings.floor_m > 0.35 or top < 0.12 or top > settings.tallest_object_m:
        return None
    if pixels[1] >= 2 and _is_person(view, patch, points, top):
        return Detection(
            label="person",
            score=0.6 if cut else 0.9,
            box_m=_on_floor(box, settings),
            pixels=pixels,
            points_m=points[::9],
            frame_index=index,
        )
    if cut or max(box.size_m[:2]) > settings.widest_object_m:
        return None
    whole = _completed(box, points, np.asarray(view.frame.world_from_camera[:2, 3], float), settings)
    longest = max(whole.size_m)
    flagged = patch & view.valid
    colour = colour_word(
        view.hue[flagged], view.saturation[flagged], view.value[flagged], floor_value=_floor_value(view, settings)
    )
    shape = shape_word(view, patch)
    words = [("colour", colour), ("size", size_word(longest)), *([("shape", shape)] if shape else [])]
    distance = float(np.median(view.depth_m[flagged]))
    return Detection(
        label="box",
        score=float(np.clip(1.05 - 0.09 * distance, 0.3, 0.95)),
        box_m=whole,
        attributes=tuple(Attribute(name=name, value=value) for name, value in words),
        pixels=pixels,
        points_m=points[::9],
        frame_index=index,
    )


def _floor_value(view: View, settings: PerceptionSettings) -> float:
    """Median value of the floor, infinite where little of it is in view: tells a dim hall from dark paint."""
    floor = view.valid & (np.abs(view.points_m[..., 2] - settings.floor_m) < 0.03 + 1.5 * view.sigma_m)
    return float(np.median(view.value[floor])) if int(floor.sum()) >= LEAST_FLOOR else np.inf


def _is_person(view: View, patch: Bools, points: Floats, top_m: float) -> bool:
    """Low, as long as somebody lying, and of several colours."""
    if top_m > PERSON_HEIGHT_M:
        return False
    level = points[:, :2] - points[:, :2].mean(axis=0)
    _, axes = np.linalg.eigh(level.T @ level)
    ends = np.percentile(level @ axes[:, 1], (1, 99))
    across = np.percentile(level @ axes[:, 0], (2, 98))
    if not PERSON_LENGTH_M[0] <= float(ends[1] - ends[0]) <= PERSON_LENGTH_M[1] or across[1] - across[0] < THIN_M:
        return False
    seen = patch & view.valid
    words, counts = np.unique(colour_words(view.hue[seen], view.saturation[seen], view.value[seen]), return_counts=True)
    shares = counts[words != "grey"] / counts.sum()
    return int((shares > BODY_COLOURS).sum()) >= 2


def _completed(box: Box, points: Floats, eye_m: Floats, settings: PerceptionSettings) -> Box:
    """The extent with the part that is turned away: as deep as it is wide, standing on the floor.

    A camera sees the near side only. Seen from above a box shows its top and so its depth; seen level it does not.
    """
    del points
    lo, hi = np.asarray(box.lo_m), np.asarray(box.hi_m)
    size = hi - lo
    wide = float(max(size[0], size[1]))
    away = (lo + hi)[:2] / 2 - eye_m
    axis = int(np.argmax(np.abs(away)))
    if size[axis] < 0.75 * wide:
        missing = wide - size[axis]
        if away[axis] > 0:
            hi[axis] += missing
        else:
            lo[axis] -= missing
    lo[2] = settings.floor_m
    return Box(lo_m=(float(lo[0]), float(lo[1]), float(lo[2])), hi_m=(float(hi[0]), float(hi[1]), float(hi[2])))


def _on_floor(box: Box, settings: PerceptionSettings) -> Box:
    return Box(lo_m=(box.lo_m[0], box.lo_m[1], settings.floor_m), hi_m=box.hi_m)
