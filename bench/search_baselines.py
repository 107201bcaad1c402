"""What the compiled search is measured against: plain C, scipy and scikit-image, each on its own rule."""

from __future__ import annotations

import ctypes
import subprocess
import tempfile
from pathlib import Path

import numpy as np
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import dijkstra

from mintpilot.core.errors import MissingPartError
from mintpilot.core.geometry import Bools
from mintpilot.planning.grid_search import GridSearch

SOURCE = Path(__file__).with_name("search_plain_astar.c")
Cell3 = tuple[int, int, int]


def compiled() -> ctypes.CDLL:
    """The plain C search, built now with ``gcc -O3``."""
    library = Path(tempfile.mkdtemp(prefix="mintpilot-bench-")) / "plain_astar.so"
    command = ["gcc", "-O3", "-march=native", "-shared", "-fPIC", "-o", str(library), str(SOURCE), "-lm"]
    try:
        subprocess.run(command, check=True, capture_output=True, text=True)
    except FileNotFoundError as error:
        raise MissingPartError("gcc is not installed; the benchmark needs it: apt-get install gcc") from error
    loaded = ctypes.CDLL(str(library))
    loaded.grid_new.restype = ctypes.c_void_p
    loaded.grid_new.argtypes = [ctypes.c_void_p, ctypes.c_int, ctypes.c_int, ctypes.c_int]
    loaded.grid_astar.restype = ctypes.c_double
    loaded.grid_astar.argtypes = [ctypes.c_void_p, ctypes.c_uint32, ctypes.c_uint32, ctypes.c_double]
    loaded.grid_free.argtypes = [ctypes.c_void_p]
    return loaded


class PlainC:
    """Bucket-queue A* in plain C, with its own table of allowed moves."""

    def __init__(self, library: ctypes.CDLL, search: GridSearch) -> None:
        self._library, self._lattice = library, search.lattice
        self._grid = library.grid_new(search.lattice.free.ctypes.data, *search.lattice.padded)

    def cost(self, start: Cell3, goal: Cell3) -> float:
        """Length of the shortest path, edges."""
        node = self._lattice.node
        return float(self._library.grid_astar(self._grid, node(start), node(goal), 0.25))

    def close(self) -> None:
        """Gives the memory back."""
        self._library.grid_free(self._grid)


class Scipy:
    """Dijkstra of scipy on a sparse graph that is built beforehand with the same moves."""

    def __init__(self, search: GridSearch) -> None:
        lattice = search.lattice
        self._lattice = lattice
        rows, columns, lengths = [], [], []
        for k, (offset, length) in enumerate(zip(lattice.offset, lattice.moves.length, strict=True)):
            nodes = np.flatnonzero(lattice.allowed >> np.uint64(k) & np.uint64(1))
            rows.append(nodes)
            columns.append(nodes + offset)
            lengths.append(np.full(nodes.size, length))
        triple = (np.concatenate(lengths), (np.concatenate(rows), np.concatenate(columns)))
        self._graph = csr_matrix(triple, shape=(lattice.size, lattice.size))

    def cost(self, start: Cell3, goal: Cell3) -> float:
        """Length of the shortest path, edges."""
        node = self._lattice.node
        return float(dijkstra(self._graph, indices=node(start))[node(goal)])


class Skimage:
    """``skimage.graph.route_through_array``, geometric. It knows one rule only: corners may be cut."""

    def __init__(self, free: Bools) -> None:
        try:
            from skimage.graph import route_through_array
        except ImportError as error:
            raise MissingPartError("scikit-image is not installed: pip install 'mintpilot[bench]'") from error
        self._route = route_through_array
        self._costs = np.where(free, 1.0, -1.0)
        self._flat = free.shape[0] == 1

    def cost(self, start: Cell3, goal: Cell3) -> float:
        """Length of the shortest path, edges."""
        if self._flat:
            return float(self._route(self._costs[0], start[1:], goal[1:], fully_connected=True, geometric=True)[1])
        return float(self._route(self._costs, start, goal, fully_connected=True, geometric=True)[1])
