"""Small maps for the tests of this room."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from mintpilot.core.geometry import Box, GridFrame, Vec3
from mintpilot.core.observation import Attribute, RegionKind
from mintpilot.core.semantic_map import Cell, Knowledge, MapObject, Region, Room, SemanticMap
from mintpilot.core.task import Action, Reference, SubGoal

FRAME = GridFrame(origin_m=(0.0, 0.0, 0.0), resolution_m=0.5, shape=(8, 30, 40))
START_M: Vec3 = (1.0, 7.5, 1.0)


def thing(name: str, label: str, at_m: Vec3, edge_m: float = 0.4, **attributes: str | Sequence[str]) -> MapObject:
    x, y, z = at_m
    half = edge_m / 2
    pairs = [
        Attribute(name=key, value=value)
        for key, values in attributes.items()
        for value in ([values] if isinstance(values, str) else values)
    ]
    box = Box(lo_m=(x - half, y - half, z - half), hi_m=(x + half, y + half, z + half))
    return MapObject(id=name, label=label, box_m=box, attributes=tuple(pairs))


def smoke(
    name: str, first: int, prior: float | None = None, passable: Knowledge = Knowledge.OPEN, words: str = ""
) -> Region:
    cells = np.arange(first, first + 4, dtype=np.int64)
    return Region(
        id=name, kind=RegionKind.SMOKE, cells=cells, passable=passable, prior_passable=prior, description=words
    )


def room(name: str, x_m: float, **known: object) -> Room:
    return Room(
        id=name,
        door_m=Box(lo_m=(x_m - 0.5, 13.0, 0.0), hi_m=(x_m + 0.5, 13.1, 2.0)),
        viewpoint_m=(x_m, 11.8, 1.4),
        **known,  # type: ignore[arg-type]
    )


def world(
    objects: Sequence[MapObject] = (), regions: Sequence[Region] = (), rooms: Sequence[Room] = (), flat: bool = False
) -> SemanticMap:
    frame = FRAME if not flat else GridFrame(origin_m=(0.0, 0.0, 0.0), resolution_m=0.5, shape=(1, 30, 40))
    cells = np.full(frame.shape, Cell.FREE, np.uint8)
    return SemanticMap(frame=frame, cells=cells, objects=tuple(objects), regions=tuple(regions), rooms=tuple(rooms))


def step(action: Action, phrase: str, label: str = "", **attributes: str) -> SubGoal:
    pairs = tuple(Attribute(name=key, value=value) for key, value in attributes.items())
    return SubGoal(action=action, reference=Reference(phrase=phrase, label=label, attributes=pairs))
