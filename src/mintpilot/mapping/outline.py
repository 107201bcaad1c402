"""Declared regions: which cells lie in a box, a polygon or a mask.

A cell belongs to an outline as soon as a part of it does: a region that may be impassable is never made smaller.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from mintpilot.core.errors import MapError
from mintpilot.core.geometry import Box, Floats, GridFrame, Ints
from mintpilot.core.observation import RegionKind
from mintpilot.core.semantic_map import Cell, Region, SemanticMap
from mintpilot.mapping.occupancy import read_cells, read_ros_header
from mintpilot.mapping.picture_map import read_picture

_SLACK = 1e-9
"""In cells: edges on a cell's border do not reach into the cell next to it."""
_SHIFT_SLACK = 1e-3
"""In cells: two lattices that are shifted against each other by less than this are one."""


def cells_in_box(frame: GridFrame, box: Box) -> Ints:
    """Flat indices (n,), sorted, of all cells that share some volume with the box; empty when it lies outside.

    On a flat map the heights do not count.
    """
    lo, hi = _window(frame, np.array([box.lo_m, box.hi_m]))
    if frame.is_flat:
        lo[0], hi[0] = 0, 1
    return _flat(frame, lo, np.ones(np.maximum(hi - lo, 0), bool))


def cells_in_polygon(
    frame: GridFrame, corners_m: Sequence[tuple[float, float]], heights_m: tuple[float, float] | None = None
) -> Ints:
    """Flat indices (n,), sorted, of all cells that share some volume with the upright prism over the polygon.

    Args:
        frame: the lattice.
        corners_m: three corners or more (x, y) in order, either way round; edges may cross (even-odd rule).
        heights_m: lowest and highest z; None, or a flat map: all heights.

    Raises:
        MapError: fewer than three corners, or one that is not finite.
    """
    corners = np.asarray(corners_m, float).reshape(-1, 2)
    if len(corners) < 3 or not np.isfinite(corners).all():
        raise MapError(f"polygon {[tuple(c) for c in corners.tolist()]} needs three or more finite corners [x, y]")
    z_lo, z_hi = (-np.inf, np.inf) if heights_m is None or frame.is_flat else heights_m
    z_lo, z_hi = max(z_lo, frame.box.lo_m[2]), min(z_hi, frame.box.hi_m[2])
    bounds = np.array([[*corners.min(axis=0), z_lo], [*corners.max(axis=0), z_hi]])
    lo, hi = _window(frame, bounds)
    if (hi <= lo).any():
        return np.zeros(0, np.int64)
    in_cells = (corners - frame.origin_m[:2]) / frame.resolution_m - lo[:0:-1]
    layer: NDArray[np.bool_] = _polygon_mask(in_cells, int(hi[1] - lo[1]), int(hi[2] - lo[2]))
    return _flat(frame, lo, np.broadcast_to(layer, (int(hi[0] - lo[0]), *layer.shape)))


def within_fence(semantic_map: SemanticMap, corners_m: Sequence[tuple[float, float]]) -> SemanticMap:
    """The map with every cell unknown that is not wholly inside the fence, so that nothing is flown outside it.

    Args:
        semantic_map: the map.
        corners_m: the fence's corners (x, y) in order, either way round, metres.

    Raises:
        MapError: fewer than three corners, or one that is not finite.
    """
    frame = semantic_map.frame
    inside = cells_in_polygon(frame, corners_m)  # checks the corners
    # The even-odd rule makes the complement: the outline of a box around everything, joined to the leftmost corner.
    ring = [(float(x), float(y)) for x, y in corners_m]
    first = min(range(len(ring)), key=lambda n: ring[n])
    ring = [*ring[first:], *ring[: first + 1]]
    lo = [min(frame.box.lo_m[i], *(corner[i] for corner in ring)) - frame.resolution_m for i in (0, 1)]
    hi = [max(frame.box.hi_m[i], *(corner[i] for corner in ring)) + frame.resolution_m for i in (0, 1)]
    gate = (lo[0], ring[0][1])
    around = [gate, (lo[0], lo[1]), (hi[0], lo[1]), (hi[0], hi[1]), (lo[0], hi[1]), gate]
    outside = cells_in_polygon(frame, [*around, *ring])
    cells = np.full(semantic_map.cells.size, Cell.UNKNOWN, np.uint8)
    kept = np.setdiff1d(inside, outside)
    cells[kept] = semantic_map.cells.reshape(-1)[kept]
    return replace(semantic_map, cells=cells.reshape(semantic_map.cells.shape))


def regions_from_mask(
    semantic_map: SemanticMap, mask_path: str | Path, *, name: str, description: str = "", prior_passable: float = 0.5
) -> tuple[Region, ...]:
    """One open region for each connected area of a mask, such as a keep-out mask, larger areas first.

    Args:
        semantic_map: a flat map.
        mask_path: a map_server YAML file of the same resolution, or a picture of the map's size; dark is in the mask.
        name: ids are ``name`` when there is one area, else ``name-1``, ``name-2`` …
        description: what the operator can see; numbered likewise.
        prior_passable: of each region.

    Raises:
        MapError: the map is not flat, the mask does not fit it, or cannot be read.
        LimitError: the mask has too many pixels.
    """
    from scipy import ndimage

    marked = _mask_on_map(semantic_map.frame, Path(mask_path))
    marked &= semantic_map.cells[0] != Cell.OCCUPIED
    labels, count = ndimage.label(marked, np.ones((3, 3)))
    flat = labels.ravel()
    order = np.argsort(flat, kind="stable")
    parts = np.split(order, np.searchsorted(flat[order], np.arange(1, count + 1)))[1:]
    parts.sort(key=len, reverse=True)
    return tuple(
        Region(
            id=f"{name}-{i}" if count > 1 else name,
            kind=RegionKind.AREA,
            cells=part.astype(np.int64),
            prior_passable=prior_passable,
            description=f"{description} {i}" if count > 1 and description else description,
        )
        for i, part in enumerate(parts, start=1)
    )


