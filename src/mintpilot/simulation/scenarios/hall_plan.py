"""The fire-warehouse's floor plan: two fire walls, a spine wall, gates, closed rooms, and the ways through.

::

    y 15 +-----------+--------------------+-----------+
         | room?    gate    north hall   gate   room? |
         |           |     racks, room?   |           |
         |  start    |------ (link) ------|  person   |
         |           |     racks, room?   |           |
         | room?    gate    south hall   gate   room? |
    y  0 +-----------+--------------------+-----------+
         x 0        x_a                  x_b         x 20
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mintpilot.core.geometry import Box, Vec3
from mintpilot.simulation.scenarios.floor import block, length_m, snap

VOLUME = Box(lo_m=(0.0, 0.0, 0.0), hi_m=(20.0, 15.0, 4.0))
WALL_M = 0.2
ROOM_M = 3.0
ROOM_HEIGHT_M = 2.6
HALLS = ("south", "north")
ROOM_PLACES = ("south-west", "north-west", "south-east", "north-east", "south", "north")
EYE_M = 1.4
VIEW_M = 1.2


@dataclass(frozen=True, slots=True, kw_only=True)
class Way:
    """One way from the start to the person."""

    name: str
    """``south-north`` passes the south gate of the western wall and the north gate of the eastern one."""
    points: tuple[tuple[float, float], ...]
    """Polyline through the middles of the gates."""
    passes: frozenset[str]
    """Gates and halls on it."""

    @property
    def length_m(self) -> float:
        """Length along straight lines, metres: racks that are flown over or around are not counted."""
        return length_m(self.points)


@dataclass(frozen=True, slots=True, kw_only=True)
class HallPlan:
    """Where walls and gates are."""

    x_a_m: float
    """West face of the western fire wall."""
    x_b_m: float
    """West face of the eastern one."""
    y_m: float
    """South face of the spine wall between the halls."""
    gates: tuple[tuple[str, float, float], ...]
    """(name, x, y) of the middle of each gate in the fire walls: ``a-south``, ``a-north``, ``b-south``, ``b-north``."""
    link_x_m: float | None
    """Middle of the gate in the spine wall, where there is one."""
    gate_m: float
    """Width of the gates."""

    def gate(self, name: str) -> tuple[float, float]:
        """Middle of the gate with that name."""
        return next((x, y) for known, x, y in self.gates if known == name)

    def hall(self, name: str) -> Box:
        """Inner space of the south or north hall."""
        low, high = VOLUME.lo_m[1], VOLUME.hi_m[1]
        y = (low, self.y_m) if name == "south" else (self.y_m + WALL_M, high)
        return block((self.x_a_m + WALL_M, self.x_b_m), y, (0.0, VOLUME.hi_m[2]))

    def partitions(self) -> list[Box]:
        """The walls' pieces between the gates, floor to roof."""
        half, top = self.gate_m / 2, (0.0, VOLUME.hi_m[2])
        pieces = []
        for wall, x in (("a", self.x_a_m), ("b", self.x_b_m)):
            south, north = self.gate(f"{wall}-south")[1], self.gate(f"{wall}-north")[1]
            ends = (VOLUME.lo_m[1], south - half, south + half, north - half, north + half, VOLUME.hi_m[1])
            for low, high in (ends[0:2], ends[2:4], ends[4:6]):
                pieces.append(block((x, x + WALL_M), (low, high), top))
        spine = (self.y_m, self.y_m + WALL_M)
        x0, x1 = self.x_a_m + WALL_M, self.x_b_m
        if self.link_x_m is None:
            return [*pieces, block((x0, x1), spine, top)]
        return [
            *pieces,
            block((x0, self.link_x_m - half), spine, top),
            block((self.link_x_m + half, x1), spine, top),
        ]

    def ways(self, start: tuple[float, float], goal: tuple[float, float]) -> tuple[Way, ...]:
        """All ways from start to goal, shortest first."""
        ways = []
        for first in HALLS:
            for second in HALLS:
                if first != second and self.link_x_m is None:
                    continue
                enter, leave = f"a-{first}", f"b-{second}"
                link = [] if first == second or self.link_x_m is None else [(self.link_x_m, self.y_m + WALL_M / 2)]
                points = (start, self.gate(enter), *link, self.gate(leave), goal)
                halls = {f"hall-{first}", f"hall-{second}"} if first != second else {f"hall-{first}"}
                ways.append(Way(name=f"{first}-{second}", points=points, passes=frozenset({enter, leave} | halls)))
        return tuple(sorted(ways, key=lambda way: way.length_m))


def draw_plan(rng: np.random.Generator, *, gate_m: float, link_probability: float) -> HallPlan:
    """Draws walls and gates; everything lies on the grid."""
    x_a, x_b = snap(rng.uniform(5.8, 6.4)), snap(rng.uniform(13.6, 14.2))
    y_m = snap(rng.uniform(6.8, 7.8))
    gates = []
    for wall, x in (("a", x_a), ("b", x_b)):
        south, north = snap(rng.uniform(1.8, 4.8)), snap(rng.uniform(10.2, 13.2))
        gates += [(f"{wall}-south", x + WALL_M / 2, south), (f"{wall}-north", x + WALL_M / 2, north)]
    has_link = bool(rng.random() < link_probability)
    link = snap(rng.uniform(x_a + 2.4, x_b - 2.2))
    return HallPlan(
        x_a_m=x_a, x_b_m=x_b, y_m=y_m, gates=tuple(gates), link_x_m=link if has_link else None, gate_m=gate_m
    )


def room_place(plan: HallPlan, place: str) -> tuple[Box, Box, Vec3]:
    """Outer walls, door leaf and viewpoint of a closed room at one of `ROOM_PLACES`; its door faces y = 7.5."""
    south = place.startswith("south")
    if place.endswith("west"):
        x0 = VOLUME.lo_m[0]
    elif place.endswith("east"):
        x0 = VOLUME.hi_m[0] - ROOM_M
    else:
        x0 = snap((plan.x_a_m + WALL_M + plan.x_b_m - ROOM_M) / 2)
    y0 = VOLUME.lo_m[1] if south else VOLUME.hi_m[1] - ROOM_M
    walls = block((x0, x0 + ROOM_M), (y0, y0 + ROOM_M), (0.0, ROOM_HEIGHT_M))
    middle = x0 + ROOM_M / 2
    face, out = (y0 + ROOM_M, 1.0) if south else (y0, -1.0)
    leaf = sorted((face - out * 0.02, face - out * 0.10))
    door = block((middle - 0.45, middle + 0.45), (leaf[0], leaf[1]), (0.0, 2.05))
    return walls, door, (middle, face + out * VIEW_M, EYE_M)
