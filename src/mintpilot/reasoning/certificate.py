"""Why no further question is asked, with the numbers that prove it (method, section 5)."""

from __future__ import annotations

from typing import Final

import numpy as np

from mintpilot.core.gap import Belief
from mintpilot.core.message import Message, joined, message
from mintpilot.core.mission import AskingSettings
from mintpilot.core.plan import Plan
from mintpilot.core.tolerances import TOLERANCE
from mintpilot.core.tree import Certificate, Mint, StopReason
from mintpilot.reasoning.classes import cheapest_under, class_entropy_bits, cost_under
from mintpilot.reasoning.situation import may_fail, succeeds

_BECAUSE: Final = {
    StopReason.NO_GAPS: message("Nothing that is unknown bears on the task."),
    StopReason.GOOD_FOR_ALL: message("One plan succeeds whatever the answers would be."),
    StopReason.BUDGET: message("All questions that are allowed have been asked."),
    StopReason.SILENCE: message("The operator does not answer."),
    StopReason.INFEASIBLE: message("Nothing can be flown under anything that is still possible."),
    StopReason.PRICE: message("However it were asked on, it would cost more than it saves."),
    StopReason.WAITING: message("Waiting for an answer may lose more than it gives: the battery runs meanwhile."),
    StopReason.LOOK: message("A look tells more a second than any question."),
    StopReason.NEVER_ASKS: message("This method does not ask."),
    StopReason.LIMIT: message("A bound on the work was reached."),
}
"""Those without figures."""


def bound_s(plan: Plan | None, mint: Mint, belief: Belief, settings: AskingSettings) -> float:
    """Largest cost of a plan above the best one, over the hypotheses that are left, seconds.

    Infinite where the plan may fail, or where it is None though something might have been flown.
    """
    lowest = cheapest_under(mint).ravel()[mint.support]
    if plan is None:
        return 0.0 if np.isinf(lowest).all() else float("inf")
    if may_fail(plan, belief, settings.floor) or not succeeds(plan, mint.belief).ravel()[mint.support].all():
        return float("inf")
    if _may_be_missed(plan, mint, belief, settings):
        return float("inf")
    cost = cost_under(plan, mint).ravel()[mint.support]
    return float(max(0.0, (cost - lowest)[np.isfinite(lowest)].max(initial=0.0)))


def _may_be_missed(plan: Plan, mint: Mint, belief: Belief, settings: AskingSettings) -> bool:
    """Whether somebody may be in a room that the plan takes for empty, and the tree does not show what that costs."""
    known = {g.id for g in belief.gaps} - {g.id for g in mint.belief.gaps}
    rooms = [(gap, value) for gap, value, _ in plan.stakes if gap in plan.skips and gap in known]
    return any(belief.probability_of(gap, value) > settings.floor for gap, value in rooms)


def mass_outside(plan: Plan | None, mint: Mint, settings: AskingSettings) -> float:
    """Probability that the plan fails, or is dearer than the best plan by more than ``delta_c_s``."""
    probability = mint.belief.probability.ravel()[mint.support]
    lowest = cheapest_under(mint).ravel()[mint.support]
    if plan is None:
        return float(probability[np.isfinite(lowest)].sum())
    fine = succeeds(plan, mint.belief).ravel()[mint.support]
    cost = cost_under(plan, mint).ravel()[mint.support]
    near = np.isinf(lowest) | (cost - lowest <= settings.delta_c_s + TOLERANCE)
    return float(max(0.0, 1.0 - probability[fine & near].sum() / max(probability.sum(), TOLERANCE)))


def certify(
    reason: StopReason,
    plan: Plan | None,
    mint: Mint,
    belief: Belief,
    settings: AskingSettings,
    *,
    best_gain_bits: float = 0.0,
) -> Certificate:
    """The certificate for flying that plan (None: for staying safe) and asking no more."""
    top = mint.classes[0].probability
    bound, outside = bound_s(plan, mint, belief, settings), mass_outside(plan, mint, settings)
    if reason is StopReason.GOOD_FOR_ALL and not bound <= settings.delta_c_s + TOLERANCE:
        reason = StopReason.NO_GAIN  # delta_c is spent once: what costs more is not good for all
    return Certificate(
        reason=reason,
        top_class_probability=top,
        entropy_bits=class_entropy_bits(mint),
        best_gain_bits=best_gain_bits,
        bound_s=bound,
        text=joined([_because(reason, top, best_gain_bits), _consequence(plan, bound, outside, settings.delta_c_s)]),
        mass_outside=outside,
    )


def _because(reason: StopReason, top: float, gain_bits: float) -> Message:
    if reason is StopReason.ONE_CLASS:
        return message("One way to fly is right with {top:.1%} probability.", top=top)
    if reason is StopReason.NO_GAIN:
        return message(
            "No question that is left is worth asking (the best has a gain of {gain_bits:.3f} bits).",
            gain_bits=gain_bits,
        )
    return _BECAUSE[reason]


def _consequence(plan: Plan | None, bound: float, outside: float, delta_c_s: float) -> Message:
    if plan is None:
        return message("No safe plan is left to fly.")
    beyond = message(
        "with {outside:.1%} probability it fails, or is more than {delta_c_s:g} s dearer than the best",
        outside=outside,
        delta_c_s=delta_c_s,
    )
    if np.isinf(bound):
        return message(
            "The plan of {cost_s:.1f} s is the best that is safe; {beyond}.", cost_s=plan.cost_s, beyond=beyond
        )
    if bound > delta_c_s + TOLERANCE:
        return message(
            "The plan of {cost_s:.1f} s is at most {bound_s:.1f} s dearer than the best; {beyond}.",
            cost_s=plan.cost_s,
            bound_s=bound,
            beyond=beyond,
        )
    text = message(
        "No further answer would change the flight of {cost_s:.1f} s by more than {bound_s:.1f} s.",
        cost_s=plan.cost_s,
        bound_s=bound,
    )
    if not plan.leaves_undone:
        return text
    left = [message("{what} ({why})", what=one.stop.said, why=one.reason) for one in plan.leaves_undone]
    return joined([text, message("It leaves undone: {what}.", what=joined(left, "; "))])
