"""Likely is not known: a region is entered only after an explicit yes (method, section 6)."""

from __future__ import annotations

import math
from collections.abc import Sequence

from mintpilot.core.gap import PASSABLE, KnowledgeGap
from mintpilot.core.plan import Plan
from mintpilot.core.ports import Ask, Decision, Situation
from mintpilot.core.query import Literal, Query, Saying, SayingKind
from mintpilot.core.tolerances import ROUNDING, TOLERANCE
from mintpilot.core.topics import turns_on
from mintpilot.core.tree import Mint, ScoredQuery, StopReason
from mintpilot.elicitation.candidates import MAX_TOGETHER
from mintpilot.elicitation.sentences import is_sayable
from mintpilot.reasoning.certificate import bound_s
from mintpilot.reasoning.safety import unknown_regions
from mintpilot.strategies.flying import cautious_plan, expected_cost_s, fly, questions_left

MAX_CONFIRMATIONS = 50
"""Bound on the answers that are counted on in a row."""


def confirm_or_avoid(situation: Situation, mint: Mint, plan: Plan, reason: StopReason) -> Decision:
    """Flies the plan if it enters no region of doubtful passability; else asks about them, or keeps out of all of them.

    Keeping out is good for all that is left only where it costs at most ``delta_c_s`` more than the best plan under
    each joint hypothesis: the tolerance is spent once. Elsewhere asking is preferred while questions are left and the
    seconds that it saves on average pass its price.
    """
    settings, belief = situation.settings, situation.belief
    doubtful = unknown_regions(plan, belief, situation.confirmed, settings)
    if not doubtful:
        return fly(situation, mint, plan, reason)
    around = cautious_plan(situation)
    if around is not None and bound_s(around, mint, belief, settings) <= settings.delta_c_s + TOLERANCE:
        return fly(situation, mint, around, StopReason.GOOD_FOR_ALL)
    saving_s = (around.cost_s if around else settings.failure_price_s) - plan.cost_s
    gaps = [gap for gap in belief.gaps if gap.id in doubtful]
    queries = _confirming(gaps, situation)
    total = sum(max(confirmations(belief.probability_of(g, PASSABLE), situation) for g in q.gap_ids) for q in queries)
    chance = math.prod(belief.probability_of(g, PASSABLE) for g in doubtful)
    worth_s = chance * saving_s - settings.question_price_s * total
    if not all(_may_ask(query, situation) for query in queries) or worth_s <= TOLERANCE:
        return fly(situation, mint, around, StopReason.SILENCE if situation.silent else StopReason.NO_GAIN)
    if questions_left(situation) < total:
        return fly(situation, mint, around, StopReason.SILENCE if situation.silent else StopReason.BUDGET)
    # The likeliest to be refused goes first: a no there makes the other questions needless.
    query = min(queries, key=lambda q: (_all_passable(q, situation), q.id))
    yes, error = _all_passable(query, situation), settings.answer_error
    heard = (1 - error) * yes + error * (1 - yes)
    scored = ScoredQuery(
        query=query,
        score=worth_s,
        gain_bits=0.0,
        regret_saved_s=chance * saving_s,
        reply_probabilities=(heard, 1 - heard),
    )
    return Ask(scored=scored, mint=mint)


def confirm_certain(situation: Situation, mint: Mint, safe: Plan | None) -> Ask | None:
    """Asks for the missing yes of regions that are certain by inference, where a better plan than the safe one needs it.

    Args:
        situation: what is decided on.
        mint: its tree.
        safe: the plan that would be flown else; None: there is none.
    """
    belief, settings = situation.belief, situation.settings
    least_s = expected_cost_s(situation, mint, safe) if safe is not None else settings.failure_price_s
    better: list[tuple[float, str, Plan]] = []
    for plan in (c.plan for c in mint.classes if c.plan is not None):
        doubtful = unknown_regions(plan, belief, situation.confirmed, settings)
        cost_s = expected_cost_s(situation, mint, plan)
        certain = all(belief.probability_of(g, PASSABLE) >= 1 - settings.alpha_safe - ROUNDING for g in doubtful)
        if doubtful and certain and cost_s < least_s - TOLERANCE:
            better.append((cost_s, plan.signature, plan))
    for _, _, plan in sorted(better, key=lambda item: item[:2]):
        decision = confirm_or_avoid(situation, mint, plan, StopReason.NO_GAIN)
        if isinstance(decision, Ask):
            return decision
    return None


def _confirming(gaps: Sequence[KnowledgeGap], situation: Situation) -> list[Query]:
    """The queries that ask for the missing yes: one for regions that are certain, as far as it is sayable; else one each."""
    certain = [g for g in gaps if situation.belief.probability_of(g.id, PASSABLE) >= 1 - ROUNDING]
    single = [passable_query(gap) for gap in gaps if gap not in certain]
    known = {gap.id: gap for gap in certain}
    while certain:
        for count in range(min(MAX_TOGETHER, len(certain)), 0, -1):
            query = passable_query(*certain[:count])
            if count == 1 or (is_sayable(query, known) and _may_ask(query, situation)):
                single.append(query)
                certain = certain[count:]
                break
    return single


def _all_passable(query: Query, situation: Situation) -> float:
    """Probability that all regions that the query is about are passable; those of several are certain."""
    return min(situation.belief.probability_of(gap, PASSABLE) for gap in query.gap_ids)


def passable_query(*gaps: KnowledgeGap) -> Query:
    """The query that asks for an explicit yes for one region, or for all of several."""
    saying = Saying(kind=SayingKind.VALUE, value=PASSABLE)
    return Query(literals=tuple(Literal(gap=g.id, values=frozenset({PASSABLE}), saying=saying) for g in gaps))


def confirmations(passable: float, situation: Situation) -> int:
    """How many answers of yes in a row make a region known; at least 1 where none was given yet."""
    settings = situation.settings
    doubt = settings.alpha_safe if settings.answer_error > 0 else 0.0
    count = 1
    while count < MAX_CONFIRMATIONS:
        right = (1 - settings.answer_error) ** count * passable
        wrong = settings.answer_error**count * (1 - passable)
        if wrong <= doubt * (right + wrong):
            break
        count += 1
    return count


def _may_ask(query: Query, situation: Situation) -> bool:
    """Not what was given up or is not known, nor what was answered already by somebody who is never wrong."""
    if turns_on(query, situation.unknown):
        return False
    answered = {one.query.id for one in situation.asked}
    return query.id not in situation.withdrawn and (situation.settings.answer_error > 0 or query.id not in answered)
