"""The least distance between flown places and what is not known free, by sampling. Uses nothing of the package."""

from __future__ import annotations

import itertools

import numpy as np


def densely(points: np.ndarray, spacing: float) -> np.ndarray:
    """Points along a polyline (n, 3), at most so far apart."""
    parts = [points[:1]]
    for a, b in itertools.pairwise(points):
        count = max(1, int(np.ceil(np.linalg.norm(b - a) / spacing)))
        parts.append(a + (b - a) * (np.arange(1, count + 1) / count)[:, None])
    return np.concatenate(parts)


def distances(
    points: np.ndarray, barred: np.ndarray, origin: tuple[float, ...], cell: float, most: float
) -> np.ndarray:
    """Distance (n,) of each point (n, 3) to the nearest barred cell's cube or the grid's border, at most ``most``.

    Args:
        points: ``[x, y, z]``, metres.
        barred: flags (nz, ny, nx); one layer stands for a flat world without heights.
        origin: outer corner of the first cell, metres.
        cell: edge, metres.
        most: distances beyond need not be told apart, metres.
    """
    size = np.array(barred.shape[::-1])
    axes = 2 if size[2] == 1 else 3
    spot = (np.asarray(points, float) - np.asarray(origin))[:, :axes] / cell
    size = size[:axes]
    least = np.minimum(np.minimum(spot, size - spot).min(axis=1), most / cell)
    reach = int(np.ceil(most / cell)) + 1
    here = np.floor(spot).astype(int)
    for offset in itertools.product(range(-reach, reach + 1), repeat=axes):
        other = here + np.array(offset)
        inside = ((other >= 0) & (other < size)).all(axis=1)
        index = np.zeros((len(spot), 3), int)
        index[:, :axes] = np.where(inside[:, None], other, 0)
        solid = inside & barred[index[:, 2], index[:, 1], index[:, 0]]
        gap = np.maximum(np.maximum(other - spot, spot - other - 1), 0.0)
        least = np.where(solid, np.minimum(least, np.sqrt((gap * gap).sum(axis=1))), least)
    return np.maximum(least, 0.0) * cell
