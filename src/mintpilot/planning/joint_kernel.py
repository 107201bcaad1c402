"""The compiled heart of the joint search: labels (cost, set of regions entered) in a ring of buckets."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from mintpilot.core.geometry import Floats, Ints
from mintpilot.planning.buckets import PER_EDGE, RING, SLACK, lowest_bit, redundant
from mintpilot.planning.lattice import NEAR, Words
from mintpilot.planning.moves import NO_MOVE

LABEL = np.dtype([("g", np.float64)] + [(n, np.int32) for n in ("set", "node", "parent", "below", "next", "last")])
"""Cost so far; number of the set of regions entered; where; the label it came from, the node's next label, the
bucket's next label; the move."""

ENTERED = np.dtype([("mask", np.uint64), ("cap", np.float64)])
"""A set of regions, and the least cost of a way found so far that enters no other region."""

FOUND = np.dtype([("cost", np.float64), ("label", np.int64)])
"""A way to the goal: its cost, and the label from which on it is the shortest way of the optimistic map."""

AIM = np.dtype([("mask", np.uint64), ("tag", np.uint32), ("last", np.int32)])
"""The shortest way from a node to the goal on the optimistic map: the regions that it enters, the number of the search
that wrote this, and the move of the field search that led from the next node of that way to this one."""

SMALL = -1
SPENT = -2

_DEAD = 64
_FIRST = 32  # a node's `last` below it is still the move of the field search: the node has no label yet


@njit(cache=True, error_model="numpy")
def numbered(
    mask: np.uint64, sets: NDArray[np.void], index: NDArray[np.int32], known: int, bound: float, best: Floats
) -> int:
    """The number of a set of regions in ``sets``; a new one is written at ``known``."""
    slot = np.int64((mask * np.uint64(0x9E3779B97F4A7C15)) >> np.uint64(32)) & (index.size - 1)
    while index[slot] >= 0:
        if sets[index[slot]].mask == mask:
            return int(index[slot])
        slot = (slot + 1) & (index.size - 1)
    index[slot] = known
    sets[known].mask = mask
    sets[known].cap = bound
    for i in range(known):
        if sets[i].mask & ~mask == 0:
            sets[known].cap = min(sets[known].cap, best[i])
    return known


@njit(cache=True, error_model="numpy")
def take_aim(
    node: int,
    aims: NDArray[np.void],
    cells: NDArray[np.void],
    tag: int,
    allowed: Words,
    offset: Ints,
    swept: Ints,
    region: NDArray[np.uint64],
) -> None:
    """Writes the aim of a node, and of all nodes on its way up to the first that has one.

    Must come before the node's first label, which takes the place of the field's move in ``cells``.
    """
    trail = np.empty(64, np.int64)
    count = 0
    while aims[node].tag != tag:
        if count == trail.size:
            longer = np.empty(2 * count, np.int64)
            longer[:count] = trail
            trail = longer
        trail[count] = node
        count += 1
        last = cells[node].last
        if last == NO_MOVE:
            break
        node -= offset[last]
    for i in range(count - 1, -1, -1):
        here = trail[i]
        last = cells[here].last
        mask = region[here]
        if last != NO_MOVE:
            ahead = here - offset[last]
            mask = aims[ahead].mask
            if allowed[ahead] & NEAR:
                for j in range(swept.shape[1]):
                    mask |= region[ahead + swept[last, j]]
        aims[here].mask = mask
        aims[here].last = last
        aims[here].tag = tag


@njit(cache=True, error_model="numpy")
def admit(
    pool: NDArray[np.void], cells: NDArray[np.void], sets: NDArray[np.void], to: int, cost: float, mask: np.uint64
) -> int:
    """Drops the labels of the node that (cost, mask) beats; 1 + number of comparisons, negative if one beats it."""
    above, steps = -1, 1
    i = cells[to].last - _FIRST
    while i >= 0:
        steps += 1
        below = pool[i].below
        other = sets[pool[i].set].mask
        if pool[i].g <= cost + 1e-12 and other & ~mask == 0:
            return -steps
        if cost <= pool[i].g + 1e-12 and mask & ~other == 0:
            pool[i].last |= _DEAD
            if above < 0:
                cells[to].last = _FIRST + below if below >= 0 else 0
            else:
                pool[above].below = below
        else:
            above = i
        i = below
    return steps


