"""Checks of frame sources and of namers."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from mintpilot.conformance.sample import require
from mintpilot.core.geometry import Box
from mintpilot.core.observation import CameraModel, Frame, Segment
from mintpilot.core.ports import FrameSource, Namer

MOST_FRAMES = 20
"""Frames of a source that are looked at."""


def check_frame_source(make: Callable[[], FrameSource]) -> None:
    """Reads some frames of a source.

    Args:
        make: opens the source afresh.

    Raises:
        ConformanceError: it breaks the contract of `mintpilot.core.ports.FrameSource`.
    """
    source = make()
    require(isinstance(source.z_is_up, bool), source, "z_is_up must be True or False")
    number = 0
    for number, frame in enumerate(source.frames(), start=1):
        size = (frame.camera.height, frame.camera.width)
        require(frame.rgb.shape == (*size, 3), source, f"colours of shape {frame.rgb.shape}, the lens says {size}")
        require(frame.rgb.dtype == np.uint8, source, f"colours of type {frame.rgb.dtype}, 8 bits are wanted")
        require(frame.depth_m.shape == size, source, f"depth of shape {frame.depth_m.shape}, the lens says {size}")
        sound = bool(np.isfinite(frame.depth_m).all()) and float(frame.depth_m.min()) >= 0
        require(sound, source, "depth must be finite and not below 0; 0 means no return")
        pose = frame.source_from_camera
        require(pose is None or pose.shape == (4, 4), source, "a pose is a 4 x 4 matrix or None")
        if number == MOST_FRAMES:
            break
    require(number > 0, source, "no frame; a source without any must raise MapError or DeviceError")
    said = source.remarks()
    require(all(isinstance(text, str) and text for text in said), source, "remarks must be sentences")


def check_namer(make: Callable[[], Namer]) -> None:
    """Shows a namer a segment, and none.

    Args:
        make: makes a fresh namer.

    Raises:
        ConformanceError: it breaks the contract of `mintpilot.core.ports.Namer`.
    """
    namer, (frame, segment) = make(), _sample()
    require(len(namer.names(frame, [])) == 0, namer, "without segments there are no names")
    found = namer.names(frame, [segment, segment])
    require(len(found) == 2, namer, f"{len(found)} answers for 2 segments; each segment gets one, empty if need be")
    require(found[0] == found[1], namer, "the same segment got different names")
    for guesses in found:
        total = sum(g.probability for g in guesses)
        sound = all(0 <= g.probability <= 1 and g.label for g in guesses) and total <= 1 + 1e-9
        require(sound, namer, f"probabilities {guesses} must be from 0 to 1 each, and sum to at most 1")
        labels = [g.label for g in guesses]
        require(len(set(labels)) == len(labels), namer, f"a name is given twice in {labels}")


def _sample() -> tuple[Frame, Segment]:
    size = (60, 80)
    lens = CameraModel(width=80, height=60, fx=70.0, fy=70.0, cx=40.0, cy=30.0)
    depth = np.full(size, 2.0, np.float32)
    frame = Frame(
        time_s=0.0,
        rgb=np.full((*size, 3), 120, np.uint8),
        depth_m=depth,
        camera=lens,
        world_from_camera=np.array([[0.0, 0, 1, 0], [-1, 0, 0, 0], [0, -1, 0, 1], [0, 0, 0, 1]]),
    )
    mask = np.zeros(size, bool)
    mask[20:40, 30:50] = True
    rows, columns = np.nonzero(mask)
    points = np.stack([np.full(len(rows), 2.0), (40.0 - columns) / 35.0, 1.0 + (30.0 - rows) / 35.0], axis=1)
    low, high = points.min(axis=0), points.max(axis=0)
    segment = Segment(
        mask=mask,
        points_m=points,
        normals=np.repeat([[-1.0, 0.0, 0.0]], len(points), axis=0),
        box_m=Box(lo_m=(low[0], low[1], low[2]), hi_m=(high[0], high[1], high[2])),
        stands_on_m=0.0,
        on_floor=True,
        cut=False,
    )
    return frame, segment
