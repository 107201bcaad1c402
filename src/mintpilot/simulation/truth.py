"""The truth about a scene, for scripted operators and for scoring; never used to plan."""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np

from mintpilot.core.gap import (
    ABSENT,
    BLOCKED,
    NONE_OF_THEM,
    NOT_HERE,
    PASSABLE,
    PRESENT,
    Candidate,
    GapKind,
    KnowledgeGap,
)
from mintpilot.core.geometry import Box, Vec3
from mintpilot.core.ports import TruthOracle
from mintpilot.simulation.scene import Scene

TOLERANCE_M = 1.5
"""What the drone speaks of lies at most this far from the thing itself; otherwise nothing is there."""

ZONE_M = 8.0
"""What was not seen lies at most this far from the viewpoint of its zone, metres."""

BODY_M = 1.0
"""What is taken for a person is one if somebody's middle is nearer on the ground, metres."""


def distance_m(point_m: Vec3, box: Box) -> float:
    """From a point to a box, metres; 0 inside."""
    nearest = np.clip(point_m, box.lo_m, box.hi_m)
    return float(np.linalg.norm(nearest - np.asarray(point_m)))


class SceneTruth(TruthOracle):
    """Answers by geometry: ids of the map need not be those of the scene.

    * Obstacle gap: the nearest cloud says whether it is toxic; without a cloud nearby, a solid or a shut door there
      means blocked.
    * Presence gap: the nearest closed room says whether somebody is inside; of a thing, whether somebody is there.
    * Target gap: the candidate at the first of `Scene.goal_objects` that is among the candidates; without one, the
      candidate at a person who must be found; where the phrase may mean none of them, and none is there, that. Of zones
      of unseen space, the one nearest to what is sought.

    Args:
        scene: the world.
        tolerance_m: how far the drone's idea of a place may be off, metres.
    """

    def __init__(self, scene: Scene, *, tolerance_m: float = TOLERANCE_M) -> None:
        self._scene = scene
        self._tolerance_m = tolerance_m

    def value_of(self, gap: KnowledgeGap) -> str | None:
        """The true value of the gap; None where nothing of the kind is within the tolerance."""
        match gap.kind:
            case GapKind.OBSTACLE:
                value = self._passable(gap.position_m)
            case GapKind.PRESENCE:
                value = self._is_somebody(gap.position_m) if gap.is_thing else self._occupied(gap.position_m)
            case GapKind.TARGET:
                value = self._zone(gap.candidates) if gap.is_search else self._meant(gap.candidates)
            case GapKind.VALUE | GapKind.GO:
                value = None
        return value if value in gap.values else None

    def _passable(self, position_m: Vec3) -> str | None:
        near = self._nearest(position_m, ((s.toxic, s.extent_m) for s in self._scene.smokes))
        if near is not None:
            return BLOCKED if near else PASSABLE
        shut = [s.extent_m for s in self._scene.solids] + [r.door_m for r in self._scene.rooms]
        return BLOCKED if self._nearest(position_m, ((True, box) for box in shut)) else None

    def _occupied(self, position_m: Vec3) -> str | None:
        rooms = ((r.occupant is not None, r.door_m) for r in self._scene.rooms)
        near = self._nearest(position_m, rooms)
        return None if near is None else PRESENT if near else ABSENT

    def _is_somebody(self, position_m: Vec3) -> str:
        near = (math.dist(position_m[:2], p.position_m[:2]) < BODY_M for p in self._scene.persons)
        return PRESENT if any(near) else ABSENT

    def _nearest(self, position_m: Vec3, things: Iterable[tuple[bool, Box]]) -> bool | None:
        """The flag of the nearest box within the tolerance; a tie goes to the one with the nearer middle."""
        ranked = [
            (distance_m(position_m, box), math.dist(position_m, box.centre_m), flag)
            for flag, box in things
            if distance_m(position_m, box) <= self._tolerance_m
        ]
        return min(ranked)[2] if ranked else None

    def _meant(self, candidates: tuple[Candidate, ...]) -> str | None:
        stands_for = {c.id: self._thing_at(c.position_m) for c in candidates}
        persons = [*self._scene.persons, *(r.occupant for r in self._scene.rooms if r.occupant is not None)]
        wanted = [*self._scene.goal_objects, *(p.id for p in persons if p.must_be_found)]
        places = dict(self._places())
        for name in wanted:
            found = [c for c in candidates if stands_for[c.id] == name]
            if found:
                return min(found, key=lambda c: (math.dist(c.position_m, places[name]), c.id)).id
        return NONE_OF_THEM if wanted else None

    def _zone(self, zones: tuple[Candidate, ...]) -> str | None:
        """The zone of unseen space whose viewpoint is nearest to somebody who must be found in the open, or to a goal.

        `NOT_HERE` where there is nothing to be found in the open; None where it is far from all zones.
        """
        wanted = {*self._scene.goal_objects, *(p.id for p in self._scene.persons if p.must_be_found)}
        places = [place for name, place in self._places() if name in wanted]
        away = [(math.dist(zone.position_m, place), zone.id) for zone in zones for place in places]
        near = [entry for entry in away if entry[0] <= ZONE_M]
        return min(near)[1] if near else None if places else NOT_HERE

    def _places(self) -> list[tuple[str, Vec3]]:
        """Middles of all things and persons."""
        persons = [*self._scene.persons, *(r.occupant for r in self._scene.rooms if r.occupant is not None)]
        return [*((s.id, s.extent_m.centre_m) for s in self._scene.solids), *((p.id, p.position_m) for p in persons)]

    def _thing_at(self, position_m: Vec3) -> str | None:
        """Id of the solid or person whose middle is nearest, within the tolerance."""
        ranked = [(math.dist(position_m, place), name) for name, place in self._places()]
        near = [entry for entry in ranked if entry[0] <= self._tolerance_m]
        return min(near)[1] if near else None
