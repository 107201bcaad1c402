"""Ways through what cannot be seen: the middle of the gap, since walls go on inside a cloud."""

from __future__ import annotations

import itertools

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage
from scipy.sparse import coo_array, csr_array
from scipy.sparse.csgraph import dijkstra

from mintpilot.core.geometry import Bools, Floats, Ints

SHY_M = 2.0
"""Further than this from what may go on inside the cloud nothing is doubted; lanes cost twice as much at this distance
from it, and five times as much at half of it."""
BREADTH_M = 0.3
"""How far the vehicle may be off the middle of a lane."""
TOUCHING = 1
"""Only what stands inside a cloud, or no more voxels than this beside it, may go on inside."""
DEAD_END_M = 0.5
"""Distance kept where the cloud leads nowhere: whoever wants to go into it must still find room."""
RING_M = 0.6
"""What is connected is judged in a ring of this width around the cloud, besides the vehicle's own size."""
CONTEXT_M = 6.0
"""Ground further away from the cloud than this does not matter."""
ROOMY_M2 = 4.0
"""Pockets of free ground smaller than this need not stay connected."""
TALL_M = 0.6
"""Walls and racks are taller than this; floors, roofs and things that lie about are not."""
MOST_LAYERS = 0.5
"""A place is passable if it is so in this share of the cloud's layers."""


def hugging(
    cloud: Bools, solid: Bools, free: Bools, *, ends: Bools | None = None, resolution_m: float, hull_m: float
) -> Bools:
    """Unseen voxels of a cloud that are not to be counted on, because they lie off the lanes through it.

    What is solid at the edge of a cloud often goes on inside, where no sensor sees it. So all roomy places that the
    cloud connects are joined by lanes that keep away from that, in the middle of each gap. Lanes are the same at every
    height. A cloud that leads nowhere has none; there only what is near to something solid is left out.

    Args:
        cloud: voxels of the cloud (nz, ny, nx).
        solid: voxels known to be occupied.
        free: voxels known to be free.
        ends: solid voxels of things that are known to end where they are seen to end, such as flames.
        resolution_m: edge of a voxel.
        hull_m: radius of the vehicle with its margin.

    Returns:
        Voxels (nz, ny, nx) of the cloud.
    """
    near = np.zeros(cloud.shape, bool)
    found = np.argwhere(cloud)
    if not len(found) or not solid.any():
        return near
    reach = int(np.ceil(CONTEXT_M / resolution_m)) * np.array([0, 1, 1])
    lo, hi = np.maximum(found.min(axis=0) - reach, 0), found.max(axis=0) + 1 + reach
    part = tuple(slice(int(a), int(b)) for a, b in zip(lo, hi, strict=True))
    inside, hard = np.asarray(cloud[part].any(axis=0), bool), solid[part]
    tall = hard.sum(axis=0) * resolution_m >= TALL_M
    beside = hard.any(axis=0) & tall & ndimage.binary_dilation(inside, np.ones((3, 3), bool), iterations=TOUCHING)
    if ends is not None:
        beside &= ~ends[part].any(axis=0)
    if not beside.any():
        return near
    passable = ((cloud | free)[part] & (_away_m(hard, resolution_m) >= hull_m)).mean(axis=0) >= MOST_LAYERS
    around = ndimage.binary_dilation(inside, iterations=int(np.ceil((RING_M + hull_m) / resolution_m)) + 1)
    shore = _roomy(passable & ~inside, resolution_m) & around
    away_m = _away_m(beside[None], resolution_m)[0]
    lanes = _lanes(shore, passable & inside, away_m, resolution_m, hull_m + BREADTH_M)
    keep = away_m >= DEAD_END_M if lanes is None else lanes | (away_m >= SHY_M)
    near[part] = cloud[part] & ~free[part] & ~keep
    return near


def _roomy(ground: Bools, resolution_m: float) -> Bools:
    """The parts of it that are no mere pockets."""
    labels, _ = ndimage.label(ground)
    roomy: Bools = ground & (np.bincount(labels.ravel()) * resolution_m**2 >= ROOMY_M2)[labels]
    return roomy


def _away_m(solid: Bools, resolution_m: float) -> Floats:
    """Distance of every voxel to what is solid in its layer, metres: neither floor nor roof counts."""
    away: Floats = np.stack([ndimage.distance_transform_edt(~layer, sampling=resolution_m) for layer in solid])
    away[~solid.any(axis=(1, 2))] = np.inf
    return away


def _lanes(shore: Bools, passage: Bools, away_m: Floats, resolution_m: float, radius_m: float) -> Bools | None:
    """Places (ny, nx) on lanes through the passage that join all parts of the shore which it joins; None for none."""
    parts, count = ndimage.label(shore)
    nodes = np.flatnonzero(shore | passage)
    number = np.full(shore.size, -1, np.int64)
    number[nodes] = np.arange(len(nodes))
    graph = _graph(number.reshape(shore.shape), (1.0 + (SHY_M / np.maximum(away_m, 0.1)) ** 2).ravel()[nodes])
    part = parts.ravel()[nodes]
    joined = list(range(count + 1))
    offers: list[tuple[float, int, int, int]] = []
    back: dict[int, NDArray[np.int32]] = {}
    for a in range(1, count + 1):
        cost, before, _ = dijkstra(graph, indices=np.flatnonzero(part == a), min_only=True, return_predecessors=True)
        back[a] = before
        for b in range(a + 1, count + 1):
            there = np.flatnonzero(part == b)
            best = int(there[np.argmin(cost[there])])
            if np.isfinite(cost[best]):
                offers.append((float(cost[best]), a, b, best))
    lanes = np.zeros(shore.shape, bool)
    for _, a, b, node in sorted(offers):
        if joined[a] == joined[b]:
            continue
        joined = [joined[a] if j == joined[b] else j for j in joined]
        while node >= 0:
            _widen(lanes, int(nodes[node]), resolution_m, radius_m)
            node = int(back[a][node])
    return lanes if lanes.any() else None


def _graph(number: Ints, weight: Floats) -> csr_array:
    """Neighbouring places (8 each), at the mean weight of the two times their distance."""
    rows, columns, costs = [], [], []
    ny, nx = number.shape
    for dy, dx in itertools.product((0, 1), (-1, 0, 1)):
        if (dy, dx) <= (0, 0):
            continue
        a = number[: ny - dy, max(0, -dx) : nx - max(0, dx)]
        b = number[dy:, max(0, dx) : nx - max(0, -dx)]
        both = (a >= 0) & (b >= 0)
        rows.append(a[both])
        columns.append(b[both])
        costs.append((weight[a[both]] + weight[b[both]]) / 2 * np.hypot(dy, dx))
    i, j, cost = (np.concatenate(x) for x in (rows, columns, costs))
    size = len(weight)
    return coo_array((np.tile(cost, 2), (np.concatenate([i, j]), np.concatenate([j, i]))), shape=(size, size)).tocsr()


def _widen(lanes: Bools, place: int, resolution_m: float, radius_m: float) -> None:
    """Adds the disc around a place of a lane."""
    y, x = divmod(place, lanes.shape[1])
    reach = int(np.ceil(radius_m / resolution_m))
    rows, columns = slice(max(0, y - reach), y + reach + 1), slice(max(0, x - reach), x + reach + 1)
    v, u = np.ogrid[rows.start : min(rows.stop, lanes.shape[0]), columns.start : min(columns.stop, lanes.shape[1])]
    lanes[rows, columns] |= np.hypot(v - y, u - x) * resolution_m <= radius_m
