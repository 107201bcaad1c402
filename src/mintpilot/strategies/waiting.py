"""A question is put only where waiting for its answer may not lose more than the answer gives (method, section 10)."""

from __future__ import annotations

import math

import numpy as np

from mintpilot.core.ports import Ask, Decision, Situation, Strategy
from mintpilot.core.tolerances import TOLERANCE
from mintpilot.core.tree import Mint, StopReason
from mintpilot.reasoning.classes import cost_under
from mintpilot.reasoning.waiting import in_time, longest_wait_s, spare_s
from mintpilot.strategies.flying import best_safe_plan, cautious_plan, expected_cost_s, fly

SOONEST_ANSWER_S = 0.5
"""Nobody hears or reads a question and answers it sooner, seconds."""


class CountsWaiting(Strategy):
    """Decides as another strategy does, but flies where no answer can be worth its waiting.

    Args:
        strategy: decides.
    """

    def __init__(self, strategy: Strategy) -> None:
        self.strategy = strategy

    def decide(self, situation: Situation) -> Decision:
        """See `Strategy.decide`."""
        decision = self.strategy.decide(situation)
        if not isinstance(decision, Ask) or decision.mint is None or math.isinf(situation.problem.limits.endurance_s):
            return decision
        safe = best_safe_plan(situation, decision.mint)
        now_s = _nothing_s(situation) if safe is None else expected_cost_s(situation, decision.mint, safe)
        longest_s = longest_wait_s(cautious_plan(situation), situation.problem.limits)
        no_time = longest_s < SOONEST_ANSWER_S and situation.settings.reply_s > 0
        if not no_time and waited_for_s(situation, decision.mint) <= now_s + TOLERANCE:
            return decision
        return fly(situation, decision.mint, safe, StopReason.WAITING, best_gain_bits=decision.scored.gain_bits)


def waited_for_s(situation: Situation, mint: Mint) -> float:
    """Expected cost, seconds, if an answer is waited for that tells the plan class: no question does better.

    Until the answer comes the battery runs: a plan class whose plan does not fit any more then is lost, and the plan
    that is safe whatever holds is flown instead, which the deadline keeps within the battery. Where there is none, all
    is left undone.
    """
    limits, settings = situation.problem.limits, situation.settings
    cautious = cautious_plan(situation)
    support = mint.support
    mass, class_of = mint.belief.probability.ravel()[support], mint.class_of.ravel()[support]
    nothing_s = np.full(support.size, _nothing_s(situation))
    silent_s = nothing_s if cautious is None else cost_under(cautious, mint).ravel()[support]
    most_s = min(settings.patience_s, longest_wait_s(cautious, limits))
    total_s = 0.0
    for number, one in enumerate(mint.classes):
        own = class_of == number
        chance, told_s = 0.0, silent_s
        if one.plan is not None:
            chance = in_time(min(most_s, spare_s(one.plan, limits)), settings)
            told_s = cost_under(one.plan, mint).ravel()[support]
        total_s += float((mass * (chance * told_s + (1 - chance) * silent_s))[own].sum())
    return total_s


def _nothing_s(situation: Situation) -> float:
    """The prices of all stops, by the chance that they are needed, seconds."""
    return sum(stop.price_s * stop.chance for stop in situation.problem.stops)
