"""Looking ahead in flight: is the way that is still to come known to be free?"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from mintpilot.core.geometry import Floats, Vec3
from mintpilot.core.plan import VehicleLimits
from mintpilot.core.semantic_map import SemanticMap
from mintpilot.planning.checks import check_path

NEAR_M = 3.0
"""Trouble nearer than this stops the drone at once: well above its braking distance."""
PATIENCE_LOOKS = 2
"""Trouble further off must be seen in this many looks in a row: single voxels flicker with the sensor's noise."""


class Lookout:
    """Watches one way.

    Args:
        way_m: points (n, 3) in the order in which they are passed, metres.
        limits: the vehicle. Its margin is for planning; what is flown already may use it up.
    """

    def __init__(self, way_m: Floats, limits: VehicleLimits) -> None:
        self._way = way_m
        self._limits = replace(limits, margin_m=0.0)
        self._passed = 0
        self._bad_looks = 0

    def trouble(self, position_m: Vec3, believed: SemanticMap) -> str:
        """Why the way ahead cannot be flown any more; empty while it can."""
        here = np.asarray(position_m)
        window = self._way[self._passed : self._passed + 400]
        self._passed += int(np.argmin(np.linalg.norm(window - here, axis=1)))
        ahead = self._way[self._passed + 1 :]
        if not len(ahead):
            return ""
        steps = np.linalg.norm(np.diff(np.vstack([here[None], ahead]), axis=0), axis=1)
        near = ahead[np.cumsum(steps) <= NEAR_M]
        close = check_path(near, believed, self._limits) if len(near) else ""
        far = close or check_path(ahead, believed, self._limits)
        self._bad_looks = self._bad_looks + 1 if far else 0
        return close or (far if self._bad_looks >= PATIENCE_LOOKS else "")
