"""Looks compete with questions: whichever tells more of the plan for each second (method, section 11)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mintpilot.core.message import message
from mintpilot.core.ports import Ask, Decision, Fly, LookOption, Situation, Strategy
from mintpilot.core.tolerances import TOLERANCE
from mintpilot.core.tree import Certificate, Mint, StopReason
from mintpilot.reasoning.classes import class_entropy_bits
from mintpilot.reasoning.entropy import entropy_bits
from mintpilot.reasoning.situation import plans_of, regret_matrix
from mintpilot.strategies.flying import may_be_flown

UNSETTLED = frozenset(
    {StopReason.NO_GAIN, StopReason.BUDGET, StopReason.SILENCE, StopReason.PRICE, StopReason.WAITING, StopReason.LIMIT}
)
"""Endings of asking after which more knowledge may still change the flight."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Worth:
    """What a look is worth."""

    option: LookOption
    bits: float
    """Information on the plan class, by its chance of seeing."""
    saved_s: float
    """Expected regret that it saves, by its chance of seeing, seconds."""

    @property
    def bits_per_s(self) -> float:
        """Information for each second that it takes."""
        return self.bits / max(self.option.seconds, TOLERANCE)


class MayLook(Strategy):
    """Decides as another strategy does, but looks where that pays and tells more a second than the question.

    Without looks nothing is changed. Where nothing may be asked, or no question is worth its price, it looks where the
    regret that a look saves is more than the seconds that it takes.

    Args:
        strategy: decides.
    """

    def __init__(self, strategy: Strategy) -> None:
        self.strategy = strategy

    def decide(self, situation: Situation) -> Decision:
        """See `Strategy.decide`."""
        decision = self.strategy.decide(situation)
        mint = decision.mint
        if not situation.looks or mint is None:
            return decision
        if isinstance(decision, Fly) and (decision.unsafe or decision.certificate.reason not in UNSETTLED):
            return decision
        paying = [one for one in worths(situation, mint) if one.saved_s > one.option.seconds + TOLERANCE]
        if not paying:
            return decision
        best = max(paying, key=lambda one: (one.bits_per_s, one.option.look.gap))
        asking = decision.scored.gain_bits if isinstance(decision, Ask) else 0.0
        reply_s = max(situation.settings.reply_s, TOLERANCE)
        if isinstance(decision, Ask) and asking / reply_s >= best.bits_per_s:
            return decision
        return Fly(plan=best.option.plan, certificate=_certificate(best, mint, asking, asking / reply_s), mint=mint)


def worths(situation: Situation, mint: Mint) -> list[Worth]:
    """What each look is worth now: at gaps that the tree branches on; others tell nothing of the plan."""
    regret_s = regret_matrix(mint, situation.settings)
    support, axes = mint.support, {gap.id: axis for axis, gap in enumerate(mint.belief.gaps)}
    mass = mint.belief.probability.ravel()[support]
    class_of = mint.class_of.ravel()[support]
    plans = plans_of(mint)[: len(regret_s)]
    flown = [i for i, plan in enumerate(plans) if plan is None or may_be_flown(situation, plan)]
    acting_s = float((regret_s[flown] @ mass).min()) if flown else situation.settings.failure_price_s
    found = []
    for option in situation.looks:
        if option.look.gap not in axes:
            continue
        value = np.indices(mint.belief.probability.shape)[axes[option.look.gap]].ravel()[support]
        parts = [np.where(value == v, mass, 0.0) for v in np.unique(value)]
        after_s = sum(float((regret_s @ part).min()) for part in parts)
        left = sum(float(part.sum()) * entropy_bits(np.bincount(class_of, weights=part)) for part in parts)
        sees = option.look.sees
        bits = sees * max(0.0, class_entropy_bits(mint) - left)
        found.append(Worth(option=option, bits=bits, saved_s=sees * max(0.0, acting_s - after_s)))
    return found


def _certificate(best: Worth, mint: Mint, asking_bits: float, asking_rate: float) -> Certificate:
    look = best.option.look
    return Certificate(
        reason=StopReason.LOOK,
        top_class_probability=mint.classes[0].probability,
        entropy_bits=class_entropy_bits(mint),
        best_gain_bits=asking_bits,
        bound_s=float("inf"),
        text=message(
            "A look at {gap} takes {look_s:.1f} s, saves {saved_s:.1f} s on average and tells {rate:.3f} bits a "
            "second; the best question tells {asking_rate:.3f}.",
            gap=look.gap,
            look_s=best.option.seconds,
            saved_s=best.saved_s,
            rate=best.bits_per_s,
            asking_rate=asking_rate,
        ),
    )
