"""Shortest ways in grid x automaton, from one place on: a search by buckets, exact, that goes on when asked to."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from mintpilot.core.compiled import compiled
from mintpilot.core.geometry import Bools, Floats, Ints
from mintpilot.planning.lattice import Lattice, Words

ROUNDING = 1e-13
"""Costs that differ by less, edges, are equal."""
UNCERTAIN = 1e-9
"""At equal length a way with fewer uncertain cells is taken: what each of them counts for, edges."""
_RING = 8
"""Buckets are an edge wide; no move leads further than twice its length, at most 4 edges."""
_FULL = -1.0


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class RuledGround:
    """A lattice with the rules over it, for ways from any place while the same propositions of stops hold."""

    lattice: Lattice
    allowed: Words
    """Moves."""
    sets: Ints
    """(n,) numbers of the sets of states; a way begins in the first, whose label counts already."""
    table: Ints
    """(n, labels) which set follows, -1: none."""
    kinds: Ints
    """(nodes,) label of each node; -1 for the rim."""
    uncertain: Floats
    """(nodes,) number of uncertain regions of each node."""
    easier: Words
    """(n,) bit sets of the sets that are no harder to go on from than each: a node that was reached in one of those at
    no greater cost need not be left in it. Of more than 64 sets, none."""
    kept: Bools
    """(n,) whether the rules are kept where a flight ends in the set."""


@dataclass(slots=True, eq=False)
class RuledWays:
    """Shortest ways from one node, by how far the rules have come, grown in the order of length and rest.

    Args:
        ground: the lattice and the rules.
        node: where they begin.
        rest: (nodes,) at most so many edges lie between each node and all that is wanted; along a move it falls by no
            more than its length.
    """

    ground: RuledGround
    node: int
    rest: Floats
    reach: float = field(init=False)
    """Ways are known whose length and rest are less, edges; infinite when all are."""
    nearest: int = field(init=False, default=-1)
    """Row of the node nearest so far at which a flight may end; -1: none."""
    cost: Floats = field(init=False)
    """(nodes x n,) edges; infinite where none leads so far."""
    _before: Ints = field(init=False)
    _hopeless: NDArray[np.uint8] = field(init=False)
    _pool: tuple[Ints, Floats, Ints] = field(init=False)
    _head: Ints = field(init=False)
    _queue: Ints = field(init=False)

    def __post_init__(self) -> None:
        rows = self.ground.lattice.size * len(self.ground.sets)
        self.cost, self._before = np.full(rows, np.inf), np.empty(rows, np.int64)
        self._hopeless, self._head = np.zeros(rows, np.uint8), np.full(_RING, -1, np.int64)
        self._pool = (np.empty(1 << 12, np.int64), np.empty(1 << 12), np.empty(1 << 12, np.int64))
        start, self.reach = self.node * len(self.ground.sets), float(self.rest[self.node])
        self.cost[start] = 0.0
        self._pool[0][0], self._pool[1][0], self._pool[2][0], self._head[0] = start, 0.0, -1, 0
        self._queue = np.array([-1, 1, 1, 0, -1], np.int64)

    def grow(self, until: float = np.inf) -> None:
        """Goes on until all ways are known whose length and rest are at most that, edges."""
        ground, lattice, found = self.ground, self.ground.lattice, _FULL
        first = float(self.rest[self.node])
        while found == _FULL:
            found = _grown(
                ground.allowed, lattice.offset, lattice.moves.length, len(ground.sets), ground.table, ground.kinds,
                ground.uncertain, ground.easier, ground.kept, self.rest, first, until, self.cost, self._before,
                self._hopeless, *self._pool, self._head, self._queue,
            )  # fmt: skip
            if found == _FULL:
                row, far, after = self._pool
                self._pool = _doubled(row), _doubled(far), _doubled(after)
        self.reach, self.nearest = found, int(self._queue[4])

    def at(self, node: int) -> list[tuple[int, float]]:
        """(place in the sets, edges) for each set in which the node is known to be reached."""
        count = len(self.ground.sets)
        rows = np.arange(node * count, (node + 1) * count)
        known = (self.cost[rows] + self.rest[node] < self.reach) & (self._hopeless[rows] == 0)
        return [(int(i), float(self.cost[rows[i]])) for i in np.flatnonzero(known)]

    def path(self, node: int, place: int) -> Ints:
        """Nodes (n,) of the way to a node in a set."""
        count = len(self.ground.sets)
        return _traced(self._before, self.node * count, node * count + place, count)


_Array = TypeVar("_Array", Floats, Ints)


def _doubled(array: _Array) -> _Array:
    """With as much room again."""
    more: _Array = np.concatenate([array, np.empty_like(array)])
    return more


@compiled(error_model="numpy")
def _grown(
    allowed: Words,
    offset: Ints,
    length: Floats,
    count: int,
    table: Ints,
    kinds: Ints,
    uncertain: Floats,
    easier: Words,
    kept: Bools,
    rest: Floats,
    first: float,
    until: float,
    cost: Floats,
    before: Ints,
    hopeless: NDArray[np.uint8],
    row: Ints,
    far: Floats,
    following: Ints,
    head: Ints,
    queue: Ints,
) -> float:
    """Label-correcting within a bucket; queue: first unused entry or -1, entries used, queued, bucket, nearest end."""
    spare, used, queued, bucket, nearest = queue[0], queue[1], queue[2], queue[3], queue[4]
    reach = np.inf
    while queued > 0:
        if used + offset.size > row.size:
            reach = -1.0
            break
        entry = head[bucket & 7]
        if entry < 0:
            if first + bucket + 1 > until:
                reach = first + bucket + 1
                break
            bucket += 1
            continue
        head[bucket & 7] = following[entry]
        here, g = row[entry], far[entry]
        following[entry] = spare
        spare = entry
        queued -= 1
        if cost[here] != g:
            continue
        node, state = here // count, here % count
        worse = False
        if easier[state]:
            for other in range(count):
                if easier[state] >> np.uint64(other) & np.uint64(1) and cost[node * count + other] <= g:
                    worse = True
                    break
        hopeless[here] = worse
        if worse:
            continue
        if kept[state] and (nearest < 0 or g < cost[nearest]):
            nearest = here
        word = allowed[node]
        for k in range(offset.size):
            if not word >> np.uint64(k) & np.uint64(1):
                continue
            there = node + offset[k]
            after = table[state, kinds[there]]
            if after < 0:
                continue
            to = there * count + after
            new = g + length[k] + UNCERTAIN * uncertain[there]
            if new >= cost[to] - ROUNDING or rest[there] == np.inf:
                continue
            cost[to] = new
            before[to] = here
            hopeless[to] = 0
            if spare >= 0:
                slot = spare
                spare = following[spare]
            else:
                slot = used
                used += 1
            ring = max(bucket, int(new + rest[there] - first)) & 7
            row[slot], far[slot], following[slot] = to, new, head[ring]
            head[ring] = slot
            queued += 1
    queue[0], queue[1], queue[2], queue[3], queue[4] = spare, used, queued, bucket, nearest
    return reach


@compiled(error_model="numpy")
def _traced(before: Ints, start: int, row: int, count: int) -> Ints:
    """Nodes of the way to a row, each once where it was not left."""
    size, here = 1, row
    while here != start:
        size += before[here] // count != here // count
        here = before[here]
    nodes = np.empty(size, np.int64)
    here = row
    nodes[size - 1] = here // count
    while here != start:
        if before[here] // count != here // count:
            size -= 1
            nodes[size - 1] = before[here] // count
        here = before[here]
    return nodes


@compiled(error_model="numpy")
def entered(nodes: Ints, masks: Words, offset: Ints, swept: Ints, axes: Ints) -> tuple[np.uint64, Ints]:
    """The regions, a bit set, that a way over these nodes enters, and its number of moves (4,) along so many axes.

    Args:
        nodes: (n,) neighbours one after another.
        masks: (nodes,) bit set of the regions of each node.
        offset: as `Lattice.offset`.
        swept: as `Lattice.swept`.
        axes: (moves,) along how many axes each move leads.
    """
    mask, kinds = masks[nodes[0]], np.zeros(4, np.int64)
    for i in range(nodes.size - 1):
        for k in range(offset.size):
            if nodes[i] + offset[k] == nodes[i + 1]:
                kinds[axes[k]] += 1
                mask |= masks[nodes[i + 1]]
                for j in range(swept.shape[1]):
                    mask |= masks[nodes[i] + swept[k, j]]
                break
    return mask, kinds
