"""Likely is not known: a region is entered only after an explicit yes (method, section 6)."""

from __future__ import annotations

import math
from collections.abc import Sequence

from mintpilot.core.gap import PASSABLE, KnowledgeGap
from mintpilot.core.plan import Plan
from mintpilot.core.ports import Ask, Decision, Situation
from mintpilot.core.query import Query, is_refused
from mintpilot.core.tolerances import TOLERANCE
from mintpilot.core.tree import Mint, ScoredQuery, StopReason
from mintpilot.elicitation.candidates import passable_literal
from mintpilot.elicitation.sentences import is_sayable
from mintpilot.reasoning.certificate import bound_s
from mintpilot.reasoning.safety import unknown_regions
from mintpilot.strategies.flying import cautious_plan, cost_if_flown_s, fly, questions_left

MAX_CONFIRMATIONS = 50
"""Bound on the answers that are counted on in a row."""


def confirm_or_avoid(situation: Situation, mint: Mint, plan: Plan, reason: StopReason) -> Decision:
    """Flies the plan if it enters no region of doubtful passability; else asks about one, or keeps out of all of them.

    Asking is preferred while questions are left and the seconds that it saves on average pass its price.
    """
    settings, belief = situation.settings, situation.belief
    doubtful = unknown_regions(plan, belief, situation.confirmed, settings)
    if not doubtful:
        return fly(situation, mint, plan, reason)
    around = cautious_plan(situation)
    done_s = cost_if_flown_s(situation, plan)
    saving_s = (cost_if_flown_s(situation, around) - done_s) if around else settings.failure_price_s - plan.cost_s
    # Measured from the best plan under each hypothesis, not from this one: delta_c is spent once.
    if around is not None and bound_s(around, mint, belief, settings) <= settings.delta_c_s + TOLERANCE:
        return fly(situation, mint, around, StopReason.GOOD_FOR_ALL)
    needed = {g: confirmations(belief.probability_of(g, PASSABLE), situation) for g in doubtful}
    total = sum(needed.values())
    chance = math.prod(belief.probability_of(g, PASSABLE) for g in doubtful)
    worth_s = chance * saving_s - settings.question_price_s * total
    certain = [g for g in belief.gaps if g.id in doubtful and _is_certain(g, situation)]
    if len(certain) > 1 and len(certain) == len(doubtful) and _sayable_together(certain):
        queries, total = [passable_query(*certain)], max(needed.values())
        worth_s = chance * saving_s - settings.question_price_s * total
    else:
        queries = [passable_query(gap) for gap in belief.gaps if gap.id in doubtful]
    if any(not _may_ask(query, situation) for query in queries) or worth_s <= TOLERANCE:
        return fly(situation, mint, around, StopReason.SILENCE if situation.silent else StopReason.NO_GAIN)
    if questions_left(situation) < total:
        return fly(situation, mint, around, StopReason.SILENCE if situation.silent else StopReason.BUDGET)
    # The likeliest to be refused goes first: a no there makes the other questions needless.
    query = min(queries, key=lambda q: (_yes_probability(q, situation), q.id))
    yes = _yes_probability(query, situation)
    error = settings.answer_error
    heard = (1 - error) * yes + error * (1 - yes)
    scored = ScoredQuery(
        query=query,
        score=worth_s,
        gain_bits=0.0,
        regret_saved_s=chance * saving_s,
        reply_probabilities=(heard, 1 - heard),
    )
    return Ask(scored=scored, mint=mint)


def passable_query(*gaps: KnowledgeGap) -> Query:
    """The query that asks for an explicit yes for one region, or for all of several at once."""
    return Query(literals=tuple(passable_literal(gap) for gap in gaps))


def _sayable_together(gaps: Sequence[KnowledgeGap]) -> bool:
    return is_sayable(passable_query(*gaps), {gap.id: gap for gap in gaps})


def _is_certain(gap: KnowledgeGap, situation: Situation) -> bool:
    """Whether a region is passable by inference: only the explicit yes is missing."""
    return situation.belief.probability_of(gap.id, PASSABLE) >= 1 - situation.settings.alpha_safe


def _yes_probability(query: Query, situation: Situation) -> float:
    """Probability that everything that the query asks about is passable."""
    return math.prod(situation.belief.probability_of(name, PASSABLE) for name in query.gap_ids)


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
    """A query that was given up is not asked again, nor one that was answered by somebody who is never wrong."""
    answered = {one.query.id for one in situation.asked}
    if is_refused(query, situation.withdrawn):
        return False
    return situation.settings.answer_error > 0 or query.id not in answered
