"""The double's fence: what was uploaded, and whether a place lies inside."""

from __future__ import annotations

import math
from dataclasses import dataclass

from mintpilot.conformance.vehicle_double.body import Ned

HOME_DEG, HOME_ALTITUDE_M = (47.397742, 8.545594), 488.0
"""Where the double stands on the earth."""
METRES_A_DEGREE = 111_319.5
ORIGIN_M: Ned = (1.5, -2.0, 0.25)
"""Where the origin of its local frame lies from home: it was set where it first knew its place, not where it stands."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Fence:
    """A polygon to stay in, and a height to stay below."""

    corners_m: tuple[tuple[float, float], ...] = ()
    """North and east from home; none: there is no polygon."""

    def holds(self, place: Ned, top_m: float) -> bool:
        """Whether it lies inside; ``top_m``: the height, 0 for none."""
        north, east, down = place
        if top_m > 0 and -down > top_m:
            return False
        if not self.corners_m:
            return True
        inside = False
        for (n0, e0), (n1, e1) in zip(self.corners_m, (*self.corners_m[1:], self.corners_m[0]), strict=True):
            if (e0 > east) != (e1 > east) and north < (n1 - n0) * (east - e0) / (e1 - e0) + n0:
                inside = not inside
        return inside


def fence_of(corners: list[tuple[int, int]]) -> Fence:
    """The fence with these corners, latitude and longitude in 1e-7 degrees."""
    return Fence(corners_m=tuple(_local(latitude / 1e7, longitude / 1e7) for latitude, longitude in corners))


def _local(latitude: float, longitude: float) -> tuple[float, float]:
    east_scale = METRES_A_DEGREE * math.cos(math.radians(HOME_DEG[0]))
    return (latitude - HOME_DEG[0]) * METRES_A_DEGREE, (longitude - HOME_DEG[1]) * east_scale
