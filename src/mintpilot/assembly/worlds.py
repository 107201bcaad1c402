"""From a mission file to a world: mission, task, truth, and a scene to fly in or a map to think on."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

from mintpilot.assembly.spoken_rules import with_rules
from mintpilot.core.errors import InputError, MissionError
from mintpilot.core.gap import CorrelationGroup
from mintpilot.core.geometry import Vec3
from mintpilot.core.message import joined
from mintpilot.core.mission import Mission
from mintpilot.core.observation import PERSON
from mintpilot.core.plan import VehicleLimits
from mintpilot.core.semantic_map import SemanticMap
from mintpilot.core.task import SLOW, KeepAway, Reference, Task
from mintpilot.mapping.listed_objects import with_solid_objects
from mintpilot.mission_file.ruling import rules_of
from mintpilot.mission_file.schema import MissionFile
from mintpilot.mission_file.schema_base import attributes_of, in_english, place_of
from mintpilot.mission_file.schema_core import asking_of, correlations_of, limits_of, mission_of, task_of, truths_of
from mintpilot.mission_file.schema_map import load_bare_map, map_of
from mintpilot.mission_file.schema_scene import ClosedRoomSpec, PersonSpec, SceneSpec
from mintpilot.mission_file.schema_world import MapWorld, ScenarioWorld, SceneWorld, SeenWorld
from mintpilot.mission_file.seen_map import load_map
from mintpilot.mission_file.values import with_values
from mintpilot.simulation.scene import ClosedRoom, FlightRules, Person, Scene, Shape, Smoke, Solid
from mintpilot.uncertainty.findings import find_gaps
from mintpilot.uncertainty.keep_away import check_keep_away, with_keep_away

if TYPE_CHECKING:
    from mintpilot.core.ports import TruthOracle
    from mintpilot.simulation.scenarios import Scenario

RESERVE = 0.2
"""Share of a battery that plans leave."""
ROUNDING_M = 1e-6
"""Rounding error of distances, metres, that no collision is made of."""


@dataclass(frozen=True, slots=True, kw_only=True)
class World:
    """Everything about a mission's world."""

    mission: Mission
    task: Task
    make_scene: Callable[[], Scene]
    """Makes the truth to fly in; thinking needs none. It can be pickled, for workers."""
    rules: FlightRules
    make_truth: Callable[[], TruthOracle]
    """Makes what knows the answers: for scripted operators and judges only."""
    map: SemanticMap
    """What a perfect survey would show, or the map that was given."""
    is_map: bool
    """True when the map was given: there is nothing to render or survey."""
    seed: int
    groups: tuple[CorrelationGroup, ...] = ()

    @property
    def truth(self) -> TruthOracle:
        """What knows the answers; made anew each time."""
        return self.make_truth()

    @property
    def scene(self) -> Scene:
        """The truth to fly in; made when it is asked for."""
        return self.make_scene()


class Parse(Protocol):
    """Reads an instruction."""

    def __call__(self, text: str, /, *, home_m: Vec3 | None, known: Collection[str] = ()) -> Task:
        """The task. Raises `InputError` with the reason.

        ``home_m`` is where the drone comes back to, metres; ``known`` the words that the map uses for things.
        """
        ...


MOST_SEED = 2**32 - 1


def build_world(file: MissionFile, *, base: Path, seed: int | None, parse: Parse | None = None) -> World:
    """The world of a mission file.

    Args:
        file: the checked mission.
        base: folder that file names in it are relative to.
        seed: overrides the seed in the file.
        parse: reads the instruction where the file gives no goals; None: rules do.

    Raises:
        InputError: the instruction is not understood, or a map or scenario cannot be used.
    """
    parse = parse or _by_rules
    world = file.world
    drawn = seed if seed is not None else (world.seed or 0)
    if not 0 <= drawn <= MOST_SEED:
        raise InputError(f"seed {drawn} must be a whole number from 0 to {MOST_SEED}; give one of them")
    if isinstance(world, ScenarioWorld):
        return _from_scenario(file, world, drawn, parse)
    if isinstance(world, SceneWorld):
        return _from_scene(file, replace(scene_of(world.scene, file.name), seed=drawn), drawn, parse)
    if isinstance(world, SeenWorld):
        seen, begin = load_map(base / world.seen)
        return _from_seen(file, seen, world.start_m or begin, drawn, parse)
    return _from_map(file, world, base, drawn, parse)


