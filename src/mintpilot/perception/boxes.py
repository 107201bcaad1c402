"""Boxes around points and pixels."""

from __future__ import annotations

import numpy as np

from mintpilot.core.geometry import Bools, Box, Floats


def box_around(points_m: Floats, *, stray: float = 1.0) -> Box:
    """The upright box around points (n, 3), without the outermost ``stray`` percent on each side."""
    lo = np.percentile(points_m, stray, axis=0)
    hi = np.percentile(points_m, 100 - stray, axis=0)
    return Box(lo_m=(float(lo[0]), float(lo[1]), float(lo[2])), hi_m=(float(hi[0]), float(hi[1]), float(hi[2])))


def pixel_box(mask: Bools) -> tuple[int, int, int, int]:
    """Left, top, right, bottom (exclusive) of the flagged pixels; at least one is flagged."""
    rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
    return int(columns[0]), int(rows[0]), int(columns[-1]) + 1, int(rows[-1]) + 1


def touches_border(pixels: tuple[int, int, int, int], shape: tuple[int, int], *, margin: int = 2) -> bool:
    """Whether a patch reaches the edge of the picture, so that a part of it may be missing."""
    left, top, right, bottom = pixels
    return left < margin or top < margin or right > shape[1] - margin or bottom > shape[0] - margin
