"""Distances from one node, grown as far as they are asked for."""

from __future__ import annotations

import numpy as np

from mintpilot.core.geometry import Floats
from mintpilot.planning import buckets
from mintpilot.planning.field_kernel import field
from mintpilot.planning.lattice import Lattice, Words
from mintpilot.planning.workspace import Workspace


class DistanceField:
    """Exact distances from a source, in the order of f = distance + octile distance to the target.

    The distances stay in ``work.cells`` under ``work.tag``; they count where f < `reach`.

    Args:
        lattice: the grid.
        work: memory that no other search uses as long as the field is needed.
        source: node that distances are measured from.
        target: node to grow towards; -1 to grow evenly, where f is the distance itself.
        allowed: moves of each node, at most those of the lattice.
    """

    def __init__(self, lattice: Lattice, work: Workspace, source: int, target: int, allowed: Words) -> None:
        self.lattice = lattice
        self.work = work
        self.source = source
        self.target = target
        self.allowed = allowed
        self.reach = 0.0
        """All distances whose f is less are exact; infinity when all are."""
        self.expanded = 0
        """Nodes expanded so far."""
        self._queue = work.begin(source)

    def grow(self, until: float = np.inf, *, hold: bool = False) -> None:
        """Goes on, in the order of f, until all nodes whose f is at most ``until`` (edges) are known.

        With ``hold`` it stops as soon as the distance to the target is known.
        """
        lattice, work, moves = self.lattice, self.work, self.lattice.moves
        self.reach = buckets.FULL
        while self.reach == buckets.FULL:
            self.reach, expanded = field(
                self.allowed,
                lattice.offset,
                moves.step,
                moves.length,
                moves.after,
                moves.detour,
                moves.open,
                lattice.padded[2],
                lattice.padded[1],
                self.source,
                self.target,
                until,
                hold,
                work.cells,
                work.tag,
                work.pool,
                work.head,
                self._queue,
            )
            self.expanded += expanded
            if self.reach == buckets.FULL:
                work.make_room()

    def at(self, node: int) -> float:
        """Distance of a node; infinity where nothing is known of it."""
        state = self.work.cells[node]
        return float(state["g"]) if state["tag"] == self.work.tag else np.inf

    def everywhere(self) -> Floats:
        """Distances (size,) of all nodes; infinity where nothing is known of them."""
        cells = self.work.cells
        return np.where(cells["tag"] == self.work.tag, cells["g"], np.inf)
