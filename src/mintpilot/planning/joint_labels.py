"""Labels of the joint search: where a way is, what it cost, and the set of regions that it has entered."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mintpilot.core.compiled import compiled
from mintpilot.core.geometry import Floats
from mintpilot.planning.buckets import KNOWN, RING

LABEL = np.dtype([("g", np.float64)] + [(n, np.int32) for n in ("set", "node", "parent", "below", "next", "last")])
"""Cost so far; number of the set of regions entered; where; the label it came from, the node's next label, the
bucket's next label; the move."""

ENTERED = np.dtype([("mask", np.uint64), ("cap", np.float64)])
"""A set of regions, and the least cost of a way found so far that enters no other region."""

FOUND = np.dtype([("cost", np.float64), ("label", np.int64)])
"""A way to the goal: its cost, and the label from which on it is the shortest way of the optimistic map."""

AT_ENTRY = -2
"""`AT_ENTRY` - v stands for the way to node v that enters no region, in the place of a label."""

DEAD = 64
FIRST = 32  # a node whose `last` is below has no label: it is still the move of the field


@compiled(error_model="numpy")
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


@compiled(error_model="numpy")
def admit(
    pool: NDArray[np.void], cells: NDArray[np.void], sets: NDArray[np.void], to: int, cost: float, mask: np.uint64
) -> int:
    """Drops the labels of the node that (cost, mask) beats; 1 + number of comparisons, negative if one beats it."""
    above, steps = -1, 1
    i = cells[to].last - FIRST
    while i >= 0:
        steps += 1
        below = pool[i].below
        other = sets[pool[i].set].mask
        if pool[i].g <= cost + 1e-12 and other & ~mask == 0:
            return -steps
        if cost <= pool[i].g + 1e-12 and mask & ~other == 0:
            pool[i].last |= DEAD
            if above < 0:
                cells[to].last = FIRST + below if below >= 0 else KNOWN
            else:
                pool[above].below = below
        else:
            above = i
        i = below
    return steps


@compiled(error_model="numpy")
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
    pool[new].below = max(cells[node].last - FIRST, -1)
    pool[new].next = head[slot]
    cells[node].last = FIRST + new
    head[slot] = new


@compiled(error_model="numpy")
def forget(pool: NDArray[np.void], used: int, cells: NDArray[np.void]) -> None:
    """Takes all labels off their nodes, so that the search can begin anew."""
    for i in range(used):
        cells[pool[i].node].last = KNOWN
