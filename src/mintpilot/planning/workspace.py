"""The memory of searches on one lattice."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from mintpilot.core.geometry import Ints
from mintpilot.planning import buckets


@dataclass(slots=True, eq=False)
class Workspace:
    """Memory that searches of one lattice use again and again; it grows when it must."""

    size: int
    """Number of nodes."""
    cells: NDArray[np.void] = field(init=False)
    """State of each node, dtype `buckets.CELL`."""
    pool: NDArray[np.void] = field(init=False)
    """Queue entries, dtype `buckets.ENTRY`."""
    head: NDArray[np.int32] = field(init=False)
    """First queue entry of each bucket, for searches that go on where they stopped."""
    tag: int = field(init=False, default=0)
    """Number of the last search: states with another tag are stale."""

    def __post_init__(self) -> None:
        self.cells = np.zeros(self.size, buckets.CELL)
        self.pool = np.empty(1 << 12, buckets.ENTRY)
        self.head = np.empty(buckets.RING, np.int32)

    def next_tag(self) -> int:
        """The number of a new search."""
        if self.tag == 0xFFFFFFFF:
            self.cells["tag"] = 0
            self.tag = 0
        self.tag += 1
        return self.tag

    def begin(self, source: int) -> Ints:
        """Begins a new search at a node; the queue's numbers, as the kernels want them."""
        buckets.begin(self.cells, self.pool, self.head, source, self.next_tag())
        return np.array([-1, 1, 1, 0], np.int64)

    def make_room(self) -> None:
        """Doubles the pool; entries stay."""
        self.pool = np.concatenate([self.pool, np.empty_like(self.pool)])
