"""From a mission file to a world: mission, task, truth, and a scene to fly in or a map to think on."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Protocol

from mintpilot.assembly.declared import DeclaredTruth, wanted_of
from mintpilot.core.errors import MissionError
from mintpilot.core.gap import CorrelationGroup
from mintpilot.core.geometry import Vec3
from mintpilot.core.mission import Mission
from mintpilot.core.plan import VehicleLimits
from mintpilot.core.ports import TruthOracle
from mintpilot.core.semantic_map import SemanticMap
from mintpilot.core.task import Task
from mintpilot.language.instruction import parse_instruction
from mintpilot.mission_file.schema import MissionFile
from mintpilot.mission_file.schema_base import attributes_of, place_of
from mintpilot.mission_file.schema_core import asking_of, correlations_of, limits_of, mission_of, task_of, truths_of
from mintpilot.mission_file.schema_map import map_of
from mintpilot.mission_file.schema_scene import ClosedRoomSpec, PersonSpec, SceneSpec
from mintpilot.mission_file.schema_world import ScenarioWorld, SceneWorld, SeenWorld
from mintpilot.mission_file.seen_map import load_map
from mintpilot.simulation.map_scene import scene_of_map
from mintpilot.simulation.scenarios import Scenario, make_scenario
from mintpilot.simulation.scene import ClosedRoom, FlightRules, Person, Scene, Shape, Smoke, Solid
from mintpilot.simulation.scene_map import map_of_scene
from mintpilot.simulation.truth import SceneTruth

RESERVE = 0.2
"""Share of a battery that plans leave."""


@dataclass(frozen=True, slots=True, kw_only=True)
class World:
    """Everything about a mission's world."""

    mission: Mission
    task: Task
    scene: Scene
    """The truth to fly in."""
    rules: FlightRules
    truth: TruthOracle
    """For scripted operators only."""
    map: SemanticMap
    """What a perfect survey would show, or the map that was given."""
    is_map: bool
    """True when the map was given: there is nothing to render or survey."""
    seed: int
    groups: tuple[CorrelationGroup, ...] = ()


class Parse(Protocol):
    """Reads an instruction."""

    def __call__(self, text: str, /, *, home_m: Vec3 | None) -> Task:
        """The task; ``home_m`` is where the drone comes back to, metres. Raises `InputError` with the reason."""
        ...


def build_world(file: MissionFile, *, base: Path, seed: int | None, parse: Parse = parse_instruction) -> World:
    """The world of a mission file.

    Args:
        file: the checked mission.
        base: folder that file names in it are relative to.
        seed: overrides the seed in the file.
        parse: reads the instruction where the file gives no goals.

    Raises:
        InputError: the instruction is not understood, or a map or scenario cannot be used.
    """
    world = file.world
    drawn = seed if seed is not None else (world.seed or 0)
    if isinstance(world, ScenarioWorld):
        return _from_scenario(file, world, drawn, parse)
    if isinstance(world, SceneWorld):
        return _from_scene(file, replace(scene_of(world.scene, file.name), seed=drawn), drawn, parse)
    if isinstance(world, SeenWorld):
        seen, begin = load_map(base / world.seen)
        return _from_map(file, seen, world.start_m or begin, None, drawn, parse)
    start = place_of(world.start_m, world.height_m)
    return _from_map(file, map_of(world, base, file.priors), start, world.height_m, drawn, parse)


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
    )
    if file.survey is not None:
        surveyed = mission_of(file, start_m=mission.start_m, volume=mission.volume)
        mission = replace(mission, survey=surveyed.survey, resolution_m=surveyed.resolution_m)
    return _assembled(file, mission, scenario.scene, rules, seed, parse)


def _from_scene(file: MissionFile, scene: Scene, seed: int, parse: Parse) -> World:
    mission = mission_of(file, start_m=scene.start_m, volume=scene.volume)
    rules = FlightRules(endurance_s=mission.limits.endurance_s)
    return _assembled(file, replace(mission, limits=_with_reserve(mission.limits)), scene, rules, seed, parse)


def _assembled(file: MissionFile, mission: Mission, scene: Scene, rules: FlightRules, seed: int, parse: Parse) -> World:
    return World(
        mission=mission,
        task=task_of(file) or parse(mission.instruction, home_m=mission.start_m),
        scene=scene,
        rules=rules,
        truth=SceneTruth(scene),
        map=map_of_scene(scene, mission.resolution_m),
        is_map=False,
        seed=seed,
        groups=correlations_of(file),
    )


def _from_map(
    file: MissionFile, map_: SemanticMap, start: Vec3, layer_m: float | None, seed: int, parse: Parse
) -> World:
    truths = truths_of(file)
    mission = mission_of(file, start_m=start, volume=map_.frame.box)
    task = (task_of(file, layer_m=layer_m) if layer_m is not None else task_of(file)) or parse(
        mission.instruction, home_m=mission.start_m
    )
    wanted = wanted_of(map_, task, truths, start)
    scene = scene_of_map(
        map_,
        name=file.name,
        start_m=start,
        truths=truths,
        goal_objects=wanted.objects,
        places_m=wanted.places,
        must_be_found=wanted.people,
    )
    rules = FlightRules(radius_m=min(0.27, mission.limits.radius_m), endurance_s=mission.limits.endurance_s)
    return World(
        mission=replace(mission, limits=_with_reserve(mission.limits)),
        task=task,
        scene=scene,
        rules=rules,
        truth=DeclaredTruth(truths),
        map=map_,
        is_map=True,
        seed=seed,
        groups=correlations_of(file),
    )


def _with_reserve(limits: VehicleLimits) -> VehicleLimits:
    """Plans may use the battery less a reserve, for braking, corners and gusts: costs are lengths at cruise speed."""
    return replace(limits, endurance_s=limits.endurance_s * (1 - RESERVE))


def scenario_of(world: ScenarioWorld, seed: int) -> Scenario:
    """The drawn scenario of a mission file.

    Raises:
        UnknownNameError: the generator has no parameter of a name.
        MissionError: a parameter's value breaks a rule.
    """
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
