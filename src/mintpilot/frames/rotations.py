"""Poses as matrices."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from mintpilot.core.errors import MapError
from mintpilot.core.geometry import Floats

BODY_FROM_OPTICAL = np.array([[0.0, 0.0, 1.0, 0.0], [-1.0, 0.0, 0.0, 0.0], [0.0, -1.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0]])
"""A camera that looks ahead: its optical frame (x right, y down, z ahead) in a body frame (x ahead, y left, z up)."""
BODY_FROM_OPTICAL.setflags(write=False)


def pose_of(translation_m: Sequence[float], quaternion: Sequence[float]) -> Floats:
    """The homogeneous matrix (4, 4) of a translation and a quaternion x, y, z, w.

    Raises:
        MapError: the quaternion is not of length 1, within a hundredth.
    """
    x, y, z, w = (float(part) for part in quaternion)
    length = float(np.sqrt(x * x + y * y + z * z + w * w))
    if not abs(length - 1) < 0.01:
        raise MapError(f"quaternion {[x, y, z, w]} has the length {length:g}, it must be 1; its order is x, y, z, w")
    x, y, z, w = x / length, y / length, z / length, w / length
    pose = np.eye(4)
    pose[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    pose[:3, 3] = translation_m
    return pose


def turning(source: Floats, target: Floats) -> Floats:
    """The smallest rotation (3, 3) that takes one unit vector (3,) to another."""
    axis, cosine = np.cross(source, target), float(source @ target)
    if cosine < -1 + 1e-9:
        other = np.eye(3)[int(np.argmin(np.abs(source)))]
        axis = np.cross(source, other)
        axis /= np.linalg.norm(axis)
        rotation: Floats = 2 * np.outer(axis, axis) - np.eye(3)
        return rotation
    cross = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    return np.asarray(np.eye(3) + cross + cross @ cross / (1 + cosine), float)
