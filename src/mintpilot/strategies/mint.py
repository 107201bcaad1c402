"""MINT: ask only what changes the plan, by information gain (method, sections 3 to 6)."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from mintpilot.core.geometry import Floats
from mintpilot.core.mission import CriticalityRule
from mintpilot.core.plan import Plan
from mintpilot.core.ports import Ask, Decision, Fly, QueryObjective, Situation, Strategy
from mintpilot.core.tolerances import TOLERANCE
from mintpilot.core.tree import LeafReason, Mint, ScoredQuery, StopReason
from mintpilot.elicitation.candidates import candidate_queries
from mintpilot.elicitation.choose import choose
from mintpilot.reasoning.situation import plans_of, regret_matrix
from mintpilot.strategies.confirming import confirm_or_avoid
from mintpilot.strategies.flying import (
    answerable,
    best_safe_plan,
    expected_cost_s,
    fly,
    fly_cautiously,
    may_be_flown,
    questions_left,
    tree_of,
)
from mintpilot.strategies.proposals import gain_bound_bits, with_proposals

ALTERNATIVES = 5
"""How many of the other queries are reported with the chosen one."""


class MintStrategy(Strategy):
    """The method of the paper, made exact by the specification.

    Args:
        objective: judges queries instead of the situation's objective, e.g. a random one.
    """

    def __init__(self, objective: QueryObjective | None = None) -> None:
        self._objective = objective

    def decide(self, situation: Situation) -> Decision:
        """Asks the best query, or flies; the stop reasons are those of method section 5, in this order.

        1. One plan class is left or holds enough of the mass, or one plan is good for all: fly it. If it enters a
           region that is not known to be passable, ask about that one or avoid it, whichever is cheaper on average.
        2. The operator is silent: fly the cautious plan.
        3. The budget is spent, or no query is worth asking: fly the safe plan that loses least on average.

        A proposer (a language model), where there is one, is asked for queries only when the best of our own falls
        short of what any query could gain (`mintpilot.strategies.proposals.with_proposals`); the best by score wins.
        """
        mint = tree_of(situation)
        if mint.root.leaf is LeafReason.INFEASIBLE:
            return fly(situation, mint, None, StopReason.INFEASIBLE)
        settled = _settled(situation, mint)
        if settled is not None:
            return confirm_or_avoid(situation, mint, *settled)
        if situation.silent:
            return fly_cautiously(situation, mint, StopReason.SILENCE)
        objective = self._objective or situation.objective
        regret_s = regret_matrix(mint, situation.settings)
        ranked = _rank(situation, mint, regret_s, objective)
        bound_bits = gain_bound_bits(situation, mint, regret_s)
        proposed: tuple[ScoredQuery, ...] = ()
        if questions_left(situation):
            ranked, proposed = with_proposals(situation, mint, regret_s, objective, ranked, bound_bits)
        gain = max((s.gain_bits for s in ranked), default=0.0)
        if not questions_left(situation):
            plan = best_safe_plan(situation, mint)
            return fly(situation, mint, plan, StopReason.BUDGET, best_gain_bits=gain)
        if not ranked or ranked[0].score <= 0:
            return replace(_without_gain(situation, mint, gain), proposed=proposed)
        return Ask(
            scored=ranked[0],
            alternatives=ranked[1 : 1 + ALTERNATIVES],
            mint=mint,
            proposed=proposed,
            bound_bits=bound_bits,
        )


def _without_gain(situation: Situation, mint: Mint, gain: float) -> Ask | Fly:
    """No query divides the plan classes: the safe plan that loses least, unless a missing yes makes a better one.

    A region that is certain by inference but has no explicit yes is asked about when the plan needs it (method, section
    6), never a reason to give up.
    """
    safe = best_safe_plan(situation, mint)
    plans = [c.plan for c in mint.classes if c.plan is not None]
    best = min(plans, key=lambda p: (expected_cost_s(situation, mint, p), p.cost_s, p.signature), default=None)
    if best is not None and not may_be_flown(situation, best):
        stays_s = situation.settings.failure_price_s if safe is None else expected_cost_s(situation, mint, safe)
        if stays_s - expected_cost_s(situation, mint, best) > situation.settings.delta_c_s + TOLERANCE:
            decision = confirm_or_avoid(situation, mint, best, StopReason.NO_GAIN)
            if isinstance(decision, Ask):
                return decision
    return fly(situation, mint, safe, StopReason.NO_GAIN, best_gain_bits=gain)


def _rank(situation: Situation, mint: Mint, regret_s: Floats, objective: QueryObjective) -> tuple[ScoredQuery, ...]:
    """The enumerated queries, best first."""
    queries = candidate_queries(
        mint, start_m=situation.problem.start_m, refused=situation.withdrawn, kinds=situation.settings.kinds
    )
    asked = {one.query.id for one in situation.asked}
    return choose(answerable(queries, situation), mint, regret_s, objective, situation.settings, asked=asked)


def _settled(situation: Situation, mint: Mint) -> tuple[Plan, StopReason] | None:
    """The plan that further answers would not change beyond the tolerances, and why; None while they might."""
    root, top = mint.root, mint.classes[0]
    if root.leaf is LeafReason.RELIES_ON_NOTHING and root.plan is not None:
        return root.plan, StopReason.ONE_CLASS if situation.asked else StopReason.NO_GAPS
    if root.leaf is LeafReason.CAUTIOUS_IS_GOOD_ENOUGH and root.plan is not None:
        return root.plan, StopReason.GOOD_FOR_ALL
    if top.plan is not None and (
        root.leaf is LeafReason.TARGET_IS_CLEAR_ENOUGH or top.probability >= 1 - situation.settings.alpha - TOLERANCE
    ):
        return top.plan, StopReason.ONE_CLASS
    plan = _good_for_all(situation, mint)
    return (plan, StopReason.GOOD_FOR_ALL) if plan is not None else None


def _good_for_all(situation: Situation, mint: Mint) -> Plan | None:
    """The cheapest plan within delta_c of the best under all that is left (paper's rule: and within delta_d)."""
    settings = situation.settings
    worst = regret_matrix(mint, settings).max(axis=1, initial=0.0)
    plans = plans_of(mint)
    good = [plans[i] for i in np.flatnonzero(worst <= settings.delta_c_s + TOLERANCE)]
    for plan in sorted((p for p in good if p is not None), key=lambda p: (p.cost_s + p.undone_s, p.signature)):
        near = settings.rule is CriticalityRule.REGRET or _near_all(situation, mint, plan)
        if near and may_be_flown(situation, plan):
            return plan
    return None


def _near_all(situation: Situation, mint: Mint, plan: Plan) -> bool:
    """Whether the plan's path is within delta_d of that of every class that is left."""
    others = [c.plan.path_m for c in mint.classes if c.plan is not None and c.plan is not plan]
    apart = (situation.metric.divergence(plan.path_m, path) for path in others)
    return all(d <= situation.settings.delta_d_m + TOLERANCE for d in apart)
