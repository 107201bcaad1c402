"""Shortest ways in grid x automaton, from one place to all others: a search by buckets, exact."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mintpilot.core.compiled import compiled
from mintpilot.core.geometry import Floats, Ints
from mintpilot.planning.lattice import Lattice, Words

ROUNDING = 1e-13
"""Costs that differ by less, edges, are equal."""
UNCERTAIN = 1e-9
"""At equal length a way with fewer uncertain cells is taken: what each of them counts for, edges."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class RuledWays:
    """Shortest ways from one place, by how far the rules have come."""

    lattice: Lattice
    start: int
    """Row of the first node and set."""
    sets: Ints
    """(n,) numbers of the sets of states."""
    cost: Floats
    """(nodes x n,) edges; infinite where none leads."""
    before: Ints
    """(nodes x n,) the row that each is reached from."""

    def at(self, node: int) -> list[tuple[int, float]]:
        """(place in ``sets``, edges) for each set in which the node can be reached."""
        row = self.cost[node * len(self.sets) : (node + 1) * len(self.sets)]
        return [(int(i), float(row[i])) for i in np.flatnonzero(np.isfinite(row))]

    def path(self, node: int, place: int) -> Ints:
        """Nodes (n,) of the way to a node in a set."""
        return _traced(self.before, self.start, node * len(self.sets) + place, len(self.sets))


def ways_from(
    lattice: Lattice, allowed: Words, node: int, sets: Ints, table: Ints, kinds: Ints, uncertain: Floats, easier: Words
) -> RuledWays:
    """Searches from a node in the first of the sets, whose label counts already.

    Args:
        lattice: the grid.
        allowed: moves.
        node: where to begin.
        sets: (n,) numbers.
        table: (n, labels) which set follows, -1: none.
        kinds: (nodes,) label of each node; -1 for the rim.
        uncertain: (nodes,) number of uncertain regions of each node.
        easier: (n,) bit sets of the sets that are no harder to go on from than each: a node that was reached in one of
            those at no greater cost need not be left in it. Of more than 64 sets, none.
    """
    count, size = len(sets), lattice.size
    cost = np.full(size * count, np.inf)
    before = np.full(size * count, -1, np.int64)
    length = lattice.moves.length
    _spread(allowed, lattice.offset, length, node * count, count, table, kinds, uncertain, easier, cost, before)
    return RuledWays(lattice=lattice, start=node * count, sets=sets, cost=cost, before=before)


@compiled(error_model="numpy")
def _spread(
    allowed: Words,
    offset: Ints,
    length: Floats,
    start: int,
    count: int,
    table: Ints,
    kinds: Ints,
    uncertain: Floats,
    easier: Words,
    cost: Floats,
    before: Ints,
) -> None:
    """No move is shorter than one edge: what is in a bucket an edge wide cannot better another in it."""
    room = 1 << 14
    row = np.empty(room, np.int64)
    following = np.empty(room, np.int64)
    head = np.full(4, -1, np.int64)
    closed = np.zeros(cost.size, np.uint8)
    cost[start] = 0.0
    row[0], following[0], head[0] = start, -1, 0
    used, spare, queued, bucket = 1, -1, 1, 0
    while queued > 0:
        entry = head[bucket & 3]
        if entry < 0:
            bucket += 1
            continue
        head[bucket & 3] = following[entry]
        here = row[entry]
        following[entry] = spare
        spare = entry
        queued -= 1
        if closed[here] or int(cost[here]) != bucket:
            continue
        closed[here] = 1
        node, state = here // count, here % count
        hopeless = False
        if easier[state]:
            for other in range(count):
                if easier[state] >> np.uint64(other) & np.uint64(1) and cost[node * count + other] <= cost[here]:
                    hopeless = True
                    break
        if hopeless:
            cost[here] = np.inf
            continue
        word = allowed[node]
        for k in range(offset.size):
            if not word >> np.uint64(k) & np.uint64(1):
                continue
            there = node + offset[k]
            after = table[state, kinds[there]]
            if after < 0:
                continue
            to = there * count + after
            far = cost[here] + length[k] + UNCERTAIN * uncertain[there]
            if closed[to] or far >= cost[to] - ROUNDING:
                continue
            cost[to] = far
            before[to] = here
            if spare >= 0:
                new = spare
                spare = following[spare]
            else:
                if used == room:
                    room *= 2
                    wider = np.empty(room, np.int64)
                    wider[:used] = row
                    row = wider
                    wider = np.empty(room, np.int64)
                    wider[:used] = following
                    following = wider
                new = used
                used += 1
            slot = int(far) & 3
            row[new], following[new] = to, head[slot]
            head[slot] = new
            queued += 1


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
