"""From a world to the components of a mission: vehicle, map source, strategy, operators, recorder."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import AbstractContextManager, ExitStack
from dataclasses import dataclass, field, replace
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from mintpilot.assembly.briefing import briefing_of
from mintpilot.assembly.policies import make_metric, make_planner
from mintpilot.assembly.stated_looks import with_stated_looks
from mintpilot.assembly.strategies import Argument, make_objective, make_strategy, strategy_label
from mintpilot.assembly.talk import Talk
from mintpilot.assembly.worlds import World
from mintpilot.core.errors import InputError
from mintpilot.core.geometry import Floats, GridFrame
from mintpilot.core.ports import Judge, Operator, Perception, Recorder, Vehicle
from mintpilot.core.semantic_map import SemanticMap
from mintpilot.core.task import Action
from mintpilot.core.think_time import think_time
from mintpilot.elicitation.wording import word_question
from mintpilot.mission.components import MissionComponents
from mintpilot.mission.deliberation import DeliberationParts
from mintpilot.mission.map_source import CameraMapSource, GivenMap, MapSource
from mintpilot.mission_file.schema import OperatorSpec
from mintpilot.uncertainty.keep_away import with_keep_away

if TYPE_CHECKING:
    from mintpilot.assembly.earlier_map import EarlierMap
    from mintpilot.interaction.scripted import ScriptedOperator
    from mintpilot.mapping.builder import MapBuilder
    from mintpilot.simulation.kinematic import KinematicSimulator
    from mintpilot.simulation.mujoco_vehicle import MujocoSimulator

TAKE_OFF_CLEAR_M = 1.0
"""Free space around the hover point that whoever puts the drone down vouches for, metres."""


class VehicleChoice(StrEnum):
    """What the mission is flown with."""

    MUJOCO = "mujoco"
    """Four rotors, physics, rendered RGB-D: the map is made by a survey flight."""
    KINEMATIC = "kinematic"
    """Follows trajectories exactly; the map is what a perfect survey would show."""
    MAVLINK = "mavlink"
    """A real vehicle, over MAVLink or by a plug-in; the map is given, and there is no camera."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Choices:
    """What a command line or a caller chooses."""

    strategy: str = "mint"
    strategy_arguments: Mapping[str, Argument] = field(default_factory=dict)
    """The strategy's own, e.g. ``{"quantile": 0.8}``."""
    vehicle: VehicleChoice = VehicleChoice.MUJOCO
    address: str = ""
    """Where a real vehicle is reached: ``mavlink://udpin:127.0.0.1:14540``."""
    accept_failsafes: bool = False
    """Fly a real vehicle although its autopilot's fail-safes are not as they should be."""
    planner: str = "grid"
    perception: str = "geometric"
    namers: tuple[str, ...] = ()
    """Who names what perception finds; empty: its own way."""
    calibration: Path | None = None
    """File of measured confidences of the namers; None: as they say them."""
    camera_size: tuple[int, int] = (320, 240)
    earlier: EarlierMap | None = None
    """The map of an earlier mission, to begin with in place of a survey; None: there is none."""
    views: bool = False
    """Whether somebody watches the camera's pictures while it is flown."""
    briefs: bool = False
    """Whether go or no-go is asked before take-off. It always is where a language model read the instruction."""


