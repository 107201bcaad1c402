"""The short form of a record: what ``run --json`` prints."""

from __future__ import annotations

from mintpilot.core.query import Reply
from mintpilot.recording.people import PeopleSummary, people_of
from mintpilot.recording.record import (
    AchievedRecord,
    Figure,
    FlightRecord,
    LeftRecord,
    LookRecord,
    MissionRecord,
    Part,
    RuleRecord,
    WaitingRecord,
)


class QuestionSummary(Part):
    """One question."""

    text: str
    gap: str
    """Id of the gap; of several, joined by a comma and a space."""
    gain_bits: Figure
    reply: Reply
    latency_s: Figure


class GapSummary(Part):
    """One gap: asked or not, and why, in figures."""

    id: str
    description: str
    asked: bool
    why: str
    cost_if_favourable_s: Figure
    cost_if_unfavourable_s: Figure
    divergence_m: Figure
    entropy_bits: Figure
    gain_bits: Figure
    regret_saved_s: Figure


class RunSummary(Part):
    """One mission in short."""

    schema_version: int
    outcome: str
    """``success``, or how it failed by its stable name, e.g. ``collision``."""
    reason: str
    """The same in a sentence."""
    questions: tuple[QuestionSummary, ...]
    gaps: tuple[GapSummary, ...]
    achieved: tuple[AchievedRecord, ...]
    left: tuple[LeftRecord, ...]
    looks: tuple[LookRecord, ...]
    people: PeopleSummary
    rules: tuple[RuleRecord, ...]
    waiting: WaitingRecord | None
    flight: FlightRecord
    timings_s: dict[str, float]
    seed: int | None
    run_dir: str


def summary(record: MissionRecord) -> RunSummary:
    """The record in short; ``summary(record).model_dump_json()`` is the output of ``run --json``."""
    return RunSummary(
        schema_version=record.schema_version,
        outcome=record.outcome.value,
        reason=record.reason,
        questions=tuple(
            QuestionSummary(
                text=q.text, gap=", ".join(q.gaps), gain_bits=q.gain_bits, reply=q.reply, latency_s=q.latency_s
            )
            for q in record.questions
        ),
        gaps=tuple(GapSummary(**{name: getattr(g, name) for name in GapSummary.model_fields}) for g in record.gaps),
        achieved=record.achieved,
        left=record.left,
        looks=record.looks,
        people=people_of(record),
        rules=record.rules,
        waiting=record.waiting,
        flight=record.flight,
        timings_s=record.timings_s,
        seed=record.seed,
        run_dir=record.run_dir,
    )
