"""What only the whole mission file can tell: contradictions, unknown names, sums of probabilities."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Iterator
from pathlib import Path

from mintpilot.core.gap import ABSENT, BLOCKED, PASSABLE, PRESENT, GapKind, kind_of, obstacle_id, presence_id
from mintpilot.core.tolerances import SUM_TOLERANCE
from mintpilot.mission_file.form_checks import nearest, show
from mintpilot.mission_file.ruling import rule_faults
from mintpilot.mission_file.schema import CorrelationSpec, GoalSpec, MissionFile
from mintpilot.mission_file.schema_world import MapWorld, SceneWorld, SeenWorld
from mintpilot.mission_file.semantic_checks_map import map_faults
from mintpilot.mission_file.semantic_checks_scene import scene_faults
from mintpilot.mission_file.semantic_checks_seen import seen_faults
from mintpilot.mission_file.values import value_faults
from mintpilot.mission_file.yaml_places import Fault, Path_

_VALUES = {GapKind.OBSTACLE: (PASSABLE, BLOCKED), GapKind.PRESENCE: (PRESENT, ABSENT)}


def contradictions(mission: MissionFile, base: Path) -> Iterator[Fault]:
    """Every mistake in a mission of correct form; files that it names are relative to ``base``."""
    yield from _goal_faults(mission)
    yield from _truth_faults(mission)
    yield from _correlation_faults(mission)
    yield from rule_faults(mission)
    yield from value_faults(mission)
    yield from _look_faults(mission)
    if isinstance(mission.world, MapWorld | SeenWorld) and mission.survey is not None:
        yield _fault(("survey",), "a given map needs no survey flight; remove 'survey'")
    if isinstance(mission.world, MapWorld):
        yield from map_faults(mission, mission.world, base)
    elif isinstance(mission.world, SeenWorld):
        yield from seen_faults(mission, mission.world, base)
    elif isinstance(mission.world, SceneWorld):
        yield from scene_faults(mission.world.scene)


def _fault(path: Path_, message: str) -> Fault:
    return Fault(path=path, line=None, message=message)


def _goal_faults(mission: MissionFile) -> Iterator[Fault]:
    for index, goal in enumerate(mission.goals or ()):
        path: Path_ = ("goals", index)
        ways = [key for key in ("phrase", "object", "room", "position_m") if getattr(goal, key) is not None]
        if len(ways) != 1:
            given = " and ".join(ways) or "none"
            yield _fault(
                path, f"where is it? exactly one of phrase, object, room and position_m is wanted, not {given}"
            )
        if goal.phrase is None:
            for key in ("label", "attributes", "truth"):
                if key in goal.model_fields_set:
                    yield _fault((*path, key), f"'{key}' goes with a phrase only; remove it, or give a phrase")
        yield from _goal_names(mission, goal, path)


def _goal_names(mission: MissionFile, goal: GoalSpec, path: Path_) -> Iterator[Fault]:
    world = mission.world
    if isinstance(world, SeenWorld):
        return  # its things are known to its own checks
    if not isinstance(world, MapWorld):
        for key in ("object", "room", "truth"):
            if getattr(goal, key) is not None:
                yield _fault(
                    (*path, key),
                    f"{show(getattr(goal, key))}: names of things are known on a given map only; "
                    "here the drone names what it sees: describe it with a phrase",
                )
        return
    objects, rooms = [x.id for x in world.objects], [x.id for x in world.rooms]
    for key, known in (("object", objects), ("truth", objects), ("room", rooms)):
        name = getattr(goal, key)
        if name is not None and name not in known:
            yield _fault(
                (*path, key), f"there is no {key if key == 'room' else 'object'} '{name}'; {nearest(name, known)}"
            )


def _truth_faults(mission: MissionFile) -> Iterator[Fault]:
    if isinstance(mission.world, SeenWorld):
        return  # its things are known to its own checks
    if not isinstance(mission.world, MapWorld):
        if mission.truth:
            yield _fault(("truth",), "this world has its own truth; remove 'truth', or write it into the scene")
        return
    world = mission.world
    regions, rooms = {r.id: r for r in world.regions}, {r.id: r for r in world.rooms}
    phrases = {g.phrase: g for g in mission.goals or () if g.phrase}
    allowed = dict.fromkeys(regions, _VALUES[GapKind.OBSTACLE]) | dict.fromkeys(rooms, _VALUES[GapKind.PRESENCE])
    for subject, value in mission.truth.items():
        path: Path_ = ("truth", subject)
        thing = regions.get(subject) or rooms.get(subject) or phrases.get(subject)
        # Without goals the phrases come out of the instruction, which is not read here.
        if thing is None and not (mission.goals is None and subject.lower() in mission.instruction.lower()):
            known = [*regions, *rooms, *phrases]
            yield _fault(path, f"there is no region, room or phrase '{subject}'; {nearest(subject, known)}")
            continue
        values = allowed.get(subject, tuple(x.id for x in world.objects))
        if value not in values:
            yield _fault(path, f"'{value}' is not a value of '{subject}'; {nearest(value, values)}")
        own = getattr(thing, "truth", None)
        if own is not None and own != value:
            yield _fault(path, f"'{value}' contradicts the truth '{own}' given at '{subject}' itself; keep one of them")


def _look_faults(mission: MissionFile) -> Iterator[Fault]:
    """Looks at what is no region, or at one twice; the regions of a drawn or seen world are not known here."""
    known = None
    if isinstance(mission.world, MapWorld):
        known = [region.id for region in mission.world.regions]
    elif isinstance(mission.world, SceneWorld):
        known = [smoke.id for smoke in mission.world.scene.smokes]
    names = [look.at for look in mission.looks]
    for index, name in enumerate(names):
        if known is not None and name not in known and name.rpartition("-")[0] not in known:
            yield _fault(("looks", index, "at"), f"there is no region '{name}'; {nearest(name, known)}")
        if name in names[:index]:
            yield _fault(("looks", index, "at"), f"'{name}' is looked at twice; keep one of the looks")


def _correlation_faults(mission: MissionFile) -> Iterator[Fault]:
    seen = Counter(gap for group in mission.correlations for gap in group.gaps)
    known: list[str] | None = None
    if isinstance(mission.world, MapWorld):
        known = [obstacle_id(r.id) for r in mission.world.regions if r.passable is None]
        known += [presence_id(r.id) for r in mission.world.rooms if r.occupied is None]
    for index, group in enumerate(mission.correlations):
        path: Path_ = ("correlations", index)
        for place, gap in enumerate(group.gaps):
            if seen[gap] > 1:
                yield _fault((*path, "gaps", place), f"'{gap}' is named {seen[gap]} times; a gap is in one group, once")
            masked = known is not None and gap.rpartition("-")[0] in known
            if known is not None and gap not in known and not masked and kind_of(gap) is not GapKind.TARGET:
                yield _fault((*path, "gaps", place), f"there is no gap '{gap}'; {nearest(gap, known)}")
        yield from _joint_faults(group, path)


def _joint_faults(group: CorrelationSpec, path: Path_) -> Iterator[Fault]:
    total = sum(c.probability for c in group.joint)
    if not math.isclose(total, 1, abs_tol=SUM_TOLERANCE):
        yield _fault((*path, "joint"), f"the probabilities sum to {total:g}; they must sum to 1")
    for index in _repeated(tuple(c.values) for c in group.joint):
        yield _fault((*path, "joint", index), f"{show(group.joint[index].values)} is given twice; keep one of them")
    for index, combination in enumerate(group.joint):
        here: Path_ = (*path, "joint", index, "values")
        if len(combination.values) != len(group.gaps):
            yield _fault(here, f"{len(combination.values)} values for {len(group.gaps)} gaps; give one for each")
            continue
        for place, (gap, value) in enumerate(zip(group.gaps, combination.values, strict=True)):
            kind = kind_of(gap)
            values = _VALUES.get(kind) if kind is not None else None
            if values and value not in values:
                yield _fault((*here, place), f"'{value}' is not a value of '{gap}'; {nearest(value, values)}")


def _repeated(items: Iterable[tuple[str, ...]]) -> Iterator[int]:
    """Indices of the items that were there before."""
    seen: set[tuple[str, ...]] = set()
    for index, item in enumerate(items):
        if item in seen:
            yield index
        seen.add(item)
