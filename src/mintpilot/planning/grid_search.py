"""Shortest paths and distances on one grid, exact, compiled (2D 8-connected, 3D 26-connected, no corner cutting).

Costs are in cell edges: 1, ``sqrt(2)`` and ``sqrt(3)`` a move; multiply by the resolution for metres.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mintpilot.core.errors import InfeasibleError
from mintpilot.core.geometry import Bools, Floats, Ints
from mintpilot.planning import buckets, kernels
from mintpilot.planning.distance_field import DistanceField
from mintpilot.planning.lattice import Lattice, Words, lattice_of
from mintpilot.planning.workspace import Workspace

STRIDE = 4.0
"""Distance that a heuristic is grown further at a time, edges."""


class GridSearch:
    """Searches on one grid.

    Args:
        free: flags (nz, ny, nx); ``nz == 1`` makes a flat, 8-connected grid.
        cut_corners: lets diagonal moves pass blocked cells, as searches do that know no better. Never fly such a path.
    """

    def __init__(self, free: Bools, *, cut_corners: bool = False) -> None:
        self.lattice: Lattice = lattice_of(free, cut_corners=cut_corners)
        self.work = Workspace(self.lattice.size)
        self.expanded = 0
        """Nodes that the last search expanded."""

    def shortest_path(self, start: ArrayLike, goal: ArrayLike) -> tuple[float, Ints] | None:
        """The shortest path between two cells (z, y, x).

        Returns:
            (cost in edges, cells (n, 3) from start to goal, both among them), or None where there is none.
        """
        source, target = self.lattice.node(start), self.lattice.node(goal)
        cost, nodes = self.node_path(source, target, self.lattice.allowed)
        if not np.isfinite(cost):
            return None
        cells = self.lattice.cells(nodes)
        return self.lattice.path_cost(cells), cells

    def node_path(
        self,
        source: int,
        target: int,
        allowed: Words,
        ahead: DistanceField | None = None,
        work: Workspace | None = None,
    ) -> tuple[float, NDArray[np.int64]]:
        """A* over nodes with any word of allowed moves; (infinity, empty) where there is no path.

        Args:
            source: node to start from.
            target: node to reach.
            allowed: moves of each node, at most those of the lattice.
            ahead: distances from the target, grown towards the source (and known there) on a map with no fewer moves:
                the heuristic, which grows as it is needed; None: octile distance.
            work: where to leave the nodes' states, not that of ``ahead``; None: in `work`. The costs of all nodes whose
                cost and heuristic sum up to less than the result are exact.
        """
        lattice, moves = self.lattice, self.lattice.moves
        work = work or self.work
        if not (lattice.free[source] and lattice.free[target]):
            return np.inf, np.zeros(0, np.int64)
        queue = work.begin(source)
        cost, self.expanded = buckets.FULL, 0
        while cost < 0:
            cost, expanded = kernels.astar(
                allowed,
                lattice.offset,
                moves.step,
                moves.length,
                moves.after,
                moves.detour,
                moves.open,
                lattice.padded[2],
                lattice.padded[1],
                source,
                target,
                ahead.work.cells if ahead else None,
                ahead.work.tag if ahead else 0,
                ahead.reach if ahead else 0.0,
                work.cells,
                work.tag,
                work.pool,
                work.head,
                queue,
            )
            self.expanded += expanded
            if cost == buckets.FULL:
                work.make_room()
            elif cost == buckets.SHORT and ahead:
                ahead.grow(ahead.reach + STRIDE)
        if not np.isfinite(cost):
            return np.inf, np.zeros(0, np.int64)
        return cost, kernels.walk_back(work.cells, lattice.offset, source, target)

    def distances(self, source: ArrayLike, bound: float = np.inf) -> Floats:
        """Distance in edges from a cell (z, y, x) to every cell (nz, ny, nx).

        Cells further than ``bound``, blocked or cut off are at infinity.
        """
        node = self.lattice.node(source)
        out = np.full(self.lattice.size, np.inf)
        if self.lattice.free[node]:
            field = DistanceField(self.lattice, self.work, node, -1, self.lattice.allowed)
            field.grow(bound)
            out = field.everywhere()
            out[out > bound + buckets.SLACK] = np.inf
        up = slice(None) if self.lattice.shape[0] == 1 else slice(1, -1)
        distances: Floats = out.reshape(self.lattice.padded)[up, 1:-1, 1:-1].copy()
        return distances


def shortest_path(free: Bools, start: ArrayLike, goal: ArrayLike) -> tuple[float, Ints]:
    """The shortest path on a grid, for a single query; keep a `GridSearch` for several.

    Args:
        free: flags (nz, ny, nx).
        start: cell (z, y, x).
        goal: cell (z, y, x).

    Returns:
        (cost in edges, cells (n, 3)).

    Raises:
        MapError: a cell is outside the grid.
        InfeasibleError: the two are not connected.
    """
    found = GridSearch(free).shortest_path(start, goal)
    if found is None:
        ends = " to ".join(str(tuple(int(i) for i in np.ravel(cell))) for cell in (start, goal))
        raise InfeasibleError(f"no path of free cells from {ends}; see which cells block the way")
    return found


def distance_field(free: Bools, source: ArrayLike, bound: float = np.inf) -> Floats:
    """Distances in edges (nz, ny, nx) from a cell to all others; infinity where it is further than ``bound``."""
    return GridSearch(free).distances(source, bound)
