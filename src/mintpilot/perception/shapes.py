"""Cubic, cylindrical or spherical: told by how the surface is turned.

A box shows level and upright faces whose directions agree modulo a quarter turn; a cylinder shows a level top and
upright sides that face everywhere; a ball shows slanted surface.
"""

from __future__ import annotations

import numpy as np

from mintpilot.core.geometry import Bools
from mintpilot.perception.view import Singles, View, mean_around

LEAST_PIXELS = 140
"""Fewer pixels do not show a shape."""
SLANTED_BALL = 0.34
"""A ball shows at least this share of slanted surface."""
AGREE_BOX = 0.55
"""The upright faces of a box agree at least this well in direction (1: fully)."""


def shape_word(view: View, patch: Bools) -> str:
    """``cubic``, ``cylindrical``, ``spherical``, or nothing where it cannot be told."""
    if int(patch.sum()) < LEAST_PIXELS:
        return ""
    rows, columns = np.flatnonzero(patch.any(axis=1)), np.flatnonzero(patch.any(axis=0))
    window = (slice(rows[0], rows[-1] + 1), slice(columns[0], columns[-1] + 1))
    normals, inner = _normals(view.points_m[window], patch[window] & view.valid[window])
    if len(normals) < 40 or not inner.any():
        return ""
    steep = np.abs(normals[:, 2])
    slanted = float(((steep > 0.3) & (steep < 0.88)).mean())
    upright = normals[steep <= 0.35]
    if slanted > SLANTED_BALL:
        return "spherical"
    if len(upright) < 30:
        return ""
    angle = np.arctan2(upright[:, 1], upright[:, 0])
    agreement = float(np.abs(np.exp(4j * angle).mean()))
    return "cubic" if agreement >= AGREE_BOX else "cylindrical"


def _normals(points: Singles, patch: Bools) -> tuple[Singles, Bools]:
    """Unit normals (n, 3) at the inner pixels of a patch, from points smoothed over a window that fits its size."""
    width = 5 if patch.sum() < 1200 else 7
    smooth = np.stack([mean_around(points[..., i], patch, width) for i in range(3)], axis=-1)
    step = width // 2 + 1
    inner = np.zeros(patch.shape, bool)
    if min(patch.shape) <= 2 * step:
        return np.zeros((0, 3), np.float32), inner
    middle = (slice(step, -step), slice(step, -step))
    across = smooth[step:-step, 2 * step :] - smooth[step:-step, : -2 * step]
    down = smooth[2 * step :, step:-step] - smooth[: -2 * step, step:-step]
    whole = (
        patch[middle]
        & patch[step:-step, 2 * step :]
        & patch[step:-step, : -2 * step]
        & patch[2 * step :, step:-step]
        & patch[: -2 * step, step:-step]
    )
    normal = np.cross(across, down)[whole]
    length = np.linalg.norm(normal, axis=1, keepdims=True)
    inner[middle] = whole
    return (normal / np.maximum(length, 1e-9)).astype(np.float32), inner
