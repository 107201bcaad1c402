"""Gaps that the map itself opens: regions that may be passable, rooms that may hold somebody (method, section 1)."""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence

import numpy as np

from mintpilot.core.gap import ABSENT, BLOCKED, PASSABLE, PRESENT, GapKind, KnowledgeGap, obstacle_id, presence_id
from mintpilot.core.geometry import Vec3
from mintpilot.core.plan import Site, Stop
from mintpilot.core.semantic_map import Knowledge, Region, Room, SemanticMap
from mintpilot.core.task import Action
from mintpilot.uncertainty.describing import place
from mintpilot.uncertainty.doubts import doubtful_people
from mintpilot.uncertainty.things import ROOM, Thing

LOOK_REACH_M = 0.5
"""A room is looked into from within this distance of its viewpoint, metres."""


def obstacle_gaps(
    map: SemanticMap, things: Sequence[Thing], *, prior_passable: float, leave_out: Collection[str] = ()
) -> list[KnowledgeGap]:
    """One gap for each region whose passability is open; regions without cells, and those left out by id, open none."""
    return [
        KnowledgeGap(
            id=obstacle_id(region.id),
            kind=GapKind.OBSTACLE,
            subject=region.id,
            description=region.description or _unnamed(f"the {region.kind}", region_middle_m(map, region), things),
            values=(PASSABLE, BLOCKED),
            prior=_two(prior_passable if region.prior_passable is None else region.prior_passable),
            position_m=region_middle_m(map, region),
            threshold=region.threshold,
        )
        for region in map.regions
        if region.passable is Knowledge.OPEN and region.cells.size and region.id not in leave_out
    ]


def presence_gaps(
    map: SemanticMap, things: Sequence[Thing], *, finished: Collection[str], looked_at: Collection[str]
) -> tuple[list[KnowledgeGap], list[Stop]]:
    """A gap and an optional stop for each room that may hold somebody and was not looked into.

    A room known to be occupied has a gap with the one value `PRESENT` left: its stop is needed for certain, still at
    whichever place in the order is shortest.

    Args:
        map: what is believed of the world.
        things: objects and rooms of the map, for landmarks.
        finished: ids of stops already fulfilled.
        looked_at: ids of rooms that the ordered stops look into anyway.
    """
    gaps, stops = [], []
    for room in sorted(map.rooms, key=lambda room: room.id):
        stop = _look(room)
        if room.searched or room.occupied is Knowledge.NO or room.id in looked_at or stop.id in finished:
            continue
        known = room.occupied is Knowledge.YES
        gaps.append(
            KnowledgeGap(
                id=stop.gap,
                kind=GapKind.PRESENCE,
                subject=room.id,
                description=room.description or _unnamed("the closed room", room.door_m.centre_m, things),
                values=(PRESENT,) if known else (PRESENT, ABSENT),
                prior=(1.0,) if known else _two(room.prior_occupied),
                position_m=room.door_m.centre_m,
            )
        )
        stops.append(stop)
    return gaps, stops


def people_gaps(
    map: SemanticMap, *, finished: Collection[str], bound: Collection[str]
) -> tuple[list[KnowledgeGap], list[Stop]]:
    """A gap and an optional stop for each thing that may be a person: it is asked about, or flown to.

    Args:
        map: what is believed of the world.
        finished: ids of stops already fulfilled.
        bound: ids of things that the ordered stops go to anyway.
    """
    gaps = [g for g in doubtful_people(map.objects) if look_id(g.subject) not in finished and g.subject not in bound]
    return gaps, [
        Stop(
            id=look_id(gap.subject),
            action=Action.GO,
            sites=(Site(position_m=gap.position_m, value=PRESENT, label=gap.subject),),
            gap=gap.id,
            optional=True,
        )
        for gap in gaps
    ]


def look_id(subject: str) -> str:
    """Id of the stop at which it is seen whether somebody is in a room, or whether a thing is somebody."""
    return f"look:{subject}"


def region_middle_m(map: SemanticMap, region: Region) -> Vec3:
    """Mean of the centres of a region's cells, metres."""
    cells = np.stack(np.unravel_index(region.cells, map.frame.shape), axis=1)
    x, y, z = map.frame.centres_of(cells).mean(axis=0)
    return (float(x), float(y), float(z))


def _look(room: Room) -> Stop:
    site = Site(position_m=room.viewpoint_m, reach_m=LOOK_REACH_M, value=PRESENT, label=room.id)
    return Stop(id=look_id(room.id), action=Action.LOOK, sites=(site,), gap=presence_id(room.id), optional=True)


def _two(first: float) -> tuple[float, float]:
    return (first, 1.0 - first)


def _unnamed(noun: str, at_m: Vec3, things: Sequence[Thing]) -> str:
    here = Thing(id="", label=ROOM, attributes=(), position_m=at_m, size_m=(0, 0, 0), goal_m=at_m)
    near = sorted((t for t in things if t.label != ROOM), key=lambda t: (math.dist(t.position_m, at_m), t.id))
    return noun + place(here, near)
