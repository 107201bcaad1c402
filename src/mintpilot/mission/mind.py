"""What the drone knows and has asked, as a value; and the two steps that change it: thinking and learning."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from mintpilot.core.errors import InfeasibleError
from mintpilot.core.gap import PASSABLE, Belief, CorrelationGroup, GapKind, KnowledgeGap
from mintpilot.core.geometry import Vec3
from mintpilot.core.mission import AskingSettings, Mission
from mintpilot.core.ports import Decision, Fly, ImpactMetric, Planner, Proposer, QueryObjective, Situation, Strategy
from mintpilot.core.query import Answer, Evidence, Query, Reply
from mintpilot.core.semantic_map import SemanticMap
from mintpilot.core.task import Task
from mintpilot.mapping.knowledge import apply_knowledge
from mintpilot.mission.surplus import with_surplus
from mintpilot.reasoning.belief import condition, extend
from mintpilot.uncertainty.findings import Findings, find_gaps, frame_problem


@dataclass(frozen=True, slots=True, kw_only=True)
class Thinking:
    """The parts that thinking is done with; the same for a whole mission."""

    mission: Mission
    task: Task
    planner: Planner
    strategy: Strategy
    metric: ImpactMetric
    objective: QueryObjective
    groups: tuple[CorrelationGroup, ...] = ()
    proposer: Proposer | None = None
    """Whom the strategy may ask for cuts besides its own; None: nobody."""

    @property
    def settings(self) -> AskingSettings:
        """Thresholds and bounds of asking."""
        return self.mission.asking


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Mind:
    """Everything that answers and pictures have taught so far."""

    map: SemanticMap
    belief: Belief
    confirmed: frozenset[str] = frozenset()
    """Obstacle gaps that got an explicit yes."""
    withdrawn: frozenset[str] = frozenset()
    """Cuts answered UNSURE."""
    asked: tuple[Evidence, ...] = ()
    """Queries that were answered, with the answer, oldest first."""
    attempts: tuple[str, ...] = ()
    """Ids of all cuts that were put, oldest first, answered or not."""
    finished: frozenset[str] = frozenset()
    """Stops that were fulfilled."""
    silent: bool = False
    """No answer came within the operator's patience."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Thought:
    """One deliberation: what was looked at, and what it came to."""

    mind: Mind
    findings: Findings
    situation: Situation
    decision: Decision

    @property
    def left_out(self) -> tuple[str, ...]:
        """What bounds on the work left out, in plain sentences: plans stay safe, but may not be the best."""
        mint = self.decision.mint
        notes = self.situation.space.notes
        if isinstance(self.decision, Fly):
            notes = (*notes, *(notice.rstrip(".") for notice in self.decision.notices))
        if mint is None or not mint.not_expanded:
            return notes
        return (*notes, f"{mint.not_expanded} leaves of the tree were not expanded; they get the cautious plan")


@dataclass(frozen=True, slots=True, kw_only=True)
class Lesson:
    """What an answer did."""

    mind: Mind
    contradiction: bool = False
    """The answer goes against earlier ones beyond what the answer error explains; it was not taken into the belief."""
    surplus_refused: bool = False
    """The same of what was said beyond the question: of that, nothing was taken into the belief."""


def think(mind: Mind, parts: Thinking, *, start_m: Vec3, endurance_s: float) -> Thought:
    """Finds the gaps, plans, and decides whether to ask or to fly (method, sections 2 to 5).

    Args:
        mind: what is known so far.
        parts: what thinking is done with.
        start_m: where the drone is, metres.
        endurance_s: flight time that a plan may use, seconds.

    Raises:
        InfeasibleError: nothing can be flown, whatever the answers are.
    """
    try:
        thought = _think(mind, parts, start_m=start_m, endurance_s=endurance_s, honour_wishes=True)
        hopeless = isinstance(thought.decision, Fly) and thought.decision.plan is None
    except InfeasibleError:
        if not _wishes(mind, parts, start_m):
            raise
        hopeless = True
    if hopeless and _wishes(mind, parts, start_m):
        return _think(mind, parts, start_m=start_m, endurance_s=endurance_s, honour_wishes=False)
    return thought


