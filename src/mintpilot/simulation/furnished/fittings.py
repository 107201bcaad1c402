"""What belongs to the floor and the walls of a room: carpets, pictures, windows, paint. None of it is a thing."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from types import MappingProxyType

import numpy as np

from mintpilot.simulation.furnished.doors import Doorway, in_wall
from mintpilot.simulation.furnished.shapes import Assembly, Part
from mintpilot.simulation.furnished.style import Rgb, Style

Size = tuple[float, float]


def fittings(style: Style, size: Size, doors: Sequence[Doorway], rng: np.random.Generator) -> tuple[Part, ...]:
    """Draws those of the style; on walls they keep clear of the doors and, but for paint and pipes, of each other."""
    room = _Room(style, size, doors, rng)
    for kind in style.fittings:
        MAKERS[kind](room)
    return tuple(room.made.parts)


class _Room:
    """The room that is being fitted out."""

    def __init__(self, style: Style, size: Size, doors: Sequence[Doorway], rng: np.random.Generator) -> None:
        self.made, self.size, self.rng = Assembly(), size, rng
        self._doors, self._cloth = doors, style.cloth
        self._taken = [(d.wall, d.at_m, d.width_m + 0.8) for d in doors]

    def colour(self) -> Rgb:
        return self._cloth[int(self.rng.integers(len(self._cloth)))]

    def on_wall(self, wall: int, lo: Sequence[float], hi: Sequence[float], colour: Rgb) -> None:
        """A block by (along, out of the wall, up)."""
        box = in_wall(wall, self.size, lo, hi)
        self.made.block(box.lo_m, box.hi_m, colour)

    def strip(self, low: float, high: float, out: float, colour: Rgb) -> None:
        """Along all walls, but not across doors and their frames."""
        for wall in range(4):
            at, end = 0.0, self.size[0] if wall < 2 else self.size[1]
            for door in (d for d in self._doors if d.wall == wall):
                gap = door.width_m / 2 + 0.09
                self.on_wall(wall, (at, 0.0, low), (door.at_m - gap, out, high), colour)
                at = door.at_m + gap
            self.on_wall(wall, (at, 0.0, low), (end, out, high), colour)

    def at_door(self, wall: int, at: float, half: float) -> bool:
        """Whether something so wide would reach into a door or its frame."""
        return any(d.wall == wall and abs(d.at_m - at) < d.width_m / 2 + 0.09 + half for d in self._doors)

    def free(self, width: float) -> tuple[int, float] | None:
        """A wall and where along it something so wide may hang; it counts as taken."""
        for _ in range(20):
            wall = int(self.rng.integers(4))
            end = self.size[0] if wall < 2 else self.size[1]
            if end < width + 0.4:
                continue
            at = float(self.rng.uniform(width / 2 + 0.2, end - width / 2 - 0.2))
            if all(other != wall or abs(there - at) > (wide + width) / 2 for other, there, wide in self._taken):
                self._taken.append((wall, at, width + 0.1))
                return wall, at
        return None


def _carpet(room: _Room) -> None:
    w, d = (float(room.rng.uniform(0.35, 0.6)) * edge for edge in room.size)
    x, y = (float(room.rng.uniform(0.15, 0.35)) * edge for edge in room.size)
    edge, inner = room.colour(), room.colour()
    room.made.block((x, y, 0.0), (x + w, y + d, 0.008), edge)
    room.made.block((x + 0.15, y + 0.15, 0.0), (x + w - 0.15, y + d - 0.15, 0.011), inner)
    for i in range(3):
        mid = x + w * (i + 1) / 4
        room.made.block((mid - 0.06, y + 0.3, 0.0), (mid + 0.06, y + d - 0.3, 0.012), edge)


def _skirting(room: _Room) -> None:
    room.strip(0.0, 0.10, 0.015, (0.93, 0.92, 0.88))


def _dado(room: _Room) -> None:
    """The lower part of the walls painted otherwise, with a rail."""
    colour = room.colour()
    room.strip(0.0, 1.1, 0.003, colour)
    room.strip(1.1, 1.16, 0.02, (0.75 * colour[0], 0.75 * colour[1], 0.75 * colour[2]))


def _panelling(room: _Room) -> None:
    """The whole of the walls in framed boards, about as wide as doors, with rails below, at the hips and above."""
    wood = room.colour()
    darker: Rgb = (0.8 * wood[0], 0.8 * wood[1], 0.8 * wood[2])
    wide = float(room.rng.uniform(0.55, 1.0))
    for low, high in ((0.0, 0.14), (0.86, 0.96), (2.25, 2.40)):
        room.strip(low, high, 0.025, darker)
    room.strip(0.14, 2.25, 0.004, wood)
    for wall in range(4):
        end = room.size[0] if wall < 2 else room.size[1]
        for at in np.arange(wide, end - 0.1, wide):
            if not room.at_door(wall, at, 0.06):
                room.on_wall(wall, (at - 0.05, 0.0, 0.14), (at + 0.05, 0.025, 2.25), darker)


def _handrail(room: _Room) -> None:
    room.strip(0.86, 0.98, 0.05, room.colour())


def _pictures(room: _Room) -> None:
    for _ in range(int(room.rng.integers(2, 6))):
        w, h, low = (float(room.rng.uniform(*span)) for span in ((0.3, 0.9), (0.3, 0.7), (1.2, 1.6)))
        place = room.free(w)
        if place is not None:
            wall, at = place
            room.on_wall(wall, (at - w / 2, 0, low), (at + w / 2, 0.02, low + h), (0.25, 0.17, 0.10))
            room.on_wall(
                wall, (at - w / 2 + 0.04, 0, low + 0.04), (at + w / 2 - 0.04, 0.022, low + h - 0.04), room.colour()
            )


def _window(room: _Room) -> None:
    """Panes in a frame, with a curtain on each side."""
    w, low, high = float(room.rng.uniform(1.0, 1.9)), float(room.rng.uniform(0.8, 1.0)), 2.25
    place = room.free(w + 0.6)
    if place is None:
        return
    wall, at = place
    room.on_wall(wall, (at - w / 2 - 0.06, 0, low - 0.06), (at + w / 2 + 0.06, 0.03, high + 0.06), (0.95, 0.95, 0.93))
    for x in (at - w / 2, at + 0.03):
        room.on_wall(wall, (x, 0, low), (x + w / 2 - 0.03, 0.032, high), (0.70, 0.82, 0.93))
    colour = room.colour()
    for x in (at - w / 2 - 0.28, at + w / 2 + 0.02):
        for fold in range(4):
            out = 0.05 + 0.03 * (fold % 2)
            room.on_wall(wall, (x + 0.07 * fold, 0, 0.25), (x + 0.07 * (fold + 1), out, high + 0.1), colour)


def _board(room: _Room) -> None:
    """A board with sheets of paper pinned to it."""
    w, low = float(room.rng.uniform(1.2, 2.0)), 1.0
    place = room.free(w)
    if place is None:
        return
    wall, at = place
    room.on_wall(wall, (at - w / 2, 0, low), (at + w / 2, 0.02, low + 1.0), (0.62, 0.45, 0.28))
    for _ in range(8):
        x, z = at + float(room.rng.uniform(-w / 2 + 0.02, w / 2 - 0.24)), low + float(room.rng.uniform(0.02, 0.65))
        room.on_wall(wall, (x, 0, z), (x + 0.21, 0.023, z + 0.3), room.colour())


def _pegs(room: _Room) -> None:
    """A board with tools that hang before it: hammers, saws, spanners."""
    w, low = float(room.rng.uniform(1.2, 1.8)), 1.15
    place = room.free(w)
    if place is None:
        return
    wall, at = place
    room.on_wall(wall, (at - w / 2, 0, low), (at + w / 2, 0.015, low + 0.85), (0.72, 0.55, 0.35))
    for x in np.arange(at - w / 2 + 0.08, at + w / 2 - 0.1, 0.16):
        top, long = low + float(room.rng.uniform(0.6, 0.78)), float(room.rng.uniform(0.2, 0.4))
        room.on_wall(wall, (x, 0.015, top - long), (x + 0.03, 0.04, top), room.colour())
        if room.rng.random() < 0.6:
            room.on_wall(wall, (x - 0.04, 0.015, top - 0.03), (x + 0.07, 0.05, top + 0.03), (0.35, 0.36, 0.38))


def _pipes(room: _Room) -> None:
    for low in (2.30, 2.45):
        room.strip(low, low + 0.06, 0.07, room.colour())


def _tiles(room: _Room) -> None:
    """A piece of wall that is tiled in two shades, as behind a sink."""
    wide, colour = float(room.rng.uniform(1.4, 2.6)), room.colour()
    place = room.free(wide)
    if place is None:
        return
    wall, at = place
    for i, u in enumerate(np.arange(at - wide / 2, at + wide / 2 - 0.2, 0.2)):
        for j, z in enumerate(np.arange(0.9, 1.5, 0.2)):
            shade = 1.0 if (i + j) % 2 else 0.88
            room.on_wall(
                wall, (u, 0, z), (u + 0.2, 0.006, z + 0.2), (shade * colour[0], shade * colour[1], shade * colour[2])
            )


MAKERS: MappingProxyType[str, Callable[[_Room], None]] = MappingProxyType(
    {
        "carpet": _carpet,
        "skirting": _skirting,
        "dado": _dado,
        "panelling": _panelling,
        "handrail": _handrail,
        "pictures": _pictures,
        "window": _window,
        "board": _board,
        "pegs": _pegs,
        "pipes": _pipes,
        "tiles": _tiles,
    }
)
