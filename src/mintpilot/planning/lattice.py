"""The grid as a graph: which moves are allowed from each cell.

A cell has up to 8 (2D) or 26 (3D) moves of length 1, ``sqrt(2)`` or ``sqrt(3)`` edges. No move cuts a corner: all cells
of the block that it sweeps (2, 4 or 8 cells) must be free. The allowed moves of a cell are one word of bits, computed
once per map, so that a search tests no neighbour.

The grid is padded with blocked cells (in 2D only sideways): no move ever leaves it. A *node* is a flat index into the
padded grid, a *cell* is ``[z, y, x]`` in the caller's.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mintpilot.core.compiled import compiled
from mintpilot.core.errors import MapError
from mintpilot.core.geometry import Bools, Ints, frozen
from mintpilot.planning.moves import Moves, grid_moves

Words = NDArray[np.uint64]
"""For each node: bit k is set when move k is allowed, bit 32 + i when the i-th node around it is free."""

NEAR = np.uint64(1 << 31)
"""Set in the word of a cell whose 3 x 3 (x 3) neighbourhood touches a region."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Lattice:
    """A padded grid with the allowed moves of each node."""

    shape: tuple[int, int, int]
    """Cells (nz, ny, nx) of the caller's grid."""
    padded: tuple[int, int, int]
    """Cells of the padded grid."""
    free: NDArray[np.uint8]
    """1 for each free node, flat."""
    allowed: Words
    """Allowed moves and surroundings of each node."""
    moves: Moves
    """Steps and lengths of the moves."""
    offset: Ints
    """What move k adds to a node."""
    around: Ints
    """Offsets of the 27 nodes of a neighbourhood (2D: 9), in the order of `Moves.needs`."""
    swept: Ints
    """(n, 7) what to add to a node for all other nodes that move k sweeps; the target is repeated to fill up."""

    @property
    def size(self) -> int:
        """Number of nodes."""
        return int(self.allowed.size)

    def node(self, cell: ArrayLike) -> int:
        """The node of a cell (z, y, x). Raises `MapError` outside the grid."""
        z, y, x = (int(i) for i in np.asarray(cell).ravel())
        if not all(0 <= i < n for i, n in zip((z, y, x), self.shape, strict=True)):
            raise MapError(f"cell {(z, y, x)} is outside the grid of {self.shape} cells; give one inside")
        return int(self.nodes_of_flat(np.array([(z * self.shape[1] + y) * self.shape[2] + x], np.int64))[0])

    def nodes_of_flat(self, flat: Ints) -> Ints:
        """Nodes (n,) of flat cell indices (n,) of the caller's grid."""
        z, y, x = np.unravel_index(flat, self.shape)
        up = 0 if self.shape[0] == 1 else 1
        nodes: Ints = np.ravel_multi_index((z + up, y + 1, x + 1), self.padded).astype(np.int64)
        return nodes

    def cells(self, nodes: Ints) -> Ints:
        """Cells (n, 3) ``[z, y, x]`` of nodes (n,)."""
        up = 0 if self.shape[0] == 1 else 1
        cells: Ints = np.stack(np.unravel_index(nodes, self.padded), axis=1).astype(np.int64) - (up, 1, 1)
        return cells

    def path_cost(self, cells: Ints) -> float:
        """Length of a path of neighbouring cells (n, 3) in edges, the same for equal counts of moves."""
        return cost_of_moves(np.bincount(np.abs(np.diff(cells, axis=0)).sum(axis=1), minlength=4))


def cost_of_moves(kinds: Sequence[int] | Ints) -> float:
    """Length in edges of so many moves (4,) along 0, 1, 2 and 3 axes."""
    return float(kinds[1]) + float(kinds[2]) * 2**0.5 + float(kinds[3]) * 3**0.5


def swept_cells(cells: Ints) -> Ints:
    """All cells (m, 3) that a path of neighbouring cells (n, 3) touches, the side cells of diagonal moves included."""
    corners = [np.where(np.array(pick, bool), cells[1:], cells[:-1]) for pick in np.ndindex(2, 2, 2)]
    swept: Ints = np.unique(np.concatenate([cells[:1], *corners]), axis=0)
    return swept


def lattice_of(free: Bools, *, cut_corners: bool = False) -> Lattice:
    """The graph of a grid.

    Args:
        free: flags (nz, ny, nx); ``nz == 1`` makes a flat, 8-connected graph.
        cut_corners: moves need only their target to be free (for comparisons with other searches).

    Raises:
        MapError: the grid is empty or not three-dimensional.
    """
    if free.ndim != 3 or free.size == 0:
        raise MapError(f"grid of shape {free.shape}: give flags of shape (nz, ny, nx), none of them 0")
    shape = (free.shape[0], free.shape[1], free.shape[2])
    flat = shape[0] == 1
    moves = grid_moves(flat=flat)
    if cut_corners:
        moves = moves.cutting_corners()
    padded = np.pad(np.asarray(free, np.uint8), ((0, 0) if flat else (1, 1), (1, 1), (1, 1)))
    _, ny, nx = padded.shape
    layers = (0,) if flat else (-1, 0, 1)
    around = [(z * ny + y) * nx + x for z, y, x in itertools.product(layers, (-1, 0, 1), (-1, 0, 1))]
    offset = [(int(z) * ny + int(y)) * nx + int(x) for z, y, x in moves.step]
    ground = np.ascontiguousarray(padded).ravel()
    around_array = np.array(around, np.int64)
    allowed = allowed_moves(ground, around_array, moves.needs)
    for array in (ground, allowed):
        frozen(array)
    return Lattice(
        shape=shape,
        padded=(padded.shape[0], ny, nx),
        free=ground,
        allowed=allowed,
        moves=moves,
        offset=np.array(offset, np.int64),
        around=around_array,
        swept=_swept(moves, around_array),
    )


def _swept(moves: Moves, around: Ints) -> Ints:
    rows = []
    for needs in moves.needs:
        offsets = [int(o) for i, o in enumerate(around) if int(needs) >> i & 1 and o]
        rows.append((offsets * 7)[:7])
    return np.array(rows, np.int64)


@compiled(error_model="numpy")
def allowed_moves(free: NDArray[np.uint8], around: Ints, needs: NDArray[np.uint32]) -> Words:
    """The word of every node; 0 for those that are not free."""
    allowed = np.zeros(free.size, np.uint64)
    for node in range(free.size):
        if free[node]:
            allowed[node] = moves_at(free, around, needs, node)
    return allowed


@compiled(error_model="numpy")
def moves_at(free: NDArray[np.uint8], around: Ints, needs: NDArray[np.uint32], node: int) -> np.uint64:
    """The word of one free node: a move is allowed if the block that it sweeps is free."""
    ground = np.uint64(0)
    for i in range(around.size):
        if free[node + around[i]]:
            ground |= np.uint64(1) << np.uint64(i)
    word = ground << np.uint64(32)
    for k in range(needs.size):
        if ground & needs[k] == needs[k]:
            word |= np.uint64(1) << np.uint64(k)
    return np.uint64(word)
