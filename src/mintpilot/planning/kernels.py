"""Compiled searches over a lattice: A* and distance fields. Compiled once, and cached on disk.

Both are label-correcting: a node that is improved later is queued again. The comments in
`mintpilot.planning.buckets` tell how the queue works, those in `mintpilot.planning.moves` which moves are left out.
"""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from mintpilot.core.geometry import Floats, Ints
from mintpilot.planning.buckets import (
    CLOSED,
    FULL,
    PER_EDGE,
    RING,
    SLACK,
    begin,
    coordinates,
    lowest_bit,
    octile,
    put,
    redundant,
)
from mintpilot.planning.lattice import Words


@njit(cache=True, error_model="numpy")
def astar(
    allowed: Words,
    offset: Ints,
    step: Floats,
    length: Floats,
    after: NDArray[np.uint32],
    detour: NDArray[np.uint32],
    open_ground: np.uint32,
    nx: int,
    ny: int,
    start: int,
    goal: int,
    guide: Floats | None,
    cells: NDArray[np.void],
    tag: int,
    pool: NDArray[np.void],
) -> tuple[float, int]:
    """A* from start to goal; (cost, infinity or `FULL`; nodes expanded). Moves that led to each node stay in cells.

    ``guide`` is a consistent lower bound of the distance to the goal of every node, or None for the octile distance.
    """
    gx, gy, gz = coordinates(goal, nx, ny)
    x, y, z = coordinates(start, nx, ny)
    if guide is None:  # noqa: SIM108 - the compiler prunes the branch, but not the expression
        f0 = octile(x - gx, y - gy, z - gz)
    else:
        f0 = guide[start]
    if f0 == np.inf:
        return np.inf, 0
    head = np.empty(RING, np.int32)
    begin(cells, pool, head, start, tag)
    best, limit = np.inf, np.inf
    spare, used, queued, bucket, expanded = -1, 1, 1, 0, 0
    while queued > 0:
        entry = head[bucket & (RING - 1)]
        if entry < 0:
            bucket += 1
            if best <= f0 + bucket / PER_EDGE + SLACK:
                break
            continue
        node, g = pool[entry].node, pool[entry].g
        head[bucket & (RING - 1)] = pool[entry].next
        pool[entry].next = spare
        spare = entry
        queued -= 1
        last = cells[node].last
        if cells[node].g != g or last & CLOSED:
            continue
        cells[node].last = last | CLOSED
        if node == goal:
            best, limit = g, g - SLACK
            continue
        expanded += 1
        if used + length.size > pool.size:
            return FULL, expanded
        x, y, z = coordinates(node, nx, ny)
        if best < np.inf and guide is None and g + octile(x - gx, y - gy, z - gz) >= limit:
            continue
        ground = allowed[node] >> np.uint64(32)
        word = allowed[node] & after[last, 1 if ground == open_ground else 0]
        while word:
            k = lowest_bit(word)
            word &= word - np.uint64(1)
            if redundant(ground, detour, last, k):
                continue
            to = node + offset[k]
            cost = g + length[k]
            if cells[to].tag == tag and cost >= cells[to].g - 1e-12:
                continue
            if guide is None:
                f = cost + octile(x + step[k, 2] - gx, y + step[k, 1] - gy, z + step[k, 0] - gz)
            else:
                f = cost + guide[to]
            if not f < limit:
                continue
            cells[to].g = cost
            cells[to].tag = tag
            cells[to].last = k
            spare, used = put(pool, head, max(bucket, int((f - f0) * PER_EDGE)), to, cost, spare, used)
            queued += 1
    return best, expanded


@njit(cache=True, error_model="numpy")
def field(
    allowed: Words,
    offset: Ints,
    step: Floats,
    length: Floats,
    after: NDArray[np.uint32],
    detour: NDArray[np.uint32],
    open_ground: np.uint32,
    nx: int,
    ny: int,
    source: int,
    target: int,
    bound: float,
    cells: NDArray[np.void],
    tag: int,
    pool: NDArray[np.void],
) -> int:
    """Distances from the source to all nodes that may lie on a way to the target of at most ``bound``.

    The test is distance + octile distance to the target <= bound; with target -1 it is distance <= bound. Distances
    of all nodes that pass are exact. They stay in ``cells``. Returns the nodes expanded, or -1 when the pool is full.
    """
    gx, gy, gz = coordinates(max(target, 0), nx, ny)
    head = np.empty(RING, np.int32)
    begin(cells, pool, head, source, tag)
    spare, used, queued, bucket, expanded = -1, 1, 1, 0, 0
    while queued > 0:
        entry = head[bucket & (RING - 1)]
        if entry < 0:
            bucket += 1
            continue
        node, g = pool[entry].node, pool[entry].g
        head[bucket & (RING - 1)] = pool[entry].next
        pool[entry].next = spare
        spare = entry
        queued -= 1
        if cells[node].g != g:
            continue
        expanded += 1
        if used + length.size > pool.size:
            return -1
        x, y, z = coordinates(node, nx, ny)
        last = cells[node].last
        ground = allowed[node] >> np.uint64(32)
        word = allowed[node] & after[last, 1 if ground == open_ground else 0]
        while word:
            k = lowest_bit(word)
            word &= word - np.uint64(1)
            if redundant(ground, detour, last, k):
                continue
            to = node + offset[k]
            cost = g + length[k]
            if cells[to].tag == tag and cost >= cells[to].g - 1e-12:
                continue
            ahead = octile(x + step[k, 2] - gx, y + step[k, 1] - gy, z + step[k, 0] - gz) if target >= 0 else 0.0
            if cost + ahead > bound + SLACK:
                continue
            cells[to].g = cost
            cells[to].tag = tag
            cells[to].last = k
            spare, used = put(pool, head, max(bucket, int(cost * 2)), to, cost, spare, used)
            queued += 1
    return expanded


@njit(cache=True, error_model="numpy")
def walk_back(cells: NDArray[np.void], offset: Ints, start: int, goal: int) -> Ints:
    """Nodes (n,) from start to goal, along the moves that a search left in cells."""
    count = 1
    node = goal
    while node != start:
        node -= offset[cells[node].last & (CLOSED - 1)]
        count += 1
    path = np.empty(count, np.int64)
    node = goal
    for i in range(count - 1, -1, -1):
        path[i] = node
        if i:
            node -= offset[cells[node].last & (CLOSED - 1)]
    return path
