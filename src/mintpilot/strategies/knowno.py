"""Asks for help when the conformal prediction set has more than one member, after KnowNo (Ren et al., CoRL 2023).

There a language model scores a few next steps; here the options are the plan classes and the score of one is its
probability, so that the method is compared by *when* it asks, with the same knowledge. On calibration worlds the
nonconformity of the true class, one minus its probability, has the quantile q; the prediction set of a new world is
every class of at least 1 - q, which holds the true one with the coverage that q was chosen for. One member: fly it.
More: ask. The person there picks from the set; with yes/no questions only, the gaps that set the classes apart are
asked about one by one, in order of their ids: the method has no notion of information gain.
"""

from __future__ import annotations

from mintpilot.core.errors import InputError
from mintpilot.core.plan import Plan
from mintpilot.core.ports import Ask, Decision, Situation, Strategy
from mintpilot.core.tolerances import TOLERANCE
from mintpilot.core.tree import LeafReason, Mint, PlanClass, ScoredQuery, StopReason
from mintpilot.strategies.exhaustive import best_about, is_known
from mintpilot.strategies.flying import (
    best_safe_plan,
    fly,
    fly_cautiously,
    may_be_flown,
    questions_left,
    tree_of,
)


class KnowNoStrategy(Strategy):
    """Asks until one plan class is left in the prediction set.

    Args:
        quantile: the calibrated q, from 0 to 1: classes of probability ``1 - quantile`` and above are in the set.
            The default suits nothing in particular: calibrate it on worlds like those that are to be flown in.

    Raises:
        InputError: the quantile is no probability.
    """

    def __init__(self, quantile: float = 0.9) -> None:
        if not 0 <= quantile <= 1:
            raise InputError(f"conformal quantile {quantile}: must be from 0 to 1")
        self._quantile = quantile

    def decide(self, situation: Situation) -> Decision:
        """Asks about the first gap that is not known, or flies."""
        mint = tree_of(situation)
        if mint.root.leaf is LeafReason.INFEASIBLE:
            return fly(situation, mint, None, StopReason.INFEASIBLE)
        if situation.silent:
            return fly_cautiously(situation, mint, StopReason.SILENCE)
        members = self.prediction_set(mint)
        if len(members) == 1:
            return fly(situation, mint, _flyable(situation, mint, members[0].plan), StopReason.ONE_CLASS)
        scored = _next(situation, mint)
        if scored is None:
            return fly(situation, mint, best_safe_plan(situation, mint), StopReason.NO_GAIN)
        if not questions_left(situation):
            return fly(situation, mint, best_safe_plan(situation, mint), StopReason.BUDGET)
        return Ask(scored=scored, mint=mint)

    def prediction_set(self, mint: Mint) -> tuple[PlanClass, ...]:
        """The plan classes that are likely enough; never empty: at least the likeliest one."""
        likely = tuple(c for c in mint.classes if c.probability >= 1 - self._quantile - TOLERANCE)
        return likely or mint.classes[:1]


def _flyable(situation: Situation, mint: Mint, plan: Plan | None) -> Plan | None:
    """The class's own plan if it may be flown; else the safe one that loses least."""
    if plan is not None and may_be_flown(situation, plan):
        return plan
    return best_safe_plan(situation, mint)


def _next(situation: Situation, mint: Mint) -> ScoredQuery | None:
    for gap in mint.belief.gaps:
        if not is_known(gap, situation):
            scored = best_about(gap, situation)
            if scored is not None:
                return scored
    return None
