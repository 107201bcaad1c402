"""From a world to a crew: vehicle, eyes, strategy, operator, recorder, ready for the loop."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager, ExitStack
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from mintpilot.assembly.registry import load
from mintpilot.assembly.talk import Talk
from mintpilot.assembly.worlds import World
from mintpilot.core.errors import InputError
from mintpilot.core.geometry import Floats, GridFrame
from mintpilot.core.ports import Operator, Perception, Recorder
from mintpilot.core.semantic_map import SemanticMap
from mintpilot.core.task import Action
from mintpilot.interaction.scripted import ScriptedOperator
from mintpilot.mapping.builder import MapBuilder
from mintpilot.mission.eyes import CameraEyes, Eyes, FixedEyes
from mintpilot.mission.loop import Crew
from mintpilot.mission.mind import Thinking
from mintpilot.mission.survey import survey
from mintpilot.mission_file.schema import OperatorSpec
from mintpilot.simulation.kinematic import KinematicSimulator
from mintpilot.simulation.mujoco_vehicle import MujocoSimulator
from mintpilot.simulation.scene_eyes import SceneEyes
from mintpilot.uncertainty.keep_away import with_keep_away


class VehicleChoice(StrEnum):
    """What the mission is flown with."""

    MUJOCO = "mujoco"
    """Four rotors, physics, rendered RGB-D: the map is made by a survey flight."""
    KINEMATIC = "kinematic"
    """Follows trajectories exactly; the map is what a perfect survey would show."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Choices:
    """What a command line or a caller chooses."""

    strategy: str = "mint"
    vehicle: VehicleChoice = VehicleChoice.MUJOCO
    planner: str = "grid"
    perception: str = "geometric"
    camera_size: tuple[int, int] = (320, 240)


def thinking_parts(world: World, choices: Choices, talk: Talk | None = None) -> Thinking:
    """The parts that deliberation is done with; ``talk`` may bring somebody who proposes cuts.

    Raises:
        UnknownNameError: a strategy, objective, metric or planner that nobody registered.
    """
    asking = world.mission.asking
    return Thinking(
        mission=world.mission,
        task=world.task,
        planner=load("planner", choices.planner)(),
        strategy=load("strategy", choices.strategy)(),
        metric=load("metric", asking.impact_metric)(),
        objective=load("objective", asking.objective)(),
        groups=world.groups,
        proposer=talk.proposer if talk is not None else None,
    )


def scripted_operator(world: World, spec: OperatorSpec) -> ScriptedOperator:
    """An operator that knows the truth of the world."""
    return ScriptedOperator(
        world.truth,
        rng=np.random.default_rng([world.seed, 7]),
        answer_error=spec.answer_error,
        unsure_rate=spec.unsure,
        silence_rate=spec.silence,
        latency_s=spec.latency_s,
    )


def crew_for(
    world: World, choices: Choices, *, operator: Operator, recorder: Recorder, talk: Talk | None = None
) -> AbstractContextManager[Crew]:
    """A crew, as a context that closes the simulator, and the language model of ``talk``, in the end.

    Args:
        world: what is flown in.
        choices: which parts.
        operator: who answers.
        recorder: told about everything.
        talk: the mission's language; None: English by template.

    Raises:
        MissingPartError: MuJoCo is chosen but not installed.
    """
    return _CrewContext(world, choices, operator, recorder, talk or Talk())


class _CrewContext(AbstractContextManager[Crew]):
    def __init__(self, world: World, choices: Choices, operator: Operator, recorder: Recorder, talk: Talk) -> None:
        self._world, self._choices, self._operator, self._recorder = world, choices, operator, recorder
        self._talk = talk
        self._stack = ExitStack()

    def __enter__(self) -> Crew:
        world, choices = self._world, self._choices
        self._stack.callback(self._talk.close)
        parts = thinking_parts(world, choices, self._talk)
        if choices.vehicle is VehicleChoice.MUJOCO and not world.is_map:
            simulator = MujocoSimulator(world.scene, world.rules, seed=world.seed, camera_size=choices.camera_size)
            self._stack.callback(simulator.close)
            perception: Perception = load("perception", choices.perception)()
            builder = map_builder(world)
            eyes = CameraEyes(camera=simulator, perception=perception, builder=builder, recorder=self._recorder)
            seen_by_camera: Eyes = KeepAwayEyes(eyes, world) if world.task.keep_away else eyes
            return self._crew(parts, simulator, seen_by_camera, self._surveyed(simulator, eyes), watch_map=True)
        photographs = [g for g in world.task.subgoals if g.action is Action.PHOTOGRAPH]
        if photographs:
            raise InputError(
                f"'photograph {photographs[0].reference.phrase}' cannot be done: this vehicle has no camera. "
                "Fly with one that has, or leave the picture out."
            )
        kinematic = KinematicSimulator(world.scene, world.rules, seed=world.seed)
        seen: Eyes = FixedEyes(world.map) if world.is_map else SceneEyes(world.scene, kinematic.state)
        changes = any(solid.appears_s > 0 for solid in world.scene.solids)

        def given() -> SemanticMap:
            kinematic.begin_mission()
            return world.map

        return self._crew(parts, kinematic, seen, given, watch_map=changes)

    def __exit__(self, *_: object) -> None:
        self._stack.close()

    def _surveyed(self, simulator: MujocoSimulator, eyes: CameraEyes) -> Callable[[], SemanticMap]:
        def fly() -> SemanticMap:
            mission = self._world.mission
            if mission.survey is None:
                first = eyes.look(None)
            else:
                first = survey(mission, mission.survey, vehicle=simulator, eyes=eyes, recorder=self._recorder)
            simulator.begin_mission()
            return with_keep_away(first, self._world.task, start_m=mission.start_m)

        return fly

    def _crew(
        self,
        parts: Thinking,
        simulator: MujocoSimulator | KinematicSimulator,
        eyes: Eyes,
        first_map: Callable[[], SemanticMap],
        *,
        watch_map: bool,
    ) -> Crew:
        return Crew(
            thinking=parts,
            vehicle=simulator,
            eyes=eyes,
            operator=self._operator,
            recorder=self._recorder,
            survey=first_map,
            judge=simulator,
            word=self._talk.word,
            improve=self._talk.improve,
            remarks=self._talk.take_remarks,
            language=self._talk.lang,
            language_model=self._talk.model_name,
            simulated=True,
            watch_map=watch_map,
            strategy_name=self._choices.strategy,
            seed=self._world.seed,
        )


class KeepAwayEyes(Eyes):
    """Draws what is to be kept away from on every map that the drone makes.

    Args:
        eyes: make the map.
        world: says from what, and where the mission starts.
    """

    def __init__(self, eyes: Eyes, world: World) -> None:
        self._eyes = eyes
        self._world = world

    def look(self, previous: SemanticMap | None) -> SemanticMap:
        """See `Eyes.look`."""
        mission = self._world.mission
        newer = self._eyes.look(previous)
        return with_keep_away(newer, self._world.task, start_m=mission.start_m, previous=previous)

    def flown(self, points_m: Floats, radius_m: float) -> None:
        """See `Eyes.flown`."""
        self._eyes.flown(points_m, radius_m)


def map_builder(world: World) -> MapBuilder:
    """A builder on the lattice of the world's map."""
    mission = world.mission
    frame: GridFrame = world.map.frame
    return MapBuilder(
        frame,
        limits=mission.limits,
        volume=mission.volume,
        prior_passable=mission.prior_passable,
        prior_occupied=mission.prior_occupied,
    )
