"""Grids whose axes are turned against the world's, laid on an upright grid of the same cell size."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from mintpilot.core.compiled import compiled
from mintpilot.core.geometry import Floats
from mintpilot.mapping.picture_map import check_size

_TOUCH = 1e-9
"""In cells: cells that share less than this along any axis only touch."""
_UNKNOWN, _FREE, _OCCUPIED = 0, 1, 2


def turned_cells(cells: NDArray[np.uint8], yaw_rad: float) -> tuple[NDArray[np.uint8], Floats]:
    """A flat grid turned about its corner, on an upright grid that covers it.

    A cell of the result is free only if all cells that it shares some area with are free and cover it wholly; it is
    occupied as soon as one of them is: walls become no thinner, and nothing that was not known free becomes free.

    Args:
        cells: states (ny, nx), values of `mintpilot.core.semantic_map.Cell`.
        yaw_rad: how far the grid is turned about the outer corner of cell (0, 0), counter-clockwise.

    Returns:
        (states (rows, columns); corner of least (x, y) of the result, in cells from that corner).

    Raises:
        LimitError: the result would have too many cells.
    """
    quarters = round(yaw_rad / (math.pi / 2))
    exact = abs(yaw_rad - quarters * math.pi / 2) < 1e-9
    c, s = math.cos(yaw_rad), math.sin(yaw_rad)
    if exact:
        c, s = ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))[quarters % 4]
    ny, nx = cells.shape
    corners = np.array([(0, 0), (nx, 0), (0, ny), (nx, ny)], float) @ np.array([(c, s), (-s, c)])
    low, high = corners.min(axis=0), corners.max(axis=0)
    columns, rows = (max(1, math.ceil(edge - _TOUCH)) for edge in high - low)
    check_size("the turned map", columns, rows)
    turned = np.empty((rows, columns), np.uint8)
    _fill(turned, cells, c, s, low)
    return turned, low


@compiled(error_model="numpy")
def _fill(turned: NDArray[np.uint8], cells: NDArray[np.uint8], c: float, s: float, low: Floats) -> None:
    """Two squares of the same size, one turned, share area if and only if their shadows overlap on all four axes.

    On each of these axes the two shadows together are ``1 + |c| + |s|`` long.
    """
    half = 0.5 * (1 + abs(c) + abs(s)) - _TOUCH
    for row in range(turned.shape[0]):
        for column in range(turned.shape[1]):
            x, y = low[0] + column + 0.5, low[1] + row + 0.5
            u, v = c * x + s * y, c * y - s * x
            state = _FREE
            for j in range(int(np.floor(v - half)), int(np.floor(v + half)) + 1):
                for i in range(int(np.floor(u - half)), int(np.floor(u + half)) + 1):
                    du, dv = i + 0.5 - u, j + 0.5 - v
                    if max(abs(du), abs(dv), abs(c * du - s * dv), abs(s * du + c * dv)) >= half:
                        continue
                    inside = 0 <= j < cells.shape[0] and 0 <= i < cells.shape[1]
                    other = cells[j, i] if inside else _UNKNOWN
                    if other == _OCCUPIED or state == _FREE:
                        state = other
            turned[row, column] = state