def _from_scenario(file: MissionFile, world: ScenarioWorld, seed: int, parse: Parse) -> World:
    scenario = scenario_of(world, seed)
    given = file.model_fields_set
    limits, rules = scenario.mission.limits, scenario.rules
    if "vehicle" in given:
        limits = limits_of(file)
        if file.vehicle.endurance_s is None:
            limits = replace(limits, endurance_s=scenario.mission.limits.endurance_s)
        else:
            limits, rules = _with_reserve(limits), replace(rules, endurance_s=limits.endurance_s)
    mission = replace(
        scenario.mission,
        name=file.name,
        instruction=file.instruction,
        limits=limits,
        asking=asking_of(file) if "asking" in given else scenario.mission.asking,
        georeference=mission_of(file, start_m=scenario.mission.start_m, volume=scenario.mission.volume).georeference,
    )
    if file.survey is not None:
        surveyed = mission_of(file, start_m=mission.start_m, volume=mission.volume)
        mission = replace(mission, survey=surveyed.survey, resolution_m=surveyed.resolution_m)
    return _assembled(file, mission, scenario.scene, rules, seed, parse)


def _from_scene(file: MissionFile, scene: Scene, seed: int, parse: Parse) -> World:
    mission = mission_of(file, start_m=scene.start_m, volume=scene.volume)
    rules = FlightRules(endurance_s=mission.limits.endurance_s)
    return _assembled(file, replace(mission, limits=_with_reserve(mission.limits)), scene, rules, seed, parse)


def _by_rules(text: str, /, *, home_m: Vec3 | None, known: Collection[str] = ()) -> Task:
    from mintpilot.language.instruction import parse_instruction

    return parse_instruction(text, home_m=home_m, known=known)


def _assembled(file: MissionFile, mission: Mission, scene: Scene, rules: FlightRules, seed: int, parse: Parse) -> World:
    from mintpilot.simulation.scene_map import map_of_scene

    task = _with_wishes(task_of(file) or parse(mission.instruction, home_m=mission.start_m), file, {})
    scene = _with_people_sought(scene, task)
    seen = map_of_scene(scene, mission.resolution_m)
    return World(
        mission=replace(mission, limits=_at_pace(mission.limits, task)),
        task=task,
        make_scene=partial(_as_it_is, scene),
        rules=rules,
        make_truth=partial(_truth_of_scene, scene),
        map=with_keep_away(seen, task, start_m=mission.start_m),
        is_map=False,
        seed=seed,
        groups=correlations_of(file),
    )


def _from_map(file: MissionFile, world: MapWorld, base: Path, seed: int, parse: Parse) -> World:
    """The world of a map of one's own."""
    bare = load_bare_map(world, base)
    start = place_of(world.start_m, world.height_m)
    regions = {region.id: in_english(region.description) for region in world.regions}
    task = _task_on_map(file, parse, start, world.height_m, regions)
    limits = mission_of(file, start_m=start, volume=bare.frame.box).limits
    map_ = map_of(
        world,
        base,
        file.priors,
        bare=bare,
        goals_m=[goal.reference.position_m for goal in task.subgoals if goal.reference.position_m is not None],
        clearance_m=limits.clearance_m,
    )
    return _on_map(file, map_, task, start, seed)


def _from_seen(file: MissionFile, map_: SemanticMap, start: Vec3, seed: int, parse: Parse) -> World:
    """The world of what was seen in pictures."""
    regions = {region.id: region.description for region in map_.regions}
    return _on_map(file, map_, _task_on_map(file, parse, start, None, regions), start, seed)


