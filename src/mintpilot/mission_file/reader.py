"""Reads a mission file and finds every mistake in it.

In three steps, each only when the one before found nothing: the YAML, the form (`mintpilot.mission_file.schema`), and
what only the whole file and its map can tell (`mintpilot.mission_file.semantic_checks`).
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TypeAlias

from pydantic import ValidationError

from mintpilot.core.errors import MissionError
from mintpilot.mission_file.form_checks import FormWords
from mintpilot.mission_file.geodetic_places import with_local_places
from mintpilot.mission_file.plan_stops import SUFFIXES, refused_as_mission, with_plan_stops
from mintpilot.mission_file.schema import MissionFile
from mintpilot.mission_file.semantic_checks import contradictions
from mintpilot.mission_file.yaml_places import Document, Fault, Path_, read_document

Place: TypeAlias = Path_
"""The way to a key of a mission file, from the top: ``("world", "regions", 0, "box")``."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Problem:
    """One mistake in a mission file."""

    file: str
    """The file as it was named."""
    line: int
    """Line in it, from 1; 0 for contents that no file holds."""
    path: str
    """Where in the mission, e.g. ``world.regions[0].prior_passable``; empty for the file as a whole."""
    message: str
    """The offending value, the rule that it breaks, and what to write instead."""

    @property
    def place(self) -> str:
        """``FILE:LINE (path.to.key)``."""
        where = f"{self.file}:{self.line}" if self.line else self.file
        return where + (f" ({self.path})" if self.path else "")

    def __str__(self) -> str:
        return f"{self.place}: {self.message}"


class MissionFileError(MissionError):
    """A mission file with mistakes.

    Attributes:
        problems: all of them, in the order of the file.
    """

    def __init__(self, problems: Sequence[Problem]) -> None:
        lines = "\n".join(f"  {problem}" for problem in problems)
        count = f"{len(problems)} mistakes" if len(problems) > 1 else "1 mistake"
        super().__init__(f"{count} in {problems[0].file}:\n{lines}")
        self.place = problems[0].place
        self.problems = tuple(problems)


def read_mission(path: str | Path) -> MissionFile:
    """The mission in that file.

    Raises:
        MissionFileError: the file cannot be read or has mistakes; all of them are in the message and in ``problems``.
    """
    mission, problems = read_or_find_problems(path)
    if mission is None:
        raise MissionFileError(problems)
    return mission


def check_contents(mission: MissionFile, base: Path) -> None:
    """Checks a mission that was made by a program as one that is read from a file is.

    Args:
        mission: of correct form.
        base: folder that file names in it are relative to.

    Raises:
        MissionFileError: it has mistakes; all of them are in the message and in ``problems``.
    """
    name = f"mission '{mission.name}'"
    problems = [
        Problem(file=name, line=0, path=path_text(fault.path), message=fault.message)
        for fault in contradictions(mission, base)
    ]
    if problems:
        raise MissionFileError(problems)


def find_problems(path: str | Path) -> list[Problem]:
    """Every mistake in that mission file, in the order of its lines; empty when it is sound."""
    return read_or_find_problems(path)[1]


def read_or_find_problems(path: str | Path) -> tuple[MissionFile | None, list[Problem]]:
    """The mission in that file, or None with every mistake in it."""
    file = Path(path)
    if file.suffix in SUFFIXES:
        return None, _placed([refused_as_mission(file)], Document(), file)
    document = read_document(file)
    mission, faults = None, document.faults
    if not faults:
        mission, faults = _formed(document, file.parent)
    if mission is not None:
        faults = list(contradictions(mission, file.parent))
    return (None if faults else mission), _placed(faults, document, file)


def place_problems(path: str | Path, mistakes: Sequence[tuple[Place, str]]) -> list[Problem]:
    """Mistakes that were found elsewhere, each told at its line of that file; in the order of the lines.

    Args:
        path: the mission file.
        mistakes: the key's way from the top, e.g. ``("asking", "objective")``, and the message.
    """
    faults = [Fault(path=place, line=None, message=message) for place, message in mistakes]
    return _placed(faults, read_document(Path(path)), Path(path)) if faults else []


def json_schema() -> str:
    """The published JSON Schema of mission files, as text."""
    head = {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "MintPilot mission file, version 1",
    }
    schema = MissionFile.model_json_schema()
    schema["$defs"]["RuleSpec"]["type"] = ["object", "string"]  # a formula may stand alone
    return json.dumps({**head, **schema, **head}, indent=2, ensure_ascii=False) + "\n"


def path_text(path: Path_) -> str:
    """``("regions", 0, "id")`` as ``regions[0].id``."""
    return "".join(f"[{step}]" if isinstance(step, int) else f".{step}" for step in path).lstrip(".")


def _formed(document: Document, base: Path) -> tuple[MissionFile | None, list[Fault]]:
    if not isinstance(document.value, dict):
        message = "a mission is a mapping of keys to values; begin with 'mintpilot: 1'"
        return None, [Fault(path=(), line=1, message=message)]
    if "mintpilot" not in document.value:
        message = "'mintpilot' is missing; begin the file with 'mintpilot: 1', the version of its schema"
        return None, [Fault(path=(), line=1, message=message)]
    value, faults = with_plan_stops(document.value, base)
    if not faults:
        value, faults = with_local_places(value)
    if faults:
        return None, faults
    try:
        return MissionFile.model_validate(value), []
    except ValidationError as error:
        words = FormWords(document.value)
        found = error.errors(include_url=False)
        return None, [Fault(path=words.path(e["loc"]), line=None, message=words.message(e)) for e in found]


def _placed(faults: Sequence[Fault], document: Document, path: Path) -> list[Problem]:
    problems = [
        Problem(
            file=str(path),
            line=fault.line or document.line_of(fault.path),
            path=path_text(fault.path),
            message=fault.message,
        )
        for fault in faults
    ]
    return sorted(problems, key=lambda problem: (problem.line, problem.path))
