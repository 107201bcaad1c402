"""Stable ids: the same thing keeps its name when the map is replaced."""

from __future__ import annotations

from collections.abc import Sequence


class Names:
    """Hands out ``kind-1``, ``kind-2`` …; a number is never used twice, whatever is forgotten meanwhile."""

    def __init__(self) -> None:
        self._used: dict[str, int] = {}

    def seen(self, identity: str) -> None:
        """Notes an id that exists already, so that it is not handed out."""
        kind, _, number = identity.rpartition("-")
        if number.isdigit():
            self._used[kind] = max(self._used.get(kind, 0), int(number))

    def new(self, kind: str) -> str:
        """A fresh id; a space in the kind becomes a hyphen."""
        kind = kind.replace(" ", "-")
        self._used[kind] = self._used.get(kind, 0) + 1
        return f"{kind}-{self._used[kind]}"


def match(closeness: Sequence[Sequence[float]]) -> dict[int, int]:
    """Pairs rows with columns, closest first; 0 or less never pairs. Returns row → column; each is used once."""
    pairs = sorted(
        ((value, i, j) for i, row in enumerate(closeness) for j, value in enumerate(row) if value > 0),
        key=lambda p: (-p[0], p[1], p[2]),
    )
    chosen: dict[int, int] = {}
    for _, i, j in pairs:
        if i not in chosen and j not in chosen.values():
            chosen[i] = j
    return chosen