@njit(cache=True, error_model="numpy")
def append(
    pool: NDArray[np.void],
    cells: NDArray[np.void],
    head: NDArray[np.int32],
    new: int,
    bucket: int,
    g: float,
    number: int,
    node: int,
    parent: int,
    last: int,
) -> None:
    """Writes a new label, and puts it on its node's list and in its bucket."""
    slot = bucket & (RING - 1)
    pool[new].g = g
    pool[new].set = number
    pool[new].node = node
    pool[new].parent = parent
    pool[new].last = last
    pool[new].below = max(cells[node].last - _FIRST, -1)
    pool[new].next = head[slot]
    cells[node].last = _FIRST + new
    head[slot] = new


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
    bound: float,
    budget: int,
    cells: NDArray[np.void],
    tag: int,
    aims: NDArray[np.void],
    pool: NDArray[np.void],
    sets: NDArray[np.void],
    found: NDArray[np.void],
) -> tuple[int, int, int]:
    """All ways from start to goal that are best under some set of blocked regions.

    ``cells`` holds, under ``tag``, the exact distances to the goal on the optimistic map of every node that may matter.
    ``bound`` is the cost of the way that enters no region, or infinity; that way itself is not found again.

    Returns:
        (number of ways in ``found``, some of which others beat, or `SMALL` when a buffer is too small, or `SPENT` when
        the budget of comparisons is spent; labels made; labels expanded).
    """
    if cells[start].tag != tag:
        return 0, 0, 0
    f0 = cells[start].g
    head = np.full(RING, -1, np.int32)
    index = np.full(2 * sets.size, -1, np.int32)
    best = np.full(sets.size, np.inf)
    numbered(region[start], sets, index, 0, bound, best)
    take_aim(start, aims, cells, tag, allowed, offset, swept, region)
    append(pool, cells, head, 0, 0, 0.0, 0, start, -1, NO_MOVE)
    count, known, used, queued, bucket, expanded, work = 0, 1, 1, 1, 0, 0, 0
    while queued > 0:
        label = head[bucket & (RING - 1)]
        if label < 0:
            bucket += 1
            continue
        head[bucket & (RING - 1)] = pool[label].next
        queued -= 1
        node, g, number, last = pool[label].node, pool[label].g, pool[label].set, pool[label].last
        if last & _DEAD or sets[number].cap <= g + cells[node].g + SLACK:
            continue
        if used + length.size > pool.size or known + length.size > sets.size or count == found.size:
            return SMALL, used, expanded
        if work > budget:
            return SPENT, used, expanded
        mask = sets[number].mask
        if aims[node].mask & ~mask == 0:
            # The shortest way on from here enters nothing new: no other way on is better for any set of regions.
            cost = g + cells[node].g
            found[count].cost = cost
            found[count].label = label
            count += 1
            best[number] = cost
            for i in range(known):
                if mask & ~sets[i].mask == 0:
                    sets[i].cap = min(sets[i].cap, cost)
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
            entered, into = mask, number
            if near:
                for i in range(swept.shape[1]):
                    entered |= region[node + swept[k, i]]
                if entered != mask:
                    into = numbered(entered, sets, index, known, bound, best)
                    if into == known:
                        work += known
                        known += 1
            cost = g + length[k]
            f = cost + cells[to].g
            if sets[into].cap <= f + SLACK:
                continue
            compared = admit(pool, cells, sets, to, cost, entered)
            work += abs(compared)
            if compared < 0:
                continue
            if aims[to].tag != tag:
                take_aim(to, aims, cells, tag, allowed, offset, swept, region)
            append(pool, cells, head, used, max(bucket, int((f - f0) * PER_EDGE)), cost, into, to, label, k)
            used += 1
            queued += 1
    return count, used, expanded


@njit(cache=True, error_model="numpy")
def forget(pool: NDArray[np.void], used: int, cells: NDArray[np.void]) -> None:
    """Takes all labels off their nodes, so that the search can begin anew."""
    for i in range(used):
        cells[pool[i].node].last = 0


@njit(cache=True, error_model="numpy")
def trace(pool: NDArray[np.void], label: int, aims: NDArray[np.void], offset: Ints) -> Ints:
    """Nodes (n,) from the start to where the label is, and on to the goal."""
    ahead, count = 0, 0
    node = pool[label].node
    while aims[node].last != NO_MOVE:
        ahead += 1
        node -= offset[aims[node].last]
    i = label
    while i >= 0:
        count += 1
        i = pool[i].parent
    path = np.empty(count + ahead, np.int64)
    i = label
    for at in range(count - 1, -1, -1):
        path[at] = pool[i].node
        i = pool[i].parent
    for at in range(count, count + ahead):
        path[at] = path[at - 1] - offset[aims[path[at - 1]].last]
    return path
