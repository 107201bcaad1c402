"""Regions laid over a lattice: which regions each node belongs to, and the moves without them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mintpilot.core.compiled import compiled
from mintpilot.core.geometry import Ints
from mintpilot.planning.lattice import NEAR, Lattice, Words, moves_at


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Overlay:
    """Up to 63 regions on a lattice, which may overlap, touch and cover anything."""

    region: NDArray[np.uint64]
    """Bit set of the regions of each node."""
    near: Words
    """Allowed moves with all regions passable; `NEAR` is set where one of them is next to the node."""
    without: Words
    """Allowed moves that touch no region."""
    entry_nodes: Ints
    """Nodes (n,) outside all regions from which one move may touch a region."""
    closed: Words
    """The allowed moves that it was laid over."""
    touched: Ints
    """Nodes (n,) at which the arrays differ from what there would be without regions."""


def overlay_of(lattice: Lattice, regions: Sequence[Ints], closed: Words, worn: Overlay | None = None) -> Overlay:
    """Lays regions over a lattice.

    Args:
        lattice: the grid.
        regions: nodes of each region; bit r stands for the r-th.
        closed: allowed moves to start from (those of the lattice, or fewer).
        worn: an overlay that is used no more, whose memory may be taken: whole copies of the moves cost as much as a
            search.
    """
    if worn is not None and worn.closed is closed:
        region, near, without = worn.region, worn.near, worn.without
        region[worn.touched] = 0
        near[worn.touched] = without[worn.touched] = closed[worn.touched]
    else:
        region, near, without = np.zeros(lattice.size, np.uint64), closed.copy(), closed.copy()
    for bit, nodes in enumerate(regions):
        region[nodes] |= np.uint64(1 << bit)
    entry_nodes = touched = np.zeros(0, np.int64)
    if regions:
        covered = np.concatenate(list(regions))
        nodes = covered[lattice.free[covered] == 1]
        rest = _mark(lattice, nodes)
        marked = _close(without, near, lattice.free, rest, lattice.around, lattice.moves.needs, nodes)
        entry_nodes = marked[region[marked] == 0]
        touched = np.concatenate([covered, marked])
    return Overlay(region=region, near=near, without=without, entry_nodes=entry_nodes, closed=closed, touched=touched)


def closed_moves(lattice: Lattice, allowed: Words, regions: Iterable[Ints]) -> Words:
    """The allowed moves that touch none of the regions' nodes."""
    parts = list(regions)
    without = allowed.copy()
    if parts:
        nodes = np.concatenate(parts)
        nodes = nodes[lattice.free[nodes] == 1]
        _close(without, allowed.copy(), lattice.free, _mark(lattice, nodes), lattice.around, lattice.moves.needs, nodes)
    return without


def _mark(lattice: Lattice, nodes: Ints) -> NDArray[np.uint8]:
    free = lattice.free.copy()
    free[nodes] = 0
    return free


@compiled(error_model="numpy")
def _close(
    without: Words,
    near: Words,
    free: NDArray[np.uint8],
    rest: NDArray[np.uint8],
    around: Ints,
    needs: NDArray[np.uint32],
    nodes: Ints,
) -> Ints:
    """Takes from ``without`` the moves that touch the nodes (not free in ``rest``); marks and returns all near them."""
    marked = np.empty(min(free.size, nodes.size * around.size), np.int64)
    count = 0
    for node in nodes:
        for i in range(around.size):
            other = node + around[i]
            if not free[other] or near[other] & NEAR:
                continue
            near[other] |= NEAR
            without[other] &= moves_at(rest, around, needs, other) if rest[other] else np.uint64(0)
            marked[count] = other
            count += 1
    return marked[:count].copy()


@compiled(error_model="numpy")
def followed(
    path: Ints, rows: int, columns: int, offset: Ints, swept: Ints, region: NDArray[np.uint64]
) -> tuple[Ints, Ints, np.uint64]:
    """What a path of nodes (n,) is made of.

    Args:
        path: neighbouring nodes.
        rows: of the lattice with its rim.
        columns: of the lattice with its rim.
        offset: what moves add to a node.
        swept: what moves sweep.
        region: bit set of the regions of each node.

    Returns:
        (cells (n, 3) ``[z, y, x]`` of the lattice with its rim; number of moves (4,) along 0, 1, 2 and 3 axes; bit set
        of the regions that it touches, side cells of its diagonal moves included).
    """
    cells = np.empty((path.size, 3), np.int64)
    kinds = np.zeros(4, np.int64)
    mask = region[path[0]]
    for i in range(path.size):
        node = path[i]
        row = node // columns
        cells[i, 0], cells[i, 1], cells[i, 2] = row // rows, row % rows, node - row * columns
        if i == 0:
            continue
        before = path[i - 1]
        along = 0
        for axis in range(3):
            along += cells[i, axis] != cells[i - 1, axis]
        kinds[along] += 1
        for k in range(offset.size):
            if before + offset[k] == node:
                for j in range(swept.shape[1]):
                    mask |= region[before + swept[k, j]]
                break
    return cells, kinds, np.uint64(mask)
