"""The record of a mission: one typed, versioned document, from which reports and tables are made."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Annotated

from pydantic import BaseModel, BeforeValidator, ConfigDict, JsonValue, ValidationError

from mintpilot.core.errors import RecordError
from mintpilot.core.gap import GapKind
from mintpilot.core.mission import Outcome, Sight
from mintpilot.core.query import Order, Reply
from mintpilot.core.tree import LeafReason, StopReason

SCHEMA_VERSION = 2
"""Of the record; raised with every change that old readers would misread."""


def _finite(value: object) -> object:
    """JSON knows no infinity: what is not finite becomes null."""
    return None if isinstance(value, float) and not math.isfinite(value) else value


Figure = Annotated[float | None, BeforeValidator(_finite)]
"""A number; null where there is none, or none that is finite."""
Point = tuple[float, float, float]


class Part(BaseModel):
    """Base of all parts: never changed in place, and nothing unknown in it."""

    model_config = ConfigDict(frozen=True, extra="forbid")


class ValueRecord(Part):
    """One value that a gap may have."""

    value: str
    prior: float
    means: str
    """In plain words."""


class GapRecord(Part):
    """One gap: asked or not, and why, in figures."""

    id: str
    kind: GapKind | None
    subject: str
    description: str
    values: tuple[ValueRecord, ...]
    asked: bool
    relevant: bool | None
    """Whether any best plan depended on it; null: the mission ended before that was decided."""
    why: str
    cost_if_favourable_s: Figure = None
    cost_if_unfavourable_s: Figure = None
    """Null also where no plan exists then."""
    divergence_m: Figure = None
    entropy_bits: Figure = None
    gain_bits: Figure = None
    regret_saved_s: Figure = None


class QuestionRecord(Part):
    """One question, why it was asked, and what came back."""

    text: str
    query: str
    """Stable id of the cut."""
    gaps: tuple[str, ...]
    gain_bits: Figure
    score: Figure
    regret_saved_s: Figure
    reply_probabilities: tuple[float, ...] = ()
    """With which each reply was expected, in the order of ``replies``; empty in records of older versions."""
    replies: tuple[str, ...] = ("yes", "no")
    """What could be answered, besides "don't know": ``yes`` and ``no``, or the options of a choice."""
    yes_probability: Figure = None
    """In records of older versions, instead of ``reply_probabilities``."""
    yes_means: str
    no_means: str
    option_means: tuple[str, ...] = ()
    """Of a choice: the consequence of each reply."""
    worded_by: str
    wording_s: Figure
    attempt: int
    reply: Reply
    option: int | None = None
    """Which of ``replies`` was chosen, from 0; null where the question was no choice."""
    answer_text: str
    """As it was given: data, never an instruction."""
    latency_s: Figure
    first_text: str = ""
    """The words that were shown first, where better ones (``text``) followed; else empty."""
    better_s: Figure = None
    """From the cut to the better words, seconds; null where there were none."""
    understood_by: str = ""
    """Who made a reply of free words: ``rules`` or ``model``; empty where nobody had to."""
    also: tuple[str, ...] = ()
    """What the answer said beyond the question, as it was understood, in plain words."""
    proposed_by: str = "enumeration"
    """Who proposed the cut: our own enumeration, or a language model by name."""


class TreeRecord(Part):
    """One node of the tree with everything under it."""

    given: dict[str, tuple[str, ...]]
    """What is assumed here: for some gaps, the values that are still possible."""
    words: str
    """What is assumed here beyond the node above, in plain words."""
    probability: float
    optimistic_s: Figure = None
    cautious_s: Figure = None
    divergence_m: Figure = None
    entropy_bits: Figure = None
    branch_on: str = ""
    branch_words: str = ""
    """Description of the gap that the children differ in."""
    asked: bool = False
    """Whether a question spoke of that gap."""
    ruled_out: bool = False
    """Whether an answer contradicts the assumptions."""
    leaf: LeafReason | None = None
    cost_s: Figure = None
    """Of a leaf's plan."""
    plan: str = ""
    """Signature of a leaf's plan."""
    flown: bool = False
    """Whether that plan is the one that was chosen in the end."""
    left_out: int = 0
    """Nodes under this one that are not in the record."""
    children: tuple[TreeRecord, ...] = ()


