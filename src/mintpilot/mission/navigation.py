"""Checked ways through what is known: a leg of the plan, the survey's next place, the way home, a place to land."""

from __future__ import annotations

import numpy as np

from mintpilot.core.decisions import Explore, FlyTrajectory, GoBack, RefuseFlight
from mintpilot.core.errors import InfeasibleError
from mintpilot.core.geometry import Bools, Floats, Ints, Vec3
from mintpilot.core.message import Message, message
from mintpilot.core.mission import Mission
from mintpilot.core.plan import Leg, VehicleLimits
from mintpilot.core.rule import Ruling
from mintpilot.core.semantic_map import Cell, Knowledge, SemanticMap
from mintpilot.core.task import Action
from mintpilot.core.trajectory import Trajectory, VehicleState
from mintpilot.mission.path_monitor import with_passable
from mintpilot.mission.way_back import is_stranded, way_back
from mintpilot.planning.checks import check_path, check_trajectory
from mintpilot.planning.flyable import known_flyable
from mintpilot.planning.grid_search import distance_field
from mintpilot.planning.reach import LookAround, next_view, way_to
from mintpilot.planning.ruled_path import keeps_rules, ruled_path
from mintpilot.planning.sight import inspect
from mintpilot.planning.trajectory import plan_trajectory

ARRIVED_M = 0.6
"""Distance to the start below which the vehicle is there, metres."""
FACING_M = 0.3
"""Things nearer than this, seen from above, give no heading."""
MOST_UNREACHABLE = 40
"""So many places that no trajectory leads to are tried in one search for the next view."""


def leg_trajectory(
    leg: Leg,
    map: SemanticMap,
    limits: VehicleLimits,
    vehicle: VehicleState,
    assume_passable: frozenset[str],
    ruling: Ruling | None = None,
) -> FlyTrajectory | RefuseFlight:
    """The checked trajectory of a leg from where the vehicle is, or why there is none.

    Under rules it comes to where they are along the leg's own path: where cut corners would not, that path is flown.
    """
    believed = with_passable(map, assume_passable)
    path = np.vstack([np.asarray(vehicle.position_m, float), leg.path_m[1:]])
    refusal = check_path(path, believed, limits)
    if refusal:
        return RefuseFlight(reason=refusal)
    for shortcut in (True, False):
        try:
            trajectory = plan_trajectory(
                path,
                map=believed,
                limits=limits,
                start_yaw_rad=vehicle.yaw_rad,
                end_yaw_rad=_facing(leg, map, path[-1]),
                shortcut=shortcut,
            )
        except InfeasibleError as error:
            return RefuseFlight(reason=error.said)
        refusal = check_trajectory(trajectory, believed, limits)
        if refusal:
            return RefuseFlight(reason=refusal)
        if ruling is None or keeps_rules(trajectory.position_m, ruling, map, limits, as_along_m=path):
            return FlyTrajectory(trajectory=trajectory)
    return RefuseFlight(reason=message("no motion along the way keeps the rules"))


def explore(
    map: SemanticMap,
    mission: Mission,
    vehicle: VehicleState,
    track_m: Floats,
    *,
    seen_from_m: tuple[Vec3, ...],
    inspected: Bools,
    speed_mps: float,
    spacing_m: float | None,
) -> Explore:
    """The next flight of the survey: back out, to the next place to look around from, or home.

    Args:
        map: what is known.
        mission: where to fly and with what vehicle.
        vehicle: where it hovers.
        track_m: where it has been (n, 3), metres.
        seen_from_m: places that count as looked around from.
        inspected: flags (nz, ny, nx) of surface cells that were looked at from near.
        speed_mps: of the flight.
        spacing_m: between places to look around from; None: fly home.
    """
    limits, here = mission.limits, vehicle.position_m
    inspected = inspected.copy()
    look = LookAround() if spacing_m is None else LookAround(apart_m=spacing_m / 2)
    if spacing_m is not None:
        inspect(map, inspected, np.asarray(here), close_m=look.close_m, elevation_rad=look.elevation_rad)
    if len(track_m) and is_stranded(map, limits, vehicle):
        out = way_back(map, limits, vehicle, track_m)
        if out is not None:
            return Explore(trajectory=out, retreat=True, unreachable_m=(), inspected=inspected)
    unreachable: list[Vec3] = []
    notes: list[Message] = []
    while len(unreachable) < MOST_UNREACHABLE:
        if spacing_m is None:
            path = way_to(map, limits, start_m=here, goal_m=mission.start_m)
        else:
            places = np.asarray([*seen_from_m, *unreachable], float).reshape(-1, 3)
            path = next_view(map, limits, start_m=here, seen_from_m=places, inspected=inspected, settings=look)
        if path is None:
            break
        found = _checked(path, map, limits, vehicle.yaw_rad, speed_mps)
        if isinstance(found, Trajectory):
            return Explore(
                trajectory=found,
                retreat=False,
                unreachable_m=tuple(unreachable),
                inspected=inspected,
                notes=tuple(notes),
            )
        notes.append(found)
        if spacing_m is None:
            break
        x, y, z = (float(v) for v in path[-1])
        unreachable.append((x, y, z))
    return Explore(
        trajectory=None, retreat=False, unreachable_m=tuple(unreachable), inspected=inspected, notes=tuple(notes)
    )


