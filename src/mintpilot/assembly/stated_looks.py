"""Looks that a mission file states: in the kinematic simulator, standing there settles what they are about."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from mintpilot.assembly.worlds import World
from mintpilot.core.gap import PASSABLE, region_of
from mintpilot.core.geometry import Floats
from mintpilot.core.plan import Look
from mintpilot.core.semantic_map import Knowledge, SemanticMap
from mintpilot.core.trajectory import VehicleState
from mintpilot.mission.map_source import MapSource
from mintpilot.uncertainty.findings import find_gaps

NEAR_M = 0.75
"""A look is taken within this distance of its viewpoint, metres."""
SLOW_MPS = 0.2
"""Slower than this, metres per second, the drone stands."""


class StatedLooks(MapSource):
    """Draws what was looked at as it is, with the probability that the look sees it; each look is tried once.

    Args:
        source: makes the map.
        looks: those that the mission states.
        truth: the true value of a gap by its id; None where nobody knows.
        state: where the drone is.
        rng: draws whether a look sees.
    """

    def __init__(
        self,
        source: MapSource,
        looks: tuple[Look, ...],
        truth: Callable[[str], str | None],
        state: Callable[[], VehicleState],
        rng: np.random.Generator,
    ) -> None:
        self._source, self._truth, self._state, self._rng = source, truth, state, rng
        self._left = list(looks)
        self._seen: dict[str, Knowledge] = {}

    def look(self) -> None:
        """See `MapSource.look`."""
        self._source.look()
        here = self._state()
        if math.hypot(*here.velocity_mps) > SLOW_MPS:
            return
        for one in [x for x in self._left if math.dist(x.viewpoint_m, here.position_m) <= NEAR_M]:
            self._left.remove(one)
            value = self._truth(one.gap)
            if value is not None and self._rng.random() < one.sees:
                self._seen[region_of(one.gap)] = Knowledge.YES if value == PASSABLE else Knowledge.NO

    def draw(self, previous: SemanticMap | None) -> SemanticMap:
        """See `MapSource.draw`."""
        newer = self._source.draw(previous)
        seen, self._seen = self._seen, {}  # told once: from then on the mission keeps it, and lets it age
        for region, known in seen.items():
            if any(one.id == region and one.passable is Knowledge.OPEN for one in newer.regions):
                newer = newer.with_region(region, known)
        return newer

    def flown(self, points_m: Floats, radius_m: float) -> None:
        """See `MapSource.flown`."""
        self._source.flown(points_m, radius_m)


def with_stated_looks(source: MapSource, world: World, state: Callable[[], VehicleState]) -> MapSource:
    """The source with what the looks of the world's mission show; ``state`` says where the drone is."""
    rng = np.random.default_rng([world.seed, 13])
    return StatedLooks(source, world.mission.looks, _truths(world).get, state, rng)


def settled_looks(world: World, *, kinematic: bool) -> tuple[Look, ...]:
    """Those of the mission's looks that something settles.

    Args:
        world: with the mission.
        kinematic: whether the kinematic simulator flies it, which knows how what is looked at truly is, where anybody
            does. Neither a rendered camera nor a real vehicle tells whether a region is passable.
    """
    if not kinematic or not world.mission.looks:
        return ()
    truths = _truths(world)
    return tuple(look for look in world.mission.looks if truths.get(look.gap) is not None)


def _truths(world: World) -> dict[str, str | None]:
    gaps = find_gaps(world.map, world.task, start_m=world.mission.start_m).gaps
    return {gap.id: world.truth.value_of(gap) for gap in gaps}