def deliberation_parts(world: World, choices: Choices, talk: Talk | None = None) -> DeliberationParts:
    """The parts that deliberation is done with; ``talk`` may bring somebody who proposes queries.

    Raises:
        UnknownNameError: a strategy, objective, metric or planner that nobody registered.
        InputError: the strategy does not take those arguments.
    """
    asking = world.mission.asking
    return DeliberationParts(
        mission=world.mission,
        task=world.task,
        planner=make_planner(choices.planner),
        strategy=make_strategy(choices.strategy, seed=world.seed, arguments=choices.strategy_arguments),
        metric=make_metric(asking.impact_metric),
        objective=make_objective(asking.objective, seed=world.seed),
        groups=world.groups,
        proposer=talk.proposer if talk is not None else None,
        word=talk.word if talk is not None else word_question,
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class PartsBesideVehicle:
    """Makes the parts of deliberation in the process that deliberates. Language models stay with the loop."""

    world: World
    choices: Choices
    lang: str
    names: tuple[tuple[str, str], ...]

    def __call__(self) -> DeliberationParts:
        """The parts; questions are worded in the mission's language by template, and bettered by the loop."""
        return deliberation_parts(self.world, self.choices, Talk(lang=self.lang, names=dict(self.names)))


def scripted_operator(world: World, spec: OperatorSpec) -> ScriptedOperator:
    """An operator that knows the truth of the world."""
    from mintpilot.interaction.scripted import ScriptedOperator

    return ScriptedOperator(
        world.truth,
        rng=np.random.default_rng([world.seed, 7]),
        answer_error=spec.answer_error,
        unsure_rate=spec.unsure,
        silence_rate=spec.silence,
        think=think_time(spec.latency_s),
    )


def components_for(
    world: World,
    choices: Choices,
    *,
    operators: tuple[Operator, ...],
    recorder: Recorder,
    talk: Talk | None = None,
    digests: bool = False,
) -> AbstractContextManager[MissionComponents]:
    """The components of a mission, as a context that closes the simulator, and the language model of ``talk``.

    Args:
        world: what is flown in.
        choices: which parts.
        operators: who answers and gives orders.
        recorder: told about everything.
        talk: the mission's language; None: English by template.
        digests: whether the record is to be replayed.

    Raises:
        MissingPartError: MuJoCo is chosen but not installed.
    """
    return _Components(world, choices, operators, recorder, talk or Talk(), digests)


class _Components(AbstractContextManager[MissionComponents]):
    def __init__(
        self,
        world: World,
        choices: Choices,
        operators: tuple[Operator, ...],
        recorder: Recorder,
        talk: Talk,
        digests: bool,
    ) -> None:
        self._world, self._choices, self._operators, self._recorder = world, choices, operators, recorder
        self._talk, self._digests = talk, digests
        self._perception: Perception | None = None
        self._stack = ExitStack()

    def __enter__(self) -> MissionComponents:
        from mintpilot.planning.warm import warm_up

        warm_up()
        world, choices = self._world, self._choices
        self._stack.callback(self._talk.close)
        if choices.vehicle is VehicleChoice.MUJOCO and not world.is_map:
            from mintpilot.simulation.mujoco_vehicle import MujocoSimulator

            simulator = MujocoSimulator(world.scene, world.rules, seed=world.seed, camera_size=choices.camera_size)
            self._stack.callback(simulator.close)
            wanted = tuple(dict.fromkeys(g.reference.label for g in world.task.subgoals if g.reference.label))
            from mintpilot.assembly.perceiving import Seeing, make_perception

            perception = make_perception(
                Seeing(
                    perception=choices.perception,
                    namers=choices.namers,
                    wanted=wanted,
                    calibration=choices.calibration,
                )
            )
            self._perception = perception
            builder = map_builder(world)
            earlier = choices.earlier
            surveys = world.mission.survey is not None and earlier is None
            if earlier is not None:
                builder.begin_with(earlier.map)
            if surveys or earlier is not None:
                # Whoever puts the drone down vouches for the space around it: the camera never sees it.
                builder.mark_flown(np.asarray([world.mission.start_m], float), TAKE_OFF_CLEAR_M)
            camera = CameraMapSource(camera=simulator, perception=perception, builder=builder, recorder=self._recorder)
            source: MapSource = KeepAwayMapSource(camera, world) if world.task.keep_away else camera
            known = earlier.map if earlier is not None else None if surveys else world.map
            made = self._made(simulator, source, surveys=surveys, known=known, watch_map=True)
            viewed = simulator if choices.views else None
            return replace(made, viewed=viewed, begins_with=earlier.words if earlier is not None else "")
        if choices.earlier is not None:
            raise InputError(
                "--map needs a camera, which looks again at what was free: fly with --vehicle mujoco, or leave it out"
            )
        photographs = [g for g in world.task.subgoals if g.action is Action.PHOTOGRAPH]
        if photographs:
            raise InputError(
                f"'photograph {photographs[0].reference.phrase}' cannot be done: this vehicle has no camera. "
                "Fly with one that has, or leave the picture out."
            )
        if choices.vehicle is VehicleChoice.MAVLINK:
            return self._beside_vehicle()
        from mintpilot.simulation.kinematic import KinematicSimulator
        from mintpilot.simulation.scene_map_source import SceneMapSource

        kinematic = KinematicSimulator(world.scene, world.rules, seed=world.seed)
        given: MapSource = GivenMap(world.map)
        if not world.is_map:
            given = SceneMapSource(world.scene, world.map, kinematic.state)
        if world.mission.looks:
            given = with_stated_looks(given, world, kinematic.state)
        changes = any(solid.appears_s > 0 for solid in world.scene.solids)
        return self._made(kinematic, given, surveys=False, known=world.map, watch_map=changes)

    def _beside_vehicle(self) -> MissionComponents:
        """A real vehicle on a given map. Nobody judges it, and it ends on the ground."""
        from mintpilot.assembly.real_vehicle import make_vehicle
        from mintpilot.mission.process_worker import ProcessWorker

        world, choices = self._world, self._choices
        if world.task.needs_confirmation and not any(operator.attended for operator in self._operators):
            raise InputError(
                f"'{world.mission.instruction}' was read by a language model: a real vehicle flies it only after "
                "somebody has said go; use --operator terminal or console"
            )
        vehicle = make_vehicle(world, choices.address, accept_failsafes=choices.accept_failsafes)
        self._stack.callback(vehicle.close)
        beside = PartsBesideVehicle(
            world=world, choices=choices, lang=self._talk.lang, names=tuple(self._talk.names.items())
        )
        return replace(
            self._common(vehicle, GivenMap(world.map), known=world.map, watch_map=False),
            worker=lambda _: ProcessWorker(beside),
            lands=True,
        )

    def __exit__(self, *_: object) -> None:
        self._stack.close()

    def _remarks(self) -> tuple[str, ...]:
        from mintpilot.assembly.perceiving import remarks_of

        seen = () if self._perception is None else tuple(remarks_of(self._perception))
        return (*self._talk.take_remarks(), *seen)

    def _made(
        self,
        simulator: MujocoSimulator | KinematicSimulator,
        source: MapSource,
        *,
        surveys: bool,
        known: SemanticMap | None,
        watch_map: bool,
    ) -> MissionComponents:
        made = self._common(simulator, source, known=known, watch_map=watch_map)
        judge: Judge = simulator
        if self._world.task.rules:
            from mintpilot.assembly.rule_judge import RuleJudge

            judge = ruled = RuleJudge(simulator, made.recorder, self._world)
            made = replace(made, recorder=ruled)
        return replace(
            made,
            begin_task=simulator.begin_mission,
            judge=judge,
            surveys=surveys,
            simulated=True,
        )

    def _common(
        self, vehicle: Vehicle, source: MapSource, *, known: SemanticMap | None, watch_map: bool
    ) -> MissionComponents:
        parts = deliberation_parts(self._world, self._choices, self._talk)
        briefed = self._choices.briefs or self._world.task.needs_confirmation
        return MissionComponents(
            parts=parts,
            briefing=briefing_of(parts, known, lang=self._talk.lang) if briefed else None,
            vehicle=vehicle,
            map_source=source,
            operators=self._operators,
            recorder=self._recorder,
            improve=self._talk.improve,
            remarks=self._remarks,
            watch_map=watch_map,
            digests=self._digests,
            strategy_name=strategy_label(self._choices.strategy, self._choices.strategy_arguments),
            planner_name=self._choices.planner,
            language=self._talk.lang,
            names=tuple(self._talk.names.items()),
            language_model=self._talk.model_name,
            seed=self._world.seed,
        )


class KeepAwayMapSource(MapSource):
    """Draws what is to be kept away from on every map that the drone makes.

    Args:
        source: makes the map.
        world: says from what, and where the mission starts.
    """

    def __init__(self, source: MapSource, world: World) -> None:
        self._source = source
        self._world = world

    def look(self) -> None:
        """See `MapSource.look`."""
        self._source.look()

    def draw(self, previous: SemanticMap | None) -> SemanticMap:
        """See `MapSource.draw`."""
        mission = self._world.mission
        newer = self._source.draw(previous)
        return with_keep_away(newer, self._world.task, start_m=mission.start_m, previous=previous)

    def flown(self, points_m: Floats, radius_m: float) -> None:
        """See `MapSource.flown`."""
        self._source.flown(points_m, radius_m)


def map_builder(world: World) -> MapBuilder:
    """A builder on the lattice of the world's map."""
    from mintpilot.mapping.builder import MapBuilder

    mission = world.mission
    frame: GridFrame = world.map.frame
    return MapBuilder(
        frame,
        limits=mission.limits,
        volume=mission.volume,
        prior_passable=mission.prior_passable,
        prior_occupied=mission.prior_occupied,
    )