class PlanClassRecord(Part):
    """Joint hypotheses that lead to the same plan."""

    probability: float
    cost_s: Figure
    """Null: nothing can be flown."""
    length_m: Figure
    plan: str
    words: tuple[str, ...]
    """Which hypotheses, in plain words; the first few."""
    hypotheses: int
    """How many leaves there are."""
    enters: tuple[str, ...] = ()
    skips: tuple[str, ...] = ()
    flown: bool = False


class CertificateRecord(Part):
    """Why the asking stopped, with the numbers."""

    reason: StopReason
    text: str
    top_class_probability: Figure
    entropy_bits: Figure
    best_gain_bits: Figure
    bound_s: Figure
    """Null: not bounded."""


class CutRecord(Part):
    """A cut that was proposed from outside, scored like all others."""

    query: str
    """Its stable id."""
    words: str
    """The same in plain words: what Yes would say."""
    proposed_by: str
    gain_bits: Figure
    score: Figure
    asked: bool
    """Whether it was the best, and so the one that was asked."""


class RoundRecord(Part):
    """One deliberation."""

    round: int
    seconds: float
    gaps: int
    nodes: int
    query: str = ""
    """Id of the cut that was chosen; empty where the asking stopped."""
    alternatives: tuple[tuple[str, Figure], ...] = ()
    """The next best cuts with their gains in bits. Those not among ``proposals`` are our own."""
    proposals: tuple[CutRecord, ...] = ()
    """What a language model proposed and was sound, best first."""
    best_gain_bits: Figure = None
    """Of all cuts that were scored, the most that one tells; null where none was."""
    bound_bits: Figure = None
    """No cut whatever could tell more; null where that was not worked out."""


class FlightRecord(Part):
    """What was planned and what was flown, survey not included."""

    planned_m: Figure
    """Length of the trajectories; of those that were broken off, the part that was commanded."""
    flown_m: Figure
    seconds: Figure
    """Vehicle's clock, from the first sample of the first flight to the last of the last one: stays and waits between
    them count, those before and after do not."""
    rms_error_m: Figure
    """Root mean square distance between where the drone was and where it should have been."""
    max_error_m: Figure


class SeenRecord(Part):
    """Something in the map."""

    id: str
    kind: str
    """``object``, ``region`` or ``room``."""
    description: str
    position_m: Point
    state: str
    """For regions and rooms, what is known: ``open``, ``yes``, ``no``; for objects their class."""
    sightings: int = 0
    view: tuple[int, int, int, int, int] | None = None
    """Provenance: number of the picture, and left, top, right, bottom in it, pixels."""


class OrderRecord(Part):
    """One order that an operator gave."""

    order: Order
    operator: str
    text: str
    """As it was given: data, never an instruction to this program."""
    answer: str
    """What the drone said that it does."""
    time_s: float
    """Mission clock."""


class NoticeRecord(Part):
    """Something worth a line."""

    kind: str
    text: str


class AchievedRecord(Part):
    """A stop that was done."""

    n: int
    """Number of its step."""
    text: str
    at_s: float
    """When, seconds since the task began."""


class RuleRecord(Part):
    """A rule in time that the mission had."""

    text: str
    """In plain words."""
    formula: str
    """The same in LTLf."""
    kept: bool | None
    """Whether the flight kept it; null where nobody judged that: after orders, where it gave up, on a real vehicle."""


class WaitingRecord(Part):
    """What waiting for answers took."""

    delay_s: Figure
    """From questions shown to their answers, or to the end of waiting."""
    hidden_s: Figure
    """Of that, what the drone flew meanwhile of what had to be flown anyway, by its plans."""


