"""Asks about whatever is uncertain enough, whether it bears on the plan or not: the usual uncertainty gate."""

from __future__ import annotations

from mintpilot.core.errors import InputError
from mintpilot.core.gap import KnowledgeGap
from mintpilot.core.ports import Ask, Decision, Situation, Strategy
from mintpilot.core.tolerances import DECIMALS
from mintpilot.core.tree import ScoredQuery, StopReason
from mintpilot.reasoning.entropy import entropy_bits
from mintpilot.strategies.exhaustive import best_about
from mintpilot.strategies.flying import best_safe_plan, fly, fly_cautiously, questions_left, tree_of


class EntropyThresholdStrategy(Strategy):
    """Asks about the most uncertain gap as long as one has more entropy than the threshold; then flies.

    Args:
        threshold_bits: half a bit by default: a yes/no matter that is less than about 89 % sure.

    Raises:
        InputError: the threshold is negative.
    """

    def __init__(self, threshold_bits: float = 0.5) -> None:
        if not threshold_bits >= 0:
            raise InputError(f"entropy threshold {threshold_bits} bits: must not be below 0")
        self._threshold_bits = threshold_bits

    def decide(self, situation: Situation) -> Decision:
        """Asks the query with the highest gain on the most uncertain gap, or flies what loses least on average."""
        mint = tree_of(situation)
        if situation.silent:
            return fly_cautiously(situation, mint, StopReason.SILENCE)
        scored = self._next(situation)
        if scored is None:
            return fly(situation, mint, best_safe_plan(situation, mint), StopReason.NO_GAIN)
        if not questions_left(situation):
            return fly(situation, mint, best_safe_plan(situation, mint), StopReason.BUDGET)
        return Ask(scored=scored, mint=mint)

    def _next(self, situation: Situation) -> ScoredQuery | None:
        def entropy(gap: KnowledgeGap) -> float:
            return entropy_bits(situation.belief.marginal(gap.id))

        unsure = [gap for gap in situation.belief.gaps if entropy(gap) > self._threshold_bits]
        for gap in sorted(unsure, key=lambda gap: (-round(entropy(gap), DECIMALS), gap.id)):
            scored = best_about(gap, situation)
            if scored is not None:
                return scored
        return None
