"""What only building a mission's parts can tell: an instruction not understood, wrong parameters, unknown names."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path

from mintpilot.assembly.policies import check_metric_name
from mintpilot.assembly.registry import check_name
from mintpilot.assembly.worlds import build_world, listed_words, scenario_of
from mintpilot.core.errors import MintPilotError
from mintpilot.mission_file.reader import Place, Problem, place_problems, read_or_find_problems
from mintpilot.mission_file.schema import MissionFile
from mintpilot.mission_file.schema_world import MapWorld, ScenarioWorld
from mintpilot.uncertainty.findings import find_gaps
from mintpilot.uncertainty.keep_away import NothingToKeepAwayFromError

_ANYWHERE = (0.0, 0.0, 0.0)
"""Stands for the start until the world is built."""


def check_mission(path: str | Path) -> list[Problem]:
    """Every mistake in that mission file, with its place and what to write instead; empty when it is sound.

    A file of sound form is built as well, so that names, parameters and the instruction are known to be usable.
    """
    file, problems = read_or_find_problems(path)
    return problems if file is None else validation_problems(path, file)


def validation_problems(path: str | Path, file: MissionFile) -> list[Problem]:
    """Every mistake that shows when the parts of a mission of sound form are made, in the order of its lines.

    Args:
        path: of the mission file.
        file: what was read from it.
    """
    return place_problems(path, list(_mistakes(file, Path(path).parent)))


def _mistakes(file: MissionFile, base: Path) -> Iterator[tuple[Place, str]]:
    found = [
        *_tried(("asking", "objective"), lambda: check_name("objective", file.asking.objective)),
        *_tried(("asking", "impact_metric"), lambda: check_metric_name(file.asking.impact_metric)),
        *_strategy_mistakes(file),
        *_tried(("perception", "use"), lambda: check_name("perception", file.perception.use)),
        *(
            fault
            for number, namer in enumerate(file.perception.namers)
            for fault in _tried(("perception", "namers", number), partial(check_name, "namer", namer))
        ),
        *_tried(("language", "model"), lambda: check_name("language", file.language.model)),
    ]
    if file.goals is None or file.keep_away:
        found += _wording_mistakes(file)
    if isinstance(file.world, ScenarioWorld):
        found += _scenario_mistakes(file.world)
    yield from found
    if not found:
        yield from _world_mistakes(file, base)


def _wording_mistakes(file: MissionFile) -> list[tuple[Place, str]]:
    """An instruction, or a thing to keep away from, in words that are not understood."""
    from mintpilot.language.instruction import parse_instruction
    from mintpilot.language.phrases import parse_phrase

    found, known = [], listed_words(file.world)
    if file.goals is None:
        found += _tried(("instruction",), lambda: parse_instruction(file.instruction, home_m=_ANYWHERE, known=known))
    regions = {r.id for r in file.world.regions} if isinstance(file.world, MapWorld) else set()
    for index, wish in enumerate(file.keep_away):
        if wish.thing not in regions:
            found += _tried(("keep_away", index, "from"), partial(parse_phrase, wish.thing, known))
    return found


def _strategy_mistakes(file: MissionFile) -> list[tuple[Place, str]]:
    """Arguments that a strategy does not take, or strategies that nobody registered."""
    if not file.asking.strategy_arguments:
        return []
    from mintpilot.assembly.strategies import make_strategy

    return [
        mistake
        for name, arguments in file.asking.strategy_arguments.items()
        for mistake in _tried(
            ("asking", "strategy_arguments", name), partial(make_strategy, name, seed=0, arguments=arguments)
        )
    ]


def _scenario_mistakes(world: ScenarioWorld) -> list[tuple[Place, str]]:
    """Told at the parameter that the message names, where it names one."""
    found = _tried(("world", "parameters"), lambda: scenario_of(world, world.seed or 0))
    return [
        (
            (*place, *[name for name in world.parameters if f"'{name}'" in message or f"{name} =" in message][:1]),
            message,
        )
        for place, message in found
    ]


def _world_mistakes(file: MissionFile, base: Path) -> Iterator[tuple[Place, str]]:
    """The world as a whole, and whether a given map has what the mission speaks of."""
    try:
        world = build_world(file, base=base, seed=None)
    except NothingToKeepAwayFromError as error:
        wishes = [index for index, wish in enumerate(file.keep_away) if wish.thing == error.phrase]
        yield (("keep_away", wishes[0], "from") if wishes else ("instruction",)), str(error)
        return
    except MintPilotError as error:
        yield ("world",), str(error)
        return
    if not world.is_map:
        return
    for problem in find_gaps(world.map, world.task, start_m=world.mission.start_m).problems:
        named = [i for i, goal in enumerate(file.goals or ()) if f"'{goal.phrase or goal.object}'" in str(problem)]
        yield (("goals", named[0]) if named else ("instruction",)), str(problem)


def _tried(place: Place, work: Callable[[], object]) -> list[tuple[Place, str]]:
    try:
        work()
    except MintPilotError as error:
        return [(place, str(error))]
    return []
