"""Regions that somebody drew on the map, seen from above."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from mintpilot.core.geometry import Bools, Floats, GridFrame, Ints
from mintpilot.core.tolerances import TOLERANCE


def drawn_cells(frame: GridFrame, corners_m: Sequence[tuple[float, float]]) -> Ints:
    """The cells that a drawn outline covers or touches, at every height.

    What an outline that crosses itself goes around in any direction is inside.

    Args:
        frame: the lattice.
        corners_m: x, y of three corners or more in order, metres; the last joins the first.

    Returns:
        Flat indices (n,), sorted; none where the outline lies beside the lattice.
    """
    nz, ny, nx = frame.shape
    x_m: Floats = frame.origin_m[0] + (np.arange(nx, dtype=float) + 0.5) * frame.resolution_m
    y_m: Floats = frame.origin_m[1] + (np.arange(ny, dtype=float) + 0.5) * frame.resolution_m
    winding = np.zeros((ny, nx), np.int64)
    touched = np.zeros((ny, nx), bool)
    corners = np.asarray(corners_m, float)
    for begin, end in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        winding += _turns(begin, end, x_m[None], y_m[:, None])
        touched |= _crossed(begin, end, x_m, y_m, frame.resolution_m / 2)
    columns = np.flatnonzero((winding != 0) | touched)
    cells: Ints = (np.arange(nz)[:, None] * (ny * nx) + columns[None]).ravel().astype(np.int64)
    return cells


def _turns(begin: Floats, end: Floats, x_m: Floats, y_m: Floats) -> Ints:
    """How one edge adds to the winding number of each place: 1 where it passes to the right upwards, -1 downwards."""
    side = (end[0] - begin[0]) * (y_m - begin[1]) - (x_m - begin[0]) * (end[1] - begin[1])
    up = (begin[1] <= y_m) & (end[1] > y_m) & (side > 0)
    down = (begin[1] > y_m) & (end[1] <= y_m) & (side < 0)
    turns: Ints = up.astype(np.int64) - down.astype(np.int64)
    return turns


def _crossed(begin: Floats, end: Floats, x_m: Floats, y_m: Floats, half_m: float) -> Bools:
    """The squares (ny, nx) of that half edge around each centre that a segment passes through or touches."""
    enters, leaves = np.zeros((len(y_m), len(x_m))), np.ones((len(y_m), len(x_m)))
    for centres, at, along in ((x_m[None], begin[0], end[0] - begin[0]), (y_m[:, None], begin[1], end[1] - begin[1])):
        lo, hi = centres - half_m - at - TOLERANCE, centres + half_m - at + TOLERANCE
        if abs(along) <= TOLERANCE:
            beside = (lo > 0) | (hi < 0)
            enters, leaves = np.where(beside, 1.0, enters), np.where(beside, 0.0, leaves)
        else:
            first, second = np.minimum(lo / along, hi / along), np.maximum(lo / along, hi / along)
            enters, leaves = np.maximum(enters, first), np.minimum(leaves, second)
    passed: Bools = enters <= leaves
    return passed
