"""Ways between places in grid x automaton, made when asked for and remembered (method, section 14)."""

from __future__ import annotations

import numpy as np

from mintpilot.core.geometry import Floats, Ints
from mintpilot.planning.decision_list import ParetoPath
from mintpilot.planning.lattice import Words, cost_of_moves, lattice_of
from mintpilot.planning.legs import Cell3
from mintpilot.planning.overlay import closed_moves
from mintpilot.planning.rule_labels import RuleGrid
from mintpilot.planning.rule_search import RuledWays, entered, ways_from
from mintpilot.planning.terrain import Terrain


class RuledLegs:
    """Ways on one terrain under the rules of a grid.

    Args:
        grid: the rules.
        terrain: where it may be flown.
    """

    def __init__(self, grid: RuleGrid, terrain: Terrain) -> None:
        self._grid, self._terrain = grid, terrain
        self.lattice = lattice_of(terrain.free)
        self._kinds = grid.over(self.lattice)
        self._regions = tuple(self.lattice.nodes_of_flat(cells) for cells in terrain.regions)
        self._masks: Words = np.zeros(self.lattice.size, np.uint64)
        for bit, nodes in enumerate(self._regions):
            self._masks[nodes] |= np.uint64(1 << bit)
        self._axes: Ints = np.abs(self.lattice.moves.step).sum(axis=1).astype(np.int64)
        self._ways: dict[tuple[int, int, Cell3, int, int], RuledWays] = {}
        self.searches = 0

    def ways(self, place: Cell3, rules: int, held: int, blocked: int, uncertain: int) -> RuledWays:
        """The ways to everywhere from a place where the rules are in that set and these propositions hold.

        Args:
            place: cell.
            rules: number of the set of states at the place and its stop.
            held: bits of the propositions of stops.
            blocked: bit set of the regions to keep out of.
            uncertain: those still open: at equal length, fewer of them are entered.
        """
        key = (blocked, uncertain, place, rules, held)
        if key not in self._ways:
            left = self._grid.after(rules, int(self._grid.kinds[self.flat(place)]), held)
            sets, table = self._grid.table(left, held)
            closed = [r for i, r in enumerate(self._regions) if blocked >> i & 1]
            doubtful: Floats = np.zeros(self.lattice.size)
            for i, nodes in enumerate(self._regions):
                doubtful[nodes] += uncertain >> i & 1
            allowed = closed_moves(self.lattice, self.lattice.allowed, closed)
            node = self.lattice.node(place)
            if any(node in region for region in closed):
                allowed = np.zeros_like(allowed)
            self.searches += 1
            self._ways[key] = ways_from(
                self.lattice, allowed, node, sets, table, self._kinds, doubtful, self._grid.easier(sets)
            )
        return self._ways[key]

    def path(self, ways: RuledWays, place: Cell3, state: int) -> ParetoPath[Ints]:
        """The way to a place in one of the sets, with the regions that it enters."""
        nodes = ways.path(self.lattice.node(place), state)
        mask, kinds = entered(nodes, self._masks, self.lattice.offset, self.lattice.swept, self._axes)
        return ParetoPath(cost=cost_of_moves(kinds), mask=int(mask), path=self.lattice.cells(nodes))

    def flats(self, cells: Ints) -> Ints:
        """Flat cells (n,) of cells (n, 3)."""
        flat: Ints = np.ravel_multi_index(tuple(cells.T), self._terrain.frame.shape).astype(np.int64)
        return flat

    def flat(self, cell: Cell3) -> int:
        """The flat cell of one."""
        return int(self.flats(np.array([cell], np.int64))[0])
