"""What an instruction is understood as, on a mission's map where there is one; nothing is flown."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from mintpilot.assembly.talk import Talk, talk_for
from mintpilot.assembly.worlds import build_world
from mintpilot.core.errors import InputError
from mintpilot.core.message import joined
from mintpilot.core.ports import LanguageModel
from mintpilot.core.task import Task
from mintpilot.language.phrases import InstructionError
from mintpilot.mission_file.reader import read_mission
from mintpilot.mission_file.schema import LanguageSpec, MissionFile
from mintpilot.uncertainty.findings import find_gaps

_ANYWHERE = (0.0, 0.0, 0.0)
"""Stands for the start where no mission says where it is."""


@dataclass(frozen=True, slots=True, kw_only=True)
class UnderstoodInstruction:
    """An instruction with its task, or with why there is none."""

    text: str
    task: Task | None = None
    word: str = ""
    """The word or phrase that refuses it; empty where it is not one."""
    reason: str = ""
    """Why it is refused, as a sentence; empty where it is not."""


def understand_instructions(
    texts: Iterable[str], *, mission: str | Path | None = None, llm: str | LanguageModel | None = None
) -> list[UnderstoodInstruction]:
    """Reads instructions one by one.

    Args:
        texts: the words of each.
        mission: a mission file, whose map says what there is and whose start where ``come back`` leads; its own
            instruction and goals do not count.
        llm: language model that may help, by name or made already; None: none.

    Raises:
        MissionError: the mission file has mistakes.
        UnknownNameError: nobody registered that model.
    """
    file = read_mission(mission) if mission is not None else None
    base = Path(mission).parent if mission is not None else Path.cwd()
    with talk_for(LanguageSpec(), llm=llm) as talk:
        return [_understood(text, file, base, talk) for text in texts]


def _understood(text: str, file: MissionFile | None, base: Path, talk: Talk) -> UnderstoodInstruction:
    try:
        task = talk.parse(text, home_m=_ANYWHERE) if file is None else _on_map(text, file, base, talk)
    except InstructionError as error:
        return UnderstoodInstruction(text=text, word=error.word, reason=str(error))
    except InputError as error:
        return UnderstoodInstruction(text=text, reason=str(error))
    return UnderstoodInstruction(text=text, task=task)


def _on_map(text: str, file: MissionFile, base: Path, talk: Talk) -> Task:
    """The task in that mission's world. Raises `InputError` where the map has nothing that it names."""
    given = file.model_copy(update={"instruction": text, "goals": None, "truth": {}})
    world = build_world(given, base=base, seed=None, parse=talk.parse)
    if not world.is_map:
        return world.task
    problems = find_gaps(world.map, world.task, start_m=world.mission.start_m).problems
    if problems:
        word = str(next((value for name, value in problems[0].values if name in ("wanted", "what")), ""))
        raise InstructionError(str(joined(problems)), word=word)
    return world.task
