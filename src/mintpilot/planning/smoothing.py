"""Line of sight through cells, the shortcut of a path along it, and a heading that turns no faster than allowed."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from mintpilot.core.compiled import compiled
from mintpilot.core.geometry import Bools, Floats, GridFrame, Ints

BORDER_CELLS = 1e-6
"""A point this near to the border of two cells (in cells) belongs to either; shorter passages do not count."""


class Sight:
    """Straight lines through the allowed cells of a lattice, exactly: every cell that a line passes through counts."""

    def __init__(self, allowed: Bools, frame: GridFrame) -> None:
        self._allowed = np.ascontiguousarray(allowed)
        self._origin = np.asarray(frame.origin_m, float)
        self._resolution = frame.resolution_m

    def clear(self, a_m: Floats, b_m: Floats) -> bool:
        """Whether the line from a to b (3,) passes through allowed cells only; a line without length is its point."""
        return bool(_line_clear(self._allowed, self._cells(a_m), self._cells(b_m)))

    def blocked_pieces(self, points_m: Floats) -> Bools:
        """For the polyline (n, 3): which of its n - 1 pieces leave the allowed cells."""
        blocked: Bools = _blocked_pieces(self._allowed, self._cells(points_m))
        return blocked

    def shortcut(self, path_m: Floats) -> Floats:
        """The path (n, 3) with every detour cut that a clear line makes needless; ends and clearness are kept.

        Twice: the second pass starts from points half a cell apart, so that corners need not be way-points of the path.
        """
        once = path_m[_farthest_visible(self._allowed, self._cells(path_m))]
        dense = _densified(once, self._resolution / 2)
        return np.asarray(dense[_farthest_visible(self._allowed, self._cells(dense))])

    def _cells(self, points_m: Floats) -> Floats:
        return np.asarray((points_m - self._origin) / self._resolution, float)


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


def _densified(points_m: Floats, spacing_m: float) -> Floats:
    parts = [points_m[:1]]
    for a, b in pairwise(points_m):
        count = max(1, int(np.ceil(np.linalg.norm(b - a) / spacing_m)))
        parts.append(a + (b - a) * (np.arange(1, count + 1) / count)[:, None])
    return np.concatenate(parts)


@compiled()
def _point_clear(allowed: Bools, x: float, y: float, z: float) -> bool:
    nz, ny, nx = allowed.shape
    for k in range(int(np.floor(z - BORDER_CELLS)), int(np.floor(z + BORDER_CELLS)) + 1):
        for j in range(int(np.floor(y - BORDER_CELLS)), int(np.floor(y + BORDER_CELLS)) + 1):
            for i in range(int(np.floor(x - BORDER_CELLS)), int(np.floor(x + BORDER_CELLS)) + 1):
                if 0 <= k < nz and 0 <= j < ny and 0 <= i < nx and allowed[k, j, i]:
                    return True
    return False


@compiled()
def _line_clear(allowed: Bools, a: Floats, b: Floats) -> bool:
    """Steps from border to border (Amanatides and Woo) and looks at the middle of each passage."""
    d = b - a
    length = np.sqrt((d * d).sum())
    if length <= BORDER_CELLS:
        return _point_clear(allowed, a[0], a[1], a[2])
    crossing = np.full(3, np.inf)
    spacing = np.full(3, np.inf)
    for axis in range(3):
        if abs(d[axis]) > 1e-12:
            border = np.floor(a[axis]) + 1 if d[axis] > 0 else np.ceil(a[axis]) - 1
            crossing[axis] = (border - a[axis]) / d[axis]
            spacing[axis] = 1 / abs(d[axis])
    t = 0.0
    while t < 1.0:
        following = min(1.0, crossing.min())
        if (following - t) * length > BORDER_CELLS:
            m = a + d * (0.5 * (t + following))
            if not _point_clear(allowed, m[0], m[1], m[2]):
                return False
        for axis in range(3):
            if crossing[axis] <= following:
                crossing[axis] += spacing[axis]
        t = following
    return True


@compiled()
def _blocked_pieces(allowed: Bools, points: Floats) -> Bools:
    blocked = np.zeros(max(len(points) - 1, 0), np.bool_)
    for i in range(len(blocked)):
        blocked[i] = not _line_clear(allowed, points[i], points[i + 1])
    return blocked


@compiled()
def _farthest_visible(allowed: Bools, points: Floats) -> Ints:
    """Indices of the points kept when each is followed by the farthest one that it sees."""
    kept = [0]
    here = 0
    while here < len(points) - 1:
        there = len(points) - 1
        while there > here + 1 and not _line_clear(allowed, points[here], points[there]):
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
