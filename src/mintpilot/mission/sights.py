"""What a look into a room came to: found, empty, or it could not be seen (method, section 9)."""

from __future__ import annotations

import math

import numpy as np

from mintpilot.core.geometry import Floats
from mintpilot.core.message import message
from mintpilot.core.mission import Left, Looked, Sight
from mintpilot.core.observation import PERSON
from mintpilot.core.plan import Stop
from mintpilot.core.room_view import RoomView
from mintpilot.core.semantic_map import Cell, Room, SemanticMap
from mintpilot.core.task import Task
from mintpilot.uncertainty.things import is_inside, stands_for

SEEN_ENOUGH = 0.5
"""Least share of the doorway through which the room was seen, for nothing found to mean that nothing is there."""
_BEYOND_M = 1.0
"""So far behind the door free space, or a wall, counts as having seen into the room, metres."""
_RAYS = 15


def looked(stop: Stop, task: Task, map: SemanticMap, view: RoomView | None) -> Looked:
    """The result of a look.

    Args:
        stop: a room that was looked into.
        task: says what was asked for there.
        map: as drawn after the look.
        view: what the vehicle itself says that it saw, as a simulator does; None: the map alone tells.
    """
    room = next(r for r in map.rooms if r.id == stop.sites[0].label)
    wanted = _wanted(stop, task)
    there = [o for o in map.objects if is_inside(o.position_m, room) and (not wanted or stands_for(o.label, wanted))]
    people = view.people if view is not None and wanted in ("", PERSON) else 0
    share = view.seen_share if view is not None else seen_share(map, room)
    count = max(len(there), people)
    result = Sight.FOUND if count else Sight.EMPTY if share >= SEEN_ENOUGH else Sight.UNSEEN
    return Looked(
        n=stop.step,
        text=stop.said,
        result=result,
        what=wanted or (PERSON if people else ""),
        count=count,
        objects=tuple(o.id for o in there),
        seen_share=share,
    )


def unknown(look: Looked) -> Left:
    """A look that told nothing, as something that was not done."""
    reason = message(
        "it could not see inside: the room was seen through {share:.0%} of its doorway", share=look.seen_share
    )
    return Left(n=look.n, text=look.text, reason=reason, resource="sight")


def seen_share(map: SemanticMap, room: Room) -> float:
    """Through which share of the doorway's width the room was seen, 0 to 1.

    From the viewpoint, straight lines through the doorway at half its height: one counts where the map knows all of it
    for a metre behind the door, or up to a wall.
    """
    lo, hi = np.asarray(room.door_m.lo_m), np.asarray(room.door_m.hi_m)
    eye, middle = np.asarray(room.viewpoint_m), (lo + hi) / 2
    width = np.where(np.arange(3) == int(np.argmax((hi - lo)[:2])), (hi - lo) / 2, 0.0)
    through = middle + width * np.linspace(-0.9, 0.9, _RAYS)[:, None]
    return float(np.mean([_sees(map, eye, point) for point in through]))


def _sees(map: SemanticMap, eye: Floats, door: Floats) -> bool:
    far_m, step_m = math.dist(eye, door), map.frame.resolution_m / 2
    beyond_m = np.arange(far_m + step_m, far_m + _BEYOND_M + step_m, step_m)
    cells = map.frame.cells_of(eye + (door - eye) / max(far_m, 1e-9) * beyond_m[:, None])
    inside = map.frame.contains(cells)
    states = np.full(len(cells), Cell.UNKNOWN, np.uint8)
    states[inside] = map.cells[tuple(cells[inside].T)]
    ends = np.flatnonzero(states != Cell.FREE)
    return not ends.size or (int(ends[0]) > 0 and states[ends[0]] == Cell.OCCUPIED)


def _wanted(stop: Stop, task: Task) -> str:
    """The class of what was asked for; empty: whatever is there."""
    if stop.optional:
        return PERSON
    for number, subgoal in enumerate(task.subgoals, 1):
        if task.step_for(number).n == stop.step:
            return subgoal.thing.label if subgoal.thing is not None else ""
    return PERSON
