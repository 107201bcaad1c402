"""Clouds and fires of the fire-warehouse."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mintpilot.core.geometry import Box
from mintpilot.simulation.scenarios.floor import Floor, block, gap_m, standing
from mintpilot.simulation.scenarios.hall_plan import VOLUME, WALL_M, HallPlan, Way
from mintpilot.simulation.scene import ClosedRoom, Shape, Smoke, Solid

SMOKE_KINDS = ("on-way", "other-way", "off-way")
"""In a gate or hall of the shortest way, of another way, or off every way."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SmokeChances:
    """How many clouds, and with which probabilities where and what."""

    count: int
    on_way: float
    other_way: float
    toxic: float


def draw_smokes(
    floor: Floor,
    plan: HallPlan,
    ways: tuple[Way, ...],
    rooms: tuple[ClosedRoom, ...],
    chances: SmokeChances,
    layout: np.random.Generator,
    truth: np.random.Generator,
) -> tuple[tuple[Smoke, ...], list[str]]:
    """Clouds from floor to roof, each at a place of a drawn kind, or of the next kind where that has none left."""
    smokes: list[Smoke] = []
    kinds = []
    for index in range(chances.count):
        drawn = float(layout.random())
        first = 0 if drawn < chances.on_way else 1 if drawn < chances.on_way + chances.other_way else 2
        for kind in (*SMOKE_KINDS[first:], *SMOKE_KINDS[:first]):
            spots = _spots(floor, plan, ways, kind, layout)
            spots = [s for s in spots if _is_apart(s, smokes, rooms)]
            if spots:
                extent = spots[int(layout.integers(len(spots)))]
                toxic = bool(truth.random() < chances.toxic)
                smokes.append(
                    Smoke(id=f"smoke-{index + 1}", extent_m=extent, toxic=toxic, prior_safe=1 - chances.toxic)
                )
                kinds.append(kind)
                break
    return tuple(smokes), kinds


def _is_apart(extent: Box, smokes: list[Smoke], rooms: tuple[ClosedRoom, ...]) -> bool:
    """Clouds keep apart from each other, and from rooms and the places before their doors."""
    views = [block((r.viewpoint_m[0],) * 2, (r.viewpoint_m[1],) * 2, (0.0, 0.0)) for r in rooms]
    return (
        all(gap_m(extent, s.extent_m) > 1.2 for s in smokes)
        and all(gap_m(extent, r.extent_m) > 0.4 for r in rooms)
        and all(gap_m(extent, view) > 1.0 for view in views)
    )


def _spots(floor: Floor, plan: HallPlan, ways: tuple[Way, ...], kind: str, rng: np.random.Generator) -> list[Box]:
    """Possible extents of a cloud of that kind."""
    if kind == "off-way":
        spare = Floor(taken=[*floor.taken], clear=[*floor.clear])
        for way in ways:
            spare.keep_way_clear(way.points, 1.3)
        found = spare.place(rng, _corner_cloud, spacing_m=0.0)
        return [found] if found else []
    best = ways[0].passes
    passages = sorted({name for way in ways for name in way.passes})
    wanted = [name for name in passages if (name in best) == (kind == "on-way")]
    return [_cloud_in(plan, name, rng) for name in wanted]


def _cloud_in(plan: HallPlan, passage: str, rng: np.random.Generator) -> Box:
    """A cloud that fills a gate, or a stretch of a hall from wall to wall."""
    height = (0.0, VOLUME.hi_m[2])
    if passage.startswith("hall-"):
        hall = plan.hall(passage.removeprefix("hall-"))
        long = float(rng.uniform(2.2, 3.2))
        x = float(rng.uniform(hall.lo_m[0] + 1.6, hall.hi_m[0] - 1.6 - long))
        return block((x, x + long), (hall.lo_m[1], hall.hi_m[1]), height)
    x, y = plan.gate(passage)
    before, behind, south, north = (float(v) for v in rng.uniform((1.0, 1.0, 0.6, 0.6), (1.6, 1.6, 1.2, 1.2)))
    half = plan.gate_m / 2
    low, high = (0.0, plan.y_m) if passage.endswith("south") else (plan.y_m + WALL_M, VOLUME.hi_m[1])
    return block((x - before, x + behind), (max(y - half - south, low), min(y + half + north, high)), height)


def _corner_cloud(rng: np.random.Generator) -> Box:
    """A cloud in the west or the east, anywhere."""
    x, y = (
        float(rng.uniform(17.0, 18.8) if rng.random() < 0.5 else rng.uniform(1.2, 4.6)),
        float(rng.uniform(1.2, 13.8)),
    )
    size = rng.uniform(2.0, 2.8, 2)
    return standing((x, y), (float(size[0]), float(size[1]), VOLUME.hi_m[2]), VOLUME)


def draw_fires(floor: Floor, smokes: tuple[Smoke, ...], rng: np.random.Generator) -> tuple[Solid, ...]:
    """One fire in or next to each cloud, where there is room for it; never so high that it cannot be flown over."""
    fires: list[Solid] = []
    for smoke in smokes:
        (x0, y0, _), (x1, y1, _) = smoke.extent_m.lo_m, smoke.extent_m.hi_m

        def draw(rng: np.random.Generator, spans: tuple[float, ...] = (x0, x1, y0, y1)) -> Box:
            centre = (
                float(rng.uniform(spans[0] - 0.8, spans[1] + 0.8)),
                float(rng.uniform(spans[2] - 0.8, spans[3] + 0.8)),
            )
            wide = float(rng.uniform(1.0, 1.4))
            return standing(centre, (wide, wide, float(rng.uniform(1.2, 1.6))), VOLUME)

        place = floor.place(rng, draw)
        if place is not None:
            fires.append(Solid(id=f"fire-{len(fires) + 1}", kind="fire", extent_m=place, shape=Shape.BOX))
    return tuple(fires)
