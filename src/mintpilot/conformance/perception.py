"""Check of perceptions: what is made of one picture."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from mintpilot.conformance.sample import require
from mintpilot.core.observation import CameraModel, Detection, Frame
from mintpilot.core.ports import Perception

_SIZE = (120, 160)
_LENS = CameraModel(width=160, height=120, fx=140.0, fy=140.0, cx=80.0, cy=60.0)
_EYE_M = (2.0, 3.0, 1.4)


def check_perception(make: Callable[[], Perception]) -> None:
    """Shows it a box on a floor, and pictures without depth, with broken depth and of noise.

    Args:
        make: makes a fresh perception; called more than once.

    Raises:
        ConformanceError: it breaks the contract of `mintpilot.core.ports.Perception`.
    """
    perception = make()
    for what, value in (("NaN", np.nan), ("0", 0.0)):
        found = perception.detect(_frame(np.full(_SIZE, value, np.float32)), 0)
        rule = f"{len(found)} detections in a frame whose depth is all {what}; without usable depth there are none"
        require(len(found) == 0, perception, rule)
    rng = np.random.default_rng(0)
    holed = _room()
    holed[rng.random(_SIZE) < 0.3] = np.nan
    noise = rng.uniform(0.05, 60.0, _SIZE).astype(np.float32)
    for index, depth in enumerate(
        (_room(), holed, noise, np.full(_SIZE, 1e-3, np.float32), np.full(_SIZE, np.inf, np.float32))
    ):
        frame = _frame(depth)
        found = perception.detect(frame, index)
        for detection in found:
            _check_detection(detection, frame, index, perception)
    one, other = (make().detect(_frame(_room()), 7) for _ in range(2))
    same = [(d.label, d.box_m) for d in one] == [(d.label, d.box_m) for d in other]
    require(same, perception, "the same picture gives different detections; the same seed must give the same")


def _check_detection(found: Detection, frame: Frame, index: int, perception: Perception) -> None:
    require(bool(found.label), perception, "a detection without a label")
    require(0 <= found.score <= 1, perception, f"'{found.label}' has score {found.score}; from 0 to 1 it must be")
    corners = (*found.box_m.lo_m, *found.box_m.hi_m)
    require(bool(np.isfinite(corners).all()), perception, f"'{found.label}' has the extent {found.box_m}, not finite")
    rule = f"'{found.label}' says frame {found.frame_index}; it was seen in frame {index}"
    require(found.frame_index == index, perception, rule)
    left, top, right, bottom = found.pixels
    inside = 0 <= left <= right <= frame.camera.width and 0 <= top <= bottom <= frame.camera.height
    size = (frame.camera.width, frame.camera.height)
    require(inside, perception, f"'{found.label}' is at pixels {found.pixels}, outside the picture of {size}")
    points = found.points_m
    sound = points is None or (points.ndim == 2 and points.shape[1] == 3 and bool(np.isfinite(points).all()))
    require(sound, perception, f"'{found.label}' has surface points that are not a finite (n, 3)")


def _rays() -> np.ndarray:
    """Directions (h, w, 3) through the pixels, optical frame, z = 1."""
    v, u = np.mgrid[0 : _SIZE[0], 0 : _SIZE[1]] + 0.5
    return np.dstack([(u - _LENS.cx) / _LENS.fx, (v - _LENS.cy) / _LENS.fy, np.ones(_SIZE)])


def _room() -> np.ndarray:
    """Depth (h, w) of a wall 5 m ahead, the floor below, and a box of 0.6 m on it, 3 m ahead."""
    rays = _rays()
    down = rays[..., 1]
    with np.errstate(divide="ignore"):
        floor = np.where(down > 0, _EYE_M[2] / np.maximum(down, 1e-9), np.inf)
    depth = np.minimum(floor, 5.0)
    box = (np.abs(rays[..., 0] * 3.0) <= 0.3) & (down * 3.0 >= _EYE_M[2] - 0.6) & (down * 3.0 <= _EYE_M[2])
    return np.where(box, 3.0, depth).astype(np.float32)


def _frame(depth: np.ndarray) -> Frame:
    rgb = np.full((*_SIZE, 3), 150, np.uint8)
    rgb[np.isclose(depth, 3.0)] = (200, 30, 30)
    pose = np.eye(4)
    pose[:3, :3] = np.array([[0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]])
    pose[:3, 3] = _EYE_M
    return Frame(time_s=0.0, rgb=rgb, depth_m=depth.astype(np.float32), camera=_LENS, world_from_camera=pose)
