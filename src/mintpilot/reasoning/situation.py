"""What each plan would cost under each joint hypothesis: regret, and whether a plan succeeds at all."""

from __future__ import annotations

import numpy as np

from mintpilot.core.gap import Belief, GapKind, Joint
from mintpilot.core.geometry import Bools, Floats
from mintpilot.core.mission import AskingSettings
from mintpilot.core.plan import Plan
from mintpilot.core.tree import Mint
from mintpilot.reasoning.classes import assumes, cheapest_under, cost_under, demands, nodes_of
from mintpilot.reasoning.tables import mask_of

MAX_CELLS = 1 << 22
"""Bound on the cells of a regret matrix; beyond it only the likeliest classes get a row."""


def succeeds(plan: Plan, joint: Joint) -> Bools:
    """Under which joint hypotheses the plan succeeds, in the shape of ``joint.probability``."""
    return mask_of(joint, {gap: (value,) for gap, value in demands(plan).items()})


def may_fail(plan: Plan, belief: Belief, floor: float) -> bool:
    """Whether some single gap may, with more probability than the floor, have a value that the plan cannot bear."""
    kinds = {g.id: g for g in belief.gaps}
    return any(
        gap in kinds and value in kinds[gap].values and 1 - belief.probability_of(gap, value) > floor
        for gap, value in demands(plan).items()
    )


def plans_of(mint: Mint) -> tuple[Plan | None, ...]:
    """The plans that may be chosen: that of each class, in order, then the other cautious plans of the tree's nodes.

    After some answers a cautious plan that was too dear may suffice: then no question between its classes is needed.
    """
    made: dict[str, Plan | None] = {c.plan.signature if c.plan else "": c.plan for c in mint.classes}
    for node in nodes_of(mint.root):
        if node.cautious is not None:
            made.setdefault(node.cautious.signature, node.cautious)
    return tuple(made.values())


def regret_matrix(mint: Mint, settings: AskingSettings) -> Floats:
    """Seconds lost by flying each plan under each joint hypothesis, instead of the best one.

    Shape (rows, n): `plans_of` by the hypotheses of `Mint.support`. What a plan leaves undone counts with its price
    (method, section 9). Where a plan would fail it loses ``settings.failure_price_s``, and no less than any plan that
    does not; so does staying on the ground where something could have been flown.
    """
    support, plans = mint.support, plans_of(mint)
    rows = min(len(plans), max(1, MAX_CELLS // max(1, support.size)))
    cost = np.full((rows, support.size), np.inf)
    # Measured from what no plan can undercut: a class's own plan may itself be a little dearer than the best.
    best = cheapest_under(mint).ravel()[support]
    for number, plan in enumerate(plans[:rows]):
        if plan is not None:
            fine = _surely_succeeds(number, plan, mint).ravel()[support]
            cost[number] = np.where(fine, cost_under(plan, mint).ravel()[support], np.inf)
    # Where nothing can be flown, only staying on the ground loses nothing.
    hopeless = np.isinf(best)
    lost: Floats = np.maximum(cost - np.where(hopeless, 0.0, best), 0.0)
    dearest = np.where(np.isfinite(lost), lost, 0.0).max(axis=0, initial=settings.failure_price_s)
    lost = np.where(np.isinf(cost), dearest, lost)
    for number, plan in enumerate(plans[:rows]):
        if plan is None:
            lost[number, hopeless] = 0.0
    return lost


def _surely_succeeds(number: int, plan: Plan, mint: Mint) -> Bools:
    """Where a plan of `plans_of` surely succeeds.

    Where it rests on something that the tree's axes do not show (an ordered value, a gap for which there was no room),
    that is under its own hypotheses only.
    """
    axes, given = {g.id for g in mint.belief.gaps}, dict(mint.root.given.items)
    hidden = any(name not in axes and given.get(name) != frozenset({value}) for name, value in assumes(plan).items())
    fine = succeeds(plan, mint.belief)
    if hidden or any(g.kind is GapKind.VALUE for g in mint.belief.gaps):
        fine &= mint.class_of == number
    return fine
