"""Straight ways that keep their clearance, the shortcut of a path along them, and the heading of a motion."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from mintpilot.core.compiled import compiled
from mintpilot.core.geometry import Bools, Floats, Ints
from mintpilot.core.plan import VehicleLimits
from mintpilot.core.semantic_map import SemanticMap
from mintpilot.planning.clearance import TOLERANCE_M, first_near, surroundings
from mintpilot.planning.flyable import squared_gaps

SPACING_M = 0.25
"""Greatest distance between places at which a shortcut may begin or end, metres; in fine cells half an edge."""


class Sight:
    """Straight lines along which the body keeps its clearance from all that is not known passable, exactly.

    Args:
        map: what is known.
        limits: the vehicle.
        around_m: points (n, 3), metres; all lines that are asked for lie in their bounding box.
    """

    def __init__(self, map: SemanticMap, limits: VehicleLimits, around_m: Floats) -> None:
        self._near = surroundings(map, around_m, limits.clearance_m - TOLERANCE_M / 2)
        self._window = int(np.ceil(self._near.keep + 0.5))
        self._gaps = squared_gaps(self._near.barred, self._window)

    def clear(self, a_m: Floats, b_m: Floats) -> bool:
        """Whether the line from a to b (3,) keeps the clearance; a line without length is its point."""
        return not self.blocked_pieces(np.stack([a_m, b_m]))[0]

    def blocked_pieces(self, points_m: Floats) -> Bools:
        """For the polyline (n, 3): which of its n - 1 pieces come too near to something."""
        near = self._near
        blocked: Bools = _blocked_pieces(near.barred, self._gaps, near.spots(points_m), near.keep, self._window)
        return blocked

    def shortcut(self, path_m: Floats) -> Floats:
        """The path (n, 3) with every detour cut that a clear line makes needless; ends and clearness are kept.

        Twice: the second pass starts from points closer together, so that corners need not be way-points of the path.
        """
        once = path_m[self._farthest_visible(path_m)]
        dense = densified(once, min(self._near.frame.resolution_m / 2, SPACING_M))
        return np.asarray(dense[self._farthest_visible(dense)])

    def _farthest_visible(self, points_m: Floats) -> Ints:
        near = self._near
        found: Ints = _farthest_visible(near.barred, self._gaps, near.spots(points_m), near.keep, self._window)
        return found


def heading(
    velocity_mps: Floats, *, start_rad: float, end_rad: float | None, step_s: float, rate_rad_s: float
) -> Floats:
    """Heading along the motion, turning at most at the given rate.

    Args:
        velocity_mps: (n, 3), one row per step. Where it has (almost) no horizontal part the heading is kept.
        start_rad: heading of the first sample.
        end_rad: heading of the last sample; None: the last of the motion.
        step_s: time between samples.
        rate_rad_s: limit of the rate.

    Returns:
        Headings (m,), continuous; more than n where turning to the end takes longer than the motion.
    """
    moving = np.hypot(velocity_mps[:, 0], velocity_mps[:, 1]) > 0.2
    wanted = np.where(moving, np.arctan2(velocity_mps[:, 1], velocity_mps[:, 0]), np.nan)
    return np.asarray(_turn(wanted, start_rad, np.nan if end_rad is None else end_rad, step_s * rate_rad_s))


def densified(points_m: Floats, spacing_m: float) -> Floats:
    """The polyline (n, 3), n at least 1, with points no further apart than that, metres."""
    parts = [points_m[:1]]
    for a, b in pairwise(points_m):
        count = max(1, int(np.ceil(np.linalg.norm(b - a) / spacing_m)))
        parts.append(a + (b - a) * (np.arange(1, count + 1) / count)[:, None])
    return np.concatenate(parts)


@compiled(error_model="numpy")
def _line_clear(barred: Bools, gaps: NDArray[np.uint32], a: Floats, b: Floats, keep: float, window: int) -> bool:
    """Looks at parts of at most one cell's edge. Most need no exact test: a cell's centre is known to be far enough
    from, or too near to, what is barred.
    """
    d = b - a
    length = np.sqrt((d * d).sum())
    parts = max(1, int(np.ceil(length)))
    d = d / parts
    for part in range(parts):
        begin = a + d * part
        x, y, z = begin[0] + 0.5 * d[0], begin[1] + 0.5 * d[1], begin[2] + 0.5 * d[2]
        i, j, k = int(np.floor(x)), int(np.floor(y)), int(np.floor(z))
        if not (0 <= k < gaps.shape[0] and 0 <= j < gaps.shape[1] and 0 <= i < gaps.shape[2]):
            return False
        off = np.sqrt((x - i - 0.5) ** 2 + (y - j - 0.5) ** 2 + (z - k - 0.5) ** 2)
        gap = 0.5 * np.sqrt(float(gaps[k, j, i]))
        if gap + off < keep:
            return False
        if min(gap, window + 0.5) - off - 0.5 * length / parts >= keep:
            continue
        if first_near(barred, begin, d, keep)[2] >= 0:
            return False
    return True


@compiled(error_model="numpy")
def _blocked_pieces(barred: Bools, gaps: NDArray[np.uint32], points: Floats, keep: float, window: int) -> Bools:
    blocked = np.zeros(max(len(points) - 1, 0), np.bool_)
    for i in range(len(blocked)):
        blocked[i] = not _line_clear(barred, gaps, points[i], points[i + 1], keep, window)
    return blocked


@compiled(error_model="numpy")
def _farthest_visible(barred: Bools, gaps: NDArray[np.uint32], points: Floats, keep: float, window: int) -> Ints:
    """Indices of the points kept when each is followed by the farthest one that it sees."""
    kept = [0]
    here = 0
    while here < len(points) - 1:
        there = len(points) - 1
        while there > here + 1 and not _line_clear(barred, gaps, points[here], points[there], keep, window):
            there -= 1
        kept.append(there)
        here = there
    return np.array(kept)


@compiled()
def _turn(wanted: Floats, start: float, end: float, most: float) -> Floats:
    full = 2 * np.pi
    n = len(wanted)
    target = start
    targets = np.empty(n)
    for i in range(n):
        if not np.isnan(wanted[i]):
            target += (wanted[i] - target + np.pi) % full - np.pi
        targets[i] = target
    if not np.isnan(end):  # the nearest full turn, and a cone that leaves time to get there
        end = target + (end - target + np.pi) % full - np.pi
        for i in range(n):
            spare = most * (n - 1 - i)
            targets[i] = min(max(targets[i], end - spare), end + spare)
    yaw = [start]
    for i in range(1, n):
        yaw.append(yaw[-1] + min(max(targets[i] - yaw[-1], -most), most))
    while not np.isnan(end) and yaw[-1] != end:
        yaw.append(yaw[-1] + min(max(end - yaw[-1], -most), most))
    return np.array(yaw)
