"""Ways between places in grid x automaton, grown as far as they are asked for (method, section 14)."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from mintpilot.core.geometry import Floats, Ints
from mintpilot.planning.decision_list import ParetoPath
from mintpilot.planning.distance_field import DistanceField
from mintpilot.planning.lattice import Words, cost_of_moves, lattice_of
from mintpilot.planning.legs import Cell3
from mintpilot.planning.overlay import closed_moves
from mintpilot.planning.rule_labels import RuleGrid
from mintpilot.planning.rule_search import RuledGround, RuledWays, entered
from mintpilot.planning.terrain import Terrain
from mintpilot.planning.workspace import Workspace


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
        self._allowed: dict[int, Words] = {}
        self._away: dict[tuple[int, Cell3], Floats] = {}
        self._ground: dict[tuple[int, int, int, int], RuledGround] = {}
        self.searches = 0

    def ways(self, label: tuple[Cell3, int, int], blocked: int, uncertain: int, rest: Floats) -> RuledWays:
        """The ways from a place, not grown yet.

        Args:
            label: cell; number of the set of states at it and its stop; bits of the propositions of stops that hold.
            blocked: bit set of the regions to keep out of.
            uncertain: those still open: at equal length, fewer of them are entered.
            rest: see `RuledWays`.
        """
        place, rules, held = label
        left = self._grid.after(rules, int(self._grid.kinds[self.flat(place)]), held)
        key = (left, held, blocked, uncertain)
        if key not in self._ground:
            sets, table = self._grid.table(left, held)
            doubtful: Floats = np.zeros(self.lattice.size)
            for i, nodes in enumerate(self._regions):
                doubtful[nodes] += uncertain >> i & 1
            self._ground[key] = RuledGround(
                lattice=self.lattice,
                allowed=self._moves(blocked),
                sets=sets,
                table=table,
                kinds=self._kinds,
                uncertain=doubtful,
                easier=self._grid.easier(sets),
                kept=np.array([self._grid.is_kept(int(number)) for number in sets]),
            )
        ground, node = self._ground[key], self.lattice.node(place)
        if blocked & int(self._masks[node]):
            ground = replace(ground, allowed=np.zeros_like(ground.allowed))
        self.searches += 1
        return RuledWays(ground=ground, node=node, rest=rest)

    def away(self, place: Cell3, blocked: int) -> Floats:
        """Edges (nodes,) of the shortest way between each node and a place without rules; infinite where none leads."""
        key = (blocked, place)
        if key not in self._away:
            field = DistanceField(
                self.lattice, Workspace(self.lattice.size), self.lattice.node(place), -1, self._moves(blocked)
            )
            field.grow()
            self._away[key] = field.everywhere()
        return self._away[key]

    def _moves(self, blocked: int) -> Words:
        """Those that touch no blocked region."""
        if blocked not in self._allowed:
            closed = [nodes for i, nodes in enumerate(self._regions) if blocked >> i & 1]
            self._allowed[blocked] = closed_moves(self.lattice, self.lattice.allowed, closed)
        return self._allowed[blocked]

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
