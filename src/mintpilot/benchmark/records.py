"""The records: one for each trial and one for each world. Tables, plots and pages are made from these only."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Literal

from pydantic import ValidationError

from mintpilot.benchmark.experiment import Part
from mintpilot.core.errors import RecordError

SCHEMA_VERSION = 1
"""Of both kinds; raised with every change that old readers would misread."""


class AskedRecord(Part):
    """One question."""

    text: str
    query: str
    """Stable id of the cut."""
    reply: str
    gain_bits: float
    wording_s: float


class Stages(Part):
    """From the instruction to the finished trajectories, by stage, seconds of this machine's clock.

    The survey flight made the map before the instruction was given. What remains to be seen then is one picture.
    """

    perception: float = 0.0
    """Finding things in one picture and drawing up the map of it: median over the mission's pictures."""
    deliberation: float = 0.0
    """Gaps, plans, tree and cuts: all deliberations before the flight together."""
    wording: float = 0.0
    """All questions together."""
    answer: float = 0.0
    """The person's thinking time, as stated in the configuration, for all questions together."""
    planning: float = 0.0
    """Timing and checking the trajectories of all legs."""


class TrialRecord(Part):
    """One method in one world."""

    schema_version: int = SCHEMA_VERSION
    kind: Literal["trial"] = "trial"
    experiment: str
    cell: str
    seed: int
    method: str
    vehicle: str
    outcome: str
    """How the mission ended (`Outcome`); or ``raised``, ``timed-out``, ``crashed`` where the method broke down."""
    success: bool
    reason: str
    """In one sentence."""
    people_found: int = 0
    """Of the people who need help, how many were reached."""
    people_there: int = 0
    """How many there are."""
    questions: int = 0
    unsure: int = 0
    """Questions that were answered "I don't know"."""
    contradictions: int = 0
    flight_s: float = 0.0
    """Mission clock from the end of the survey to the end, stays included."""
    flown_m: float = 0.0
    waited_s: float = 0.0
    """From questions shown to their answers, or to the end of waiting."""
    hidden_s: float = 0.0
    """Of that, what was flown meanwhile of what had to be flown anyway, by the plans."""
    stops_done: int = 0
    planned_s: float | None = None
    """Cost of the plan that was chosen last; None where none was."""
    stop_reason: str = ""
    """Why no further question was asked (`StopReason`)."""
    stages_s: Stages = Stages()
    deliberation_max_s: float = 0.0
    """The longest single deliberation, its wording included."""
    survey_s: float = 0.0
    """Computing and simulating the survey flight; about 0 where another method's survey was taken over."""
    frames: int = 0
    """Pictures that were looked at, those of its own survey included."""
    asked: tuple[AskedRecord, ...] = ()
    path_m: tuple[tuple[float, float], ...] = ()
    """What was flown, seen from above, thinned to a few dozen points."""
    wall_s: float = 0.0
    error: str = ""
    """Traceback, where the method broke down."""


class GapTruth(Part):
    """One gap of a world."""

    id: str
    kind: str
    truth: str | None
    mattered: bool
    """The others being what they really are, the best mission differs by more than delta_c between its values."""
    could_matter: bool
    """It is asked about somewhere in the tree: under some values of the others it decides."""


class WorldRecord(Part):
    """One world, as a planner sees it that is told the truth on the map of a perfect survey."""

    schema_version: int = SCHEMA_VERSION
    kind: Literal["world"] = "world"
    experiment: str
    cell: str
    seed: int
    possible: bool
    """Whether that planner finds a plan."""
    best_s: float | None
    """Cost of its plan."""
    people_reachable: int | None = None
    """Of the people who need help, how many its plan reaches; None in records of before this was counted."""
    gaps: tuple[GapTruth, ...]
    least_questions: float | None
    """Fewest questions that any method needs on average over the truths that the prior allows, by exact dynamic
    programming; None where the tree is too large for it."""
    outline_m: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0)
    """x and y of two corners of the building."""
    boxes: tuple[tuple[str, float, float, float, float], ...] = ()
    """Things seen from above: kind, then x and y of two corners, metres."""


Record = TrialRecord | WorldRecord


def parse_record(line: str, place: str) -> Record:
    """The record in one line of a shard.

    Raises:
        RecordError: it is of another schema, or damaged.
    """
    data = json.loads(line)
    version = data.get("schema_version") if isinstance(data, dict) else None
    if version != SCHEMA_VERSION:
        raise RecordError(
            f"{place}: record of schema version {version!r}, this program reads {SCHEMA_VERSION}; read it with the "
            "version of MintPilot that stands in config.json beside it, or run the benchmark again into another folder"
        )
    try:
        if data.get("kind") == "world":
            return WorldRecord.model_validate(data)
        return TrialRecord.model_validate(data)
    except ValidationError as error:
        first = error.errors()[0]
        where = ".".join(str(step) for step in first["loc"])
        raise RecordError(
            f"{place}: {where}: {first['msg']}; the record was changed or damaged: delete that line to fly the "
            "trial again"
        ) from error


def read_shard(path: Path) -> list[Record]:
    """All whole records of one shard. A last line that was cut off (the disk was full, the power went) is left out.

    Raises:
        RecordError: it cannot be read, or a record in it is of another schema or damaged.
    """
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise RecordError(f"cannot read the records {path}: {error}") from error
    lines = text.split("\n")
    found = []
    for number, line in enumerate(lines, 1):
        if not line.strip():
            continue
        try:
            found.append(parse_record(line, f"{path}:{number}"))
        except json.JSONDecodeError as error:
            if number == len(lines):
                break
            raise RecordError(
                f"{path}:{number}: not JSON ({error}); delete that line to fly the trial again"
            ) from error
    return found
