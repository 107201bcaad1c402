"""Choosing the best cut (method, section 4)."""

from __future__ import annotations

from collections.abc import Collection, Sequence

import numpy as np

from mintpilot.core.geometry import Floats, Ints
from mintpilot.core.mission import AskingSettings, CriticalityRule
from mintpilot.core.ports import QueryObjective, QuerySituation
from mintpilot.core.query import Query
from mintpilot.core.tree import Mint, ScoredQuery
from mintpilot.elicitation.objectives.information_gain import class_gain_bits
from mintpilot.elicitation.objectives.value_of_information import regret_saved_s
from mintpilot.elicitation.phrasing_cost import phrasing_cost
from mintpilot.elicitation.truth import truth_row

TOLERANCE = 1e-9
"""Seconds that count as none."""
SAME = 9
"""Decimal places to which scores are compared: rounding must not decide what is asked."""


def query_situation(queries: Sequence[Query], mint: Mint, regret_s: Floats, settings: AskingSettings) -> QuerySituation:
    """What an objective may look at: the joint hypotheses of the tree, flattened, and every cut's true answers."""
    support = mint.support
    p = mint.belief.probability.ravel()[support]
    yes = np.zeros((len(queries), support.size), bool)
    for row, query in zip(yes, queries, strict=True):
        row[:] = truth_row(query, mint.belief)[support]
    return QuerySituation(
        probability=p / p.sum(),
        class_of=decisions(mint.class_of.ravel()[support], p, regret_s, settings),
        regret_s=regret_s,
        yes=yes,
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
        best = int(np.argmax(np.round(weight @ left, SAME)))
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
    """The cuts with their worth, best first; ties go to the one that is easier to say, then by id.

    A cut that was answered before is left out unless answers may be wrong: then asking again tells something new.

    Args:
        queries: candidate cuts over gaps on the tree's axes.
        mint: the tree; each joint hypothesis keeps its leaf while cuts are scored.
        regret_s: from `mintpilot.reasoning.situation.regret_matrix`.
        objective: how worth is judged.
        settings: answer error, price, tolerances.
        asked: ids of cuts that were answered.
        proposed_by: who proposed these cuts.

    Raises:
        LimitError: from the objective, when the situation is too large for it.
    """
    kept = [q for q in queries if settings.answer_error > 0 or q.id not in asked]
    if not kept:
        return ()
    situation = query_situation(kept, mint, regret_s, settings)
    scores = objective.scores(situation)
    gains, saved = class_gain_bits(situation), regret_saved_s(situation)
    error = settings.answer_error
    yes = situation.yes @ situation.probability
    heard = (1 - error) * yes + error * (1 - yes)
    found = [
        ScoredQuery(
            query=query,
            score=float(scores[i]),
            gain_bits=float(gains[i]),
            regret_saved_s=float(saved[i]),
            yes_probability=float(heard[i]),
            proposed_by=proposed_by,
        )
        for i, query in enumerate(kept)
    ]
    return rank(found)


def rank(scored: Collection[ScoredQuery]) -> tuple[ScoredQuery, ...]:
    """Best first; ties by ease of saying, then by id."""
    return tuple(sorted(scored, key=lambda s: (-round(s.score, SAME), *phrasing_cost(s.query))))


def merge(*lists: Collection[ScoredQuery]) -> tuple[ScoredQuery, ...]:
    """Several ranked lists as one, e.g. enumerated and proposed cuts; of equal cuts the first stays."""
    found: dict[str, ScoredQuery] = {}
    for scored in (s for several in lists for s in several):
        found.setdefault(scored.query.id, scored)
    return rank(found.values())
