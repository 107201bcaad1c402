"""The way back: out of a place that turned out not to be known flyable, along the way the drone came."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from mintpilot.core.errors import InfeasibleError
from mintpilot.core.geometry import Floats
from mintpilot.core.plan import VehicleLimits
from mintpilot.core.semantic_map import Knowledge, SemanticMap
from mintpilot.core.trajectory import Trajectory, VehicleState
from mintpilot.planning.checks import check_trajectory
from mintpilot.planning.flyable import known_flyable
from mintpilot.planning.terrain import can_start
from mintpilot.planning.trajectory import plan_trajectory

LONGEST_M = 8.0
"""Further back than this the world may have changed as well."""
APART_M = 0.2
"""Way-points of the way back are about this far apart."""


def is_stranded(map: SemanticMap, limits: VehicleLimits, state: VehicleState) -> bool:
    """Whether no plan could start from where the drone is: a cloud was found around it, say."""
    return not can_start(map, limits, state.position_m)


def way_back(map: SemanticMap, limits: VehicleLimits, state: VehicleState, track_m: Floats) -> Trajectory | None:
    """The trajectory back along the track to the nearest known flyable place; None where there is none.

    Where the drone has just been it may be again: regions that were found around it since do not bar the way out of
    them. Voxels do, but the margin that plans keep from them may be used up.

    Args:
        map: what is known.
        limits: the vehicle.
        state: where it hovers.
        track_m: where it has been (n, 3), oldest first, metres.
    """
    flyable = known_flyable(map, limits)
    here = np.asarray(state.position_m, float)
    path, gone = [here], 0.0
    for point in track_m[::-1]:
        step = float(np.linalg.norm(point - path[-1]))
        if step < APART_M:
            continue
        gone += step
        if gone > LONGEST_M:
            return None
        path.append(point)
        z, y, x = map.frame.cells_of(point)[0]
        if bool(map.frame.contains([[z, y, x]])[0]) and flyable[z, y, x]:
            return _trajectory(map, limits, state, np.vstack(path))
    return None


def _trajectory(map: SemanticMap, limits: VehicleLimits, state: VehicleState, path_m: Floats) -> Trajectory | None:
    opened, limits = map, replace(limits, margin_m=0.0)
    for region in map.regions:
        opened = opened.with_region(region.id, Knowledge.YES)
    try:
        trajectory = plan_trajectory(path_m, map=opened, limits=limits, start_yaw_rad=state.yaw_rad)
    except InfeasibleError:
        return None
    return None if check_trajectory(trajectory, opened, limits) else trajectory