def _task_on_map(
    file: MissionFile, parse: Parse, start: Vec3, layer_m: float | None, regions: Mapping[str, str]
) -> Task:
    said = task_of(file) if layer_m is None else task_of(file, layer_m=layer_m)
    read = said or parse(file.instruction, home_m=start, known=listed_words(file.world))
    return _with_wishes(read, file, regions)


def _on_map(file: MissionFile, map_: SemanticMap, task: Task, start: Vec3, seed: int) -> World:
    mission = mission_of(file, start_m=start, volume=map_.frame.box)
    valued = with_values(map_, file.values, mission.limits)
    map_, truths = valued.map, truths_of(file) | valued.truths
    problems = find_gaps(map_, task, start_m=start).problems if task.needs_confirmation else ()
    if problems:
        raise InputError(f"'{mission.instruction}' was read by a language model: {joined(problems)}")
    check_keep_away(map_, task, start_m=start)
    return World(
        mission=replace(mission, limits=_with_reserve(_at_pace(mission.limits, task)), volume=map_.frame.box),
        task=task,
        make_scene=partial(_scene_on_map, map_, file.name, task, truths, start),
        rules=replace(_hull(mission.limits, flat=map_.frame.is_flat), endurance_s=mission.limits.endurance_s),
        make_truth=partial(_declared_truth, truths),
        map=with_keep_away(with_solid_objects(map_, mission.limits.clearance_m), task, start_m=start),
        is_map=True,
        seed=seed,
        groups=(*correlations_of(file), *valued.groups),
    )


def _as_it_is(scene: Scene) -> Scene:
    return scene


def _truth_of_scene(scene: Scene) -> TruthOracle:
    from mintpilot.simulation.truth import SceneTruth

    return SceneTruth(scene)


def _declared_truth(truths: Mapping[str, str]) -> TruthOracle:
    from mintpilot.assembly.declared import DeclaredTruth

    return DeclaredTruth(truths)


def _scene_on_map(map_: SemanticMap, name: str, task: Task, truths: Mapping[str, str], start: Vec3) -> Scene:
    from mintpilot.assembly.declared import wanted_of
    from mintpilot.simulation.map_scene import scene_of_map

    wanted = wanted_of(map_, task, truths, start)
    return scene_of_map(
        map_,
        name=name,
        start_m=start,
        truths=truths,
        goal_objects=wanted.objects,
        places_m=wanted.places,
        must_be_found=wanted.people,
        occupants_sought=task.seeks_people,
    )


def _with_people_sought(scene: Scene, task: Task) -> Scene:
    """The scene in which only people whom the task is about must be found: others fail no mission."""
    if task.seeks_people:
        return scene
    spoken_of = any(PERSON in (g.reference.label, g.thing.label if g.thing else "") for g in task.subgoals)
    people = tuple(p if spoken_of else replace(p, must_be_found=False) for p in scene.persons)
    rooms = tuple(
        room if room.occupant is None else replace(room, occupant=replace(room.occupant, must_be_found=False))
        for room in scene.rooms
    )
    return replace(scene, persons=people, rooms=rooms)


def _hull(limits: VehicleLimits, *, flat: bool) -> FlightRules:
    """The largest upright hull of the usual proportions that the vehicle's radius allows, less rounding.

    On a voxel map no part of it may be further from the centre than the radius; on a flat one only its width counts.
    """
    half_height_m = min(FlightRules().half_height_m, limits.radius_m / 5)
    wide = limits.radius_m if flat else math.sqrt(limits.radius_m**2 - half_height_m**2)
    return FlightRules(radius_m=wide - ROUNDING_M, half_height_m=half_height_m)


