"""One survey for all methods that fly in the same world: paired to the last voxel, and far fewer pictures to draw."""

from __future__ import annotations

from collections.abc import Callable
from copy import deepcopy

import numpy as np

from mintpilot.core.semantic_map import SemanticMap
from mintpilot.mapping.builder import MapBuilder
from mintpilot.mission.eyes import CameraEyes
from mintpilot.mission.loop import Crew
from mintpilot.simulation.mujoco_vehicle import MujocoSimulator

HOME_M = 0.3
"""A survey that ended further than this from where simulators begin is not handed on."""


class SharedSurvey:
    """The first method's survey of a world, handed on to the others with everything that the map is made from.

    The survey knows nothing of the method, so each would fly it alike; noise and gusts of the mission itself begin
    anew. Keep one for each world. It changes nothing for vehicles that are given their map.
    """

    def __init__(self) -> None:
        self._found: tuple[SemanticMap, MapBuilder] | None = None

    def survey_of(self, crew: Crew) -> Callable[[], SemanticMap]:
        """What to put in the place of `Crew.survey`."""
        vehicle, eyes = crew.vehicle, crew.eyes
        if not (isinstance(vehicle, MujocoSimulator) and isinstance(eyes, CameraEyes)):
            return crew.survey

        def fly_or_take_over() -> SemanticMap:
            if self._found is not None:
                first, builder = self._found
                eyes.builder = deepcopy(builder)
                vehicle.begin_mission()
                return first
            first = crew.survey()
            away_m = np.subtract(vehicle.state().position_m, crew.thinking.mission.start_m)
            if float(np.linalg.norm(away_m)) <= HOME_M:
                self._found = (first, deepcopy(eyes.builder))
            return first

        return fly_or_take_over
