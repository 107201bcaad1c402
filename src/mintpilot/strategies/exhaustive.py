"""Asks about everything that is unknown, whether it matters or not: the paper's 'always ask'."""

from __future__ import annotations

import numpy as np

from mintpilot.core.gap import PASSABLE, GapKind, KnowledgeGap
from mintpilot.core.ports import Ask, Decision, Situation, Strategy
from mintpilot.core.query import Query, is_refused
from mintpilot.core.tolerances import DECIMALS, TOLERANCE
from mintpilot.core.tree import Mint, ScoredQuery, StopReason
from mintpilot.elicitation.candidates import gap_literals
from mintpilot.elicitation.objectives.channel import noise_bits
from mintpilot.elicitation.phrasing_cost import phrasing_cost
from mintpilot.reasoning.entropy import entropy_bits
from mintpilot.reasoning.safety import known_passable
from mintpilot.strategies.flying import best_safe_plan, fly, fly_cautiously, questions_left, tree_of


class ExhaustiveStrategy(Strategy):
    """One gap after the other, by id, until each is known; then flies."""

    def decide(self, situation: Situation) -> Decision:
        """Asks about the first gap that is not known; a target gap by the queries that halve its candidates best."""
        mint = tree_of(situation)
        if situation.silent:
            return fly_cautiously(situation, mint, StopReason.SILENCE)
        for gap in situation.belief.gaps:
            if not is_known(gap, situation):
                scored = best_about(gap, situation)
                if scored is not None:
                    if not questions_left(situation):
                        return fly(situation, mint, best_safe_plan(situation, mint), StopReason.BUDGET)
                    return Ask(scored=scored, mint=mint)
        return fly(situation, mint, best_safe_plan(situation, mint), _reason(mint))


def best_about(gap: KnowledgeGap, situation: Situation) -> ScoredQuery | None:
    """The query about that gap alone with the highest gain on it; None where none may be asked or has a gain."""
    queries = [Query(literals=(literal,)) for literal in gap_literals(gap, situation.problem.start_m)]
    answered = {one.query.id for one in situation.asked} if situation.settings.answer_error == 0 else set()
    found = []
    for query in queries:
        if is_refused(query, situation.withdrawn) or query.id in answered:
            continue
        scored = scored_alone(query, gap, situation)
        # A region that is surely passable still needs its explicit yes.
        if scored.score > TOLERANCE or gap.kind is GapKind.OBSTACLE:
            found.append(scored)
    return min(found, key=lambda s: (-round(s.score, DECIMALS), *phrasing_cost(s.query)), default=None)


def scored_alone(query: Query, gap: KnowledgeGap, situation: Situation) -> ScoredQuery:
    """A query about one gap alone with its information gain on that gap."""
    error, count = situation.settings.answer_error, query.part_count
    parts = query.parts_over(((gap.id, gap.values),))
    shares = np.bincount(parts, weights=situation.belief.marginal(gap.id), minlength=count)
    named = (1 - error) * shares + error / (count - 1) * (1 - shares)
    gain = entropy_bits(named) - noise_bits(count, error)
    return ScoredQuery(
        query=query,
        score=gain,
        gain_bits=max(gain, 0.0),
        regret_saved_s=0.0,
        reply_probabilities=tuple(named.tolist()),
    )


def is_known(gap: KnowledgeGap, situation: Situation) -> bool:
    """Whether one value is sure enough: a region by `known_passable` or its opposite, others from 1 - alpha on."""
    settings, p = situation.settings, situation.belief.marginal(gap.id)
    if gap.kind is GapKind.OBSTACLE:
        blocked = 1 - situation.belief.probability_of(gap.id, PASSABLE)
        asked = any(gap.id in one.query.gap_ids for one in situation.asked)
        return known_passable(gap.id, situation.belief, situation.confirmed, settings) or (
            asked and blocked >= 1 - settings.alpha_safe
        )
    return bool(np.max(p) >= 1 - settings.alpha)


def _reason(mint: Mint) -> StopReason:
    if mint.classes[0].plan is None and len(mint.classes) == 1:
        return StopReason.INFEASIBLE
    return StopReason.ONE_CLASS if len(mint.classes) == 1 else StopReason.NO_GAIN
