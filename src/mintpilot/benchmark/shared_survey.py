"""One survey for all methods that fly in the same world: paired to the last voxel, and far fewer pictures to draw."""

from __future__ import annotations

from copy import deepcopy
from dataclasses import replace

import numpy as np

from mintpilot.core.geometry import Floats
from mintpilot.core.semantic_map import SemanticMap
from mintpilot.mapping.builder import MapBuilder
from mintpilot.mission.components import MissionComponents
from mintpilot.mission.map_source import CameraMapSource, MapSource

HOME_M = 0.3
"""A survey that ended further than this from where simulators begin is not handed on, metres."""


class SharedSurvey:
    """The first method's survey of a world, handed on to the others with everything that the map is made from.

    The survey knows nothing of the method, so each would fly it alike; noise and gusts of the mission itself begin
    anew. Keep one for each world. It changes nothing for vehicles that are given their map.
    """

    def __init__(self) -> None:
        self._found: tuple[SemanticMap, MapBuilder] | None = None

    def shared(self, components: MissionComponents) -> MissionComponents:
        """The components with the survey that was flown before, or such that keep theirs for the next ones."""
        source = components.map_source
        if not (components.surveys and isinstance(source, CameraMapSource)):
            return components
        if self._found is not None:
            first, builder = self._found
            source.builder = deepcopy(builder)
            return replace(components, surveys=False, map_source=_Surveyed(source, first))

        def begin_task() -> None:
            away_m = np.subtract(components.vehicle.state().position_m, components.parts.mission.start_m)
            last = source.builder.last
            if last is not None and float(np.linalg.norm(away_m)) <= HOME_M:
                self._found = (last, deepcopy(source.builder))
            components.begin_task()

        return replace(components, begin_task=begin_task)


class _Surveyed(MapSource):
    """A source whose first map is there already; from then on it goes on as the one inside."""

    def __init__(self, source: CameraMapSource, first: SemanticMap) -> None:
        self._source, self._first = source, first
        self._begun = False

    def look(self) -> None:
        """See `MapSource.look`; the first look is not needed."""
        if self._begun:
            self._source.look()

    def draw(self, previous: SemanticMap | None) -> SemanticMap:
        """See `MapSource.draw`."""
        self._begun = True
        return self._first if previous is None else self._source.draw(previous)

    def flown(self, points_m: Floats, radius_m: float) -> None:
        """See `MapSource.flown`."""
        self._source.flown(points_m, radius_m)
