"""Large maps cut to the part that a mission can use."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from mintpilot.core.compiled import compiled
from mintpilot.core.errors import LimitError
from mintpilot.core.geometry import Bools, GridFrame, Ints, Vec3
from mintpilot.core.semantic_map import Cell, Region, SemanticMap

SMALL_CELLS = 2_000_000
"""Number of cells up to which maps are left as they are."""
MAX_CELLS = 20_000_000
"""Number of cells of a map that is planned on, at most: about 1 GB of memory."""


def cropped(map: SemanticMap, places_m: Sequence[Vec3], spare_m: float) -> SemanticMap:
    """The part of a bare map that matters to a mission: what can be reached from its start through free cells.

    Small maps are returned as they are. Where more than `MAX_CELLS` can be reached, the part around the mission's
    places is taken, as large as that allows. What is cut off counts as not known: plans on the part are safe, and as
    short as they can be inside of it.

    Args:
        map: cells without regions.
        places_m: the start, then all places that the mission may lead to, metres.
        spare_m: width of the rim kept around what can be reached, metres.

    Raises:
        LimitError: the places lie so far apart that the part with all of them has more than `MAX_CELLS` cells.
    """
    frame = map.frame
    if frame.size <= SMALL_CELLS:
        return map
    cells = frame.cells_of(np.asarray(places_m, float))
    if frame.is_flat:
        cells[:, 0] = 0
    size = np.array(frame.shape)
    inside = cells[frame.contains(cells)]
    spare = int(np.ceil(spare_m / frame.resolution_m)) + 1
    low, high = _reached(map, cells[0])
    low, high = np.maximum(low - spare, 0), np.minimum(high + spare + 1, size)
    if np.prod(high - low) > MAX_CELLS:
        low, high = _around(np.clip(inside, low, high - 1), low, high)
    return _part(map, low, high)


def in_part(region: Region, whole: SemanticMap, part: SemanticMap) -> Region:
    """A region of the whole map on a part of it that `cropped` made; it may have no cells there."""
    if part is whole:
        return region
    corner = np.round((np.array(part.frame.origin_m) - whole.frame.origin_m) / part.frame.resolution_m).astype(np.int64)
    cells = np.stack(np.unravel_index(region.cells, whole.frame.shape), axis=1) - corner[::-1]
    cells = cells[part.frame.contains(cells)]
    flat: Ints = np.ravel_multi_index(tuple(cells.T), part.frame.shape).astype(np.int64)
    return replace(region, cells=flat)


def _reached(map: SemanticMap, start: Ints) -> tuple[Ints, Ints]:
    """Lowest and highest cell (3,) of those joined to the free cells beside the start through faces."""
    size = np.array(map.frame.shape)
    low, high = np.clip(start - 2, 0, size - 1), np.clip(start + 2, 0, size - 1)
    seeds = np.argwhere(map.cells[low[0] : high[0] + 1, low[1] : high[1] + 1, low[2] : high[2] + 1] == Cell.FREE) + low
    flat = np.ravel_multi_index(tuple(seeds.T), map.frame.shape).astype(np.int64)
    if not len(flat):
        return low, high
    bounds: Ints = _flood(map.cells, np.zeros(map.frame.shape, np.bool_), flat)
    return bounds[0], bounds[1]


def _around(cells: Ints, low: Ints, high: Ints) -> tuple[Ints, Ints]:
    """The largest box within bounds that reaches equally far beyond the given cells and is not too large."""

    def box(reach: int) -> tuple[Ints, Ints]:
        return np.maximum(cells.min(axis=0) - reach, low), np.minimum(cells.max(axis=0) + reach + 1, high)

    def count(reach: int) -> int:
        a, b = box(reach)
        return int(np.prod(b - a))

    if count(0) > MAX_CELLS:
        raise LimitError(
            f"the part of the map with the mission's places has {count(0)} cells, more than the {MAX_CELLS} that are "
            "planned on; cut the map to the part that is flown, or make it coarser"
        )
    least, most = 0, int((high - low).max())
    while most - least > 1:
        middle = (least + most) // 2
        least, most = (middle, most) if count(middle) <= MAX_CELLS else (least, middle)
    return box(least)


def _part(map: SemanticMap, low: Ints, high: Ints) -> SemanticMap:
    """The cells from ``low`` up to before ``high`` (3,) ``[z, y, x]``."""
    frame = map.frame
    x, y, z = (float(o + i * frame.resolution_m) for o, i in zip(frame.origin_m, low[::-1], strict=True))
    window = tuple(slice(int(a), int(b)) for a, b in zip(low, high, strict=True))
    cells = np.ascontiguousarray(map.cells[window])
    shape = (int(cells.shape[0]), int(cells.shape[1]), int(cells.shape[2]))
    return replace(map, frame=GridFrame(origin_m=(x, y, z), resolution_m=frame.resolution_m, shape=shape), cells=cells)


@compiled(error_model="numpy")
def _flood(cells: NDArray[np.uint8], seen: Bools, seeds: Ints) -> Ints:
    """Bounds (2, 3) of the free cells joined to the seeds; ends early when they reach all sides of the grid."""
    nz, ny, nx = cells.shape
    flat, done = cells.ravel(), seen.ravel()
    low = np.array([nz, ny, nx])
    high = np.array([-1, -1, -1])
    front, count = seeds.copy(), len(seeds)
    done[seeds] = True
    while count:
        following = np.empty(6 * count, np.int64)
        found = 0
        for at in range(count):
            node = front[at]
            x, y, z = node % nx, (node // nx) % ny, node // (nx * ny)
            low[0], low[1], low[2] = min(low[0], z), min(low[1], y), min(low[2], x)
            high[0], high[1], high[2] = max(high[0], z), max(high[1], y), max(high[2], x)
            for side in range(6):
                if side == 0 and x > 0:
                    other = node - 1
                elif side == 1 and x < nx - 1:
                    other = node + 1
                elif side == 2 and y > 0:
                    other = node - nx
                elif side == 3 and y < ny - 1:
                    other = node + nx
                elif side == 4 and z > 0:
                    other = node - nx * ny
                elif side == 5 and z < nz - 1:
                    other = node + nx * ny
                else:
                    continue
                if not done[other] and flat[other] == 1:
                    done[other] = True
                    following[found] = other
                    found += 1
        if low.max() == 0 and high[0] == nz - 1 and high[1] == ny - 1 and high[2] == nx - 1:
            break
        front, count = following, found
    return np.stack((low, high))
