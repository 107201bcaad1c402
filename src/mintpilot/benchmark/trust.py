"""What a person may rely on, counted: pestering, certificates, and consequences that tell something."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Final, Literal

from mintpilot.assembly.components import Choices, deliberation_parts
from mintpilot.benchmark.conditions import true_world
from mintpilot.benchmark.experiment import Cell
from mintpilot.benchmark.experiments import gap_parameters
from mintpilot.benchmark.intervals import clopper_pearson_upper, student
from mintpilot.core.errors import InfeasibleError
from mintpilot.core.gap import GapKind, kind_of
from mintpilot.core.ports import Ask, Fly
from mintpilot.core.query import Answer, Query, Reply, answer_for, topics
from mintpilot.core.tolerances import TOLERANCE
from mintpilot.core.tree import StopReason
from mintpilot.mission.deliberation import Deliberation
from mintpilot.mission.rehearsal import Rehearsal, begin

MOST_QUESTIONS: Final = 40
"""A mission with more questions is broken off, and counts as it is."""
ATTRIBUTES: Final = 2
"""Of so many attributes of a thing somebody may be asked who knows none."""
WORLDS: Final[tuple[tuple[Literal["medicine-boxes", "fire-warehouse"], dict[str, float]], ...]] = (
    ("medicine-boxes", {}),
    ("fire-warehouse", {}),
    ("fire-warehouse", gap_parameters(4)),
)
"""Generators and parameters; each is drawn equally often."""


@dataclass(frozen=True, slots=True, kw_only=True)
class TrustRow:
    """One figure."""

    name: str
    value: float
    n: int
    """Out of how many."""
    low: float | None
    high: float | None
    """Ends of the 95 % interval; of a count that should be 0 the exact one-sided upper bound is ``high``."""
    wanted: str
    """What is right."""


@dataclass(slots=True)
class _Counts:
    missions: int = 0
    questions: int = 0
    pestered: int = 0
    asked_unknowing: list[float] = field(default_factory=list)
    good_for_all: int = 0
    over_delta: int = 0
    same_text: int = 0
    same_though_different: int = 0


def measure_trust(trials: int, seed: int = 0) -> list[TrustRow]:
    """Thinks through so many worlds, without flying.

    Args:
        trials: number of worlds.
        seed: of the first one.
    """
    counts = _Counts()
    for number in range(trials):
        scenario, parameters = WORLDS[number % len(WORLDS)]
        world = true_world(Cell(scenario=scenario, parameters=dict(parameters), methods=()), seed + number)
        start = begin(deliberation_parts(world, Choices()), world.map)
        counts.missions += 1
        _with_somebody_who_never_knows(start, counts)
        first = _deliberated(start)
        gaps = () if first is None else first.findings.gaps
        _with_the_truth(start, {gap.id: world.truth.value_of(gap) for gap in gaps}, counts)
    return list(_rows(counts))


def _rows(counts: _Counts) -> Iterator[TrustRow]:
    yield _should_be_none("missions in which somebody who never knows is asked twice about a region or room, or about "
                          "more than two attributes of a thing", counts.pestered, counts.missions)  # fmt: skip
    mean = student(counts.asked_unknowing)
    yield TrustRow(
        name="questions to somebody who never knows, mean",
        value=sum(counts.asked_unknowing) / max(1, len(counts.asked_unknowing)),
        n=counts.missions,
        low=None if mean is None else mean[0],
        high=None if mean is None else mean[1],
        wanted="few",
    )
    yield _should_be_none(
        "plans called good for all that are not within delta_c", counts.over_delta, counts.good_for_all
    )
    yield _should_be_none("questions with one text for Yes and No though something else is flown",
                          counts.same_though_different, counts.questions)  # fmt: skip
    yield TrustRow(
        name="questions with one text for Yes and No", value=counts.same_text, n=counts.questions, low=None, high=None,
        wanted="only where the same is flown",
    )  # fmt: skip


def _should_be_none(name: str, found: int, n: int) -> TrustRow:
    return TrustRow(name=name, value=found, n=n, low=None, high=clopper_pearson_upper(found, n), wanted="0")


def _with_somebody_who_never_knows(here: Rehearsal, counts: _Counts) -> None:
    asked: Counter[str] = Counter()
    attributes: dict[str, set[str]] = {}
    questions = 0
    while questions < MOST_QUESTIONS:
        found = _deliberated(here)
        if found is None or not isinstance(found.decision, Ask):
            break
        questions += 1
        _count_topics(found.decision.scored.query, asked, attributes)
        here = here.asked(found).answered(Answer(reply=Reply.UNSURE, latency_s=0.0))
    most = max((n for name, n in asked.items() if kind_of(name) is not GapKind.TARGET), default=0)
    counts.pestered += most > 1 or any(len(known) > ATTRIBUTES for known in attributes.values())
    counts.asked_unknowing.append(questions)


def _count_topics(query: Query, asked: Counter[str], attributes: dict[str, set[str]]) -> None:
    for name in query.gap_ids:
        asked[name] += 1
        if kind_of(name) is GapKind.TARGET:
            attributes.setdefault(name, set()).update(t for t in topics(query) if t.startswith(f"{name}/"))


def _deliberated(here: Rehearsal) -> Deliberation | None:
    """The deliberation of one moment; None where nothing can be flown."""
    try:
        return here.deliberated()
    except InfeasibleError:
        return None


def _with_the_truth(here: Rehearsal, truth: dict[str, str | None], counts: _Counts) -> None:
    for _ in range(MOST_QUESTIONS):
        found = _deliberated(here)
        if found is None:
            return
        if isinstance(found.decision, Fly):
            certificate = found.decision.certificate
            if certificate.reason is StopReason.GOOD_FOR_ALL:
                counts.good_for_all += 1
                delta_c_s = found.situation.settings.delta_c_s
                counts.over_delta += not certificate.bound_s <= delta_c_s + TOLERANCE
            return
        put = here.asked(found)
        query, question = found.decision.scored.query, put.question
        if question is None:
            return
        counts.questions += 1
        if not query.is_choice and question.yes_means == question.no_means:
            counts.same_text += 1
            counts.same_though_different += _flown(put, query, 0) != _flown(put, query, 1)
        values = {name: truth.get(name) for name in query.gap_ids}
        known = {name: value for name, value in values.items() if value is not None}
        if len(known) < len(values):
            return
        here = put.answered(answer_for(query, query.part_of(known)))


def _flown(put: Rehearsal, query: Query, part: int) -> tuple[str, ...]:
    """What an answer leads to: the plan that is flown, or the next question."""
    found = _deliberated(put.answered(answer_for(query, part)))
    if found is None:
        return ("nothing",)
    if isinstance(found.decision, Ask):
        return ("asks", found.decision.scored.query.id)
    return ("flies", found.decision.plan.signature if found.decision.plan is not None else "nothing")
