"""Compiled A* over a lattice, and the walk back along what a search left.

It is label-correcting: a node that is improved later is queued again. The comments in
`mintpilot.planning.buckets` tell how the queue works, those in `mintpilot.planning.moves` which moves are left out.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mintpilot.core.compiled import compiled
from mintpilot.core.geometry import Floats, Ints
from mintpilot.planning.buckets import (
    CLOSED,
    FULL,
    MOVE,
    PER_EDGE,
    RING,
    SHORT,
    SLACK,
    coordinates,
    lowest_bit,
    octile,
    put,
    redundant,
)
from mintpilot.planning.lattice import Words


@compiled(error_model="numpy")
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
    ahead: NDArray[np.void] | None,
    ahead_tag: int,
    reach: float,
    cells: NDArray[np.void],
    tag: int,
    pool: NDArray[np.void],
    head: NDArray[np.int32],
    queue: Ints,
) -> tuple[float, int]:
    """A* from start to goal. Moves that led to each node stay in cells.

    ``ahead`` holds, under ``ahead_tag``, what `mintpilot.planning.field_kernel` found from the goal towards the start
    up to ``reach``, the start included, on a map with no fewer moves; None: the heuristic is the octile distance alone.

    Returns:
        (cost; infinity; `FULL` when the pool is too small; `SHORT` when the field must reach further. After these two
        the next call goes on from ``head`` and ``queue``, as in `mintpilot.planning.field_kernel`; nodes expanded).
    """
    gx, gy, gz = coordinates(goal, nx, ny)
    sx, sy, sz = coordinates(start, nx, ny)
    f0 = octile(sx - gx, sy - gy, sz - gz) if ahead is None else ahead[start].g
    best = cells[goal].g if cells[goal].tag == tag and cells[goal].last & CLOSED else np.inf
    limit = best - SLACK
    spare, used, queued, bucket = queue[0], queue[1], queue[2], queue[3]
    expanded = 0
    while queued > 0:
        if used + length.size > pool.size:
            best = FULL
            break
        entry = head[bucket & (RING - 1)]
        if entry < 0:
            if best <= f0 + (bucket + 1) / PER_EDGE + SLACK:
                break
            if ahead is not None and f0 + (bucket + 2) / PER_EDGE > reach:
                best = SHORT
                break
            bucket += 1
            continue
        node, g = pool[entry].node, pool[entry].g
        head[bucket & (RING - 1)] = pool[entry].next
        pool[entry].next = spare
        spare = entry
        queued -= 1
        last = cells[node].last
        if cells[node].g != g or last & CLOSED:
            continue
        x, y, z = coordinates(node, nx, ny)
        if ahead is not None:
            if ahead[node].tag == ahead_tag and ahead[node].last < 0:
                f = g + ahead[node].g
            else:
                f = g + reach - octile(x - sx, y - sy, z - sz)
            later = int((f - f0) * PER_EDGE)
            if later > bucket:  # the field has come further since the node was queued
                spare, used = put(pool, head, min(later, bucket + RING - 1), node, g, spare, used)
                queued += 1
                continue
        cells[node].last = last | CLOSED
        if node == goal:
            best, limit = g, g - SLACK
            continue
        expanded += 1
        if best < np.inf and ahead is None and g + octile(x - gx, y - gy, z - gz) >= limit:
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
            if ahead is None:
                f = cost + octile(x + step[k, 2] - gx, y + step[k, 1] - gy, z + step[k, 0] - gz)
            elif ahead[to].tag == ahead_tag and ahead[to].last < 0:
                f = cost + ahead[to].g
            else:
                f = cost + reach - octile(x + step[k, 2] - sx, y + step[k, 1] - sy, z + step[k, 0] - sz)
            if not f < limit:
                continue
            cells[to].g = cost
            cells[to].tag = tag
            cells[to].last = k
            spare, used = put(pool, head, max(bucket, int((f - f0) * PER_EDGE)), to, cost, spare, used)
            queued += 1
    queue[0], queue[1], queue[2], queue[3] = spare, used, queued, bucket
    return best, expanded


@compiled(error_model="numpy")
def walk_back(cells: NDArray[np.void], offset: Ints, start: int, goal: int) -> Ints:
    """Nodes (n,) from start to goal, along the moves that a search left in cells."""
    count = 1
    node = goal
    while node != start:
        node -= offset[cells[node].last & MOVE]
        count += 1
    path = np.empty(count, np.int64)
    node = goal
    for i in range(count - 1, -1, -1):
        path[i] = node
        if i:
            node -= offset[cells[node].last & MOVE]
    return path
