"""The compiled heart of the joint search: labels (cost, set of regions entered) in a ring of buckets."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from mintpilot.core.geometry import Floats, Ints
from mintpilot.planning.kernels import RING, SLACK, WIDTH, grown, lowest_bit
from mintpilot.planning.lattice import NEAR, Words
from mintpilot.planning.moves import NO_MOVE

LABEL = np.dtype(
    [
        ("g", np.float64),
        ("mask", np.uint64),
        ("node", np.int32),
        ("parent", np.int32),
        ("below", np.int32),
        ("next", np.int32),
        ("last", np.int32),
    ]
)
"""Cost so far, regions entered, where; the label it came from, the node's next label, the bucket's next, the move."""

FOUND = np.dtype([("cost", np.float64), ("mask", np.uint64), ("label", np.int32)])
"""A way to the goal that no other beats."""

_DEAD = 64
_FIRST = 32  # a node's `last` below it is still the move of the field search: the node has no label yet


@njit(cache=True)
def beaten(found: NDArray[np.void], count: int, cost: float, mask: np.uint64) -> bool:
    """Whether a way at most as dear, through no other regions, is known. ``found`` is sorted by cost."""
    for i in range(count):
        if found[i].cost > cost + SLACK:
            return False
        if found[i].mask & ~mask == 0:
            return True
    return False


@njit(cache=True)
def keep(found: NDArray[np.void], count: int, cost: float, mask: np.uint64, label: int) -> tuple[NDArray[np.void], int]:
    """Adds a way, sorted by cost, and drops those that it beats."""
    if count == found.size:
        found = grown(found)
    rest = 0
    for i in range(count):
        if not (found[i].cost >= cost - SLACK and mask & ~found[i].mask == 0):
            found[rest] = found[i]
            rest += 1
    i = rest
    while i > 0 and found[i - 1].cost > cost:
        found[i] = found[i - 1]
        i -= 1
    found[i].cost, found[i].mask, found[i].label = cost, mask, label
    return found, rest + 1


@njit(cache=True)
def admit(pool: NDArray[np.void], cells: NDArray[np.void], to: int, cost: float, mask: np.uint64) -> bool:
    """Whether no label of the node beats (cost, mask); labels that it beats are dropped."""
    above = -1
    i = cells[to].last - _FIRST
    while i >= 0:
        below = pool[i].below
        if pool[i].g <= cost + 1e-12 and pool[i].mask & ~mask == 0:
            return False
        if cost <= pool[i].g + 1e-12 and mask & ~pool[i].mask == 0:
            pool[i].last |= _DEAD
            if above < 0:
                cells[to].last = _FIRST + below if below >= 0 else 0
            else:
                pool[above].below = below
        else:
            above = i
        i = below
    return True


@njit(cache=True)
def search_labels(
    allowed: Words,
    offset: Ints,
    length: Floats,
    natural: Words,
    swept: Ints,
    region: NDArray[np.uint64],
    start: int,
    goal: int,
    bound: float,
    budget: int,
    cells: NDArray[np.void],
    tag: int,
    pool: NDArray[np.void],
) -> tuple[bool, int, int, int, NDArray[np.void], NDArray[np.void]]:
    """All ways from start to goal that are best under some set of blocked regions.

    ``cells`` holds, under ``tag``, the exact distances to the goal on the optimistic map of every node that may matter.
    ``bound`` is the cost of the way that enters no region, or infinity; that way itself is entry with label -1.

    Returns:
        (whether the budget of labels sufficed, number of ways, labels made, labels expanded, the ways, the pool).
    """
    found = np.empty(64, FOUND)
    count = 0
    if bound < np.inf:
        found, count = keep(found, count, bound, np.uint64(0), -1)
    if cells[start].tag != tag:
        return True, count, 0, 0, found, pool
    full = natural[NO_MOVE]
    f0 = cells[start].g
    head = np.full(RING, -1, np.int32)
    first = pool[0]
    first.g, first.mask, first.node, first.parent = 0.0, region[start], start, -1
    first.below, first.next, first.last = -1, -1, NO_MOVE
    cells[start].last = _FIRST
    head[0] = 0
    used, queued, bucket, expanded = 1, 1, 0, 0
    while queued > 0:
        slot = bucket & (RING - 1)
        label = head[slot]
        if label < 0:
            bucket += 1
            continue
        head[slot] = pool[label].next
        queued -= 1
        last = pool[label].last
        if last & _DEAD:
            continue
        node, g, mask = pool[label].node, pool[label].g, pool[label].mask
        if beaten(found, count, g + cells[node].g, mask):
            continue
        if node == goal:
            found, count = keep(found, count, g, mask, label)
            continue
        if used + 32 > budget:
            return False, count, used, expanded, found, pool
        if used + 32 > pool.size:
            pool = grown(pool)
        expanded += 1
        word = allowed[node]
        near = word & NEAR
        word &= ~NEAR
        if near == 0 and word == full:
            word &= natural[last]
        while word:
            k = lowest_bit(word)
            word &= word - np.uint32(1)
            to = node + offset[k]
            if cells[to].tag != tag:
                continue
            cost = g + length[k]
            entered = mask
            if near:
                for i in range(swept.shape[1]):
                    entered |= region[node + swept[k, i]]
            f = cost + cells[to].g
            if beaten(found, count, f, entered) or not admit(pool, cells, to, cost, entered):
                continue
            slot = max(bucket, int((f - f0) * (1 / WIDTH))) & (RING - 1)
            new = pool[used]
            new.g, new.mask, new.node, new.parent, new.last = cost, entered, to, label, k
            new.below, new.next = max(cells[to].last - _FIRST, -1), head[slot]
            cells[to].last = _FIRST + used
            head[slot] = used
            used += 1
            queued += 1
    return True, count, used, expanded, found, pool


@njit(cache=True)
def trace(pool: NDArray[np.void], label: int) -> Ints:
    """Nodes (n,) from the start to where the label is."""
    count = 0
    i = label
    while i >= 0:
        count += 1
        i = pool[i].parent
    path = np.empty(count, np.int64)
    i = label
    while i >= 0:
        count -= 1
        path[count] = pool[i].node
        i = pool[i].parent
    return path