def _think(mind: Mind, parts: Thinking, *, start_m: Vec3, endurance_s: float, honour_wishes: bool) -> Thought:
    findings, belief = _look_for_gaps(mind, parts, start_m, honour_wishes)
    known = apply_knowledge(mind.map, belief, mind.confirmed, parts.settings)
    if known is not mind.map:
        mind = replace(mind, map=known, belief=belief)
        findings, belief = _look_for_gaps(mind, parts, start_m, honour_wishes)
    if findings.problems:
        raise InfeasibleError(" ".join(findings.problems))
    mind = replace(mind, belief=belief)
    limits = replace(parts.mission.limits, endurance_s=max(endurance_s, 1e-3))
    problem = frame_problem(mind.map, parts.task, findings, start_m=start_m, limits=limits, finished=mind.finished)
    situation = Situation(
        problem=problem,
        space=parts.planner.open(problem),
        belief=belief,
        confirmed=mind.confirmed,
        withdrawn=mind.withdrawn,
        asked=mind.asked,
        silent=mind.silent,
        settings=_with_budget(parts.settings, mind),
        metric=parts.metric,
        objective=parts.objective,
        proposer=parts.proposer,
    )
    return Thought(mind=mind, findings=findings, situation=situation, decision=parts.strategy.decide(situation))


def learn(mind: Mind, query: Query, answer: Answer, settings: AskingSettings) -> Lesson:
    """The mind after an answer (method, section 5)."""
    mind = replace(mind, attempts=(*mind.attempts, query.id))
    if answer.reply is Reply.TIMEOUT:
        return Lesson(mind=replace(mind, silent=True))
    if answer.part is None:
        return Lesson(mind=replace(mind, withdrawn=mind.withdrawn | {query.id}))
    update = condition(mind.belief, query, answer.part, settings.answer_error, max_joint=settings.max_joint)
    if update.contradiction:
        return Lesson(mind=replace(mind, withdrawn=mind.withdrawn | _asked_before(mind, query)), contradiction=True)
    belief, surplus_refused = with_surplus(mind.belief, update.belief, query, answer, settings)
    return Lesson(
        mind=replace(
            mind,
            belief=belief,
            confirmed=mind.confirmed | _confirmed_by(query, answer.part, mind.belief.gaps),
            asked=(*mind.asked, Evidence(query=query, part=answer.part)),
        ),
        surplus_refused=surplus_refused,
    )


def _look_for_gaps(mind: Mind, parts: Thinking, start_m: Vec3, honour_wishes: bool) -> tuple[Findings, Belief]:
    findings = find_gaps(
        mind.map,
        parts.task,
        start_m=start_m,
        prior_passable=parts.mission.prior_passable,
        finished=mind.finished,
        honour_wishes=honour_wishes,
    )
    return findings, extend(mind.belief, findings.gaps, parts.groups, max_joint=parts.settings.max_joint)


def _with_budget(settings: AskingSettings, mind: Mind) -> AskingSettings:
    """The settings with the questions taken off the budget that left no trace: those whose answers contradicted."""
    traced = len(mind.asked) + len(mind.withdrawn)
    lost = max(0, len(mind.attempts) - traced)
    return replace(settings, max_questions=max(0, settings.max_questions - lost)) if lost else settings


def _wishes(mind: Mind, parts: Thinking, start_m: Vec3) -> bool:
    """Whether something is stayed out of only because the person wished so."""
    return bool(_look_for_gaps(mind, parts, start_m, honour_wishes=True)[0].wishes)


def _asked_before(mind: Mind, query: Query) -> frozenset[str]:
    """A contradicting cut is asked again once; the second time it is given up."""
    return frozenset({query.id}) if mind.attempts.count(query.id) > 1 else frozenset()


def _confirmed_by(query: Query, part: int, gaps: Sequence[KnowledgeGap]) -> frozenset[str]:
    """Obstacle gaps that this answer says outright to be passable."""
    obstacles = {gap.id for gap in gaps if gap.kind is GapKind.OBSTACLE}
    return frozenset(x.gap for x in query.asserted(part) if x.gap in obstacles and x.values == frozenset({PASSABLE}))
