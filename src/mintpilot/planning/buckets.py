"""States of nodes, the ring of buckets, and the small compiled helpers that all searches share.

A bucket holds nodes whose priority lies in one interval, in no order. A move changes the priority by at most
``2 * sqrt(3)``, so a short ring of buckets is enough. Entries live in a pool; used ones are given out again. When the
pool is too small a kernel returns, the caller makes room and calls again: growing inside a kernel would keep the
compiler from holding the pool's address in a register, which costs a factor of four.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, cast

import numpy as np
from llvmlite import ir  # type: ignore[import-untyped]
from numba.extending import intrinsic
from numpy.typing import NDArray

from mintpilot.core.compiled import compiled
from mintpilot.planning.moves import NO_MOVE

CELL = np.dtype([("g", np.float64), ("tag", np.uint32), ("last", np.int32)])
"""A node's state: cost so far, the number of the search that wrote it, the move that led here."""
ENTRY = np.dtype([("g", np.float64), ("node", np.int32), ("next", np.int32)])
"""A queued node and the next entry of its bucket (or of the unused ones)."""

FULL = -1.0
"""Returned instead of a cost when the pool is too small."""
SHORT = -2.0
"""Returned instead of a cost when the heuristic must be known further out."""
RING = 64
"""Number of buckets."""
PER_EDGE = 8.0
"""Buckets per edge of cost."""
SLACK = 1e-9
"""Difference of costs, edges, up to which they are equal: they are sums of the same numbers in another order."""
CLOSED = 64
"""Added to the last move of a node that A* has expanded."""
KNOWN = -64
"""Added to the last move of a node that a field has expanded: negative numbers are those of known distances."""
MOVE = 31
"""The bits of the last move."""


def _lowest_bit(typingctx: Any, word: Any) -> Any:  # noqa: ARG001
    def codegen(context: Any, builder: Any, signature: Any, args: Any) -> Any:  # noqa: ARG001
        return builder.cttz(args[0], ir.Constant(ir.IntType(1), 1))

    return word(word), codegen


lowest_bit: Callable[[np.uint64], int] = cast(Any, intrinsic)(_lowest_bit)
"""Index of the lowest bit that is set (the word must not be 0)."""


@compiled(error_model="numpy")
def redundant(ground: np.uint64, detour: NDArray[np.uint32], last: int, k: int) -> bool:
    """Whether the free surroundings make move k needless after the last one (`mintpilot.planning.moves`)."""
    one, other = detour[last, k, 0], detour[last, k, 1]
    return bool(ground & one == one or ground & other == other)


@compiled(error_model="numpy")
def octile(a: float, b: float, c: float) -> float:
    """Length of the shortest path over |a|, |b|, |c| cells of empty space."""
    a, b, c = abs(a), abs(b), abs(c)
    low = min(a, b)
    high = max(a, b)
    middle = min(high, max(low, c))
    return max(high, c) + 0.41421356237309515 * middle + 0.31783724519578205 * min(low, c)


@compiled(error_model="numpy")
def coordinates(node: int, nx: int, ny: int) -> tuple[float, float, float]:
    """(x, y, z) of a node. Exact below 2^31 nodes, and faster than dividing whole numbers."""
    row = int((node + 0.5) * (1.0 / nx))
    layer = int((row + 0.5) * (1.0 / ny))
    return float(node - row * nx), float(row - layer * ny), float(layer)


@compiled(error_model="numpy")
def begin(cells: NDArray[np.void], pool: NDArray[np.void], head: NDArray[np.int32], source: int, tag: int) -> None:
    """Queues the first node."""
    cells[source].g = 0.0
    cells[source].tag = tag
    cells[source].last = NO_MOVE
    pool[0].g = 0.0
    pool[0].node = source
    pool[0].next = -1
    head[:] = -1
    head[0] = 0


@compiled(error_model="numpy")
def put(
    pool: NDArray[np.void], head: NDArray[np.int32], bucket: int, node: int, g: float, spare: int, used: int
) -> tuple[int, int]:
    """Queues a node in a bucket; (first unused entry or -1, number of entries ever used)."""
    entry = spare
    if entry >= 0:
        spare = pool[entry].next
    else:
        entry = used
        used += 1
    slot = bucket & (RING - 1)
    pool[entry].g = g
    pool[entry].node = node
    pool[entry].next = head[slot]
    head[slot] = entry
    return spare, used
