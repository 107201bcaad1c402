"""Deliberation: find the gaps, plan, build the tree, choose the query (method, sections 2 to 5). Pure, and slow."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Protocol

from mintpilot.core.decisions import AskQuestion, FlyPlan, NoPlan, Reasoning
from mintpilot.core.errors import InfeasibleError
from mintpilot.core.gap import PASSABLE, Assumptions, Belief, CorrelationGroup, GapKind, KnowledgeGap
from mintpilot.core.geometry import Vec3
from mintpilot.core.message import Message, joined, message
from mintpilot.core.mission import AskingSettings, Mission, ReturnRule, WhileWaiting
from mintpilot.core.plan import LeftUndone, PlanningProblem, Prospect
from mintpilot.core.ports import (
    Ask,
    Decision,
    Fly,
    ImpactMetric,
    PlanMetric,
    Planner,
    Proposer,
    QueryObjective,
    Situation,
    Strategy,
)
from mintpilot.core.query import Query, Question
from mintpilot.core.semantic_map import Knowledge, SemanticMap
from mintpilot.core.task import Task
from mintpilot.core.tree import Mint
from mintpilot.elicitation.wording import word_question
from mintpilot.mapping.knowledge import apply_knowledge
from mintpilot.mission.belief_state import BeliefState, remaining_budget
from mintpilot.mission.explanations import explanations
from mintpilot.mission.looking import look_options
from mintpilot.mission.nothing_done import nothing_done, sentence
from mintpilot.mission.rule_progress import ruling
from mintpilot.mission.unseen import SEARCH, with_search
from mintpilot.reasoning.belief import extend
from mintpilot.reasoning.waiting import longest_wait_s, spare_s
from mintpilot.strategies.flying import cautious_plan
from mintpilot.uncertainty.findings import Findings, Prices, find_gaps, frame_problem

LEAST_ENDURANCE_S = 1e-3
"""A plan is framed with at least this flight time, seconds: an empty battery is no plan, not an error."""


class Wording(Protocol):
    """Puts a query into words. Words never decide meaning: the query goes with them."""

    def __call__(self, query: Query, gaps: Sequence[KnowledgeGap], mint: Mint | None, *, attempt: int = 1) -> Question:
        """The question for a query; from the second attempt on in other words."""
        ...


@dataclass(frozen=True, slots=True, kw_only=True)
class DeliberationParts:
    """The parts that deliberation is done with; the same for a whole mission."""

    mission: Mission
    task: Task
    planner: Planner
    strategy: Strategy
    metric: ImpactMetric
    objective: QueryObjective
    groups: tuple[CorrelationGroup, ...] = ()
    proposer: Proposer | None = None
    """Whom the strategy may ask for queries besides its own; None: nobody."""
    word: Wording = word_question
    """Words a query at once, by template."""

    @property
    def settings(self) -> AskingSettings:
        """Thresholds and bounds of asking."""
        return self.mission.asking


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Deliberation:
    """What was looked at, and what it came to."""

    state: BeliefState
    findings: Findings
    situation: Situation
    decision: Decision
    left: tuple[LeftUndone, ...] = ()
    """All stops, where nothing is flown."""

    @property
    def left_out(self) -> tuple[Message, ...]:
        """What bounds on the work left out, in plain sentences: plans stay safe, but may not be the best."""
        mint = self.decision.mint
        notes = self.situation.space.notes
        if isinstance(self.decision, Fly):
            notes = (*notes, *self.decision.notices)
        if mint is None or not mint.not_expanded:
            return notes
        return (
            *notes,
            message(
                "{count} leaves of the tree were not expanded; they get the cautious plan", count=mint.not_expanded
            ),
        )


def deliberate(state: BeliefState, parts: DeliberationParts, *, start_m: Vec3, endurance_s: float) -> Deliberation:
    """Finds the gaps, plans, and decides whether to ask or to fly (method, sections 2 to 5).

    Wishes (avoidances that are not strict) are given up where the task cannot be done otherwise.

    Args:
        state: what is known so far.
        parts: what deliberation is done with.
        start_m: where the drone is, metres.
        endurance_s: flight time that a plan may use, seconds.

    Raises:
        InfeasibleError: nothing can be flown, whatever the answers are.
    """
    found: Deliberation | None
    try:
        found = _deliberate(state, parts, start_m=start_m, endurance_s=endurance_s, honour_wishes=True)
        hopeless = isinstance(found.decision, Fly) and _left_s(found.decision) > 0
    except InfeasibleError:
        if not _wishes(state, parts, start_m):
            raise
        hopeless, found = True, None
    if hopeless and _wishes(state, parts, start_m):
        without = _deliberate(state, parts, start_m=start_m, endurance_s=endurance_s, honour_wishes=False)
        if found is None or isinstance(without.decision, Ask) or _left_s(without.decision) < _left_s(found.decision):
            return without
    assert found is not None, "an infeasible mission without wishes was raised"
    return found


def _moves(parts: DeliberationParts) -> bool:
    """Whether it flies on while a question is open: not where rules say what may be flown in which order."""
    return parts.settings.while_waiting is WhileWaiting.MOVE and not parts.task.rules


def _left_s(decision: Decision) -> float:
    """Prices of what a decision to fly leaves undone; infinite where nothing is flown."""
    plan = decision.plan if isinstance(decision, Fly) else None
    return math.inf if plan is None else sum(one.stop.price_s for one in plan.leaves_undone)


def decision_of(found: Deliberation, parts: DeliberationParts, explained: frozenset[str]) -> AskQuestion | FlyPlan:
    """What a deliberation came to, as a value that can be sent and kept.

    Args:
        found: the deliberation.
        parts: words the query.
        explained: ids of gaps that an earlier deliberation has explained.
    """
    choice, situation = found.decision, found.situation
    fresh = any(gap.id not in explained for gap in found.findings.gaps)
    reasoning = Reasoning(
        gaps=found.findings.gaps,
        belief=situation.belief,
        regions=tuple((r.id, r.passable) for r in found.state.map.regions if r.passable is not Knowledge.OPEN),
        rooms=tuple((r.id, r.occupied) for r in found.state.map.rooms if r.occupied is not Knowledge.OPEN),
        mint=choice.mint,
        cautious=choice.mint.root.cautious if choice.mint is not None else None,
        explanations=explanations(found.situation, choice.mint) if fresh else (),
        proposed=choice.proposed,
        left_out=found.left_out,
    )
    if isinstance(choice, Fly):
        return FlyPlan(
            reasoning=reasoning,
            plan=choice.plan,
            certificate=choice.certificate,
            unsafe=choice.unsafe,
            left=found.left,
        )
    query = choice.scored.query
    spoken_of = tuple(g for g in situation.belief.gaps if g.id in query.gap_ids)
    attempt = found.state.attempts.count(query.id) + 1
    return AskQuestion(
        reasoning=reasoning,
        question=parts.word(query, spoken_of, choice.mint, attempt=attempt),
        scored=choice.scored,
        alternatives=choice.alternatives,
        bound_bits=choice.bound_bits,
        waits_s=longest_wait_s(cautious_plan(situation), situation.problem.limits),
        prospects=prospects_of(situation, choice.mint) if _moves(parts) else (),
    )


def prospects_of(situation: Situation, mint: Mint | None) -> tuple[Prospect, ...]:
    """What the answers may come to: the plan of each class, and the cautious one last; none where no tree was built."""
    if mint is None:
        return ()
    limits, obstacles = situation.problem.limits, [g.id for g in situation.belief.gaps if g.kind is GapKind.OBSTACLE]
    found = []
    for one in mint.classes:
        if one.plan is None:
            continue
        sure = [{gap for gap, values in given.items if values == frozenset({PASSABLE})} for given in one.given]
        free = (one.plan.enters | frozenset(set.intersection(*sure))) & frozenset(obstacles)
        found.append(
            Prospect(
                probability=one.probability,
                plan=one.plan,
                given=one.given,
                free=free,
                spare_s=spare_s(one.plan, limits),
            )
        )
    cautious = cautious_plan(situation)
    if cautious is not None:
        safe = Prospect(
            probability=0.0,
            plan=cautious,
            given=(Assumptions(),),
            free=cautious.enters & frozenset(obstacles),
            spare_s=spare_s(cautious, limits),
        )
        found.append(safe)
    return tuple(found)


def settle(map: SemanticMap, reasoning: Reasoning) -> SemanticMap:
    """The map with what a deliberation has taken as known of regions and rooms (expert knowledge, method section 6)."""
    passable = {region.id: region.passable for region in map.regions}
    occupied = {room.id: room.occupied for room in map.rooms}
    for region, known in reasoning.regions:
        if passable.get(region) is Knowledge.OPEN:
            map = map.with_region(region, known)
    for room, known in reasoning.rooms:
        if occupied.get(room) is Knowledge.OPEN:
            map = map.with_room(room, occupied=known)
    return map


def mission_decision(
    state: BeliefState, parts: DeliberationParts, *, start_m: Vec3, endurance_s: float, explained: frozenset[str]
) -> AskQuestion | FlyPlan | NoPlan:
    """Deliberates and gives the decision; `NoPlan` where nothing can be flown whatever the answers are."""
    try:
        found = deliberate(state, parts, start_m=start_m, endurance_s=endurance_s)
    except InfeasibleError as error:
        return NoPlan(reason=error.said, left=_all_left(state, parts, start_m=start_m, endurance_s=endurance_s))
    return decision_of(found, parts, explained)


def _all_left(
    state: BeliefState, parts: DeliberationParts, *, start_m: Vec3, endurance_s: float
) -> tuple[LeftUndone, ...]:
    try:
        framed = _framed(state, parts, start_m=start_m, endurance_s=endurance_s, honour_wishes=False)
    except InfeasibleError:  # what is sought was not seen: there is no stop
        return ()
    return nothing_done(framed[2], parts.planner)


def _framed(
    state: BeliefState, parts: DeliberationParts, *, start_m: Vec3, endurance_s: float, honour_wishes: bool
) -> tuple[BeliefState, Findings, PlanningProblem]:
    """What is to be planned, with what the answers have settled in the map."""
    findings, belief = _gaps_of(state, parts, start_m, honour_wishes)
    known = apply_knowledge(state.map, belief, state.confirmed, parts.settings)
    if known is not state.map:
        state = replace(state, map=known, belief=belief)
        findings, belief = _gaps_of(state, parts, start_m, honour_wishes)
    if findings.problems:
        raise InfeasibleError(joined(findings.problems))
    state = replace(state, belief=belief)
    limits = replace(parts.mission.limits, endurance_s=max(endurance_s, LEAST_ENDURANCE_S))
    mission = parts.mission
    problem = frame_problem(
        state.map,
        parts.task,
        findings,
        start_m=start_m,
        limits=limits,
        finished=state.finished,
        prices=Prices(usual_s=parts.settings.failure_price_s, people_s=mission.people_price_s),
        belief=belief,
        home_m=mission.start_m if mission.returns is ReturnRule.REQUIRED else None,
        ruling=ruling(parts.task, state.progress, state.map, findings.stops),
    )
    return state, findings, problem


def _deliberate(
    state: BeliefState, parts: DeliberationParts, *, start_m: Vec3, endurance_s: float, honour_wishes: bool
) -> Deliberation:
    state, findings, problem = _framed(
        state, parts, start_m=start_m, endurance_s=endurance_s, honour_wishes=honour_wishes
    )
    belief, mission = state.belief, parts.mission
    space = parts.planner.open(problem)
    situation = Situation(
        problem=problem,
        space=space,
        looks=look_options(problem, space, parts.planner, mission.looks, state.finished) if mission.looks else (),
        belief=belief,
        confirmed=state.confirmed,
        withdrawn=state.withdrawn,
        asked=state.asked,
        silent=state.silent,
        settings=remaining_budget(parts.settings, state),
        metric=parts.metric.on(problem) if isinstance(parts.metric, PlanMetric) else parts.metric,
        objective=parts.objective,
        proposer=parts.proposer,
    )
    decision = parts.strategy.decide(situation)
    left: tuple[LeftUndone, ...] = ()
    if isinstance(decision, Fly) and decision.plan is None:
        left = nothing_done(problem, parts.planner)
        certificate = decision.certificate
        text = joined([certificate.text, sentence(left)])
        decision = replace(decision, certificate=replace(certificate, text=text))
    return Deliberation(state=state, findings=findings, situation=situation, decision=decision, left=left)


def _gaps_of(
    state: BeliefState, parts: DeliberationParts, start_m: Vec3, honour_wishes: bool
) -> tuple[Findings, Belief]:
    findings = find_gaps(
        state.map,
        parts.task,
        start_m=start_m,
        prior_passable=parts.mission.prior_passable,
        finished=state.finished,
        honour_wishes=honour_wishes,
    )
    belief, mission = state.belief, parts.mission
    if findings.sought and mission.survey is not None:
        findings = with_search(findings, state.map, mission.limits, start_m, state.finished)
        if all(SEARCH not in one.query.gap_ids for one in state.asked):
            belief = Belief(factors=tuple(f for f in belief.factors if SEARCH not in {g.id for g in f.gaps}))
    return findings, extend(belief, findings.gaps, parts.groups, max_joint=parts.settings.max_joint)


def _wishes(state: BeliefState, parts: DeliberationParts, start_m: Vec3) -> bool:
    """Whether something is stayed out of only because the person wished so."""
    return bool(_gaps_of(state, parts, start_m, honour_wishes=True)[0].wishes)
