"""The paths behind labels: how they came, and where they aim."""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from mintpilot.core.geometry import Ints
from mintpilot.planning.buckets import CLOSED
from mintpilot.planning.joint_labels import DEAD, ON_SHORE
from mintpilot.planning.lattice import NEAR, Words
from mintpilot.planning.moves import NO_MOVE

AIM = np.dtype([("mask", np.uint64), ("tag", np.uint32), ("last", np.int32)])
"""The shortest way from a node to the goal on the optimistic map: the regions that it enters, the number of the search
that wrote this, and the move of the field search that led from the next node of that way to this one."""


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
        behind += pool[i].last & ~DEAD != NO_MOVE
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
        last = pool[i].last & ~DEAD
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
