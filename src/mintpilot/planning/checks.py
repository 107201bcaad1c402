"""The last gate before anything is flown: is every point of it known to be flyable?

Called by the loop for every plan and every trajectory, whoever made it. Shares no code with the making of trajectories.
Every cell that a piece between two points passes through counts, found exactly by cutting the pieces at the cells'
borders. A point within a millionth of a cell of a border belongs to either side.
"""

from __future__ import annotations

from itertools import product

import numpy as np

from mintpilot.core.geometry import Bools, Floats, Ints
from mintpilot.core.plan import VehicleLimits
from mintpilot.core.semantic_map import Cell, Knowledge, SemanticMap
from mintpilot.core.trajectory import Trajectory
from mintpilot.planning.flyable import known_flyable, region_reach

START_SLACK_M = 0.5
"""How far from flyable space a flight may begin, metres (take-off beside something)."""
_TOUCH = 1e-6  # cells
_STRAIGHT_M = 0.01


def check_path(path_m: Floats, map: SemanticMap, limits: VehicleLimits) -> str:
    """Whether a vehicle may fly along the straight pieces of this path.

    Every cell on the way must be known flyable; regions count as such only with `Knowledge.YES`. The beginning is
    excepted: it may lie up to `START_SLACK_M` from flyable space as long as the straight way there stays in free
    cells outside every region that is not known passable.

    Args:
        path_m: points (n, 3), metres.
        map: what is known.
        limits: size of the vehicle.

    Returns:
        The empty string when all is well; else one plain sentence, without a full stop, saying what is wrong and where.
    """
    points = np.asarray(path_m, float)
    if points.ndim != 2 or points.shape[1:] != (3,) or len(points) == 0:
        return f"the path has shape {points.shape} instead of (n, 3) with n at least 1"
    if not np.isfinite(points).all():
        return f"way-point {int(np.argmin(np.isfinite(points).all(axis=1)))} is not a finite number"
    spots = (points - np.asarray(map.frame.origin_m)) / map.frame.resolution_m
    inside = ((spots >= -_TOUCH) & (spots <= np.asarray(map.frame.shape[::-1]) + _TOUCH)).all(axis=1)
    if not inside.all():
        return _sentence(spots[int(np.argmin(inside))], map, limits)
    visited = _visited(spots)
    flyable = _is(known_flyable(map, limits), visited)
    fine = flyable | _leaving(visited, flyable, map)
    if fine.all():
        return ""
    return _sentence(visited[int(np.argmin(fine))], map, limits)


def check_trajectory(trajectory: Trajectory, map: SemanticMap, limits: VehicleLimits) -> str:
    """Whether a vehicle may fly this trajectory: `check_path` for the pieces between its samples.

    Returns:
        The empty string when all is well; else one plain sentence, without a full stop, saying what is wrong and where.
    """
    time, position = np.asarray(trajectory.time_s), np.asarray(trajectory.position_m)
    if time.ndim != 1 or len(time) != len(position):
        return f"the trajectory has {time.shape} times for positions of shape {position.shape}"
    if not np.isfinite(time).all() or (np.diff(time) <= 0).any():
        return "the trajectory's times do not ascend"
    return check_path(position, map, limits)


def _visited(spots: Floats) -> Floats:
    """One spot (m, 3) in the middle of each passage through a cell, in order of the way; all in cells ``[x, y, z]``."""
    if len(spots) == 1:
        return spots
    a, d = spots[:-1], np.diff(spots, axis=0)
    pieces, shares = [np.arange(len(d)), np.arange(len(d))], [np.zeros(len(d)), np.ones(len(d))]
    for axis in range(3):
        low = np.ceil(np.minimum(a[:, axis], a[:, axis] + d[:, axis]))
        count = np.maximum(np.floor(np.maximum(a[:, axis], a[:, axis] + d[:, axis])) - low + 1, 0).astype(np.int64)
        count[d[:, axis] == 0] = 0
        piece = np.repeat(np.arange(len(d)), count)
        border = low[piece] + np.arange(len(piece)) - np.repeat(np.cumsum(count) - count, count)
        pieces.append(piece)
        shares.append(np.clip((border - a[piece, axis]) / d[piece, axis], 0.0, 1.0))
    piece, share = np.concatenate(pieces), np.concatenate(shares)
    order = np.lexsort((share, piece))
    piece, share = piece[order], share[order]
    long = np.linalg.norm(d, axis=1)[piece[:-1]] * np.diff(share) > _TOUCH
    passage = (np.diff(piece) == 0) & long
    middle = (share[:-1] + share[1:])[passage] / 2
    inner = a[piece[:-1][passage]] + d[piece[:-1][passage]] * middle[:, None]
    visited: Floats = np.concatenate([spots[:1], inner, spots[-1:]])
    return visited


