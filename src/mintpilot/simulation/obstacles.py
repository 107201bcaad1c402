"""When and where a drone's hull touches the solids of a scene, by geometry alone."""

from __future__ import annotations

import math

import numpy as np

from mintpilot.core.compiled import compiled
from mintpilot.core.geometry import Box, Floats, Ints
from mintpilot.simulation.scene import FlightRules, Person, Scene, Shape, Solid

_PERSON_RADIUS_M = 0.3
_PERSON_HEIGHT_M = 0.3
_SHAPES = {Shape.BOX: 0, Shape.CYLINDER: 1, Shape.SPHERE: 2}


class Obstacles:
    """All that can be touched: solids, rooms (shut, hence solid), people, and the building's side walls.

    The hull is an upright cylinder as the rules say. People are three flat cylinders along the body. Floor and roof are
    left to the flight volume.
    """

    def __init__(self, scene: Scene, rules: FlightRules) -> None:
        solids = [*scene.solids, *_rooms(scene), *_people(scene), *_walls(scene.volume)]
        self._names = [s.id for s in solids]
        self._shape: Ints = np.array([_SHAPES[s.shape] for s in solids], np.int64)
        self._lo: Floats = np.array([s.extent_m.lo_m for s in solids], float)
        self._hi: Floats = np.array([s.extent_m.hi_m for s in solids], float)
        # Those that stand from the start do so during the survey, too, when the mission's clock is below 0.
        self._appears: Floats = np.array([s.appears_s if s.appears_s > 0 else -math.inf for s in solids], float)
        self._hull = rules.radius_m, rules.half_height_m

    def first_touch(self, position_m: Floats, mission_s: Floats) -> tuple[int, str] | None:
        """The first sample at which the hull touches something, and what.

        Args:
            position_m: (n, 3) positions of the hull's centre.
            mission_s: (n,) seconds of mission flight.
        """
        radius, half_height = self._hull
        spare = np.array([radius, radius, half_height])
        low, high = position_m.min(axis=0) - spare, position_m.max(axis=0) + spare
        near = np.flatnonzero(((self._hi >= low) & (self._lo <= high)).all(axis=1))
        if not len(near):
            return None
        sample, which = _first_touch(
            np.ascontiguousarray(position_m),
            np.ascontiguousarray(mission_s),
            self._shape[near],
            self._lo[near],
            self._hi[near],
            self._appears[near],
            radius,
            half_height,
        )
        return (int(sample), self._names[near[which]]) if sample >= 0 else None


def _rooms(scene: Scene) -> list[Solid]:
    return [Solid(id=room.id, kind="room", extent_m=room.extent_m) for room in scene.rooms]


def _people(scene: Scene) -> list[Solid]:
    parts = []
    for person in scene.persons:
        parts += [_body_part(person, along) for along in (-0.6, 0.0, 0.6)]
    return parts


def _body_part(person: Person, along_m: float) -> Solid:
    x = person.position_m[0] + along_m * math.cos(person.yaw_rad)
    y = person.position_m[1] + along_m * math.sin(person.yaw_rad)
    r, z = _PERSON_RADIUS_M, person.position_m[2]
    extent = Box(lo_m=(x - r, y - r, z), hi_m=(x + r, y + r, z + _PERSON_HEIGHT_M))
    return Solid(id=person.id, kind="person", extent_m=extent, shape=Shape.CYLINDER)


def _walls(volume: Box, thickness_m: float = 10.0) -> list[Solid]:
    """Four walls around the volume, thick enough that nothing jumps them."""
    (x0, y0, z0), (x1, y1, z1) = volume.lo_m, volume.hi_m
    t = thickness_m
    sides = (
        ((x0 - t, y0 - t), (x0, y1 + t)),
        ((x1, y0 - t), (x1 + t, y1 + t)),
        ((x0, y0 - t), (x1, y0)),
        ((x0, y1), (x1, y1 + t)),
    )
    return [Solid(id="outer wall", kind="wall", extent_m=Box(lo_m=(*lo, z0), hi_m=(*hi, z1))) for lo, hi in sides]


@compiled()
def _first_touch(
    position: Floats,
    mission_s: Floats,
    shape: Ints,
    lo: Floats,
    hi: Floats,
    appears: Floats,
    radius: float,
    half_height: float,
) -> tuple[int, int]:
    for i in range(len(position)):
        x, y, z = position[i]
        for k in range(len(shape)):
            if mission_s[i] < appears[k]:
                continue
            if shape[k] == 2:
                r = 0.5 * min(hi[k, 0] - lo[k, 0], hi[k, 1] - lo[k, 1], hi[k, 2] - lo[k, 2])
                side = max(np.hypot(x - 0.5 * (lo[k, 0] + hi[k, 0]), y - 0.5 * (lo[k, 1] + hi[k, 1])) - radius, 0.0)
                up = max(abs(z - 0.5 * (lo[k, 2] + hi[k, 2])) - half_height, 0.0)
                if side * side + up * up < r * r:
                    return i, k
                continue
            if max(lo[k, 2] - z, z - hi[k, 2]) >= half_height:
                continue
            if shape[k] == 1:
                r = 0.5 * min(hi[k, 0] - lo[k, 0], hi[k, 1] - lo[k, 1])
                side = np.hypot(x - 0.5 * (lo[k, 0] + hi[k, 0]), y - 0.5 * (lo[k, 1] + hi[k, 1])) - r
            else:
                side = np.hypot(max(lo[k, 0] - x, 0.0, x - hi[k, 0]), max(lo[k, 1] - y, 0.0, y - hi[k, 1]))
            if side < radius:
                return i, k
    return -1, -1
