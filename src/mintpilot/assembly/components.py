"""From a world to the components of a mission: vehicle, map source, strategy, operators, recorder."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import AbstractContextManager, ExitStack, suppress
from dataclasses import dataclass, field, replace
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from mintpilot.assembly.briefing import briefing_of
from mintpilot.assembly.policies import make_metric, make_planner
from mintpilot.assembly.stated_looks import settled_looks, with_stated_looks
from mintpilot.assembly.strategies import Argument, make_objective, make_strategy, strategy_label
from mintpilot.assembly.talk import Talk
from mintpilot.assembly.worlds import World
from mintpilot.core.errors import InfeasibleError, InputError
from mintpilot.core.geometry import Floats, GridFrame
from mintpilot.core.message import Message, message, verbatim
from mintpilot.core.ports import Camera, Judge, Operator, Perception, Recorder, Vehicle
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
    """A real vehicle, over MAVLink or by a plug-in; its map is given, or made of the pictures of a frame source."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Choices:
    """What a command line or a caller chooses."""

    strategy: str = "mint"
    strategy_arguments: Mapping[str, Argument] = field(default_factory=dict)
    """The strategy's own, e.g. ``{"quantile": 0.8}``."""
    vehicle: VehicleChoice = VehicleChoice.MUJOCO
    address: str = ""
    """Where a real vehicle is reached: ``mavlink://udpin:127.0.0.1:14540``."""
    camera: str = ""
    """Frame source of a real vehicle's pictures, e.g. ``realsense:``; empty: its map is given."""
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
    kinematic = choices.vehicle is VehicleChoice.KINEMATIC or (choices.vehicle is VehicleChoice.MUJOCO and world.is_map)
    return DeliberationParts(
        mission=replace(world.mission, looks=settled_looks(world, kinematic=kinematic)),
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
        """The parts; questions are worded in the mission's language by template, and bettered by the loop.

        It deliberates once before the flight: what is loaded and compiled then is not waited for in the air.
        """
        from mintpilot.mission.rehearsal import begin

        parts = deliberation_parts(self.world, self.choices, Talk(lang=self.lang, names=dict(self.names)))
        with suppress(InfeasibleError):
            begin(parts, self.world.map).deliberated()
        return parts


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


def check_choices(world: World, choices: Choices, operators: tuple[Operator, ...]) -> None:
    """Whether those parts can fly that mission; told before anything is made or kept.

    Raises:
        InputError: the vehicle has no camera and needs one, the camera does not go with it, or nobody can say go.
    """
    real = choices.vehicle is VehicleChoice.MAVLINK
    if choices.camera and not real:
        raise InputError(
            f"--camera {choices.camera} goes with a real vehicle (--vehicle mavlink://…); simulators have one"
        )
    if real and world.task.needs_confirmation and not any(operator.attended for operator in operators):
        raise InputError(
            f"'{world.mission.instruction}' was read by a language model: a real vehicle flies it only after "
            "somebody has said go; use --operator terminal or console"
        )
    if choices.camera or (choices.vehicle is VehicleChoice.MUJOCO and not world.is_map):
        return
    if choices.earlier is not None:
        raise InputError(
            "--map needs a camera, which looks again at what was free: fly with --vehicle mujoco, or leave it out"
        )
    for goal in world.task.subgoals:
        if goal.action is Action.PHOTOGRAPH:
            raise InputError(
                f"'photograph {goal.reference.phrase}' cannot be done: this vehicle has no camera. "
                "Fly with one that has, or leave the picture out."
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
        InputError: as `check_choices` says.
        MissingPartError: MuJoCo is chosen but not installed.
    """
    check_choices(world, choices, operators)
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
        self._left_out = Message()
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
            surveys, known = self._begins()
            source = self._seeing(simulator, self._builder())
            made = self._made(simulator, source, surveys=surveys, known=known, watch_map=True)
            return self._seen_through(made, simulator)
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
        """A real vehicle, on a given map or with a camera. Nobody judges it, and it ends on the ground."""
        from mintpilot.assembly.real_vehicle import make_vehicle
        from mintpilot.mission.process_worker import ProcessWorker

        world, choices = self._world, self._choices
        sees = bool(choices.camera)
        surveys, known = self._begins() if sees else (False, world.map)
        builder = self._builder(down_to_m=world.mission.volume.lo_m[2]) if sees else None
        before = builder.snapshot() if builder is not None else None
        vehicle = make_vehicle(world, choices.address, accept_failsafes=choices.accept_failsafes, known=before)
        self._stack.callback(vehicle.close)
        names = tuple(self._talk.names.items())
        beside = PartsBesideVehicle(world=world, choices=choices, lang=self._talk.lang, names=names)
        source: MapSource = GivenMap(world.map)
        camera: Camera | None = None
        if builder is not None:
            from mintpilot.assembly.vehicle_camera import live_camera

            camera = live_camera(choices.camera, vehicle.state, getattr(vehicle, "tilt", None))
            source = self._seeing(camera, builder)
        made = replace(
            self._common(vehicle, source, known=known, watch_map=sees),
            worker=lambda _: ProcessWorker(beside),
            surveys=surveys,
            lands=True,
        )
        return self._seen_through(made, camera)

    def _begins(self) -> tuple[bool, SemanticMap | None]:
        """Whether a survey makes the map, and what is known of it before."""
        world, earlier = self._world, self._choices.earlier
        if earlier is not None:
            return False, earlier.map
        surveys = world.mission.survey is not None
        return surveys, None if surveys else world.map

    def _builder(self, *, down_to_m: float | None = None) -> MapBuilder:
        """Gathers what a camera sees; ``down_to_m``: the ground from which a real vehicle rises to its start."""
        world, builder = self._world, map_builder(self._world)
        surveys, known = self._begins()
        if known is not None and (self._choices.earlier is not None or world.is_map):
            builder.begin_with(known)
        if surveys or self._choices.earlier is not None:
            # Whoever puts the drone down vouches for the space around it: the camera never sees it.
            x, y, z = world.mission.start_m
            heights = [z] if down_to_m is None else np.arange(down_to_m, z, world.map.frame.resolution_m / 2).tolist()
            builder.mark_flown(np.asarray([(x, y, height) for height in [z, *heights]], float), TAKE_OFF_CLEAR_M)
        return builder

    def _seeing(self, camera: Camera, builder: MapBuilder) -> MapSource:
        """What makes the map of a camera's pictures."""
        from mintpilot.assembly.perceiving import Seeing, make_perception

        world, choices = self._world, self._choices
        wanted = tuple(dict.fromkeys(g.reference.label for g in world.task.subgoals if g.reference.label))
        self._perception = perception = make_perception(
            Seeing(perception=choices.perception, namers=choices.namers, wanted=wanted, calibration=choices.calibration)
        )
        source = CameraMapSource(camera=camera, perception=perception, builder=builder, recorder=self._recorder)
        return KeepAwayMapSource(source, world) if world.task.keep_away else source

    def _seen_through(self, made: MissionComponents, camera: Camera | None) -> MissionComponents:
        earlier = self._choices.earlier
        viewed = camera if self._choices.views else None
        return replace(made, viewed=viewed, begins_with=earlier.words if earlier is not None else Message())

    def __exit__(self, *_: object) -> None:
        self._stack.close()

    def _remarks(self) -> tuple[Message, ...]:
        from mintpilot.assembly.perceiving import remarks_of

        seen = () if self._perception is None else tuple(remarks_of(self._perception))
        left_out, self._left_out = self._left_out, Message()
        return (*self._talk.take_remarks(), *map(verbatim, seen), *((left_out,) if left_out else ()))

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
        unsettled = [look.gap for look in self._world.mission.looks if look not in parts.mission.looks]
        if unsettled:
            gaps = ", ".join(unsettled)
            self._left_out = message("Nothing here settles a look at {gaps}: such looks are left out.", gaps=gaps)
        briefed = self._choices.briefs or self._world.task.needs_confirmation
        return MissionComponents(
            parts=parts,
            briefing=briefing_of(parts, known, lang=self._talk.lang, names=self._talk.names) if briefed else None,
            vehicle=vehicle,
            map_source=source,
            operators=self._operators,
            recorder=self._recorder,
            improve=self._talk.improve,
            remarks=self._remarks,
            spoken=self._talk.spoken,
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
