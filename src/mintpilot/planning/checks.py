"""The last gate before anything is flown: does the body keep its clearance everywhere on the way?

Called by the loop for every plan and every trajectory, whoever made it. It shares the exact distances of
`mintpilot.planning.clearance` with the making of trajectories, and nothing else: no search, no field of distances.
"""

from __future__ import annotations

import numpy as np

from mintpilot.core.geometry import Floats
from mintpilot.core.message import Message, message, verbatim
from mintpilot.core.plan import VehicleLimits
from mintpilot.core.semantic_map import Cell, Knowledge, SemanticMap
from mintpilot.core.trajectory import Trajectory
from mintpilot.planning.clearance import TOLERANCE_M, Surroundings, surroundings

START_SLACK_M = 0.5
"""Length of the way, metres, on which a flight that begins too near to something may leave it (take-off beside it)."""
_STRAIGHT_M = 0.01


def check_path(path_m: Floats, map: SemanticMap, limits: VehicleLimits) -> Message:
    """Whether a vehicle may fly along the straight pieces of this path.

    Everywhere on the way its centre must be at least `VehicleLimits.clearance_m` away from every cell that is occupied
    or unknown, from every region that is not `Knowledge.YES`, and from the grid's border. The beginning is excepted:
    within `START_SLACK_M` of the start it may be nearer, as long as the way is straight, outside of all these, and
    never nearer than the start itself.

    Args:
        path_m: points (n, 3), metres.
        map: what is known.
        limits: size of the vehicle.

    Returns:
        The empty message when all is well; else a plain sentence, without a full stop, saying what is wrong and where.
    """
    points = np.asarray(path_m, float)
    if points.ndim != 2 or points.shape[1:] != (3,) or len(points) == 0:
        return verbatim(f"the path has shape {points.shape} instead of (n, 3) with n at least 1")
    if not np.isfinite(points).all():
        return verbatim(f"way-point {int(np.argmin(np.isfinite(points).all(axis=1)))} is not a finite number")
    box = map.frame.box
    inside = ((points >= np.asarray(box.lo_m) - TOLERANCE_M) & (points <= np.asarray(box.hi_m) + TOLERANCE_M)).all(
        axis=1
    )
    if not inside.all():
        return message("at {at} the way leaves the map", at=_at(points[int(np.argmin(inside))]))
    near = surroundings(map, points, limits.clearance_m)
    points, piece = first_breach(points, near)
    return Message() if piece < 0 else _sentence(points[piece], points[min(piece + 1, len(points) - 1)], map, near)


def check_trajectory(trajectory: Trajectory, map: SemanticMap, limits: VehicleLimits) -> Message:
    """Whether a vehicle may fly this trajectory: `check_path` for the pieces between its samples.

    Returns:
        The empty message when all is well; else a plain sentence, without a full stop, saying what is wrong and where.
    """
    time, position = np.asarray(trajectory.time_s), np.asarray(trajectory.position_m)
    if time.ndim != 1 or len(time) != len(position):
        return verbatim(f"the trajectory has {time.shape} times for positions of shape {position.shape}")
    if not np.isfinite(time).all() or (np.diff(time) <= 0).any():
        return verbatim("the trajectory's times do not ascend")
    return check_path(position, map, limits)


def first_breach(points_m: Floats, near: Surroundings) -> tuple[Floats, int]:
    """The first piece of a path that comes too near to something and is not excepted as its beginning.

    Returns:
        (the points (m, 3), one more than given where a piece was cut at the end of the beginning; number of the piece,
        -1 where all is well).
    """
    rounding = TOLERANCE_M / near.frame.resolution_m
    least = near.keep - rounding
    gaps = near.least_gaps(points_m)
    if (gaps >= least).all():
        return points_m, -1
    start_gap = float(near.least_gaps(points_m[:1])[0])
    if rounding < start_gap < least:
        points_m, beginning = _cut(points_m)
        gaps = near.least_gaps(points_m)
        wanted = np.full(len(gaps), least)
        wanted[:beginning] = max(start_gap - rounding, rounding)
        short = np.flatnonzero(gaps < least)
        if (gaps >= wanted).all() and _is_straight(points_m[: short[-1] + 2]):
            return points_m, -1
    return points_m, int(np.argmax(gaps < least))


def _cut(points: Floats) -> tuple[Floats, int]:
    """The path with a point where it first is `START_SLACK_M` from its start, and the number of pieces before that."""
    away = np.linalg.norm(points - points[0], axis=1)
    beyond = np.flatnonzero(away > START_SLACK_M)
    if not len(beyond):
        return points, len(points) - 1
    last = int(beyond[0])
    a, d = points[last - 1] - points[0], points[last] - points[last - 1]
    b, c = float(a @ d), float(a @ a) - START_SLACK_M**2
    share = (-b + np.sqrt(max(b * b - float(d @ d) * c, 0.0))) / float(d @ d)
    point = points[last - 1] + min(max(share, 0.0), 1.0) * d
    return np.concatenate([points[:last], point[None], points[last:]]), last


def _is_straight(points: Floats) -> bool:
    """Whether a path leads straight on, but for a centimetre."""
    off = points - points[0]
    u = off[-1] / max(float(np.linalg.norm(off[-1])), 1e-12)
    aside = np.linalg.norm(off - np.outer(off @ u, u), axis=1)
    return bool(aside.max() <= _STRAIGHT_M and (np.diff(off @ u) >= -TOLERANCE_M).all())


def _at(point: Floats) -> str:
    x, y, z = point
    return f"({x:.2f}, {y:.2f}, {z:.2f}) m"


def _sentence(a: Floats, b: Floats, map: SemanticMap, near: Surroundings) -> Message:
    """What is wrong on the piece from a to b (3,)."""
    cell, share, gap = near.nearest(a, b)
    at = _at(a + share * (b - a))
    keep_m = near.keep * near.frame.resolution_m
    if not map.frame.contains(cell)[0]:
        return message("at {at} the way comes nearer than {keep_m:.2f} m to the map's border", at=at, keep_m=keep_m)
    index = int(np.ravel_multi_index(tuple(cell), map.frame.shape))
    for region in map.regions:
        if region.passable is not Knowledge.YES and index in region.cells:
            what = message("region '{region}', which is not known to be passable", region=region.id)
            return _too_near(at, keep_m, gap, what)
    where = str(tuple(int(i) for i in cell))
    unknown = map.cells[tuple(cell)] == Cell.UNKNOWN
    return _too_near(
        at,
        keep_m,
        gap,
        message("cell {cell}, which was never seen", cell=where)
        if unknown
        else message("cell {cell}, which is occupied", cell=where),
    )


def _too_near(at: str, keep_m: float, gap: float, what: Message) -> Message:
    if gap == 0:
        return message("at {at} the way enters {what}", at=at, what=what)
    return message("at {at} the way comes nearer than {keep_m:.2f} m to {what}", at=at, keep_m=keep_m, what=what)