def way_home(
    map: SemanticMap,
    limits: VehicleLimits,
    vehicle: VehicleState,
    start_m: Vec3,
    track_m: Floats,
    ruling: Ruling | None = None,
) -> GoBack | RefuseFlight:
    """The shortest way to the start through space known to be free; where there is none, the way that was flown.

    One that keeps the rules goes first; where none does, the drone comes home all the same.
    """
    here = np.asarray(vehicle.position_m)
    if float(np.linalg.norm(here - start_m)) <= ARRIVED_M:
        return GoBack(trajectory=None, duration_s=0.0)
    if ruling is not None:
        kept = ruled_path(map, limits, ruling, start_m=vehicle.position_m, goal_m=start_m)
        for shortcut in (True, False):
            if kept is None:
                break
            found = _checked(kept, map, limits, vehicle.yaw_rad, limits.cruise_mps, shortcut=shortcut)
            if isinstance(found, Trajectory) and keeps_rules(found.position_m, ruling, map, limits, as_along_m=kept):
                return GoBack(trajectory=found, duration_s=found.duration_s)
    reason = message("no way to the start is known to be free")
    path = way_to(map, limits, start_m=vehicle.position_m, goal_m=start_m)
    for way in (path, np.vstack([here[None], track_m[::-1]]) if len(track_m) else None):
        if way is not None:
            found = _checked(way, map, limits, vehicle.yaw_rad, limits.cruise_mps)
            if isinstance(found, Trajectory):
                return GoBack(trajectory=found, duration_s=found.duration_s)
            reason = found
    return RefuseFlight(reason=reason)


def way_to_land(map: SemanticMap, limits: VehicleLimits, vehicle: VehicleState) -> GoBack | RefuseFlight:
    """The way to the nearest place above ground that is known to be free down to the floor."""
    landable = landable_cells(map, limits)
    frame, here = map.frame, vehicle.position_m
    z, y, x = (int(i) for i in frame.cells_of(here)[0])
    if bool(frame.contains([[z, y, x]])[0]) and landable[z, y, x]:
        return GoBack(trajectory=None, duration_s=0.0)
    free = known_flyable(map, limits)
    cells = np.argwhere(free)
    reason = message("no ground is known to be free to land on")
    if not len(cells):
        return RefuseFlight(reason=reason)
    start = cells[int(np.argmin(np.linalg.norm(frame.centres_of(cells) - here, axis=1)))]
    sz, sy, sx = (int(i) for i in start)
    away = np.where(landable & free, distance_field(free, (sz, sy, sx)), np.inf)
    if not np.isfinite(away).any():
        return RefuseFlight(reason=reason)
    goal: Ints = np.asarray(np.unravel_index(int(np.argmin(away)), away.shape), np.int64)
    gx, gy, gz = (float(v) for v in frame.centres_of(goal)[0])
    path = way_to(map, limits, start_m=here, goal_m=(gx, gy, gz))
    found = reason if path is None else _checked(path, map, limits, vehicle.yaw_rad, limits.cruise_mps)
    if isinstance(found, Trajectory):
        return GoBack(trajectory=found, duration_s=found.duration_s)
    return RefuseFlight(reason=found)


def landable_cells(map: SemanticMap, limits: VehicleLimits) -> Bools:
    """From which cells (nz, ny, nx) the vehicle may descend to the ground right below.

    All that its body passes is seen free, and what it ends on is seen occupied, or the bottom of the map. A flat map
    shows no ground: what is free may be landed on.
    """
    free = np.array(map.cells == Cell.FREE)
    for region in map.regions:
        if region.passable is not Knowledge.YES:
            free.ravel()[region.cells] = False
    reach = int(np.ceil(limits.radius_m / map.frame.resolution_m))
    y, x = np.mgrid[-reach : reach + 1, -reach : reach + 1]
    disc = (np.hypot(y, x) * map.frame.resolution_m <= limits.radius_m + map.frame.resolution_m / 2)[None]
    from scipy import ndimage

    clear: Bools = ndimage.binary_erosion(free, disc, border_value=0)
    if map.frame.is_flat:
        return clear
    landable = np.zeros_like(clear)
    below = np.ones(clear.shape[1:], bool)  # under the lowest layer is the ground
    for level in range(clear.shape[0]):
        landable[level] = clear[level] & below
        below = landable[level] | (map.cells[level] == Cell.OCCUPIED)
    return landable


def _checked(
    path: Floats, map: SemanticMap, limits: VehicleLimits, yaw_rad: float, speed_mps: float, *, shortcut: bool = True
) -> Trajectory | Message:
    """The trajectory along a path, or why it may not be flown."""
    try:
        trajectory = plan_trajectory(
            path, map=map, limits=limits, start_yaw_rad=yaw_rad, speed_mps=speed_mps, shortcut=shortcut
        )
    except InfeasibleError as error:
        return error.said
    return check_trajectory(trajectory, map, limits) or trajectory


def _facing(leg: Leg, map: SemanticMap, end_m: Floats) -> float | None:
    """Heading at the stop: towards the door or the thing it is about; None to keep the heading of the flight."""
    target = leg.site.position_m
    if leg.stop.action is Action.LOOK:
        doors = [room.door_m.centre_m for room in map.rooms if room.id == leg.site.label]
        target = doors[0] if doors else target
    offset = np.asarray(target[:2]) - end_m[:2]
    return float(np.arctan2(offset[1], offset[0])) if float(np.linalg.norm(offset)) > FACING_M else None
