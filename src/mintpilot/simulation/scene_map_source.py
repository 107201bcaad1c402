"""The map of the kinematic drone: no pictures, but whatever comes near is noticed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from mintpilot.core.geometry import Floats
from mintpilot.core.semantic_map import SemanticMap
from mintpilot.core.trajectory import VehicleState
from mintpilot.simulation.scene import Scene
from mintpilot.simulation.scene_map import map_of_scene

RANGE_M = 6.0
"""How far the drone sees what has changed, metres."""


class SceneMapSource:
    """Turns what has come into the world within `RANGE_M` into a newer map; everything else stays as it was.

    Args:
        scene: the world.
        given: the first map, that of a perfect survey.
        state: where the drone is; its clock runs from the start of the mission.
    """

    def __init__(self, scene: Scene, given: SemanticMap, state: Callable[[], VehicleState]) -> None:
        self._scene = scene
        self._given = given
        self._state = state
        self._times = sorted({solid.appears_s for solid in scene.solids})

    def look(self) -> None:
        """There is no camera: what is near shows in `draw`."""

    def draw(self, previous: SemanticMap | None) -> SemanticMap:
        """The map after a look around; the first time the one that was given."""
        if previous is None:
            return self._given
        state = self._state()
        if len(self._times) < 2 or state.time_s < self._times[1]:
            return previous
        now = map_of_scene(self._scene, previous.frame.resolution_m, time_s=state.time_s)
        changed = np.argwhere(now.cells != previous.cells)
        if not len(changed):
            return previous
        distances = np.linalg.norm(previous.frame.centres_of(changed) - np.asarray(state.position_m), axis=1)
        near = tuple(changed[distances <= RANGE_M].T)
        cells = previous.cells.copy()
        cells[near] = now.cells[near]
        return replace(previous, cells=cells)

    def flown(self, points_m: Floats, radius_m: float) -> None:
        """Nothing is learnt from having been somewhere: the map is exact there."""
