"""Compiled searches over a lattice: A* and distance fields with a ring of buckets.

Both are label-correcting: a bucket holds nodes whose priority lies in one interval, in no order; a node improved later
is queued again. A move changes the priority by at most ``2 * sqrt(3)``, so a short ring of buckets is enough.

The queue's entries live in a pool; used ones are given out again. When the pool is too small a kernel returns `FULL`,
the caller doubles the pool and calls again: growing inside a kernel would keep the compiler from holding the pool's
address in a register, which costs a factor of four. Kernels are compiled once and cached on disk.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, cast

import numpy as np
from llvmlite import ir  # type: ignore[import-untyped]
from numba import njit
from numba.extending import intrinsic
from numpy.typing import NDArray

from mintpilot.core.geometry import Floats, Ints
from mintpilot.planning.lattice import Words
from mintpilot.planning.moves import NO_MOVE

CELL = np.dtype([("g", np.float64), ("tag", np.uint32), ("last", np.int32)])
"""A node's state: cost so far, the number of the search that wrote it, the move that led here."""
ENTRY = np.dtype([("g", np.float64), ("node", np.int32), ("next", np.int32)])
"""A queued node and the next entry of its bucket (or of the unused ones)."""

FULL = -1.0
"""Returned instead of a cost when the pool is too small."""
RING = 64
"""Number of buckets."""
PER_EDGE = 8.0
"""Buckets per edge of cost."""
SLACK = 1e-9
"""Costs closer than this are equal: they are sums of the same numbers in another order."""
CLOSED = 64
"""Added to the last move of a node that has been expanded."""


def _lowest_bit(typingctx: Any, word: Any) -> Any:  # noqa: ARG001
    def codegen(context: Any, builder: Any, signature: Any, args: Any) -> Any:  # noqa: ARG001
        return builder.cttz(args[0], ir.Constant(ir.IntType(1), 1))

    return word(word), codegen


lowest_bit: Callable[[np.uint64], int] = cast(Any, intrinsic)(_lowest_bit)
"""Index of the lowest bit that is set (the word must not be 0)."""


@njit(cache=True, error_model="numpy")
def redundant(ground: np.uint64, detour: NDArray[np.uint32], last: int, k: int) -> bool:
    """Whether the free surroundings make move k needless after the last one (`mintpilot.planning.moves`)."""
    one, other = detour[last, k, 0], detour[last, k, 1]
    return bool(ground & one == one or ground & other == other)


@njit(cache=True, error_model="numpy")
def octile(a: float, b: float, c: float) -> float:
    """Length of the shortest path over |a|, |b|, |c| cells of empty space."""
    a, b, c = abs(a), abs(b), abs(c)
    low = min(a, b)
    high = max(a, b)
    middle = min(high, max(low, c))
    return max(high, c) + 0.41421356237309515 * middle + 0.31783724519578205 * min(low, c)


@njit(cache=True, error_model="numpy")
def coordinates(node: int, nx: int, ny: int) -> tuple[float, float, float]:
    """(x, y, z) of a node. Exact below 2^31 nodes, and faster than dividing whole numbers."""
    row = int((node + 0.5) * (1.0 / nx))
    layer = int((row + 0.5) * (1.0 / ny))
    return float(node - row * nx), float(row - layer * ny), float(layer)


@njit(cache=True, error_model="numpy")
def begin(cells: NDArray[np.void], pool: NDArray[np.void], head: NDArray[np.int32], source: int, tag: int) -> None:
    """Queues the first node."""
    cells[source].g = 0.0
    cells[source].tag = tag
    cells[source].last = NO_MOVE
    pool[0].g = 0.0
    pool[0].node = source
    pool[0].next = -1
    head[:] = -1
    head[0] = 0


@njit(cache=True, error_model="numpy")
def put(
    pool: NDArray[np.void], head: NDArray[np.int32], bucket: int, node: int, g: float, spare: int, used: int
) -> tuple[int, int]:
    """Queues a node in a bucket; (first unused entry or -1, number of entries ever used)."""
    entry = spare
    if entry >= 0:
        spare = pool[entry].next
    else:
        entry = used
        used += 1
    slot = bucket & (RING - 1)
    pool[entry].g = g
    pool[entry].node = node
    pool[entry].next = head[slot]
    head[slot] = entry
    return spare, used


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
