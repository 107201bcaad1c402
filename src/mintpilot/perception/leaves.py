"""Leaves in walls: doors of any colour, told by their frame in a wall that is seen straight on."""

from __future__ import annotations

import math

import numpy as np

from mintpilot.core.geometry import Box, Floats, Ints
from mintpilot.core.observation import Attribute, Detection
from mintpilot.perception.bodies import Scene
from mintpilot.perception.colours import colour_word
from mintpilot.perception.door_frames import DoorFrames, door_frames
from mintpilot.perception.door_weights import BIAS, WEIGHTS
from mintpilot.perception.settings import PerceptionSettings
from mintpilot.perception.view import View, as_floats
from mintpilot.perception.wall_pictures import CELL_M, WallPicture, wall_pictures

LEAST = 0.1
"""What is a door less probably than this is not taken down."""
OVERLAP = 0.15
"""Of two frames that share more than this of the narrower one, one is a door."""
NEAR_M = 0.4
"""Doors of two walls, as seen in one picture, that are nearer than this are one."""
LEAST_POINTS = 20


def find_leaves(view: View, scene: Scene, index: int, settings: PerceptionSettings) -> list[Detection]:
    """Doors in the walls of a view, each with the probability that it is one by what this view shows of it."""
    found: list[Detection] = []
    for wall in wall_pictures(view, scene, settings.floor_m):
        frames = door_frames(wall)
        if frames is None:
            continue
        chances = door_probabilities(frames)
        for i in apart(frames, chances):
            leaf = _as_leaf(view, scene, wall, frames, i, float(chances[i]), index, settings)
            if leaf is not None and all(math.dist(leaf.position_m, other.position_m) > NEAR_M for other in found):
                found.append(leaf)
    return found


def door_probabilities(frames: DoorFrames) -> Floats:
    """Probability (n,) that each frame is a door's, by logistic regression on its evidence."""
    odds = frames.evidence @ np.array([weight for _, weight in WEIGHTS]) + BIAS
    chances: Floats = 1 / (1 + np.exp(-np.clip(odds, -30, 30)))
    return chances


def apart(frames: DoorFrames, chances: Floats) -> list[int]:
    """The likeliest frames that do not share the same part of the wall."""
    kept: list[int] = []
    for i in np.argsort(-chances, kind="stable"):
        if chances[i] < LEAST:
            break
        left, right = frames.left[i], frames.right[i]
        shared = (min(right, frames.right[j]) - max(left, frames.left[j]) for j in kept)
        widths = (min(right - left, frames.right[j] - frames.left[j]) for j in kept)
        if all(s < OVERLAP * w for s, w in zip(shared, widths, strict=True)):
            kept.append(int(i))
    return kept


def _as_leaf(
    view: View,
    scene: Scene,
    wall: WallPicture,
    frames: DoorFrames,
    number: int,
    chance: float,
    index: int,
    settings: PerceptionSettings,
) -> Detection | None:
    left, right, top = int(frames.left[number]), int(frames.right[number]), int(frames.top[number])
    shown = wall.pixel[:top, left:right]
    pixels: Ints = np.unique(shown[shown >= 0])
    if len(pixels) < LEAST_POINTS:
        return None
    points = as_floats(scene.surfaces.points_m.reshape(-1, 3)[pixels])
    middle = (wall.begin_m + (left + right) / 2 * CELL_M) * wall.along + float(
        np.median(points @ wall.normal)
    ) * wall.normal
    across = (right - left) * CELL_M / 2 * wall.along
    # Things in front hide parts of a leaf, not of its frame.
    ends = np.stack([middle - across, middle + across])
    ends[:, 2] = settings.floor_m, settings.floor_m + top * CELL_M
    rows, columns = np.divmod(pixels, view.valid.shape[1])
    colour = colour_word(*(values[rows, columns] for values in (view.hue, view.saturation, view.value)))
    return Detection(
        label="door",
        score=chance,
        box_m=_box(ends),
        attributes=(Attribute(name="colour", value=colour),),
        pixels=(int(columns.min()), int(rows.min()), int(columns.max()) + 1, int(rows.max()) + 1),
        points_m=points[:: max(1, len(points) // 400)],
        frame_index=index,
    )


def _box(ends: Floats) -> Box:
    lo, hi = ends.min(axis=0), ends.max(axis=0)
    return Box(lo_m=(float(lo[0]), float(lo[1]), float(lo[2])), hi_m=(float(hi[0]), float(hi[1]), float(hi[2])))
