"""The truth of spatial propositions on the grid, and the automaton of the rules laid over it (method, section 14).

A proposition is known at a cell where it has one value on the half of each straight way to a neighbour that is nearer
to that cell. Elsewhere it *may* hold, and a plan must keep the rules whichever it is, at every moment: the automaton is
followed with the set of states that are possible. Where several propositions change on one such way, or a flown way
leaves the straight ones, `mintpilot.planning.rule_letters` says exactly what holds: nothing is flown before that was
looked at.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

import numpy as np

from mintpilot.core.geometry import Bools, Floats, Ints
from mintpilot.core.plan import VehicleLimits
from mintpilot.core.rule import About, Proposition, Ruling
from mintpilot.core.semantic_map import SemanticMap
from mintpilot.planning.flyable import squared_gaps
from mintpilot.planning.lattice import Lattice, Words
from mintpilot.planning.rule_letters import letters_along, piece_m
from mintpilot.planning.rule_order import covers, hardest, no_harder


@dataclass(slots=True, eq=False)
class RuleGrid:
    """Rules over the cells of one map.

    Args:
        ruling: the rules, bound to the map.
        map: what is known.
        limits: size of the vehicle.
    """

    ruling: Ruling
    map: SemanticMap
    limits: VehicleLimits
    kinds: Ints = field(init=False)
    """(cells,) number of each cell's label."""
    labels: tuple[tuple[int, int], ...] = field(init=False)
    """(what holds, what may hold) for each number."""
    sets: list[frozenset[int]] = field(init=False)
    """Sets of states by number, only the hardest of each; a set from which a rule can be kept no more is -1."""
    _order: Bools = field(init=False)
    _numbers: dict[frozenset[int], int] = field(init=False)
    _next: dict[tuple[int, int, int], int] = field(init=False)

    def __post_init__(self) -> None:
        yes = np.zeros(self.map.frame.size, np.int64)
        may = np.zeros(self.map.frame.size, np.int64)
        for bit, (what, cells) in enumerate(zip(self.ruling.automaton.propositions, self.ruling.cells, strict=True)):
            if what.about.spatial:
                sure, possible = spatial_truth(what, cells, self.map, self.limits)
                yes |= sure.ravel().astype(np.int64) << bit
                may |= (possible | sure).ravel().astype(np.int64) << bit
        most = np.int64(1) << len(self.ruling.cells)
        found, kinds = np.unique(yes * most + may, return_inverse=True)
        self.kinds = kinds.ravel().astype(np.int64)
        self.labels = tuple(divmod(int(both), int(most)) for both in found)
        self._order = no_harder(self.ruling.automaton)
        self.sets, self._numbers, self._next = [], {}, {}

    def over(self, lattice: Lattice) -> Ints:
        """The label of each node of a lattice of that map; -1 for its rim."""
        kinds = np.full(lattice.size, -1, np.int64)
        kinds[lattice.nodes_of_flat(np.arange(self.map.frame.size))] = self.kinds
        return kinds

    def number(self, states: frozenset[int]) -> int:
        """Number of a set of states; -1 where a rule may be broken for good."""
        if not all(self.ruling.automaton.alive[s] for s in states):
            return -1
        states = hardest(states, self._order)
        if states not in self._numbers:
            self._numbers[states] = len(self.sets)
            self.sets.append(states)
        return self._numbers[states]

    def after(self, number: int, kind: int, held: int) -> int:
        """The set after a stay at a cell of that label while the propositions ``held`` hold, too."""
        if number < 0:
            return -1
        key = (number, kind, held)
        if key not in self._next:
            self._next[key] = self._followed(number, [self.labels[kind]], held)
        return self._next[key]

    def table(self, start: int, held: int) -> tuple[Ints, Ints]:
        """Numbers (n,) of all sets that can come of one while ``held`` stays, and which follow (n, labels), or -1."""
        order, rows = [start], []
        for number in order:
            row = [self.after(number, kind, held) for kind in range(len(self.labels))]
            order += [s for s in dict.fromkeys(row) if s >= 0 and s not in order]
            rows.append(row)
        index = {number: i for i, number in enumerate(order)} | {-1: -1}
        return np.array(order, np.int64), np.array([[index[s] for s in row] for row in rows], np.int64)

    def followed(self, number: int, cells: Iterable[int], held: int) -> int:
        """The set after a way over these flat cells, from the middle of each straight to that of the next."""
        for kind in self.kinds[np.asarray(cells, np.int64)].tolist():
            number = self.after(number, kind, held)
        return number

    def flown(self, number: int, way_m: Floats, held: int) -> int:
        """The set after any way (n, 3), metres, from which the vehicle keeps its margin."""
        if number < 0:
            return -1
        letters = letters_along(self.ruling, self.map, self.limits, way_m, spare_m=self.limits.margin_m)
        return self._followed(number, letters, held)

    def done(self, number: int, cell: int, stop_id: str, held: int) -> tuple[int, int]:
        """(set, propositions held) after a stop was done at that flat cell; the drone is still there."""
        letters = self.ruling.letters(stop_id)
        for now in letters.moments(held):
            number = self.after(number, int(self.kinds[cell]), now)
        return number, letters.after(held)

    def covers(self, one: int, other: int) -> bool:
        """Whether whatever keeps the rules from the one set on keeps them from the other."""
        return covers(self.sets[one], self.sets[other], self._order)

    def easier(self, sets: Ints) -> Words:
        """(n,) bit sets of those of these sets, each by its place, that are no harder than each; 0s where n > 64."""
        if len(sets) > 64:
            return np.zeros(len(sets), np.uint64)
        bits = [[1 << j for j, easy in enumerate(sets) if i != j and self.covers(int(one), int(easy))]
                for i, one in enumerate(sets)]  # fmt: skip
        return np.array([sum(row) for row in bits], np.uint64)

    def is_kept(self, number: int) -> bool:
        """Whether all rules are kept if the mission ends now."""
        return number >= 0 and all(self.ruling.automaton.accepting[s] for s in self.sets[number])

    def _followed(self, number: int, letters: list[tuple[int, int]], held: int) -> int:
        return self.number(self.ruling.automaton.followed(self.sets[number], letters, held))


def spatial_truth(what: Proposition, cells: Ints, map: SemanticMap, limits: VehicleLimits) -> tuple[Bools, Bools]:
    """Where (nz, ny, nx) a proposition holds for certain, and where it may hold."""
    frame = map.frame
    half_m = frame.resolution_m * (2 if frame.is_flat else 3) ** 0.5 / 2
    region = np.zeros(frame.size, bool)
    region[cells] = True
    region = region.reshape(frame.shape)
    off_m = limits.clearance_m - limits.radius_m

    def near(solid: Bools, metres: float) -> Bools:
        return _near(solid, float(np.hypot(metres, half_m)) / frame.resolution_m)

    match what.about:
        case About.TOUCHES | About.WITHIN:
            bodily = what.metres + limits.radius_m - off_m > piece_m(frame, limits)
            return (region if bodily else np.zeros_like(region)), near(region, limits.clearance_m + what.metres)
        case About.IN:
            return region & ~near(~region, off_m), near(region, off_m)
        case _:
            return region & ~near(~region, limits.clearance_m), near(region, off_m)


def _near(solid: Bools, edges: float) -> Bools:
    """Cells of the set, and those whose centre is nearer than that to the surface of one."""
    if not solid.any():
        return solid
    near: Bools = squared_gaps(solid, int(np.ceil(edges + 0.5))) < (2 * edges) ** 2 * (1 - 1e-9)
    return near | solid