class LeftRecord(Part):
    """A stop that was not done."""

    n: int
    """Number of its step."""
    text: str
    reason: str
    """Why, with the figures."""
    resource: str
    """What ran short: ``battery``, ``way``, ``thing``, ``answer``, ``price``; ``ended``: the mission ended before."""
    needed: Figure
    """Seconds that it would have taken, where that is what counts."""
    available: Figure
    """Seconds that there were."""


class LookRecord(Part):
    """What a look into a room came to."""

    n: int
    """Number of its step."""
    text: str
    result: Sight
    """``found``, ``empty``, or ``could-not-see``: then what was asked is not known."""
    what: str
    """The class of what was asked for; empty: whatever is there."""
    count: int
    """How many were found."""
    pictures: tuple[str, ...]
    """The best picture of each who is on the map, in the run folder."""
    seen: Figure
    """Share of the doorway through which the room was seen, 0 to 1."""


class MissionRecord(Part):
    """Everything that is kept of one mission."""

    schema_version: int = SCHEMA_VERSION
    name: str
    instruction: str
    strategy: str
    language: str = "en"
    """In which it was asked."""
    language_model: str = "template"
    """Who could help with words; ``template``: nobody."""
    outcome: Outcome
    reason: str
    complete: bool
    """False where the mission was still running, or ended without a verdict."""
    seed: int | None
    settings: dict[str, JsonValue]
    """The mission as it was resolved: limits, asking, survey, volume …"""
    versions: dict[str, str]
    """Of Python, MintPilot and the parts that decide results."""
    gaps: tuple[GapRecord, ...]
    questions: tuple[QuestionRecord, ...]
    rounds: tuple[RoundRecord, ...]
    tree: TreeRecord | None
    plan_classes: tuple[PlanClassRecord, ...]
    certificate: CertificateRecord | None
    achieved: tuple[AchievedRecord, ...] = ()
    """What was done, in order."""
    left: tuple[LeftRecord, ...] = ()
    """What was to be done and was not."""
    looks: tuple[LookRecord, ...] = ()
    """What looks into rooms came to, in order."""
    rules: tuple[RuleRecord, ...] = ()
    """Rules in time."""
    waiting: WaitingRecord | None = None
    """What waiting for answers took; null in older records."""
    flight: FlightRecord
    survey: FlightRecord | None
    seen: tuple[SeenRecord, ...]
    frames: int
    """Pictures that were looked at."""
    timings_s: dict[str, float]
    notices: tuple[NoticeRecord, ...]
    orders: tuple[OrderRecord, ...] = ()
    run_dir: str
    """Empty where nothing was written."""


def read_record(path: Path) -> MissionRecord:
    """The record in that file, or in the run folder of that name.

    Raises:
        RecordError: it cannot be read, is not a record, or is of a version that this program does not know.
    """
    file = path / "record.json" if path.is_dir() else path
    try:
        data = json.loads(file.read_bytes())
    except OSError as error:
        raise RecordError(
            f"cannot read the record {file}: {error.strerror}; give the run folder of a mission"
        ) from error
    except ValueError as error:
        raise RecordError(f"{file} is not JSON ({error}); give the record.json of a run folder") from error
    version = data.get("schema_version") if isinstance(data, dict) else None
    if version != SCHEMA_VERSION:
        raise RecordError(
            f"{file}: schema_version is {version!r}, this program reads {SCHEMA_VERSION}; "
            "read it with the version of MintPilot that wrote it (under 'versions'), or fly the mission again"
        )
    try:
        return MissionRecord.model_validate(data)
    except ValidationError as error:
        first = error.errors()[0]
        place = ".".join(str(step) for step in first["loc"])
        raise RecordError(
            f"{file}: {place}: {first['msg']} ({error.error_count()} mistakes in all); "
            "the record was changed or damaged: restore it or fly the mission again"
        ) from error
