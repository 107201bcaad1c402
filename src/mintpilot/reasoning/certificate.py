"""Why no further question is asked, with the numbers that prove it (method, section 5)."""

from __future__ import annotations

from typing import Final

import numpy as np

from mintpilot.core.gap import Belief
from mintpilot.core.mission import AskingSettings
from mintpilot.core.plan import Plan
from mintpilot.core.tolerances import TOLERANCE
from mintpilot.core.tree import Certificate, Mint, StopReason
from mintpilot.reasoning.classes import cheapest_under, class_entropy_bits, demands
from mintpilot.reasoning.situation import may_fail, succeeds

_BECAUSE: Final = {
    StopReason.NO_GAPS: "Nothing that is unknown bears on the task.",
    StopReason.ONE_CLASS: "One way to fly is right with {top:.1%} probability.",
    StopReason.GOOD_FOR_ALL: "One plan succeeds whatever the answers would be.",
    StopReason.NO_GAIN: "No question that is left is worth asking (the best has a gain of {gain:.3f} bits).",
    StopReason.BUDGET: "All {budget} questions that are allowed have been asked.",
    StopReason.SILENCE: "The operator does not answer.",
    StopReason.INFEASIBLE: "Nothing can be flown under anything that is still possible.",
    StopReason.NEVER_ASKS: "This method does not ask.",
    StopReason.LIMIT: "A bound on the work was reached.",
}


def bound_s(plan: Plan | None, mint: Mint, belief: Belief, settings: AskingSettings) -> float:
    """Largest cost of a plan above the best one, over the hypotheses that are left, seconds.

    Infinite where the plan may fail, or where it is None though something might have been flown.
    """
    lowest = cheapest_under(mint).ravel()[mint.support]
    if plan is None:
        return 0.0 if np.isinf(lowest).all() else float("inf")
    if may_fail(plan, belief, settings.floor) or not succeeds(plan, mint.belief).ravel()[mint.support].all():
        return float("inf")
    return float(max(0.0, (plan.cost_s - lowest[np.isfinite(lowest)]).max(initial=0.0)))


def mass_outside(plan: Plan | None, mint: Mint, belief: Belief, settings: AskingSettings) -> float:
    """Probability that a plan fails or costs more than ``delta_c_s`` above the best one, 0 to 1.

    Of gaps that the tree does not hold, those that the plan depends on count as independent of the tree's.
    """
    lowest = cheapest_under(mint)
    p = mint.belief.probability
    if plan is None:
        return float(p[np.isfinite(lowest)].sum())
    fine = succeeds(plan, mint.belief) & (plan.cost_s <= lowest + settings.delta_c_s + TOLERANCE)
    held = float(p[fine].sum())
    axes = {gap.id for gap in mint.belief.gaps}
    for gap, value in demands(plan).items():
        if gap not in axes and any(g.id == gap for g in belief.gaps):
            held *= belief.probability_of(gap, value)
    return min(1.0, max(0.0, 1.0 - held))


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
    bound = bound_s(plan, mint, belief, settings)
    outside = mass_outside(plan, mint, belief, settings)
    if reason is StopReason.GOOD_FOR_ALL:
        assert bound <= settings.delta_c_s + TOLERANCE, f"a plan that is good for all may lose {bound} s"
    because = _BECAUSE[reason].format(top=top, gain=best_gain_bits, budget=settings.max_questions)
    return Certificate(
        reason=reason,
        top_class_probability=top,
        entropy_bits=class_entropy_bits(mint),
        best_gain_bits=best_gain_bits,
        bound_s=bound,
        text=f"{because} {_consequence(plan, bound, outside, settings)}",
        outside=outside,
    )


def _consequence(plan: Plan | None, bound: float, outside: float, settings: AskingSettings) -> str:
    if plan is None:
        return "No safe plan is left to fly."
    if np.isinf(bound):
        said = f"The plan of {plan.cost_s:.1f} s is the best that is safe, but it may not succeed"
    else:
        said = f"No further answer would change the flight of {plan.cost_s:.1f} s by more than {bound:.1f} s"
    if outside <= settings.floor:
        return f"{said}."
    return f"{said}; with {outside:.1%} probability it loses more than {settings.delta_c_s:.1f} s."
