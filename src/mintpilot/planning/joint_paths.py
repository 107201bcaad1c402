"""The paths behind labels: how they came, and where they aim."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mintpilot.core.compiled import compiled
from mintpilot.core.geometry import Floats, Ints
from mintpilot.planning.buckets import MOVE
from mintpilot.planning.joint_labels import AT_ENTRY, DEAD
from mintpilot.planning.lattice import NEAR, Words
from mintpilot.planning.moves import NO_MOVE

AIM = np.dtype([("mask", np.uint64), ("tag", np.uint32), ("last", np.int32)])
"""The shortest way from a node to the goal on the optimistic map: the regions that it enters, the number of the search
that wrote this, and the move of the field search that led from the next node of that way to this one."""


@compiled(error_model="numpy")
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
        last = cells[node].last & MOVE
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
        last = cells[node].last & MOVE


@compiled(error_model="numpy")
def traced(
    labels: Ints,
    costs: Floats,
    start_cell: Ints,
    pool: NDArray[np.void],
    safe: NDArray[np.void],
    aims: NDArray[np.void],
    offset: Ints,
    step: Ints,
) -> tuple[Ints, Ints, Ints]:
    """The paths of labels (n,), of those costs (n,): before them as they came, after them as they aim.

    Returns:
        (cells (m, 3) of all paths one after the other; where each ends there (n,); numbers of moves (n, 4) along 0, 1,
        2 and 3 axes).
    """
    room = 1
    for n in range(labels.size):
        room += int(costs[n]) + 2  # no move is shorter than 1
    moves = np.empty(room, np.int64)
    ends = np.zeros(labels.size, np.int64)
    total = 0
    for n in range(labels.size):
        total += moves_of(labels[n], pool, safe, aims, offset, moves[total:])
        ends[n] = total
    cells = np.empty((total + labels.size, 3), np.int64)
    kinds = np.zeros((labels.size, 4), np.int64)
    at, i = 0, 0
    for n in range(labels.size):
        z, y, x = start_cell[0], start_cell[1], start_cell[2]
        cells[at, 0], cells[at, 1], cells[at, 2] = z, y, x
        at += 1
        while i < ends[n]:
            k, sign = (moves[i], 1) if moves[i] >= 0 else (-1 - moves[i], -1)
            z += sign * step[k, 0]
            y += sign * step[k, 1]
            x += sign * step[k, 2]
            cells[at, 0], cells[at, 1], cells[at, 2] = z, y, x
            kinds[n, abs(step[k, 0]) + abs(step[k, 1]) + abs(step[k, 2])] += 1
            at += 1
            i += 1
        ends[n] = at
    return cells, ends, kinds


@compiled(error_model="numpy")
def moves_of(
    label: int, pool: NDArray[np.void], safe: NDArray[np.void], aims: NDArray[np.void], offset: Ints, moves: Ints
) -> int:
    """Writes the moves of a label's way (-1 - k: move k the other way round); their number."""
    count, i = 0, label
    while i >= 0:
        last = pool[i].last & ~DEAD
        if last != NO_MOVE:
            moves[count] = last
            count += 1
        i = pool[i].parent
    node = AT_ENTRY - i if i <= AT_ENTRY else -1
    while node >= 0:
        last = safe[node].last & MOVE
        if last == NO_MOVE:
            break
        moves[count] = last
        count += 1
        node -= offset[last]
    moves[:count] = moves[:count][::-1].copy()
    node = pool[label].node
    while aims[node].last != NO_MOVE:
        moves[count] = -1 - aims[node].last
        count += 1
        node -= offset[aims[node].last]
    return count
