"""Names for things by what an operator can see of them: a colour and a place, different for things of one kind."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from mintpilot.core.geometry import Box, Vec3

_ROWS = ("south", "middle", "north")
_COLUMNS = ("west", "middle", "east")


def _third(value: float, low: float, high: float) -> int:
    return 1 if high <= low else min(2, max(0, int(3 * (value - low) / (high - low))))


def place_in(volume: Box, position_m: Vec3) -> str:
    """Where a position is in the hall, by thirds: ``in the north-east corner``, ``on the west side``."""
    row = _third(position_m[1], volume.lo_m[1], volume.hi_m[1])
    column = _third(position_m[0], volume.lo_m[0], volume.hi_m[0])
    if row == 1 and column == 1:
        return "in the middle of the hall"
    if row != 1 and column != 1:
        return f"in the {_ROWS[row]}-{_COLUMNS[column]} corner"
    side = _ROWS[row] if column == 1 else _COLUMNS[column]
    return f"on the {side} side"


def describe_all(volume: Box, names: Sequence[str], positions_m: Sequence[Vec3]) -> list[str]:
    """One description per thing, none twice.

    Things of one name in one place are told apart by the axis along which they lie furthest apart: ``the grey smoke
    on the west side, the most northern of 2``.

    Args:
        volume: the hall; its thirds give the places.
        names: what each thing looks like, with its article: ``the grey smoke``.
        positions_m: where each one is.
    """
    texts = [f"{name} {place_in(volume, p)}" for name, p in zip(names, positions_m, strict=True)]
    for text in [t for t, n in Counter(texts).items() if n > 1]:
        same = [i for i, t in enumerate(texts) if t == text]
        spans = [max(positions_m[i][a] for i in same) - min(positions_m[i][a] for i in same) for a in (0, 1)]
        axis = 0 if spans[0] >= spans[1] else 1
        ends = ("western", "eastern") if axis == 0 else ("southern", "northern")
        order = sorted(same, key=lambda i: (positions_m[i][axis], positions_m[i][1 - axis], i))
        for rank, i in enumerate(order):
            texts[i] = f"{text}, {_rank(rank, len(order), ends)}"
    return texts


_ORDINALS = ("first", "second", "third", "fourth", "fifth", "sixth", "seventh", "eighth", "ninth")


def _rank(rank: int, count: int, ends: tuple[str, str]) -> str:
    if count == 2:
        return f"the {ends[rank]} one"
    if rank in (0, count - 1):
        return f"the {ends[0 if rank == 0 else 1]}most one"
    side = ends[0].replace("ern", "")
    return f"the {_ORDINALS[rank] if rank < 9 else f'number {rank + 1}'} from the {side}"
