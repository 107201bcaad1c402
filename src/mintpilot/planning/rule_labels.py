"""The truth of spatial propositions on the grid, and the automaton of the rules laid over it (method, section 14).

A proposition is known at a cell where it has one value along all straight ways between that cell's centre and those of
its neighbours. Elsewhere it *may* hold, and a plan must keep the rules whichever it is, at every moment: the automaton
is followed with the set of states that are possible. A flown way may pass a cell off such a straight way, by less than
half a cell's diagonal: within that, labels of `touches` and `within` are not certain; the judge measures exactly.
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

_HALF = 0.5


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
    """Sets of states by number; a set with a state from which a rule can be kept no more is -1."""
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
        found, kinds = np.unique(np.stack([yes, may]), axis=1, return_inverse=True)
        self.kinds = kinds.ravel().astype(np.int64)
        self.labels = tuple((int(a), int(b)) for a, b in found.T)
        self.sets, self._numbers, self._next = [], {}, {}

    def number(self, states: frozenset[int]) -> int:
        """Number of a set of states; -1 where a rule may be broken for good."""
        if not all(self.ruling.automaton.alive[s] for s in states):
            return -1
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
            yes, may = self.labels[kind]
            self._next[key] = self.number(self.ruling.automaton.after(self.sets[number], yes | held, may | held))
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

    def kinds_along(self, way_m: Floats) -> list[int]:
        """The labels that a way (n, 3), metres, passes, one after another, each once in a row."""
        cells = np.clip(self.map.frame.cells_of(way_m), 0, np.array(self.map.frame.shape) - 1)
        kinds = self.kinds[np.ravel_multi_index(tuple(cells.T), self.map.frame.shape)]
        return [int(k) for k in kinds[np.concatenate([[True], np.diff(kinds) != 0])]]

    def flown(self, number: int, way_m: Floats, held: int) -> int:
        """The set after a way (n, 3) in metres, of points no further apart than half a cell."""
        for kind in self.kinds_along(way_m):
            number = self.after(number, kind, held)
        return number

    def followed(self, number: int, cells: Iterable[int], held: int) -> int:
        """The set after a way over these flat cells."""
        for kind in self.kinds[np.asarray(cells, np.int64)].tolist():
            number = self.after(number, kind, held)
        return number

    def done(self, number: int, cell: int, stop_id: str, held: int) -> tuple[int, int]:
        """(set, propositions held) after a stop was done at that flat cell; the drone is still there."""
        letters, kind = self.ruling.letters(stop_id), int(self.kinds[cell])
        there = self.after(number, kind, held | letters.at)
        held = (held | letters.begins) & ~letters.ends
        return self.after(there, kind, held | letters.at), held

    def is_kept(self, number: int) -> bool:
        """Whether all rules are kept if the mission ends now."""
        return number >= 0 and all(self.ruling.automaton.accepting[s] for s in self.sets[number])


def spatial_truth(what: Proposition, cells: Ints, map: SemanticMap, limits: VehicleLimits) -> tuple[Bools, Bools]:
    """Where (nz, ny, nx) a proposition holds for certain, and where it may hold."""
    frame = map.frame
    edge, diagonal = frame.resolution_m, frame.resolution_m * (2 if frame.is_flat else 3) ** 0.5
    region = np.zeros(frame.size, bool)
    region[cells] = True
    region = region.reshape(frame.shape)
    match what.about:
        case About.TOUCHES | About.WITHIN:
            reach = limits.clearance_m + what.metres
            near = _near(region, float(np.hypot(reach, diagonal * _HALF)) / edge) if region.any() else region
            bodily = what.metres + limits.radius_m >= diagonal * _HALF
            return (region if bodily else np.zeros_like(region)), near | region
        case About.IN:
            return region & ~_near(~region, diagonal * _HALF / edge), region | _near(region, diagonal * _HALF / edge)
        case _:
            keep = float(np.hypot(limits.clearance_m, diagonal * _HALF))
            return region & ~_near(~region, keep / edge), region | _near(region, diagonal * _HALF / edge)


def _near(solid: Bools, edges: float) -> Bools:
    """Cells whose centre is nearer than that to the surface of a cell of the set, or in it."""
    near: Bools = squared_gaps(solid, int(np.ceil(edges + _HALF))) < (2 * edges) ** 2 * (1 - 1e-9)
    return near
