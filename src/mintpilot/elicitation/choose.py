"""Choosing the best query (method, section 4)."""

from __future__ import annotations

from collections.abc import Collection, Sequence

import numpy as np

from mintpilot.core.geometry import Floats, Ints, SmallInts
from mintpilot.core.mission import AskingSettings, CriticalityRule
from mintpilot.core.ports import QueryObjective, QuerySituation
from mintpilot.core.query import Query
from mintpilot.core.tolerances import DECIMALS, TOLERANCE
from mintpilot.core.tree import Mint, ScoredQuery
from mintpilot.elicitation.objectives.channel import heard, part_sums
from mintpilot.elicitation.objectives.information_gain import class_gain_bits
from mintpilot.elicitation.objectives.value_of_information import regret_saved_s
from mintpilot.elicitation.partitions import part_row
from mintpilot.elicitation.phrasing_cost import phrasing_cost


def query_situation(queries: Sequence[Query], mint: Mint, regret_s: Floats, settings: AskingSettings) -> QuerySituation:
    """What an objective may look at: the joint hypotheses of the tree, flattened, and the parts of every query."""
    support = mint.support
    p = mint.belief.probability.ravel()[support]
    parts: SmallInts = np.zeros((len(queries), support.size), np.int8)
    for row, query in zip(parts, queries, strict=True):
        row[:] = part_row(query, mint.belief)[support]
    return QuerySituation(
        probability=p / p.sum(),
        class_of=decisions(mint.class_of.ravel()[support], p, regret_s, settings),
        regret_s=regret_s,
        parts=parts,
        part_count=np.array([q.part_count for q in queries], np.int64),
        effort=np.array([q.effort for q in queries], float),
        settings=settings,
    )


def decisions(class_of: Ints, probability: Floats, regret_s: Floats, settings: AskingSettings) -> Ints:
    """Plan classes as far as they must be told apart, 0 to m - 1, for each joint hypothesis (n,).

    Two hypotheses whose leaves hold different plans need no question if one plan is within ``delta_c_s`` of the best
    under both. The plan that is good for most of the mass takes all that it is good for, then the next one of the rest,
    and so on. Under the paper's rule, where another path counts even at equal cost, the tree's classes stay.
    """
    if settings.rule is CriticalityRule.PAPER or len(regret_s) <= int(class_of.max(initial=0)):
        return class_of
    good = regret_s <= settings.delta_c_s + TOLERANCE
    weight = good.astype(float)  # Booleans do not multiply fast.
    merged = np.full(len(class_of), -1)
    left = np.asarray(probability, float).copy()
    for number in range(len(regret_s)):
        best = int(np.argmax(np.round(weight @ left, DECIMALS)))
        taken = good[best] & (merged < 0)
        merged[taken] = number
        left[taken] = 0.0
        if (merged >= 0).all():
            break
    # What no plan is good for keeps its own class.
    return np.where(merged >= 0, merged, len(regret_s) + class_of)


def choose(
    queries: Sequence[Query],
    mint: Mint,
    regret_s: Floats,
    objective: QueryObjective,
    settings: AskingSettings,
    *,
    asked: Collection[str] = (),
    proposed_by: str = "enumeration",
) -> tuple[ScoredQuery, ...]:
    """The queries with their worth, best first; ties go to the one of less phrasing cost, then by id.

    A query that was answered before is left out unless answers may be wrong: then asking again has some gain.

    Args:
        queries: candidates over gaps on the tree's axes.
        mint: the tree; each joint hypothesis keeps its leaf while queries are scored.
        regret_s: from `mintpilot.reasoning.situation.regret_matrix`.
        objective: how worth is judged.
        settings: answer error, price, tolerances.
        asked: ids of queries that were answered.
        proposed_by: who proposed these queries.

    Raises:
        LimitError: from the objective, when the situation is too large for it.
    """
    kept = [q for q in queries if settings.answer_error > 0 or q.id not in asked]
    if not kept:
        return ()
    situation = query_situation(kept, mint, regret_s, settings)
    scores = objective.scores(situation)
    gains, saved = class_gain_bits(situation), regret_saved_s(situation)
    replies = reply_probabilities(situation)
    found = [
        ScoredQuery(
            query=query,
            score=float(scores[i]),
            gain_bits=float(gains[i]),
            regret_saved_s=float(saved[i]),
            reply_probabilities=replies[i],
            proposed_by=proposed_by,
        )
        for i, query in enumerate(kept)
    ]
    return rank(found)


def reply_probabilities(situation: QuerySituation) -> list[tuple[float, ...]]:
    """For each query, with which probability each of its parts will be named in answer, wrong answers included."""
    named = heard(part_sums(situation, situation.probability[:, None]), situation)[:, :, 0]
    return [tuple(row[:count].tolist()) for row, count in zip(named, situation.part_count.tolist(), strict=True)]


def rank(scored: Collection[ScoredQuery]) -> tuple[ScoredQuery, ...]:
    """Best first; ties by phrasing cost, then by id."""
    return tuple(sorted(scored, key=lambda s: (-round(s.score, DECIMALS), *phrasing_cost(s.query))))


def merge(*lists: Collection[ScoredQuery]) -> tuple[ScoredQuery, ...]:
    """Several ranked lists as one, e.g. enumerated and proposed queries; of equal ones the first stays."""
    found: dict[str, ScoredQuery] = {}
    for scored in (s for several in lists for s in several):
        found.setdefault(scored.query.id, scored)
    return rank(found.values())
