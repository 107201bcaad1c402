"""What answers and pictures have taught, as a value; and the update by an answer (method, section 5)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from mintpilot.core.gap import PASSABLE, Belief, GapKind, KnowledgeGap
from mintpilot.core.geometry import Ints, frozen
from mintpilot.core.mission import AskingSettings
from mintpilot.core.query import ATTRIBUTES_NOT_KNOWN, Answer, Evidence, Query, Reply, topics
from mintpilot.core.semantic_map import SemanticMap
from mintpilot.mission.extra_evidence import with_extra_evidence
from mintpilot.mission.rule_progress import RuleProgress
from mintpilot.reasoning.belief import condition


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Grant:
    """An explicit yes for a region, or a look that saw it passable: it covers what was shown, for as long as answers
    count (method, section 12).
    """

    gap: str
    """Id of the obstacle gap."""
    cells: Ints
    """Flat indices (n,) of the region's cells as it was shown when the question was put."""
    given_s: float
    """When the answer came, mission clock."""

    def __post_init__(self) -> None:
        frozen(self.cells)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class BeliefState:
    """Everything that answers and pictures have taught so far."""

    map: SemanticMap
    belief: Belief
    confirmed: frozenset[str] = frozenset()
    """Obstacle gaps that got an explicit yes."""
    grants: tuple[Grant, ...] = ()
    """Of each of these, and of regions that were looked at: the outline that was shown, and when the yes came; sorted
    by gap, none twice."""
    withdrawn: frozenset[str] = frozenset()
    """What is not asked again: what the operator does not know (`mintpilot.core.query.topics`, and target gaps of which
    two attributes were not known), and queries whose answers contradicted twice."""
    asked: tuple[Evidence, ...] = ()
    """Queries that were answered, with the answer, oldest first."""
    attempts: tuple[str, ...] = ()
    """Ids of all queries that were put, oldest first, answered or not."""
    finished: frozenset[str] = frozenset()
    """Stops that were fulfilled."""
    progress: RuleProgress = RuleProgress()  # noqa: RUF009  (a value)
    """How far the rules have come."""
    silent: bool = False
    """No answer came within the operator's patience, or nobody is there."""


@dataclass(frozen=True, slots=True, kw_only=True)
class AnswerUpdate:
    """What an answer did."""

    state: BeliefState
    contradiction: bool = False
    """The answer goes against earlier ones beyond what the answer error explains; it was not taken into the belief."""
    extra_refused: bool = False
    """The same of what was said beyond the question: of that, nothing was taken into the belief."""


def update(state: BeliefState, query: Query, answer: Answer, settings: AskingSettings) -> AnswerUpdate:
    """The belief state after an answer (method, section 5)."""
    state = replace(state, attempts=(*state.attempts, query.id))
    if answer.reply is Reply.TIMEOUT:
        return AnswerUpdate(state=replace(state, silent=True))
    if answer.part is None:
        return AnswerUpdate(state=replace(state, withdrawn=_with_not_known(state.withdrawn, query)))
    after = condition(state.belief, query, answer.part, settings.answer_error, max_joint=settings.max_joint)
    if after.contradiction:
        given_up = frozenset({query.id}) if state.attempts.count(query.id) > 1 else frozenset[str]()
        return AnswerUpdate(state=replace(state, withdrawn=state.withdrawn | given_up), contradiction=True)
    belief, refused = with_extra_evidence(state.belief, after.belief, query, answer, settings)
    confirmed = state.confirmed | confirmed_by(query, answer.part, state.belief.gaps)
    asked = (*state.asked, Evidence(query=query, part=answer.part))
    return AnswerUpdate(
        state=replace(state, belief=belief, confirmed=confirmed, asked=asked),
        extra_refused=refused,
    )


def confirmed_by(query: Query, part: int, gaps: Sequence[KnowledgeGap]) -> frozenset[str]:
    """Obstacle gaps that this answer says outright to be passable: about them alone, or joined by *and*."""
    obstacles = {gap.id for gap in gaps if gap.kind is GapKind.OBSTACLE}
    return frozenset(x.gap for x in query.asserted(part) if x.gap in obstacles and x.values == frozenset({PASSABLE}))


def _with_not_known(withdrawn: frozenset[str], query: Query) -> frozenset[str]:
    """What is withdrawn after an "I don't know": a target gap altogether once two of its attributes were not known."""
    after = withdrawn | topics(query)
    spent = {
        name for name in query.gap_ids if sum(topic.startswith(f"{name}/") for topic in after) >= ATTRIBUTES_NOT_KNOWN
    }
    return after | spent


def remaining_budget(settings: AskingSettings, state: BeliefState) -> AskingSettings:
    """The settings with the questions that were put taken off the budget."""
    return replace(settings, max_questions=max(0, settings.question_budget - len(state.attempts)))
