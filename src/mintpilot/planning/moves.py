"""The moves of a grid, and which of them can be left out after which.

A node v was reached from u by move p. Its move k to w is *redundant* where the grid offers another way from u to w that
does not pass v and is strictly shorter, or as short with a last move along fewer axes (so of two orders of the same two
moves, the wider one goes first). Such a way lies inside v's neighbourhood: whether it is free is a test of a few bits.
Of 26 moves, 7 are left after a space diagonal, 3 after a plane one and 1 after a straight one in free space, and never
more than 7, 11 and 17 beside obstacles. This halves the work of a search in 3D and more.

Why nothing is lost: suppose that some way to a node is missed, with no search state there as good. Take the shortest
such way, and of those the one whose last move has the fewest axes. The state before its last move is not missed; that
move was left out, so there is a way that is shorter, or as short with a last move of fewer axes; it is not missed, by
choice, and it is as good. The same holds for states (cost, set of regions entered) when cells of regions that were not
entered yet count as not free in the test: the other way then enters no other region.
"""

from __future__ import annotations

import functools
import itertools
import math
from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from mintpilot.core.geometry import Floats

NO_MOVE = 31
"""The 'last move' of a node where a search starts."""
NEVER = 0xFFFFFFFF
"""Bits that no neighbourhood has."""

Step = tuple[int, ...]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Moves:
    """The 8 or 26 moves. Neighbourhoods are words with one bit for each of their 9 or 27 nodes."""

    step: Floats
    """(n, 3) change of (z, y, x), whole numbers."""
    length: Floats
    """(n,) in edges."""
    needs: NDArray[np.uint32]
    """(n,) nodes of the neighbourhood that must be free: the block swept by the move."""
    after: NDArray[np.uint32]
    """(32, 2) bit set of the moves to be tried after each move: anywhere, and in a neighbourhood that is all free."""
    detour: NDArray[np.uint32]
    """(32, n, 2) after move p, move k is redundant if all nodes of either word are free."""

    @property
    def open(self) -> np.uint32:
        """A neighbourhood that is all free."""
        return np.uint32((1 << (len(self.step) + 1)) - 1)

    def cutting_corners(self) -> Moves:
        """The same moves, needing only their target."""
        middle = (len(self.step) + 1) // 2
        targets = [k if k < middle else k + 1 for k in range(len(self.step))]
        never = np.full_like(self.detour, NEVER)
        after = np.column_stack([np.full(32, self.after[NO_MOVE, 0]), self.after[:, 1]])
        return replace(self, needs=np.array([1 << t for t in targets], np.uint32), after=after, detour=never)


@functools.cache
def grid_moves(*, flat: bool) -> Moves:
    """The 8 moves of a flat grid or the 26 of a solid one."""
    layers = (0,) if flat else (-1, 0, 1)
    around: list[Step] = list(itertools.product(layers, (-1, 0, 1), (-1, 0, 1)))
    steps = [s for s in around if any(s)]
    after = np.full((32, 2), (1 << len(steps)) - 1, np.uint32)
    detour = np.full((32, len(steps), 2), NEVER, np.uint32)
    for p, last in enumerate(steps):
        words = [_detours(last, step, around) for step in steps]
        after[p, 0] = _bits(k for k, found in enumerate(words) if 0 not in found)
        after[p, 1] = _bits(k for k, found in enumerate(words) if not found)
        for k, found in enumerate(words):
            detour[p, k, : len(found)] = sorted(found)
    return Moves(
        step=np.array(steps, float),
        length=np.sqrt(np.abs(np.array(steps, float)).sum(axis=1)),
        needs=np.array([_bits(around.index(c) for c in _block(_origin(s), s)) for s in steps], np.uint32),
        after=after,
        detour=detour,
    )


def _detours(last: Step, step: Step, around: list[Step]) -> set[int]:
    """For each other way from before ``last`` to after ``step``, the nodes that must be free besides those swept."""
    begin = _minus(last)
    swept = _block(begin, last) | _block(_origin(step), step)
    if begin == step:
        return {0}
    found = set()
    for middle in [begin, *around]:
        first, second = _plus(middle, last), _plus(step, _minus(middle))
        if not any(middle) or max(map(abs, first)) > 1 or max(map(abs, second)) > 1 or not any(second):
            continue
        longer = _length(first) + _length(second) - _length(last) - _length(step)
        if longer < -1e-9 or (longer < 1e-9 and _axes(second) < _axes(step)):
            nodes = (_block(begin, first) | _block(middle, second)) - swept
            found.add(_bits(around.index(node) for node in nodes))
    return {word for word in found if not any(other != word and other & word == other for other in found)}


@functools.cache
def _block(start: Step, step: Step) -> frozenset[Step]:
    """The cells that a move sweeps."""
    return frozenset(_plus(start, part) for part in itertools.product(*((0, s) for s in step)))


def _origin(step: Step) -> Step:
    return (0,) * len(step)


@functools.cache
def _plus(a: Step, b: Step) -> Step:
    return tuple(i + j for i, j in zip(a, b, strict=True))


def _minus(a: Step) -> Step:
    return tuple(-i for i in a)


def _axes(step: Step) -> int:
    return sum(map(abs, step))


def _length(step: Step) -> float:
    return math.sqrt(_axes(step))


def _bits(numbers: Iterable[int]) -> int:
    return sum(1 << number for number in set(numbers))
