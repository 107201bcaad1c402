"""Racks and clutter of the fire-warehouse."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from mintpilot.core.geometry import Box
from mintpilot.simulation.materials import COLOURS
from mintpilot.simulation.scenarios.floor import Floor, block, snap, standing
from mintpilot.simulation.scenarios.hall_plan import HALLS, VOLUME, HallPlan
from mintpilot.simulation.scene import Shape, Solid

RACK_HEIGHT_M = 2.8
AISLE_M = 2.4
"""No aisle is narrower."""
CROSS_AISLE_M = 1.6
"""Between a rack's end and a fire wall."""


def add_racks(floor: Floor, plan: HallPlan, room_places: Sequence[str], rng: np.random.Generator) -> tuple[Solid, ...]:
    """Rows of racks along the halls: in the middle and at the outer wall; next to a room, at the spine."""
    rows: list[Box] = []
    for name in HALLS:
        hall = plan.hall(name)
        x = (hall.lo_m[0] + CROSS_AISLE_M, hall.hi_m[0] - CROSS_AISLE_M)
        low, high = hall.lo_m[1], hall.hi_m[1]
        south = name == "south"
        if name in room_places:
            if plan.link_x_m is None:
                rows.append(_row(x, (high - 1.0, high) if south else (low, low + 1.0)))
            continue
        outer, middle = (0.8, 1.0) if high - low >= 0.8 + 1.0 + 2 * AISLE_M else (0.0, 1.0)
        spare = high - low - outer - middle - 2 * AISLE_M
        shift = snap(float(rng.uniform(0.0, spare))) if spare > 0 else 0.0
        if outer:
            rows.append(_row(x, (low, low + outer) if south else (high - outer, high)))
        start = low + outer + AISLE_M + min(shift, spare)
        start = start if south else high - (start - low) - middle
        rows.append(_row(x, (start, start + middle)))
    floor.taken += rows
    return tuple(Solid(id=f"rack-{i + 1}", kind="rack", extent_m=row) for i, row in enumerate(rows))


def _row(x: tuple[float, float], y: tuple[float, float]) -> Box:
    return block(x, y, (0.0, RACK_HEIGHT_M))


def add_clutter(floor: Floor, plan: HallPlan, rng: np.random.Generator) -> tuple[Solid, ...]:
    """Crates, drums, coloured boxes, rubble and a rack at the outer wall, west and east of the halls, off the ways."""
    solids: list[Solid] = []
    spans = {"west": (0.6, plan.x_a_m - 0.6), "east": (plan.x_b_m + 0.8, VOLUME.hi_m[0] - 0.6)}
    for side, span in spans.items():
        wall = 0.0 if side == "west" else VOLUME.hi_m[0]
        _add(
            floor, solids, "rack", rng, _anywhere((wall, wall), (0.8, 2.4), (0.8, 3.6), (RACK_HEIGHT_M, RACK_HEIGHT_M))
        )
        for _ in range(2):
            _add(floor, solids, "crate", rng, _anywhere(span, (0.6, 0.6), (1.0, 1.0), (0.6, 1.0)))
        _add(floor, solids, "rubble", rng, _anywhere(span, (0.8, 0.8), (1.4, 1.4), (0.4, 0.7)))
        _add(floor, solids, "barrel", rng, _anywhere(span, (0.6, 0.6), (0.6, 0.6), (0.9, 0.9)), Shape.CYLINDER)
        _add(floor, solids, "box", rng, _anywhere(span, (0.5, 0.5), (0.5, 0.5), (0.5, 0.5)))
    return tuple(solids)


def _anywhere(
    x: tuple[float, float], least: tuple[float, float], most: tuple[float, float], height: tuple[float, float]
) -> Callable[[np.random.Generator], Box]:
    """Draws a place between two x and a size between two."""

    def draw(rng: np.random.Generator) -> Box:
        centre = (float(rng.uniform(*x)), float(rng.uniform(0.6, VOLUME.hi_m[1] - 0.6)))
        wide, deep = (float(rng.uniform(a, b)) for a, b in zip(least, most, strict=True))
        return standing(centre, (wide, deep, float(rng.uniform(*height))), VOLUME)

    return draw


def _add(
    floor: Floor,
    solids: list[Solid],
    kind: str,
    rng: np.random.Generator,
    draw: Callable[[np.random.Generator], Box],
    shape: Shape = Shape.BOX,
) -> None:
    """Adds one where it fits; where nothing fits there is one thing less."""
    colour = str(rng.choice(sorted(COLOURS))) if kind in ("box", "barrel") else ""
    place = floor.place(rng, draw, spacing_m=0.3)
    if place is not None:
        number = sum(s.kind == kind for s in solids) + 1
        name = f"wall-rack-{number}" if kind == "rack" else f"{kind}-{number}"
        solids.append(Solid(id=name, kind=kind, extent_m=place, shape=shape, colour=colour))