def listed_words(world: MapWorld | ScenarioWorld | SceneWorld | SeenWorld) -> frozenset[str]:
    """The words that a given map uses for things, as its file states them; none for other worlds."""
    if not isinstance(world, MapWorld):
        return frozenset()
    objects = world.objects
    said = [o.label for o in objects] + [v for o in objects for values in o.attributes.values() for v in values]
    said += [in_english(room.description) for room in world.rooms]
    said += [in_english(region.description) for region in world.regions]
    return frozenset(word for text in said for word in text.lower().replace("_", " ").split())


def _with_wishes(task: Task, file: MissionFile, regions: Mapping[str, str]) -> Task:
    """The task with the rules of the file and the distances that it wants kept, besides those of the instruction."""
    if file.seeks_people is not None and file.seeks_people is not task.seeks_people:
        task = replace(task, seeks_people=file.seeks_people)
    task = with_rules(task, regions, rules_of(file))
    if not file.keep_away:
        return task
    from mintpilot.language.phrases import parse_phrase

    wishes = tuple(
        KeepAway(
            reference=Reference(phrase=spec.thing, object_id=spec.thing)
            if spec.thing in regions
            else replace(parse_phrase(spec.thing), every=True),
            distance_m=spec.metres,
        )
        for spec in file.keep_away
    )
    return replace(task, keep_away=(*task.keep_away, *wishes))


def _at_pace(limits: VehicleLimits, task: Task) -> VehicleLimits:
    """The limits with the cruise speed that the person asked for."""
    return replace(limits, cruise_mps=limits.cruise_mps * SLOW) if task.slowly else limits


def _with_reserve(limits: VehicleLimits) -> VehicleLimits:
    """Plans may use the battery less a reserve, for braking, corners and gusts: costs are lengths at cruise speed."""
    return replace(limits, endurance_s=limits.endurance_s * (1 - RESERVE))


def scenario_of(world: ScenarioWorld, seed: int) -> Scenario:
    """The drawn scenario of a mission file.

    Raises:
        UnknownNameError: the generator has no parameter of a name.
        MissionError: a parameter's value breaks a rule.
    """
    from mintpilot.simulation.scenarios import make_scenario

    return make_scenario(world.scenario, seed, **_numbers(world.parameters))


def _numbers(parameters: Mapping[str, bool | int | float | str]) -> dict[str, float]:
    """Generators take numbers only."""
    for name, value in parameters.items():
        if isinstance(value, str):
            raise MissionError(f"scenario parameter {name} = '{value}': must be a number; write it without quotes")
    return {name: float(value) for name, value in parameters.items()}


def scene_of(spec: SceneSpec, name: str) -> Scene:
    """The explicit scene of a mission file."""
    return Scene(
        name=name,
        volume=spec.volume.box(),
        start_m=spec.start_m,
        solids=tuple(
            Solid(
                id=s.id,
                kind=s.kind,
                extent_m=s.extent_m.box(),
                shape=Shape(s.shape),
                colour=s.colour,
                attributes=attributes_of(s.attributes),
                appears_s=s.appears_s,
            )
            for s in spec.solids
        ),
        smokes=tuple(
            Smoke(id=s.id, extent_m=s.extent_m.box(), toxic=s.toxic, prior_safe=s.prior_safe) for s in spec.smokes
        ),
        rooms=tuple(_room_of(room) for room in spec.rooms),
        persons=tuple(_person_of(person) for person in spec.persons),
        goal_objects=tuple(spec.goal_objects),
        seed=spec.seed,
    )


def _room_of(spec: ClosedRoomSpec) -> ClosedRoom:
    return ClosedRoom(
        id=spec.id,
        extent_m=spec.extent_m.box(),
        door_m=spec.door_m.box(),
        viewpoint_m=spec.viewpoint_m,
        occupant=_person_of(spec.occupant) if spec.occupant else None,
        prior_occupied=spec.prior_occupied,
        wall_m=spec.wall_m,
    )


def _person_of(spec: PersonSpec) -> Person:
    return Person(id=spec.id, position_m=spec.position_m, yaw_rad=spec.yaw_rad, must_be_found=spec.must_be_found)
