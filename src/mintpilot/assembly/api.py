"""The public Python API: think about a mission, fly it. What checks its file is in `mintpilot.assembly.validation`."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias, cast

from mintpilot.assembly.components import (
    Choices,
    VehicleChoice,
    check_choices,
    components_for,
    deliberation_parts,
    scripted_operator,
)
from mintpilot.assembly.deliberation_report import DeliberationReport, deliberation_report
from mintpilot.assembly.policies import make_planner
from mintpilot.assembly.registry import names
from mintpilot.assembly.strategies import Argument, strategy_label
from mintpilot.assembly.talk import Talk, talk_for
from mintpilot.assembly.worlds import World, build_world
from mintpilot.core.errors import UnknownNameError
from mintpilot.core.events import Event
from mintpilot.core.ports import Ask, LanguageModel, Operator, Recorder
from mintpilot.core.think_time import think_time
from mintpilot.mission.explanations import explanations
from mintpilot.mission.preview import preview
from mintpilot.mission_file.reader import check_contents, read_mission
from mintpilot.mission_file.schema import MissionFile
from mintpilot.vehicle.address import SCHEME, parse_address

if TYPE_CHECKING:
    from mintpilot.recording.record import MissionRecord

Progress: TypeAlias = Callable[[Event], object]
"""Called with every event of a mission, as it happens."""
MakeOperator: TypeAlias = Callable[[Talk], Operator]
"""Makes an operator that hears free words, given the mission's language: what understands them, and which it is."""

AnyOperator: TypeAlias = Operator | MakeOperator | str
"""Somebody who answers, what makes such a one, or ``"scripted"``."""


def plan_mission(
    mission: str | Path | MissionFile,
    *,
    strategy: str = "mint",
    strategy_arguments: Mapping[str, Argument] | None = None,
    planner: str = "grid",
    seed: int | None = None,
    base: Path | None = None,
    llm: str | LanguageModel | None = None,
    lang: str | None = None,
) -> DeliberationReport:
    """Deliberates on a mission without flying it, on a perfect survey's map or on the map that it gives.

    Args:
        mission: a mission file's path, or its contents.
        strategy: name of the method of asking.
        strategy_arguments: its own, e.g. ``{"quantile": 0.8}``; they override those of the file.
        planner: who plans: ``"grid"``, ``"policy"`` (by exact values), ``"policy:mine.npz"``, or a plug-in's name.
        seed: overrides the seed in the file.
        base: folder that file names in the mission are relative to; default: that of the file, or the present one.
        llm: language model by its registered name, or one that was made already; default: as the file says.
        lang: in which the question is worded; default: as the file says.

    Raises:
        MissionError: the file has mistakes.
        InfeasibleError: nothing can be flown, whatever the answers are.
        UnknownNameError: nobody registered that strategy, model or language.
        MissingPartError: the language model needs a part that is not installed.
    """
    file, folder = _opened(mission, base)
    with talk_for(file.language, llm=llm, lang=lang, world=file.world) as talk:
        arguments = _arguments(file, strategy, strategy_arguments)
        choices = Choices(
            strategy=strategy, strategy_arguments=arguments, planner=planner, vehicle=VehicleChoice.KINEMATIC
        )
        return _planned(file, folder, talk, choices, seed=seed)


def _planned(file: MissionFile, folder: Path, talk: Talk, choices: Choices, *, seed: int | None) -> DeliberationReport:
    world = build_world(file, base=folder, seed=seed, parse=talk.parse)
    parts = deliberation_parts(world, choices, talk)
    begun = time.perf_counter()
    seen = preview(world.map, parts)
    seconds = time.perf_counter() - begun
    decision = seen.first.decision
    question = None
    if isinstance(decision, Ask):
        spoken_of = tuple(g for g in seen.first.findings.gaps if g.id in decision.scored.query.gap_ids)
        question = talk.word(decision.scored.query, spoken_of, decision.mint)
        question = talk.improve(question) if talk.improve is not None else question
    return deliberation_report(
        seen,
        mission=file.name,
        strategy=strategy_label(choices.strategy, choices.strategy_arguments),
        explanations=explanations(seen.first.situation, decision.mint),
        task=world.task,
        question=question,
        seconds=seconds,
        speech=talk.spoken,
    )


