"""Where the vehicle's centre may be: clearance from matter, from the unknown, and from regions.

**How exact it is.** A cell counts as flyable by the distance from *its centre* to the nearest point of the *surface* of
each blocked cell; that distance is computed exactly (in squared half cells, whole numbers). From this follows, for
cells of any size:

* A move of the grid search keeps the same clearance everywhere between its two centres. All cells of the block that a
  move sweeps are flyable (`mintpilot.planning.moves`). Inside the block the distance to a blocked cell along each axis
  rises or falls only, so the distance is least in one of the block's corners, and these are centres of flyable cells.
* Blocked cells are taken as solid cubes. Matter that fills only part of its cell is therefore kept further away than
  asked for, by less than one cell's diagonal (``sqrt(3)`` edges in 3D, ``sqrt(2)`` in 2D).

Other places than centres of cells have other clearances: `mintpilot.planning.clearance` computes them.

What lies outside the grid is not known to be free, so it blocks: sideways, and in 3D above and below too (a hall's grid
begins at the floor, which need not be in any cell). In 2D maps (``nz == 1``) the body is a disc.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mintpilot.core.geometry import Bools, GridFrame, Ints
from mintpilot.core.plan import VehicleLimits
from mintpilot.core.semantic_map import Cell, Knowledge, Region, SemanticMap

_FAR = np.uint32(1 << 28)  # squared offsets added to it still fit in 32 bits


def flyable_cells(map: SemanticMap, limits: VehicleLimits) -> Bools:
    """Cells in whose centre the vehicle touches nothing occupied, unknown, or outside the grid.

    Regions are ignored: a region's cells are what they would be without it.

    Args:
        map: the semantic map.
        limits: the body is a ball (2D: a disc) of radius `VehicleLimits.clearance_m`. Up to half a cell's edge nothing
            is inflated, because no free cell's centre is nearer to a blocked one.

    Returns:
        Flags of shape (nz, ny, nx).
    """
    free = np.asarray(map.cells == Cell.FREE)
    above = 0 if map.frame.is_flat else 1
    solid = np.pad(~free, ((above, above), (1, 1), (1, 1)), constant_values=True)
    near = _within(solid, _radius_cells(map.frame, limits))
    flyable: Bools = free & ~near[above : above + free.shape[0], 1:-1, 1:-1]
    return flyable


def region_reach(map: SemanticMap, region: Region, limits: VehicleLimits) -> Ints:
    """The inflated region: cells in whose centre the vehicle would touch the region.

    Returns:
        Flat indices (n,), sorted; the region's own cells among them.
    """
    if region.cells.size == 0:
        return np.zeros(0, np.int64)
    shape = map.frame.shape
    radius = _radius_cells(map.frame, limits)
    cells = np.stack(np.unravel_index(region.cells, shape), axis=1)
    spare = _window(radius)
    lo = np.maximum(cells.min(axis=0) - spare, 0)
    hi = np.minimum(cells.max(axis=0) + spare + 1, shape)
    own = np.zeros(tuple(hi - lo), bool)
    own[tuple((cells - lo).T)] = True
    touched = np.argwhere(own | _within(own, radius)) + lo
    reach: Ints = np.ravel_multi_index(tuple(touched.T), shape).astype(np.int64)
    return reach


def known_flyable(map: SemanticMap, limits: VehicleLimits) -> Bools:
    """Cells that a plan may use without any answer: flyable, and touching no region but those known passable.

    Returns:
        Flags of shape (nz, ny, nx).
    """
    flyable = flyable_cells(map, limits)
    flat = flyable.ravel()
    for region in map.regions:
        if region.passable is not Knowledge.YES:
            flat[region_reach(map, region, limits)] = False
    return flyable


def _radius_cells(frame: GridFrame, limits: VehicleLimits) -> float:
    return limits.clearance_m / frame.resolution_m


def _window(radius_cells: float) -> int:
    """Offset (in cells) beyond which no cube's surface is nearer than the radius."""
    return int(np.ceil(radius_cells + 0.5))


def _within(solid: Bools, radius_cells: float) -> Bools:
    """Cells whose centre is nearer than the radius to the surface of a solid cell.

    A cube at offset (a, b, c) cells is ``sqrt(f(a) + f(b) + f(c)) / 2`` edges away with ``f(a) = max(2|a| - 1, 0)**2``:
    a sum over axes, so three passes along one axis each give the exact minimum.
    """
    reach = (2 * radius_cells) ** 2 * (1 - 1e-9)
    if reach <= 1:
        return np.zeros(solid.shape, bool)
    within: Bools = squared_gaps(solid, _window(radius_cells)) < min(reach, float(_FAR))
    return within


def squared_gaps(solid: Bools, window: int) -> NDArray[np.uint32]:
    """Squared distance in half edges from each cell's centre to the nearest solid cell, exact up to a window.

    Args:
        solid: flags (nz, ny, nx).
        window: offset in cells along each axis up to which solid cells are looked for; others count as far away.
    """
    best: NDArray[np.uint32] = np.where(solid, np.uint32(0), _FAR)
    for axis in range(3):
        if solid.shape[axis] > 1:
            best = _pass(best, axis, window)
    return best


def _pass(best: NDArray[np.uint32], axis: int, window: int) -> NDArray[np.uint32]:
    """Along one axis, the least of ``best`` at each offset plus the squared distance to it."""
    out = best.copy()
    length = best.shape[axis]
    here = np.moveaxis(best, axis, 0)
    there = np.moveaxis(out, axis, 0)
    for offset in range(1, min(window, length - 1) + 1):
        step = np.uint32(min((2 * offset - 1) ** 2, int(_FAR)))
        np.minimum(there[offset:], here[:-offset] + step, out=there[offset:])
        np.minimum(there[:-offset], here[offset:] + step, out=there[:-offset])
    return out
