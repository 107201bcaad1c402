"""Watching the path that is being flown: is what is still to come known to be free?"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from mintpilot.core.geometry import Floats, Vec3
from mintpilot.core.message import Message
from mintpilot.core.plan import VehicleLimits
from mintpilot.core.semantic_map import Knowledge, SemanticMap
from mintpilot.planning.checks import check_path

NEAR_M = 3.0
"""An obstruction nearer than this counts at once, metres: well above the braking distance."""
CONFIRMING_LOOKS = 2
"""One further off must be seen in this many maps in a row: single voxels flicker with the sensor's noise."""
_WINDOW = 400
"""The vehicle is looked for among so many of the next way-points."""


class PathMonitor:
    """Assesses one path again and again while it is flown.

    Args:
        path_m: points (n, 3) in the order in which they are passed, metres.
        limits: the vehicle. Its margin is for planning; what is flown already may use it up.
        assume_passable: ids of regions that a deliberately unsafe baseline flies through; empty for all others.
    """

    def __init__(self, path_m: Floats, limits: VehicleLimits, assume_passable: frozenset[str] = frozenset()) -> None:
        self._path = path_m
        self._limits = replace(limits, margin_m=0.0)
        self._assume_passable = assume_passable
        self._passed = 0
        self._bad_looks = 0

    def assess(self, map: SemanticMap, position_m: Vec3) -> Message:
        """Why the path ahead of that position cannot be flown any more on this map; empty while it can."""
        here = np.asarray(position_m)
        window = self._path[self._passed : self._passed + _WINDOW]
        self._passed += int(np.argmin(np.linalg.norm(window - here, axis=1)))
        ahead = self._path[self._passed + 1 :]
        if not len(ahead):
            return Message()
        map = with_passable(map, self._assume_passable)
        steps = np.linalg.norm(np.diff(np.vstack([here[None], ahead]), axis=0), axis=1)
        near = ahead[np.cumsum(steps) <= NEAR_M]
        close = check_path(near, map, self._limits) if len(near) else Message()
        far = close or check_path(ahead, map, self._limits)
        self._bad_looks = self._bad_looks + 1 if far else 0
        return close or (far if self._bad_looks >= CONFIRMING_LOOKS else Message())


def with_passable(map: SemanticMap, regions: frozenset[str]) -> SemanticMap:
    """The map with these regions taken as passable: for baselines that are unsafe on purpose, in a simulator."""
    for region in regions:
        map = map.with_region(region, Knowledge.YES)
    return map