def run_mission(
    mission: str | Path | MissionFile,
    *,
    operator: AnyOperator | tuple[AnyOperator, ...] = "scripted",
    vehicle: str = "mujoco",
    strategy: str = "mint",
    strategy_arguments: Mapping[str, Argument] | None = None,
    planner: str = "grid",
    think: str | float | None = None,
    seed: int | None = None,
    out: Path | None = None,
    progress: Progress | None = None,
    base: Path | None = None,
    llm: str | LanguageModel | None = None,
    lang: str | None = None,
    perception: str | None = None,
    accept_failsafes: bool = False,
    camera: str = "",
    briefs: bool = False,
    views: bool = False,
    earlier: Path | None = None,
) -> MissionRecord:
    """Flies a mission and keeps what happened.

    Args:
        mission: a mission file's path, or its contents.
        operator: who answers and gives orders, or what makes such a one of the mission's language; ``"scripted"``: one
            that knows the truth, with the errors that the file states. Several may be given.
        vehicle: ``"mujoco"`` or ``"kinematic"``; a mission on a given map is always flown by the latter. Or a real one:
            ``"mavlink://udpin:127.0.0.1:14540"``.
        strategy: name of the method of asking.
        strategy_arguments: its own, e.g. ``{"quantile": 0.8}``; they override those of the file.
        planner: who plans: ``"grid"``, ``"policy"`` (by exact values), ``"policy:mine.npz"``, or a plug-in's name.
        think: how long the scripted operator takes for an answer, seconds: ``5``, or drawn evenly: ``"2..8"``; default:
            as the file says.
        seed: overrides the seed in the file.
        out: the run folder; None keeps nothing on disk but returns the record.
        progress: told about every event.
        base: folder that file names in the mission are relative to; default: that of the file, or the present one.
        llm: language model by its registered name, or one that was made already (it is closed in the end); default: as
            the file says, and that is none.
        lang: in which questions are asked; default: as the file says.
        perception: registered name of what makes objects of pictures; default: as the file says.
        accept_failsafes: fly a real vehicle although its autopilot's fail-safes are not as they should be.
        camera: frame source of a real vehicle's pictures: ``"realsense:"``, ``"sim://127.0.0.1:9003"``, a recording;
            default: none, its map is given.
        briefs: whether the operator is asked go or no-go before take-off. One always is where a language model read the
            instruction.
        views: whether ``progress`` also gets pictures for a person who watches, up to five a second.
        earlier: run folder of a mission in the same place, whose map this one begins with in place of a survey.

    Returns:
        The record. How the mission ended is `MissionRecord.outcome`; an ending short of success is no exception.

    Raises:
        InputError: the mission, or a name, is wrong.
        RecordError: the run folder cannot be written, or ``earlier`` not be read.
        MissingPartError: MuJoCo is chosen, a language model or a real vehicle, but not what it needs is installed.
        DeviceError: a real vehicle cannot be reached, or is not ready to fly.
    """
    file, folder = _opened(mission, base)
    if think is not None:
        think_time(think)  # what cannot be read is told before anything is worked out
        file = file.model_copy(update={"operator": file.operator.model_copy(update={"latency_s": str(think)})})
    if earlier is not None:
        from mintpilot.assembly.earlier_map import earlier_map
    choices = Choices(
        strategy=strategy,
        strategy_arguments=_arguments(file, strategy, strategy_arguments),
        planner=planner,
        vehicle=vehicle_choice(vehicle),
        address=vehicle if "://" in vehicle else "",
        accept_failsafes=accept_failsafes,
        camera=camera,
        perception=perception or file.perception.use,
        briefs=briefs,
        views=views,
        earlier=None if earlier is None else earlier_map(earlier),
        namers=tuple(file.perception.namers) if perception in (None, file.perception.use) else (),
        calibration=_calibration(file, folder) if perception in (None, file.perception.use) else None,
    )
    make_planner(planner)  # a wrong name, or a file that cannot be used, is told before anything is kept
    with talk_for(file.language, llm=llm, lang=lang, world=file.world) as talk:
        world = build_world(file, base=folder, seed=seed, parse=talk.parse)
        several = operator if isinstance(operator, tuple) else (operator,)
        people = tuple(_operator(one, world, file, talk) for one in several)
        return _flown(world, choices, people, talk, out=out, progress=progress)


