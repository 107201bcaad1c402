"""Distances that the person wants kept from things and regions, as regions of the map.

Each wish becomes one region of kind ``area`` that nobody has freed: plans stay out of it, the body's clearance
included, and so does the last check before flight, as for any region that is not known passable. Where nothing can be
flown so, its gap is opened: the operator is asked, and only an explicit yes frees it.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from mintpilot.core.errors import InputError
from mintpilot.core.geometry import Bools, Box, Ints, Vec3
from mintpilot.core.observation import PERSON, RegionKind
from mintpilot.core.semantic_map import Knowledge, Region, SemanticMap
from mintpilot.core.task import Action, KeepAway, Task
from mintpilot.uncertainty.describing import seen
from mintpilot.uncertainty.matching import Standpoint, match
from mintpilot.uncertainty.things import Thing, stands_for, things_of

PREFIX = "keep-away-"
"""Ids of these regions begin so."""


def with_keep_away(map: SemanticMap, task: Task, *, start_m: Vec3, previous: SemanticMap | None = None) -> SemanticMap:
    """The map with one region for each distance to be kept; those that are on it already are drawn anew.

    The thing that a step goes to is no reason to stay away from itself. Where the drone starts nearer than wished,
    nothing can be flown so, and it asks.

    Args:
        map: what is believed of the world.
        task: its ``keep_away`` says from what, and how far.
        start_m: where the mission starts, metres; ``nearest`` and ``left`` are judged from there.
        previous: the map before: a region that has not grown since keeps what is known of it.
    """
    if not task.keep_away:
        return map
    bare = replace(map, regions=tuple(r for r in map.regions if not r.id.startswith(PREFIX)))
    known = {r.id: r for r in (previous or map).regions if r.id.startswith(PREFIX)}
    view = Standpoint(start_m=start_m, towards_m=map.frame.box.centre_m)
    added = []
    for number, wish in enumerate(task.keep_away, start=1):
        cells = _cells(wish, bare, task, view)
        if not cells.size:
            continue
        name = f"{PREFIX}{number}"
        before = known.get(name)
        kept = before is not None and bool(np.isin(cells, before.cells).all())
        added.append(
            Region(
                id=name,
                kind=RegionKind.AREA,
                cells=cells,
                passable=before.passable if before is not None and kept else Knowledge.OPEN,
                description=f"the space within {wish.distance_m:g} m of {wish.reference.phrase}",
            )
        )
    return replace(bare, regions=(*bare.regions, *added))


class NothingToKeepAwayFromError(InputError):
    """A distance is wanted from something that is not on a given map."""

    def __init__(self, wish: KeepAway, things: Sequence[Thing]) -> None:
        self.phrase = wish.reference.phrase
        """What it was called."""
        super().__init__(
            f"Nothing on the map matches '{self.phrase}', from which {wish.distance_m:g} m are to be kept. "
            f"On it: {seen(things)}."
        )


def check_keep_away(map: SemanticMap, task: Task, *, start_m: Vec3) -> None:
    """Whether everything that is to be kept away from is on a given map.

    People and kinds of regions are not looked for: they come and go, and the wish means whatever turns up.

    Raises:
        NothingToKeepAwayFromError: something is not.
    """
    things, view = things_of(map), Standpoint(start_m=start_m, towards_m=map.frame.box.centre_m)
    regions = {region.id for region in map.regions}
    for wish in task.keep_away:
        known = wish.reference.object_id in regions or wish.reference.label in list(RegionKind)
        if not known and not stands_for(PERSON, wish.reference.label) and not list(_meant(wish, things, view)):
            raise NothingToKeepAwayFromError(wish, things)


def _cells(wish: KeepAway, map: SemanticMap, task: Task, view: Standpoint) -> Ints:
    """Flat indices, sorted, of all cells any part of which is nearer than the distance."""
    near = np.zeros(map.frame.shape, bool)
    for region in map.regions:
        if region.id == wish.reference.object_id or str(region.kind) == wish.reference.label:
            near |= _around_cells(map, region.cells, wish.distance_m)
    things = things_of(map)
    goals = _goals(task, things, view)
    for thing in _meant(wish, things, view):
        if thing.id not in goals:
            near |= around_box(map, box_of(thing), wish.distance_m)
    return np.flatnonzero(near).astype(np.int64)


def _meant(wish: KeepAway, things: tuple[Thing, ...], view: Standpoint) -> Iterator[Thing]:
    if wish.reference.object_id:
        yield from (t for t in things if t.id == wish.reference.object_id)
    elif wish.reference.label not in list(RegionKind):
        yield from match(wish.reference, things, view)


def _goals(task: Task, things: tuple[Thing, ...], view: Standpoint) -> frozenset[str]:
    """Ids of the things that steps go to for certain."""
    found: set[str] = set()
    for goal in task.subgoals:
        reference = goal.reference
        if reference.object_id:
            found.add(reference.object_id)
        elif reference.position_m is None and goal.action is not Action.LOOK:
            meant = match(reference, things, view)
            found |= {t.id for t in meant} if reference.every or len(meant) == 1 else set()
    return frozenset(found)


def box_of(thing: Thing) -> Box:
    """The box that a thing fills."""
    half = tuple(edge / 2 for edge in thing.size_m)
    (x, y, z), (dx, dy, dz) = thing.position_m, half
    return Box(lo_m=(x - dx, y - dy, z - dz), hi_m=(x + dx, y + dy, z + dz))


def around_box(map: SemanticMap, box: Box, distance_m: float) -> Bools:
    """Cells of which some point is nearer than the distance to the box; heights do not count on a flat map."""
    frame, half = map.frame, map.frame.resolution_m / 2
    squared = np.zeros(frame.shape)
    for axis, size in ((0, frame.shape[2]), (1, frame.shape[1]), (2, frame.shape[0])):
        if axis == 2 and frame.is_flat:
            continue
        centres = frame.origin_m[axis] + (np.arange(size) + 0.5) * frame.resolution_m
        gap = np.maximum(np.maximum(box.lo_m[axis] - centres - half, centres - half - box.hi_m[axis]), 0.0)
        squared += (gap**2).reshape([-1 if 2 - axis == dim else 1 for dim in range(3)])
    near: Bools = squared < distance_m**2
    return near


def _around_cells(map: SemanticMap, cells: Ints, distance_m: float) -> Bools:
    """The cells, and those whose centres are nearer than the distance and a cell's diagonal to one of theirs."""
    from scipy.ndimage import distance_transform_edt

    inside = np.zeros(map.frame.size, bool)
    inside[cells] = True
    if not cells.size:
        return inside.reshape(map.frame.shape)
    away = distance_transform_edt(~inside.reshape(map.frame.shape), sampling=map.frame.resolution_m)
    near: Bools = np.asarray(away < distance_m + math.sqrt(3) * map.frame.resolution_m)
    return near
