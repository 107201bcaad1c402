"""What all methods share once they ask no more: which plan may be flown, and with which certificate."""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np

from mintpilot.core.plan import Plan
from mintpilot.core.ports import Fly, Situation
from mintpilot.core.query import Query
from mintpilot.core.tree import Mint, StopReason
from mintpilot.reasoning.certificate import certify
from mintpilot.reasoning.classes import demands
from mintpilot.reasoning.safety import taken_for_granted, unknown_regions
from mintpilot.reasoning.situation import succeeds
from mintpilot.reasoning.tree import build_tree


def tree_of(situation: Situation) -> Mint:
    """The tree for the situation as it is."""
    return build_tree(situation.space, situation.belief, situation.settings, situation.metric)


def may_be_flown(situation: Situation, plan: Plan) -> bool:
    """Whether the plan enters only regions that are known to be passable (method, section 6)."""
    return not unknown_regions(plan, situation.belief, situation.confirmed, situation.settings)


def cautious_plan(situation: Situation) -> Plan | None:
    """The cheapest plan that keeps to what is known or as good as known; None where there is none."""
    granted = taken_for_granted(situation.belief, situation.confirmed, situation.settings)
    plan = situation.space.cautious(granted)
    # A belief may be surer than the map; what the planner was allowed is checked again.
    return plan if plan is not None and may_be_flown(situation, plan) else None


def best_safe_plan(situation: Situation, mint: Mint) -> Plan | None:
    """The safe plan that loses least on average: the cautious one, or that of a plan class, if it may be flown.

    A plan may still fail its task (the other box was meant), which counts as ``settings.failure_price_s``; it never
    enters a region that is not known to be passable.
    """
    classes = [c.plan for c in mint.classes if c.plan is not None and may_be_flown(situation, c.plan)]
    cautious = cautious_plan(situation)
    plans = classes if cautious is None else [cautious, *classes]
    if not plans:
        return None
    return min(plans, key=lambda plan: (expected_cost_s(situation, mint, plan), plan.cost_s, plan.signature))


def expected_cost_s(situation: Situation, mint: Mint, plan: Plan) -> float:
    """Seconds of flight, what is left undone on average, and the price of failure times its probability."""
    held = float(np.where(succeeds(plan, mint.belief), mint.belief.probability, 0.0).sum())
    axes = {g.id for g in mint.belief.gaps}
    for factor in situation.belief.factors:
        for gap_id, value in demands(plan).items():
            if gap_id not in axes and any(g.id == gap_id for g in factor.gaps):
                held *= factor.probability_of(gap_id, value)
    return cost_if_flown_s(situation, plan) + max(0.0, 1.0 - held) * situation.settings.failure_price_s


def cost_if_flown_s(situation: Situation, plan: Plan) -> float:
    """Seconds of flight, and what is left undone on average, if the plan is flown as it is meant.

    Somebody who may be in a room that is not looked into counts by the expectation, once (method, section 9).
    """
    known = {gap.id for gap in situation.belief.gaps}
    missed_s = sum(
        price_s * (situation.belief.probability_of(gap, value) if gap in known else 1.0)
        for gap, value, price_s in plan.stakes
    )
    return plan.cost_s + plan.undone_s + missed_s


def fly(
    situation: Situation,
    mint: Mint,
    plan: Plan | None,
    reason: StopReason,
    *,
    best_gain_bits: float = 0.0,
    unsafe: bool = False,
) -> Fly:
    """The decision to fly that plan, with its certificate."""
    certificate = certify(reason, plan, mint, situation.belief, situation.settings, best_gain_bits=best_gain_bits)
    return Fly(plan=plan, certificate=certificate, mint=mint, unsafe=unsafe)


def fly_cautiously(situation: Situation, mint: Mint, reason: StopReason) -> Fly:
    """The decision to fly the cautious plan, or to stay safe where there is none."""
    return fly(situation, mint, cautious_plan(situation), reason)


def answerable(queries: Iterable[Query], situation: Situation) -> tuple[Query, ...]:
    """The queries whose answers the belief can take in: they couple at most ``settings.max_joint`` joint values."""
    factors = {gap.id: number for number, factor in enumerate(situation.belief.factors) for gap in factor.gaps}
    sizes = [factor.probability.size for factor in situation.belief.factors]

    def coupled(query: Query) -> int:
        return math.prod(sizes[number] for number in {factors[name] for name in query.gap_ids})

    return tuple(query for query in queries if coupled(query) <= situation.settings.max_joint)


def questions_left(situation: Situation) -> int:
    """How many more questions the budget allows; 0 once the operator is silent."""
    if situation.silent:
        return 0
    return situation.settings.question_budget