def _is(flags: Bools, spots: Floats) -> Bools:
    """Which spots (n, 3) lie in a flagged cell; on a border, either side will do."""
    low, high = np.floor(spots - _TOUCH).astype(np.int64), np.floor(spots + _TOUCH).astype(np.int64)
    found = np.zeros(len(spots), bool)
    for sides in product((low, high), repeat=3):
        cells = np.stack([sides[axis][:, axis] for axis in (2, 1, 0)], axis=1)
        inside = np.all((cells >= 0) & (cells < flags.shape), axis=1)
        found[inside] |= flags[tuple(cells[inside].T)]
    return found


def _leaving(visited: Floats, flyable: Bools, map: SemanticMap) -> Bools:
    """Which of the visited spots belong to an allowed straight way from the start into flyable space."""
    none = np.zeros(len(visited), bool)
    distance = np.linalg.norm(visited - visited[0], axis=1) * map.frame.resolution_m
    if flyable[0] or not flyable.any():
        return none
    beyond = np.flatnonzero(distance > START_SLACK_M)
    prefix = np.arange(len(visited)) < (beyond[0] if len(beyond) else len(visited))
    outside = np.flatnonzero(prefix & ~flyable)
    way = np.arange(len(visited)) <= outside[-1]
    u = visited[outside[-1]] - visited[0]
    u = u / max(float(np.linalg.norm(u)), 1e-12)
    off = visited[way] - visited[0]
    aside = np.linalg.norm(off - np.outer(off @ u, u), axis=1) * map.frame.resolution_m
    if aside.max() > _STRAIGHT_M or (np.diff(off @ u) < -_TOUCH).any():
        return none
    free = np.array(map.cells == Cell.FREE)
    for region in map.regions:
        if region.passable is not Knowledge.YES:
            free.ravel()[region.cells] = False
    leaving: Bools = way & _is(free, visited)
    return leaving


def _sentence(spot: Floats, map: SemanticMap, limits: VehicleLimits) -> str:
    """What is wrong at a spot (3,) that is not flyable."""
    x, y, z = np.asarray(map.frame.origin_m) + spot * map.frame.resolution_m
    at = f"at ({x:.2f}, {y:.2f}, {z:.2f}) m the way"
    cell: Ints = np.floor(spot[::-1]).astype(np.int64)
    if not map.frame.contains(cell)[0]:
        return f"{at} leaves the map"
    index = int(np.ravel_multi_index(tuple(cell), map.frame.shape))
    keep = limits.radius_m + limits.margin_m
    closed = [r for r in map.regions if r.passable is not Knowledge.YES]
    for region in closed:
        if index in region.cells:
            return f"{at} enters region '{region.id}', which is not known to be passable"
    state = Cell(int(map.cells[tuple(cell)]))
    if state is not Cell.FREE:
        seen = "was never seen" if state is Cell.UNKNOWN else "is occupied"
        return f"{at} enters cell {tuple(int(i) for i in cell)}, which {seen}"
    for region in closed:
        if index in region_reach(map, region, limits):
            return f"{at} comes nearer than {keep:.2f} m to region '{region.id}', which is not known to be passable"
    return f"{at} comes nearer than {keep:.2f} m to something occupied or never seen"
