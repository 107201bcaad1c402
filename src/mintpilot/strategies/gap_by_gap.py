"""Gap-by-gap gating: the literal reading of the paper, kept for comparison.

Every gap is judged once, by itself, the others at their most favourable value; critical ones are asked about.
Wrong as soon as gaps interact: one may matter only if another turns out closed (method, section 3).
"""

from __future__ import annotations

from mintpilot.core.gap import Assumptions, GapKind, KnowledgeGap
from mintpilot.core.ports import Ask, Decision, Situation, Strategy
from mintpilot.core.tolerances import TOLERANCE
from mintpilot.core.tree import StopReason
from mintpilot.reasoning.classes import least_cost_s
from mintpilot.reasoning.entropy import entropy_bits
from mintpilot.reasoning.support import narrow
from mintpilot.strategies.exhaustive import best_about, is_known
from mintpilot.strategies.flying import best_safe_plan, fly, fly_cautiously, questions_left, tree_of


class GapByGapStrategy(Strategy):
    """Judges every gap once, at the first decision of a mission, and asks about the critical ones, by id.

    An obstacle or presence gap is critical when cost or divergence between its values passes a threshold; a target gap
    when its goal entropy does. It remembers its judgement until it is asked to decide before any answer was given.
    """

    def __init__(self) -> None:
        self._critical: tuple[str, ...] = ()

    def decide(self, situation: Situation) -> Decision:
        """Asks about the next critical gap; afterwards flies the safe plan that loses least on average."""
        mint = tree_of(situation)
        if not situation.asked and not situation.withdrawn and not situation.silent:
            given = narrow(situation.belief, Assumptions(), situation.settings.floor)
            self._critical = tuple(g.id for g in situation.belief.gaps if _critical(g, given, situation))
        if situation.silent:
            return fly_cautiously(situation, mint, StopReason.SILENCE)
        for gap in situation.belief.gaps:
            if gap.id in self._critical and not is_known(gap, situation):
                scored = best_about(gap, situation)
                if scored is not None:
                    if not questions_left(situation):
                        return fly(situation, mint, best_safe_plan(situation, mint), StopReason.BUDGET)
                    return Ask(scored=scored, mint=mint)
        return fly(situation, mint, best_safe_plan(situation, mint), StopReason.NO_GAIN)


def _critical(gap: KnowledgeGap, given: Assumptions, situation: Situation) -> bool:
    settings = situation.settings
    if gap.kind is GapKind.TARGET:
        return entropy_bits(situation.belief.marginal(gap.id)) > settings.goal_entropy_bits
    cases = [given.assume(gap.id, (value,)) for value in given.possible(gap)]
    plans = [situation.space.optimistic(case) for case in cases]
    found = [p for p in plans if p is not None]
    if len(found) < len(plans):
        return bool(found)
    costs = [least_cost_s(p, case) for p, case in zip(plans, cases, strict=True) if p is not None]
    if max(costs) - min(costs) > settings.delta_c_s + TOLERANCE:
        return True
    apart = max((situation.metric.divergence(found[0].path_m, p.path_m) for p in found[1:]), default=0.0)
    return apart > settings.delta_d_m + TOLERANCE
