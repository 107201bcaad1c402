"""Rules bound to map and task: which cells and which stops their propositions speak of (method, section 14)."""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np

from mintpilot.core.geometry import Floats, Ints
from mintpilot.core.observation import RegionKind
from mintpilot.core.plan import Stop
from mintpilot.core.rule import About, Automaton, Proposition, Ruling, StopLetters
from mintpilot.core.semantic_map import Cell, SemanticMap
from mintpilot.core.task import Action, Task
from mintpilot.uncertainty.gaps import LOOK_REACH_M, look_id
from mintpilot.uncertainty.keep_away import around_box, box_of
from mintpilot.uncertainty.things import things_of

SIGHT_PER_CELL = 4
"""A line of sight is looked at in so many places for each edge of a cell."""
_TOUCHING_M = 1e-6


def ruling_of(
    map: SemanticMap,
    task: Task,
    automaton: Automaton,
    stops: Iterable[Stop],
    *,
    states: frozenset[int] = frozenset({0}),
    held: int = 0,
) -> Ruling:
    """The task's rules on that map.

    Args:
        map: what is believed of the world.
        task: its ``rules``.
        automaton: of these rules together.
        stops: all that may be done.
        states: of the automaton that the mission may be in.
        held: bits of the propositions of stops that hold now.
    """
    letters = [
        (stop.id, letters_of(stop, map, task, automaton, seen_from_m=np.asarray(stop.sites[0].position_m)))
        for stop in stops
    ]
    return Ruling(
        rules=task.rules,
        automaton=automaton,
        cells=tuple(_cells(what, map) for what in automaton.propositions),
        stops=tuple((name, one) for name, one in letters if one != StopLetters()),
        states=states,
        held=held,
    )


def letters_of(
    stop: Stop, map: SemanticMap, task: Task, automaton: Automaton, *, seen_from_m: Floats | None = None
) -> StopLetters:
    """What doing a stop makes true and false.

    Args:
        stop: what is done.
        map: what is believed of the world.
        task: whose stops and rules these are.
        automaton: of these rules together.
        seen_from_m: where it is done (3,), metres: a room that cannot be seen from there is not looked into. None: that
            does not matter.
    """
    at = begins = ends = 0
    for bit, what in enumerate(automaton.propositions):
        flag = 1 << bit
        match what.about:
            case About.AT if _is_goal(stop, task, what.subject):
                at |= flag
            case About.DID if _is_goal(stop, task, what.subject):
                begins |= flag
            case About.LOOKED if stop.action is Action.LOOK:
                room = _room(stop, map, task, what.subject, seen_from_m)
                begins |= flag if room and (seen_from_m is None or sees_into(map, room, seen_from_m)) else 0
            case About.CARRYING if stop.action is Action.PICK and _is_thing(stop, task, what.subject):
                begins |= flag
            case About.CARRYING if stop.action is Action.DELIVER:
                ends |= flag
            case _:
                pass
    return StopLetters(at=at, begins=begins, ends=ends)


def _goal_number(stop: Stop) -> int:
    """Number of the sub-goal that a stop belongs to; 0: none."""
    number = stop.id.split(":")[1:2]
    return int(number[0]) if not stop.optional and number and number[0].isdigit() else 0


def _is_goal(stop: Stop, task: Task, goal: str) -> bool:
    number = _goal_number(stop)
    return 0 < number <= len(task.subgoals) and task.subgoals[number - 1].id == goal


def _room(stop: Stop, map: SemanticMap, task: Task, subject: str, at_m: Floats | None) -> str:
    """Id of the room that a look goes to, where ``looked`` speaks of it by its own id or by that of the goal.

    Of several that it may go to, the one whose viewpoint is nearest; empty where it speaks of none of them.
    """
    if stop.id == look_id(subject):
        return subject
    rooms = [one for one in map.rooms if one.id == subject or _is_goal(stop, task, subject)]
    meant = [r for r in rooms if any(math.dist(s.position_m, r.viewpoint_m) <= LOOK_REACH_M for s in stop.sites)]
    near_m = stop.sites[0].position_m if at_m is None else at_m
    return min(((math.dist(near_m, r.viewpoint_m), r.id) for r in meant), default=(0.0, ""))[1]


def sees_into(map: SemanticMap, room: str, at_m: Floats) -> bool:
    """Whether nothing known stands between that place (3,) and the door of the room: no wall, and no smoke.

    What the line of sight meets last is the door itself.
    """
    doors = [one.door_m for one in map.rooms if one.id == room]
    if not doors:
        return True
    frame, to_m = map.frame, np.asarray(doors[0].centre_m)
    count = int(np.ceil(SIGHT_PER_CELL * float(np.linalg.norm(to_m - at_m)) / frame.resolution_m))
    points = np.linspace(at_m, to_m, count + 2)
    cells = np.clip(frame.cells_of(points), 0, np.array(frame.shape) - 1)
    flat = np.ravel_multi_index(tuple(cells.T), frame.shape)
    matter = map.cells.ravel()[flat] != Cell.FREE
    smoke = [region.cells for region in map.regions if region.kind is RegionKind.SMOKE]
    hidden = bool(smoke) and bool(np.isin(flat, np.concatenate(smoke)).any())
    return not hidden and not bool((matter[:-1] & ~matter[1:]).any())


def _is_thing(stop: Stop, task: Task, label: str) -> bool:
    number = _goal_number(stop)
    if not 0 < number <= len(task.subgoals):
        return False
    goal = task.subgoals[number - 1]
    taken = goal.thing or goal.reference
    return label in (taken.label, taken.object_id) or label in taken.phrase.split()


def _cells(what: Proposition, map: SemanticMap) -> Ints:
    """Flat cells of the region, of all regions of that kind, of the things."""
    if not what.about.spatial:
        return np.zeros(0, np.int64)
    regions = [r.cells for r in map.regions if what.subject in (r.id, str(r.kind))]
    regions = regions or [r.cells for r in map.regions if is_part_of(r.id, what.subject)]
    if regions or what.about is not About.WITHIN:
        return np.unique(np.concatenate([np.zeros(0, np.int64), *regions]))
    near = np.zeros(map.frame.shape, bool)
    for thing in things_of(map):
        if what.subject == thing.id or thing.label in labels_of(what.subject):
            near |= around_box(map, box_of(thing), _TOUCHING_M)
    return np.flatnonzero(near).astype(np.int64)


def is_part_of(region: str, whole: str) -> bool:
    """Whether a region is one of the numbered parts that a declared one was cut into: by a mask, or by its value."""
    part = region.removeprefix(f"{whole}-")
    return part != region and part.isdigit()


def labels_of(subject: str) -> tuple[str, ...]:
    """What things of that name are labelled: ``people``, ``barrels``, ``boxes``, ``the box``."""
    bare = subject.removeprefix("the ")
    return ("person",) if bare in ("people", "persons") else (bare, bare.removesuffix("s"), bare.removesuffix("es"))
