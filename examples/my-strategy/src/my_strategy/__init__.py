"""Asks about open gaps from the nearest to the farthest, as long as the plan may still change; then flies.

A strategy is one class with one method. It is asked to decide before the flight and after every answer, and either
asks a query or says what to fly. What it flies is checked by MintPilot again: a strategy cannot send the drone through
a region that is not known to be passable.
"""

from __future__ import annotations

import math

from mintpilot.core.gap import KnowledgeGap
from mintpilot.core.ports import Ask, Decision, Situation, Strategy
from mintpilot.core.tree import StopReason
from mintpilot.strategies.exhaustive import best_about, is_known
from mintpilot.strategies.flying import best_safe_plan, fly, fly_cautiously, questions_left, tree_of


class NearestFirst(Strategy):
    """What is nearest is asked about first; gaps that no plan class depends on are left alone."""

    def decide(self, situation: Situation) -> Decision:
        """Asks about the nearest gap that matters, or flies."""
        tree = tree_of(situation)
        if situation.silent:
            return fly_cautiously(situation, tree, StopReason.SILENCE)
        if len(tree.classes) > 1 and questions_left(situation):
            # The axes of the tree are the gaps that it branches on: the others change no plan.
            for gap in sorted(tree.belief.gaps, key=lambda gap: (_distance_m(gap, situation), gap.id)):
                if not is_known(gap, situation):
                    scored = best_about(gap, situation)
                    if scored is not None:
                        return Ask(scored=scored, mint=tree)
        return fly(situation, tree, best_safe_plan(situation, tree), StopReason.NO_GAIN)


def _distance_m(gap: KnowledgeGap, situation: Situation) -> float:
    return math.dist(gap.position_m, situation.problem.start_m)
