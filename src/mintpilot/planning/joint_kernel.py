"""The compiled heart of the joint search: labels (cost, set of regions entered) in a ring of buckets."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from mintpilot.core.geometry import Floats, Ints
from mintpilot.planning.kernels import PER_EDGE, RING, SLACK, lowest_bit, redundant
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


@njit(cache=True, error_model="numpy")
def beaten(found: NDArray[np.void], count: int, cost: float, mask: np.uint64) -> bool:
    """Whether a way at most as dear, through no other regions, is known. ``found`` is sorted by cost."""
    for i in range(count):
        if found[i].cost > cost + SLACK:
            return False
        if found[i].mask & ~mask == 0:
            return True
    return False


@njit(cache=True, error_model="numpy")
def keep(found: NDArray[np.void], count: int, cost: float, mask: np.uint64, label: int) -> int:
    """Adds a way, sorted by cost, and drops those that it beats; the new number of ways."""
    rest = 0
    for i in range(count):
        if not (found[i].cost >= cost - SLACK and mask & ~found[i].mask == 0):
            found[rest] = found[i]
            rest += 1
    i = rest
    while i > 0 and found[i - 1].cost > cost:
        found[i] = found[i - 1]
        i -= 1
    found[i].cost = cost
    found[i].mask = mask
    found[i].label = label
    return rest + 1


@njit(cache=True, error_model="numpy")
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


@njit(cache=True, error_model="numpy")
def search_labels(
    allowed: Words,
    offset: Ints,
    length: Floats,
    after: NDArray[np.uint32],
    detour: NDArray[np.uint32],
    open_ground: np.uint32,
    around: Ints,
    swept: Ints,
    region: NDArray[np.uint64],
    start: int,
    goal: int,
    bound: float,
    cells: NDArray[np.void],
    tag: int,
    pool: NDArray[np.void],
    found: NDArray[np.void],
) -> tuple[int, int, int]:
    """All ways from start to goal that are best under some set of blocked regions.

    ``cells`` holds, under ``tag``, the exact distances to the goal on the optimistic map of every node that may matter.
    ``bound`` is the cost of the way that enters no region, or infinity; that way itself has label -1.

    Returns:
        (number of ways in ``found``, or -1 when ``found`` or ``pool`` is too small; labels made; labels expanded).
    """
    count = 0
    if bound < np.inf:
        count = keep(found, count, bound, np.uint64(0), -1)
    if cells[start].tag != tag:
        return count, 0, 0
    f0 = cells[start].g
    head = np.full(RING, -1, np.int32)
    append(pool, cells, head, 0, 0, 0.0, region[start], start, -1, NO_MOVE)
    used, queued, bucket, expanded = 1, 1, 0, 0
    while queued > 0:
        label = head[bucket & (RING - 1)]
        if label < 0:
            bucket += 1
            continue
        head[bucket & (RING - 1)] = pool[label].next
        queued -= 1
        node, g, mask, last = pool[label].node, pool[label].g, pool[label].mask, pool[label].last
        if last & _DEAD or beaten(found, count, g + cells[node].g, mask):
            continue
        if used + length.size > pool.size or count == found.size:
            return -1, used, expanded
        if node == goal:
            count = keep(found, count, g, mask, label)
            continue
        expanded += 1
        ground = allowed[node] >> np.uint64(32)
        near = allowed[node] & NEAR
        if near:
            for i in range(around.size):
                if region[node + around[i]] & ~mask:
                    ground &= ~(np.uint64(1) << np.uint64(i))
        word = allowed[node] & after[last, 1 if ground == open_ground else 0]
        while word:
            k = lowest_bit(word)
            word &= word - np.uint64(1)
            if redundant(ground, detour, last, k):
                continue
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
            at = max(bucket, int((f - f0) * PER_EDGE))
            append(pool, cells, head, used, at, cost, entered, to, label, k)
            used += 1
            queued += 1
    return count, used, expanded


@njit(cache=True, error_model="numpy")
def append(
    pool: NDArray[np.void],
    cells: NDArray[np.void],
    head: NDArray[np.int32],
    new: int,
    bucket: int,
    g: float,
    mask: np.uint64,
    node: int,
    parent: int,
    last: int,
) -> None:
    """Writes a new label, and puts it on its node's list and in its bucket."""
    slot = bucket & (RING - 1)
    pool[new].g = g
    pool[new].mask = mask
    pool[new].node = node
    pool[new].parent = parent
    pool[new].last = last
    pool[new].below = max(cells[node].last - _FIRST, -1)
    pool[new].next = head[slot]
    cells[node].last = _FIRST + new
    head[slot] = new


@njit(cache=True, error_model="numpy")
def forget(pool: NDArray[np.void], used: int, cells: NDArray[np.void]) -> None:
    """Takes all labels off their nodes, so that the search can begin anew."""
    for i in range(used):
        cells[pool[i].node].last = 0


@njit(cache=True, error_model="numpy")
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
