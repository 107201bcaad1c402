"""What `mintpilot plan` reports: deliberation without a flight."""

from __future__ import annotations

from pydantic import BaseModel, ConfigDict

from mintpilot.core.gap import Assumptions, KnowledgeGap
from mintpilot.core.ports import Ask, Fly
from mintpilot.core.query import Question
from mintpilot.core.task import Task, step_lines
from mintpilot.core.tree import GapExplanation, Mint
from mintpilot.mission.preview import Preview
from mintpilot.recording.record import TreeRecord
from mintpilot.recording.tree_data import tree_record
from mintpilot.recording.tree_drawing import tree_text
from mintpilot.wording.speech import Speech

SCHEMA_VERSION = 1


class _Report(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid", ser_json_inf_nan="null", defer_build=True)


class GapReport(_Report):
    """One gap, with what is known of its weight."""

    id: str
    kind: str
    description: str
    values: dict[str, float]
    """Value → prior."""
    critical: bool
    """Whether the flight depends on it."""
    why: str
    """In one sentence, with the figures."""
    cost_if_favourable_s: float | None
    cost_if_unfavourable_s: float | None
    divergence_m: float | None
    entropy_bits: float
    gain_bits: float
    regret_saved_s: float


class StepReport(_Report):
    """One step as the instruction was understood."""

    n: int
    action: str
    target: str
    place: str
    text: str


class PlanClassReport(_Report):
    """Joint hypotheses that lead to the same flight."""

    cost_s: float | None
    """Null: under these hypotheses nothing can be flown."""
    probability: float
    hypotheses: list[dict[str, list[str]]]
    """Each: gap id → the values meant."""


class QueryReport(_Report):
    """The question that would be asked first."""

    id: str
    text: str
    yes_means: str
    no_means: str
    gaps: list[str]
    gain_bits: float
    yes_probability: float | None
    """Null for a choice."""
    replies: list[str]
    """What can be answered: ``yes`` and ``no``, or the options of a choice."""
    reply_probabilities: list[float]
    """With which each of them is expected."""
    option_means: list[str]
    """Of a choice: the consequence of each reply."""
    regret_saved_s: float


class DeliberationReport(_Report):
    """What the drone would ask now, and why."""

    schema_version: int = SCHEMA_VERSION
    mission: str
    language: str = "en"
    """Of its texts; what is meant for programs is in English."""
    strategy: str
    steps: list[StepReport]
    """What will be done, in order."""
    keep_out: list[str]
    """What is stayed out of or away from."""
    rules: list[str]
    """What the flight keeps from take-off to its end, in words."""
    slowly: bool
    """True where the whole flight is flown slowly."""
    understood: list[str]
    """All of that for a person to read, line by line."""
    needs_confirmation: bool
    """True where a language model read the instruction: it is flown only after the operator's yes."""
    gaps: list[GapReport]
    tree: TreeRecord | None
    """Null for strategies that build none, and where there are no gaps."""
    tree_text: str
    """The same as text."""
    plan_classes: list[PlanClassReport]
    query: QueryReport | None
    """Null when nothing needs to be asked."""
    expected_questions: float
    """Mean over the answers."""
    expected_questions_played: int
    """0: the mean is exact. Else it is over so many histories of answers, drawn from the belief."""
    expected_questions_error: float
    """Standard error of a played mean."""
    stop_reason: str | None
    """Why nothing is asked, where nothing is; else null."""
    certificate: str
    """The stop reason with its numbers, as a sentence; empty while a question is open."""
    plan_cost_s: float | None
    """Seconds of the flight that would be flown now; null while a question is open or nothing can be flown."""
    left_out: list[str]
    """What bounds on the work left out; empty when every plan is the best one."""
    seconds: float
    """How long the first deliberation took."""


def deliberation_report(
    preview: Preview,
    *,
    mission: str,
    task: Task,
    strategy: str,
    explanations: tuple[GapExplanation, ...],
    question: Question | None,
    seconds: float,
    speech: Speech,
) -> DeliberationReport:
    """The report on a preview."""
    decision = preview.first.decision
    fly = decision if isinstance(decision, Fly) else None
    gaps = {gap.id: gap for gap in preview.first.findings.gaps}
    tree = tree_record(decision.mint, gaps.values(), speech=speech) if decision.mint else None
    return DeliberationReport(
        mission=mission,
        language=speech.lang,
        steps=steps_report(task, speech),
        keep_out=list(task.keep_out),
        rules=[speech(rule.text) for rule in task.rules],
        slowly=task.slowly,
        understood=[speech(line) for line in step_lines(task)],
        needs_confirmation=task.needs_confirmation,
        strategy=strategy,
        gaps=[
            _gap(gaps[explanation.gap_id], explanation, speech)
            for explanation in explanations
            if explanation.gap_id in gaps
        ],
        tree=tree,
        tree_text=tree_text(tree, speech=speech) if tree else "",
        plan_classes=_classes(decision.mint),
        query=_query(decision, question) if isinstance(decision, Ask) and question is not None else None,
        expected_questions=preview.expected_questions,
        expected_questions_played=preview.played,
        expected_questions_error=preview.error,
        stop_reason=str(fly.certificate.reason) if fly else None,
        certificate=speech(fly.certificate.text) if fly else "",
        plan_cost_s=fly.plan.cost_s if fly and fly.plan else None,
        left_out=[speech(note) for note in preview.first.left_out],
        seconds=seconds,
    )


def steps_report(task: Task, speech: Speech) -> list[StepReport]:
    """The steps of a task, for reports."""
    return [StepReport(n=s.n, action=s.action, target=s.target, place=s.place, text=speech(s.text)) for s in task.steps]


def _gap(gap: KnowledgeGap, explanation: GapExplanation, speech: Speech) -> GapReport:
    return GapReport(
        id=gap.id,
        kind=str(gap.kind),
        description=speech.thing(gap.description),
        values=dict(zip(gap.values, gap.prior, strict=True)),
        critical=explanation.relevant,
        why=speech(explanation.why),
        cost_if_favourable_s=explanation.cost_if_favourable_s,
        cost_if_unfavourable_s=explanation.cost_if_unfavourable_s,
        divergence_m=explanation.divergence_m,
        entropy_bits=explanation.entropy_bits,
        gain_bits=explanation.gain_bits,
        regret_saved_s=explanation.regret_saved_s,
    )


def _classes(mint: Mint | None) -> list[PlanClassReport]:
    return [
        PlanClassReport(
            cost_s=c.plan.cost_s if c.plan else None,
            probability=c.probability,
            hypotheses=[_hypothesis(given) for given in c.given],
        )
        for c in (mint.classes if mint else ())
    ]


def _hypothesis(given: Assumptions) -> dict[str, list[str]]:
    return {gap: sorted(values) for gap, values in given.items}


def _query(ask: Ask, question: Question) -> QueryReport:
    scored = ask.scored
    return QueryReport(
        id=scored.query.id,
        text=question.text,
        yes_means=question.yes_means,
        no_means=question.no_means,
        gaps=list(scored.query.gap_ids),
        gain_bits=scored.gain_bits,
        yes_probability=None if scored.query.is_choice else scored.yes_probability,
        replies=[scored.query.part_words(part) for part in range(scored.query.part_count)],
        reply_probabilities=list(scored.reply_probabilities),
        option_means=list(question.option_means),
        regret_saved_s=scored.regret_saved_s,
    )