def _flown(
    world: World,
    choices: Choices,
    people: tuple[Operator, ...],
    talk: Talk,
    *,
    out: Path | None,
    progress: Progress | None,
) -> MissionRecord:
    from mintpilot.mission.loop import fly_mission
    from mintpilot.recording.in_memory import HistoryRecorder
    from mintpilot.recording.recorders import TeeRecorder
    from mintpilot.recording.run_folder import RunFolder

    check_choices(world, choices, people)
    keeper = RunFolder(out) if out is not None else None
    recorder = HistoryRecorder()
    recorders: list[Recorder] = [keeper if keeper is not None else recorder]
    if progress is not None:
        recorders.append(_Told(progress))
    tee = TeeRecorder(*recorders)
    made = components_for(world, choices, operators=people, recorder=tee, talk=talk, digests=keeper is not None)
    if keeper is None:
        with made as components:
            fly_mission(components)
        return recorder.close()
    with keeper, made as components:
        fly_mission(components)
    return keeper.close()


class _Told(Recorder):
    """Passes events on to a function."""

    def __init__(self, progress: Progress) -> None:
        self._progress = progress

    def record(self, event: Event) -> None:
        self._progress(event)


def _opened(mission: str | Path | MissionFile, base: Path | None) -> tuple[MissionFile, Path]:
    if isinstance(mission, MissionFile):
        folder = base or Path.cwd()
        check_contents(mission, folder)
        return mission, folder
    path = Path(mission)
    return read_mission(path), base or path.parent


def _arguments(file: MissionFile, strategy: str, given: Mapping[str, Argument] | None) -> dict[str, Argument]:
    """The strategy's arguments: those of the file, and what the caller gives instead."""
    return {**file.asking.strategy_arguments.get(strategy, {}), **(given or {})}


def vehicle_choice(name: str) -> VehicleChoice:
    """The vehicle of that name, or of an address.

    Raises:
        UnknownNameError: there is none; the known ones are listed.
        InputError: the address of a real vehicle cannot be read.
    """
    scheme, found, _ = name.partition("://")
    if found and scheme in names("vehicle"):
        if name.startswith(SCHEME):
            parse_address(name)  # a wrong one is told before anything is worked out
        return VehicleChoice.MAVLINK
    simulated = [choice for choice in VehicleChoice if choice is not VehicleChoice.MAVLINK]
    if name not in simulated:
        raise UnknownNameError("vehicle", name, [*simulated, f"{SCHEME}udpin:127.0.0.1:14540"])
    return VehicleChoice(name)


def _operator(operator: AnyOperator, world: World, file: MissionFile, talk: Talk) -> Operator:
    if not isinstance(operator, str):
        return cast(Operator, operator) if hasattr(operator, "poll") else operator(talk)
    if operator != "scripted":
        raise UnknownNameError("operator", operator, ["scripted"])
    return scripted_operator(world, file.operator)


def _calibration(file: MissionFile, folder: Path) -> Path | None:
    return None if file.perception.calibration is None else folder / file.perception.calibration
