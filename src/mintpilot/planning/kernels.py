"""Compiled searches over a lattice: A* and distance fields with a ring of buckets.

Both are label-correcting: a bucket holds nodes whose priority lies in one interval, in no order; a node improved later
is queued again. A move changes the priority by at most ``2 * sqrt(3)``, so a short ring of buckets is enough. The pool
of queue entries grows when it is full. Kernels are compiled once and cached on disk.
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
from mintpilot.planning.moves import NO_MOVE

CELL = np.dtype([("g", np.float64), ("tag", np.uint32), ("last", np.int32)])
"""A node's state: cost so far, the number of the search that wrote it, the move that led here."""
ENTRY = np.dtype([("g", np.float64), ("node", np.int32), ("next", np.int32)])
"""A queued node and the next entry of its bucket."""

RING = 64
WIDTH = 0.125
SLACK = 1e-9
"""Costs closer than this are equal: they are sums of the same numbers in another order."""
CLOSED = 64


def _lowest_bit(typingctx: Any, word: Any) -> Any:  # noqa: ARG001
    def codegen(context: Any, builder: Any, signature: Any, args: Any) -> Any:  # noqa: ARG001
        return builder.cttz(args[0], ir.Constant(ir.IntType(1), 1))

    return word(word), codegen


lowest_bit: Callable[[np.uint32], int] = cast(Any, intrinsic)(_lowest_bit)
"""Index of the lowest bit that is set (the word must not be 0)."""


@njit(cache=True)
def octile(a: int, b: int, c: int) -> float:
    """Length of the shortest path over |a|, |b|, |c| cells of empty space."""
    a, b, c = abs(a), abs(b), abs(c)
    low = min(a, b)
    high = max(a, b)
    mid = min(high, max(low, c))
    return max(high, c) + 0.41421356237309515 * mid + 0.31783724519578205 * min(low, c)


@njit(cache=True)
def grown(pool: NDArray[np.void]) -> NDArray[np.void]:
    """The same pool with twice the room."""
    bigger = np.empty(2 * pool.size, pool.dtype)
    bigger[: pool.size] = pool
    return bigger


