"""Deliberation that meets a bound on the work ends in the cautious plan, never in an abort."""

from __future__ import annotations

from mintpilot.core.errors import LimitError
from mintpilot.core.message import Message, message
from mintpilot.core.ports import Decision, Fly, Situation, Strategy
from mintpilot.core.tree import Certificate, StopReason
from mintpilot.strategies.flying import cautious_plan, fly_cautiously, tree_of


class WithinLimits(Strategy):
    """Decides as another strategy does; where that one meets a bound, it flies the cautious plan and says so.

    Args:
        strategy: decides.
    """

    def __init__(self, strategy: Strategy) -> None:
        self.strategy = strategy

    def decide(self, situation: Situation) -> Decision:
        """See `Strategy.decide`; `Fly.notices` says which bound was met."""
        try:
            return self.strategy.decide(situation)
        except LimitError as error:
            return _cautiously(situation, error.said)


def _cautiously(situation: Situation, notice: Message) -> Fly:
    try:
        fly = fly_cautiously(situation, tree_of(situation), StopReason.LIMIT)
    except LimitError:  # the tree itself is too large
        plan = cautious_plan(situation)
        certificate = Certificate(
            reason=StopReason.LIMIT,
            top_class_probability=0.0,
            entropy_bits=0.0,
            best_gain_bits=0.0,
            bound_s=float("inf"),
            text=message(
                "A bound on the work was reached before anything could be compared: the cautious plan is flown."
            ),
        )
        fly = Fly(plan=plan, certificate=certificate)
    return Fly(plan=fly.plan, certificate=fly.certificate, mint=fly.mint, notices=(notice,))
