"""Asks about everything that is unknown, whether it matters or not: the paper's 'always ask'."""

from __future__ import annotations

import numpy as np

from mintpilot.core.gap import PASSABLE, GapKind, KnowledgeGap
from mintpilot.core.ports import Ask, Decision, Situation, Strategy
from mintpilot.core.query import Query
from mintpilot.core.tree import Mint, ScoredQuery, StopReason
from mintpilot.elicitation.candidates import gap_literals
from mintpilot.elicitation.phrasing_cost import phrasing_cost
from mintpilot.reasoning.entropy import entropy_bits
from mintpilot.reasoning.safety import known_passable
from mintpilot.strategies.flying import best_safe_plan, fly, fly_cautiously, questions_left, tree_of


class ExhaustiveStrategy(Strategy):
    """One gap after the other, by id, until each is known; then flies."""

    def decide(self, situation: Situation) -> Decision:
        """Asks about the first gap that is not known; a target gap by the cuts that halve its candidates best."""
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
    """The cut about that gap alone that tells most of it; None where none may be asked or tells anything."""
    answered = {query.id for query, _ in situation.asked} if situation.settings.answer_error == 0 else set()
    error, p = situation.settings.answer_error, situation.belief.marginal(gap.id)
    found = []
    for literal in gap_literals(gap, situation.problem.start_m):
        query = Query(literals=(literal,))
        if query.id in situation.withdrawn or query.id in answered:
            continue
        yes = float(sum(q for v, q in zip(gap.values, p, strict=True) if v in literal.values))
        heard = (1 - error) * yes + error * (1 - yes)
        gain = entropy_bits([heard, 1 - heard]) - entropy_bits([error, 1 - error])
        # A region that is surely passable still needs its explicit yes.
        if gain > 1e-9 or gap.kind is GapKind.OBSTACLE:
            found.append(
                ScoredQuery(
                    query=query, score=gain, gain_bits=max(gain, 0.0), regret_saved_s=0.0, yes_probability=heard
                )
            )
    return min(found, key=lambda s: (-round(s.score, 9), *phrasing_cost(s.query)), default=None)


def is_known(gap: KnowledgeGap, situation: Situation) -> bool:
    """Whether one value is sure enough: a region by `known_passable` or its opposite, others from 1 - alpha on."""
    settings, p = situation.settings, situation.belief.marginal(gap.id)
    if gap.kind is GapKind.OBSTACLE:
        blocked = 1 - situation.belief.probability_of(gap.id, PASSABLE)
        asked = any(gap.id in query.gap_ids for query, _ in situation.asked)
        return known_passable(gap.id, situation.belief, situation.confirmed, settings) or (
            asked and blocked >= 1 - settings.alpha_safe
        )
    return bool(np.max(p) >= 1 - settings.alpha)


def _reason(mint: Mint) -> StopReason:
    if mint.classes[0].plan is None and len(mint.classes) == 1:
        return StopReason.INFEASIBLE
    return StopReason.ONE_CLASS if len(mint.classes) == 1 else StopReason.NO_GAIN