@njit(cache=True)
def astar(
    allowed: NDArray[np.uint32],
    offset: Ints,
    step: NDArray[np.int32],
    length: Floats,
    natural: NDArray[np.uint32],
    nx: int,
    ny: int,
    start: int,
    goal: int,
    guide: Floats | None,
    cells: NDArray[np.void],
    tag: int,
    pool: NDArray[np.void],
) -> tuple[float, int, NDArray[np.void]]:
    """A* from start to goal; (cost or infinity, nodes expanded, the pool). Moves that led to each node stay in cells.

    ``guide`` is an exact lower bound of the distance to the goal of every node, or None for the octile distance.
    """
    full = natural[NO_MOVE]
    gx, gy, gz = goal % nx, goal // nx % ny, goal // (nx * ny)
    if guide is None:  # noqa: SIM108 - numba prunes the branch, not the expression
        f0 = octile(start % nx - gx, start // nx % ny - gy, start // (nx * ny) - gz)
    else:
        f0 = guide[start]
    best = np.inf
    if f0 == np.inf:
        return best, 0, pool
    head = np.full(RING, -1, np.int32)
    cells[start].g, cells[start].tag, cells[start].last = 0.0, tag, NO_MOVE
    pool[0].g, pool[0].node, pool[0].next = 0.0, start, -1
    head[0] = 0
    spare, used, queued, bucket, expanded = -1, 1, 1, 0, 0
    while queued > 0:
        slot = bucket & (RING - 1)
        i = head[slot]
        if i < 0:
            bucket += 1
            if best <= f0 + bucket * WIDTH + SLACK:
                break
            continue
        node, g = pool[i].node, pool[i].g
        head[slot], pool[i].next, spare = pool[i].next, spare, i
        queued -= 1
        last = cells[node].last
        if cells[node].g != g or last & CLOSED:
            continue
        cells[node].last = last | CLOSED
        if node == goal:
            best = g
            if best <= f0 + bucket * WIDTH + SLACK:
                break
            continue
        expanded += 1
        x, y, z = node % nx - gx, node // nx % ny - gy, node // (nx * ny) - gz
        word = allowed[node]
        if word == full:
            word &= natural[last]
        while word:
            k = lowest_bit(word)
            word &= word - np.uint32(1)
            to = node + offset[k]
            cost = g + length[k]
            if cells[to].tag == tag and cost >= cells[to].g - 1e-12:
                continue
            if guide is None:  # noqa: SIM108
                f = cost + octile(x + step[k, 2], y + step[k, 1], z + step[k, 0])
            else:
                f = cost + guide[to]
            if f >= best - SLACK or f == np.inf:
                continue
            cells[to].g, cells[to].tag, cells[to].last = cost, tag, k
            slot = max(bucket, int((f - f0) * (1 / WIDTH))) & (RING - 1)
            i = spare
            if i >= 0:
                spare = pool[i].next
            else:
                if used == pool.size:
                    pool = grown(pool)
                i = used
                used += 1
            pool[i].g, pool[i].node, pool[i].next = cost, to, head[slot]
            head[slot] = i
            queued += 1
    return best, expanded, pool


@njit(cache=True)
def field(
    allowed: NDArray[np.uint32],
    offset: Ints,
    step: NDArray[np.int32],
    length: Floats,
    natural: NDArray[np.uint32],
    nx: int,
    ny: int,
    source: int,
    target: int,
    bound: float,
    cells: NDArray[np.void],
    tag: int,
    pool: NDArray[np.void],
) -> tuple[int, NDArray[np.void]]:
    """Distances from the source to all nodes that may lie on a way to the target of at most ``bound``.

    The test is distance + octile distance to the target <= bound; with target -1 it is distance <= bound. Distances
    of all nodes that pass are exact. They stay in ``cells``. Returns (nodes expanded, the pool).
    """
    full = natural[NO_MOVE]
    gx, gy, gz = target % nx, target // nx % ny, target // (nx * ny)
    head = np.full(RING, -1, np.int32)
    cells[source].g, cells[source].tag, cells[source].last = 0.0, tag, NO_MOVE
    pool[0].g, pool[0].node, pool[0].next = 0.0, source, -1
    head[0] = 0
    spare, used, queued, bucket, expanded = -1, 1, 1, 0, 0
    while queued > 0:
        slot = bucket & (RING - 1)
        i = head[slot]
        if i < 0:
            bucket += 1
            continue
        node, g = pool[i].node, pool[i].g
        head[slot], pool[i].next, spare = pool[i].next, spare, i
        queued -= 1
        if cells[node].g != g:
            continue
        expanded += 1
        x, y, z = node % nx - gx, node // nx % ny - gy, node // (nx * ny) - gz
        word = allowed[node]
        if word == full:
            word &= natural[cells[node].last]
        while word:
            k = lowest_bit(word)
            word &= word - np.uint32(1)
            to = node + offset[k]
            cost = g + length[k]
            if cells[to].tag == tag and cost >= cells[to].g - 1e-12:
                continue
            ahead = octile(x + step[k, 2], y + step[k, 1], z + step[k, 0]) if target >= 0 else 0.0
            if cost + ahead > bound + SLACK:
                continue
            cells[to].g, cells[to].tag, cells[to].last = cost, tag, k
            slot = max(bucket, int(cost * 2)) & (RING - 1)
            i = spare
            if i >= 0:
                spare = pool[i].next
            else:
                if used == pool.size:
                    pool = grown(pool)
                i = used
                used += 1
            pool[i].g, pool[i].node, pool[i].next = cost, to, head[slot]
            head[slot] = i
            queued += 1
    return expanded, pool


@njit(cache=True)
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
