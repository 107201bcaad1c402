"""The compiled heart of the joint search: labels (cost, set of regions entered) in a ring of buckets."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mintpilot.core.compiled import compiled
from mintpilot.core.geometry import Floats, Ints
from mintpilot.planning.buckets import MOVE, PER_EDGE, RING, SLACK, lowest_bit, redundant
from mintpilot.planning.joint_labels import AT_ENTRY, DEAD, admit, append, numbered
from mintpilot.planning.joint_paths import take_aim
from mintpilot.planning.lattice import NEAR, Words
from mintpilot.planning.moves import NO_MOVE

SMALL = -1
SPENT = -2


@compiled(error_model="numpy")
def landings(
    entry_nodes: Ints, cells: NDArray[np.void], tag: int, safe: NDArray[np.void], safe_tag: int, bound: float
) -> tuple[Ints, Floats]:
    """Nodes from which a way that has entered no region may enter its first one; costs by way of them; both sorted."""
    due = np.empty(entry_nodes.size)
    for i in range(entry_nodes.size):
        node = entry_nodes[i]
        reached = safe[node].tag == safe_tag and cells[node].tag == tag
        due[i] = safe[node].g + cells[node].g if reached else np.inf
    order = np.argsort(due, kind="mergesort")
    count = 0
    while count < order.size and due[order[count]] + SLACK < bound and due[order[count]] < np.inf:
        count += 1
    return entry_nodes[order[:count]], due[order[:count]]


@compiled(error_model="numpy")
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
    entry_nodes: Ints,
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
    """All paths from start to goal that are best under some set of blocked regions.

    ``cells`` holds, under ``tag``, the exact distances to the goal on the optimistic map of every node that may matter.
    ``bound`` is the cost of the way that enters no region, or infinity; that way itself is not found again. ``safe``
    holds, under ``safe_tag``, what the search for it left: paths that have entered no region yet are taken from there,
    and labels begin where such a way enters its first one.

    Returns:
        (number of paths in ``found``, some of which others beat, or `SMALL` when a buffer is too small, or `SPENT` when
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
        waiting, due = entry_nodes[:0], np.zeros(0)
        append(pool, cells, head, 0, 0, 0.0, 0, start, -1, NO_MOVE)
        used, queued = 1, 1
    else:
        waiting, due = landings(entry_nodes, cells, tag, safe, safe_tag, bound)
    landed = 0
    while queued > 0 or landed < waiting.size:
        if landed < waiting.size and due[landed] - f0 < (bucket + 1) / PER_EDGE:
            node, number = waiting[landed], 0
            g, last, label = safe[node].g, safe[node].last & MOVE, AT_ENTRY - node
            landed += 1
        else:
            label = head[bucket & (RING - 1)]
            if label < 0:
                bucket += 1
                continue
            head[bucket & (RING - 1)] = pool[label].next
            queued -= 1
            node, g, number, last = pool[label].node, pool[label].g, pool[label].set, pool[label].last
        if last & DEAD or sets[number].cap <= g + cells[node].g + SLACK:
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
            f = cost + cells[to].g
            if sets[into].cap <= f + SLACK or (safe[to].tag == safe_tag and safe[to].g <= cost + 1e-12):
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
