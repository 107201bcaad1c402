"""Regions laid over a lattice: which regions each node belongs to, and the moves without them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import NDArray

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


def overlay_of(lattice: Lattice, regions: Sequence[Ints], closed: Words) -> Overlay:
    """Lays regions over a lattice.

    Args:
        lattice: the grid.
        regions: nodes of each region; bit r stands for the r-th.
        closed: allowed moves to start from (those of the lattice, or fewer).
    """
    region = np.zeros(lattice.size, np.uint64)
    for bit, nodes in enumerate(regions):
        region[nodes] |= np.uint64(1 << bit)
    near = closed.copy()
    without = closed.copy()
    if regions:
        nodes = np.concatenate(list(regions))
        nodes = nodes[lattice.free[nodes] == 1]
        _close(without, near, lattice.free, _mark(lattice, nodes), lattice.around, lattice.moves.needs, nodes)
    return Overlay(region=region, near=near, without=without)


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


@njit(cache=True, error_model="numpy")
def _close(
    without: Words,
    near: Words,
    free: NDArray[np.uint8],
    rest: NDArray[np.uint8],
    around: Ints,
    needs: NDArray[np.uint32],
    nodes: Ints,
) -> None:
    """Takes from ``without`` the moves that touch the nodes (not free in ``rest``); marks their neighbours in near."""
    for node in nodes:
        for i in range(around.size):
            other = node + around[i]
            if not free[other] or near[other] & NEAR:
                continue
            near[other] |= NEAR
            without[other] &= moves_at(rest, around, needs, other) if rest[other] else np.uint64(0)


@njit(cache=True, error_model="numpy")
def entered_by(path: Ints, offset: Ints, swept: Ints, region: NDArray[np.uint64]) -> np.uint64:
    """Bit set of the regions that a path of nodes touches, side cells of its diagonal moves included."""
    mask = region[path[0]]
    for i in range(1, path.size):
        for k in range(offset.size):
            if path[i - 1] + offset[k] == path[i]:
                for j in range(swept.shape[1]):
                    mask |= region[path[i - 1] + swept[k, j]]
    return np.uint64(mask)
