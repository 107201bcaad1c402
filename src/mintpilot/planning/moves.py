"""The moves of a grid, and which of them can be left out where nothing is near.

**Canonical moves.** In a neighbourhood that is wholly free, a path that makes a short step and then a wider diagonal
one can be replaced by the same two moves in the other order, and any other change of direction by a strictly shorter
path, both inside the neighbourhood. So a node that was reached by move p needs only the moves *nested* in p: p itself
and the moves along some of its axes (7 of 26 after a space diagonal, 3 after a plane one, 1 after a straight one).

Why nothing is lost: let w be a node of least distance that is missed. Each best predecessor v of w was expanded and
left w out, so v's neighbourhood is free and a path as short reaches w through another best predecessor, with a last
move of fewer axes. That cannot go on for ever, so some predecessor did generate w. The same holds for labels (cost,
regions entered) if no region touches the neighbourhood: both ways enter the same regions.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from mintpilot.core.geometry import Floats

NO_MOVE = 31
"""The 'last move' of a node where a search starts."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Moves:
    """The 8 or 26 moves."""

    step: Floats
    """(n, 3) change of (z, y, x), whole numbers."""
    length: Floats
    """(n,) in edges."""
    needs: NDArray[np.uint32]
    """(n,) bits of the neighbourhood's nodes that must be free: the block swept by the move."""
    natural: NDArray[np.uint32]
    """(32,) moves that are needed after each move in free space; all after `NO_MOVE`."""

    def cutting_corners(self) -> Moves:
        """The same moves, needing only their target."""
        middle = (len(self.step) + 1) // 2
        targets = [k if k < middle else k + 1 for k in range(len(self.step))]
        return replace(self, needs=np.array([1 << t for t in targets], np.uint32))


def _moves(layers: tuple[int, ...]) -> Moves:
    around = list(itertools.product(layers, (-1, 0, 1), (-1, 0, 1)))
    steps = [s for s in around if any(s)]
    natural = np.full(32, (1 << len(steps)) - 1, np.uint32)
    for k, step in enumerate(steps):
        natural[k] = _bits(j for j, other in enumerate(steps) if _nested(other, step))
    return Moves(
        step=np.array(steps, float),
        length=np.sqrt(np.abs(np.array(steps, float)).sum(axis=1)),
        needs=np.array([_bits(i for i, c in enumerate(around) if c in _block(s)) for s in steps], np.uint32),
        natural=natural,
    )


def _bits(numbers: Iterable[int]) -> int:
    return sum(1 << number for number in numbers)


def _nested(inner: tuple[int, ...], outer: tuple[int, ...]) -> bool:
    return all(a in (0, b) for a, b in zip(inner, outer, strict=True))


def _block(step: tuple[int, ...]) -> set[tuple[int, ...]]:
    """The cells that a move sweeps, relative to where it starts."""
    return set(itertools.product(*((0, s) for s in step)))


MOVES_2D = _moves((0,))
MOVES_3D = _moves((-1, 0, 1))
