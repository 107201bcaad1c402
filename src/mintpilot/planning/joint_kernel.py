"""The compiled heart of the joint search: labels (cost, set of regions entered) in a ring of buckets."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from mintpilot.core.geometry import Floats, Ints
from mintpilot.planning.buckets import CLOSED, PER_EDGE, RING, SLACK, lowest_bit, redundant
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

ON_SHORE = -2
"""`ON_SHORE` - v stands for the way to node v that enters no region, in the place of a label."""

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
    trail = np.empty(0, np.int64)
    count, first = 0, node
    while True:
        last = cells[node].last
        ahead = node - offset[last] if last != NO_MOVE else -1
        if ahead < 0 or aims[ahead].tag == tag:
            break
        if count == trail.size:
            longer = np.empty(2 * count + 64, np.int64)
            longer[:count] = trail
            trail = longer
        trail[count] = node
        count += 1
        node = ahead
    while True:
        mask = region[node]
        if ahead >= 0:
            mask = aims[ahead].mask
            if allowed[ahead] & NEAR:
                for j in range(swept.shape[1]):
                    mask |= region[ahead + swept[last, j]]
        aims[node].mask, aims[node].last, aims[node].tag = mask, last, tag
        if node == first:
            break
        count -= 1
        ahead, node = node, trail[count]
        last = cells[node].last


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
def landings(
    shore: Ints, cells: NDArray[np.void], tag: int, safe: NDArray[np.void], safe_tag: int, bound: float
) -> tuple[Ints, Floats]:
    """Nodes from which a way that has entered no region may enter its first one; costs by way of them; both sorted."""
    due = np.empty(shore.size)
    for i in range(shore.size):
        node = shore[i]
        reached = safe[node].tag == safe_tag and cells[node].tag == tag
        due[i] = safe[node].g + cells[node].g if reached else np.inf
    order = np.argsort(due, kind="mergesort")
    count = 0
    while count < order.size and due[order[count]] + SLACK < bound and due[order[count]] < np.inf:
        count += 1
    return shore[order[:count]], due[order[:count]]


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
    shore: Ints,
    start: int,
    bound: float,
    budget: int,
    cells: NDArray[np.void],
    tag: int,
    safe: NDArray[np.void],
    safe_tag: int,
    aims: NDArray[np.void],
    pool: NDArray[np.void],
    sets: NDArray[np.void],
    found: NDArray[np.void],
) -> tuple[int, int, int]:
    """All ways from start to goal that are best under some set of blocked regions.

    ``cells`` holds, under ``tag``, the exact distances to the goal on the optimistic map of every node that may matter.
    ``bound`` is the cost of the way that enters no region, or infinity; that way itself is not found again. ``safe``
    holds, under ``safe_tag``, what the search for it left: ways that have entered no region yet are taken from there,
    and labels begin where such a way enters its first one.

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
    count, known, used, queued, bucket, expanded, work = 0, 1, 0, 0, 0, 0, 0
    if region[start]:
        waiting, due = shore[:0], np.zeros(0)
        append(pool, cells, head, 0, 0, 0.0, 0, start, -1, NO_MOVE)
        used, queued = 1, 1
    else:
        waiting, due = landings(shore, cells, tag, safe, safe_tag, bound)
    landed = 0
    while queued > 0 or landed < waiting.size:
        if landed < waiting.size and due[landed] - f0 < (bucket + 1) / PER_EDGE:
            node, number = waiting[landed], 0
            g, last, label = safe[node].g, safe[node].last & (CLOSED - 1), ON_SHORE - node
            landed += 1
        else:
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
        if label >= 0 and aims[node].mask & ~mask == 0:
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
            if label < 0 and into == number:
                continue  # the search that enters no region has been there
            cost = g + length[k]
            if safe[to].tag == safe_tag and safe[to].g <= cost + 1e-12:
                continue
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
def traced(
    labels: Ints,
    start_cell: Ints,
    pool: NDArray[np.void],
    safe: NDArray[np.void],
    aims: NDArray[np.void],
    offset: Ints,
    step: Ints,
) -> tuple[Ints, Ints, Ints]:
    """The ways of labels (n,): before them as they came, after them as they aim.

    Returns:
        (cells (m, 3) of all ways one after the other; where each ends there (n,); numbers of moves (n, 4) along 0, 1,
        2 and 3 axes).
    """
    ends = np.zeros(labels.size, np.int64)
    total = 0
    for n in range(labels.size):
        total += 1 + moves_of(labels[n], pool, safe, aims, offset, ends[:0])
        ends[n] = total
    cells = np.empty((total, 3), np.int64)
    kinds = np.zeros((labels.size, 4), np.int64)
    moves = np.empty(total, np.int64)
    at = 0
    for n in range(labels.size):
        count = moves_of(labels[n], pool, safe, aims, offset, moves)
        cells[at] = start_cell
        for i in range(count):
            k, sign = (moves[i], 1) if moves[i] >= 0 else (-1 - moves[i], -1)
            at += 1
            along = 0
            for axis in range(3):
                cells[at, axis] = cells[at - 1, axis] + sign * step[k, axis]
                along += abs(step[k, axis])
            kinds[n, along] += 1
        at += 1
    return cells, ends, kinds


@njit(cache=True, error_model="numpy")
def moves_of(
    label: int, pool: NDArray[np.void], safe: NDArray[np.void], aims: NDArray[np.void], offset: Ints, moves: Ints
) -> int:
    """Number of moves of a label's way; the moves themselves if there is room (-1 - k: move k the other way round)."""
    behind, i = 0, label
    while i >= 0:
        behind += pool[i].last & ~_DEAD != NO_MOVE
        i = pool[i].parent
    node = ON_SHORE - i if i <= ON_SHORE else -1
    while node >= 0:
        last = safe[node].last & (CLOSED - 1)
        behind += last != NO_MOVE
        node = node - offset[last] if last != NO_MOVE else -1
    count, node = behind, pool[label].node
    while aims[node].last != NO_MOVE:
        if moves.size:
            moves[count] = -1 - aims[node].last
        count += 1
        node -= offset[aims[node].last]
    if not moves.size:
        return count
    i = label
    while i >= 0:
        last = pool[i].last & ~_DEAD
        if last != NO_MOVE:
            behind -= 1
            moves[behind] = last
        i = pool[i].parent
    node = ON_SHORE - i if i <= ON_SHORE else -1
    while behind > 0:
        last = safe[node].last & (CLOSED - 1)
        behind -= 1
        moves[behind] = last
        node -= offset[last]
    return count
