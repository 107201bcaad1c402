"""Corridors through clouds that cannot be looked into: the middle of each gap, since walls go on inside a cloud."""

from __future__ import annotations

import itertools

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage
from scipy.sparse import coo_array, csr_array
from scipy.sparse.csgraph import dijkstra

from mintpilot.core.geometry import Bools, Floats, Ints

SHY_M = 2.0
"""Distance, metres, from what may go on inside the cloud, beyond which nothing is doubted. Corridors cost twice as much
at this distance from it, and five times as much at half of it."""
BREADTH_M = 0.3
"""Distance that the vehicle may be off the middle of a corridor, metres."""
TOUCHING = 1
"""Greatest distance from a cloud, voxels, of matter that may go on inside it."""
DEAD_END_M = 0.5
"""Distance kept from matter where the cloud leads nowhere, metres: whoever wants to go into it must still find room."""
RING_M = 0.6
"""Width of the ring around the cloud in which it is judged what the cloud connects, metres, besides the vehicle's own
size."""
CONTEXT_M = 6.0
"""Distance from the cloud up to which ground is looked at, metres: ground further away changes nothing."""
ROOMY_M2 = 4.0
"""Area of free ground, square metres, from which on it must stay connected; smaller pockets need not."""
TALL_M = 0.6
"""Height, metres, above which matter is a wall or rack; floors, roofs and things that lie about are lower."""
MOST_LAYERS = 0.5
"""Share of the cloud's layers in which a place must be passable to count as passable."""


def off_corridor(
    cloud: Bools, solid: Bools, free: Bools, *, ends: Bools | None = None, resolution_m: float, hull_m: float
) -> Bools:
    """Unseen voxels of a cloud that are not to be counted on, because they lie off the corridors through it.

    What is solid at the edge of a cloud often goes on inside, where no sensor sees it. So all roomy places that the
    cloud connects are joined by corridors that keep away from that, in the middle of each gap. Corridors are the same
    at every height. A cloud that leads nowhere has none; there only what is near to something solid is left out.

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
    entries = _roomy(passable & ~inside, resolution_m) & around
    away_m = _away_m(beside[None], resolution_m)[0]
    corridors = _corridors(entries, passable & inside, away_m, resolution_m, hull_m + BREADTH_M)
    keep = away_m >= DEAD_END_M if corridors is None else corridors | (away_m >= SHY_M)
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


def _corridors(entries: Bools, passage: Bools, away_m: Floats, resolution_m: float, radius_m: float) -> Bools | None:
    """Places (ny, nx) on corridors that join all entries which the passage joins; None where there are none."""
    parts, count = ndimage.label(entries)
    nodes = np.flatnonzero(entries | passage)
    number = np.full(entries.size, -1, np.int64)
    number[nodes] = np.arange(len(nodes))
    graph = _graph(number.reshape(entries.shape), (1.0 + (SHY_M / np.maximum(away_m, 0.1)) ** 2).ravel()[nodes])
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
    corridors = np.zeros(entries.shape, bool)
    for _, a, b, node in sorted(offers):
        if joined[a] == joined[b]:
            continue
        joined = [joined[a] if j == joined[b] else j for j in joined]
        while node >= 0:
            _widen(corridors, int(nodes[node]), resolution_m, radius_m)
            node = int(back[a][node])
    return corridors if corridors.any() else None


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


def _widen(corridors: Bools, place: int, resolution_m: float, radius_m: float) -> None:
    """Adds the disc around a place of a corridor."""
    y, x = divmod(place, corridors.shape[1])
    reach = int(np.ceil(radius_m / resolution_m))
    rows, columns = slice(max(0, y - reach), y + reach + 1), slice(max(0, x - reach), x + reach + 1)
    v, u = np.ogrid[
        rows.start : min(rows.stop, corridors.shape[0]), columns.start : min(columns.stop, corridors.shape[1])
    ]
    corridors[rows, columns] |= np.hypot(v - y, u - x) * resolution_m <= radius_m