def _mask_on_map(frame: GridFrame, path: Path) -> NDArray[np.bool_]:
    """Which cells (ny, nx) of the map the mask marks."""
    if not frame.is_flat:
        raise MapError(f"mask '{path}' needs a flat map; on a voxel map outline the region as a box or polygon")
    _, ny, nx = frame.shape
    if path.suffix not in (".yaml", ".yml"):
        mask = read_picture(path, lambda shades, white: (shades / white < 0.5).astype(np.uint8), hidden=0) == 1
        if mask.shape != (ny, nx):
            rows, columns = mask.shape
            raise MapError(
                f"mask '{path}' is {columns} x {rows} pixels, the map {nx} x {ny}; give one of the same size"
            )
        return np.asarray(mask)
    header = read_ros_header(path)
    if not np.isclose(header.resolution_m, frame.resolution_m, rtol=1e-6):
        raise MapError(
            f"mask '{path}' has {header.resolution_m} m a pixel, the map {frame.resolution_m}; export both alike"
        )
    cells, origin_m = read_cells(header)
    return _shifted(frame, origin_m, cells == Cell.OCCUPIED)


def _shifted(frame: GridFrame, origin_m: tuple[float, float], mask: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """The mask on the map's lattice, by the two origins: every cell that shares some area with one of the mask."""
    _, ny, nx = frame.shape
    off = [(origin_m[i] - frame.origin_m[i]) / frame.resolution_m for i in (0, 1)]
    across, up = ({int(np.floor(o + _SHIFT_SLACK)), int(np.ceil(o - _SHIFT_SLACK))} for o in off)
    on_map = np.zeros((ny, nx), bool)
    for dx in across:
        for dy in up:
            rows, columns = np.nonzero(mask)
            rows, columns = rows + dy, columns + dx
            inside = (rows >= 0) & (rows < ny) & (columns >= 0) & (columns < nx)
            on_map[rows[inside], columns[inside]] = True
    return on_map


def _window(frame: GridFrame, bounds_m: Floats) -> tuple[Ints, Ints]:
    """First cell ``[z, y, x]`` and the one after the last that share volume with the bounds, cut to the grid."""
    cells = ((bounds_m - frame.origin_m) / frame.resolution_m)[:, ::-1]
    limit = np.asarray(frame.shape, float)
    lo = np.clip(np.floor(cells[0] + _SLACK), 0, limit).astype(np.int64)
    hi = np.clip(np.ceil(cells[1] - _SLACK), 0, limit).astype(np.int64)
    return lo, hi


def _flat(frame: GridFrame, lo: Ints, mask: NDArray[np.bool_]) -> Ints:
    """Flat indices of the true cells of a mask whose first cell is ``lo``."""
    z, y, x = np.nonzero(mask)
    indices: Ints = np.ravel_multi_index((z + lo[0], y + lo[1], x + lo[2]), frame.shape).astype(np.int64)
    return indices


def _polygon_mask(corners: Floats, ny: int, nx: int) -> NDArray[np.bool_]:
    """Which cells (ny, nx) overlap the polygon, corners in cells: those with the centre inside or an edge through.

    Each edge is followed through the rows that it crosses. Where it crosses the middle of a row, all centres to its
    left change sides; that is noted at the last of them, and summed up from right to left in the end.
    """
    changes = np.zeros((ny, nx), np.bool_)
    touched = np.zeros((ny, nx), np.bool_)
    around = corners.tolist()
    for (ax, ay), (bx, by) in zip([around[-1], *around[:-1]], around, strict=True):
        low, high = min(ay, by), max(ay, by)
        for row in range(max(0, math.floor(low)), min(ny, math.floor(high) + 1)):
            middle = row + 0.5
            if (ay > middle) != (by > middle):
                last = math.ceil(ax + (middle - ay) / (by - ay) * (bx - ax) - 0.5) - 1
                if last >= 0:
                    changes[row, min(last, nx - 1)] ^= True
            bottom, top = max(low, row + _SLACK), min(high, row + 1 - _SLACK)
            if bottom > top or (bottom == top and ay != by):
                continue
            if ay == by:
                x0, x1 = min(ax, bx), max(ax, bx)
            else:
                x0, x1 = ax + (bottom - ay) / (by - ay) * (bx - ax), ax + (top - ay) / (by - ay) * (bx - ax)
                x0, x1 = min(x0, x1), max(x0, x1)
            first, last = math.floor(x0 - 1 + _SLACK) + 1, math.ceil(x1 - _SLACK) - 1
            touched[row, max(first, 0) : max(last + 1, 0)] = True
    inside: NDArray[np.bool_] = np.logical_xor.accumulate(changes[:, ::-1], axis=1)[:, ::-1]
    return touched | inside
