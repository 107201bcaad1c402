"""Phrasing cost: how hard a query is to say and to answer. It breaks ties between good ones (method, section 4)."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

from mintpilot.core.query import Literal, Query, SayingKind

_COST = {
    SayingKind.VALUE: 1.0,
    SayingKind.ATTRIBUTE: 1.2,
    SayingKind.THRESHOLD: 1.4,
    SayingKind.RELATION: 1.6,
}


@lru_cache(maxsize=1 << 14)
def phrasing_cost(query: Query) -> tuple[float, str]:
    """Orders queries: those of less cost first, then by id. The cost has no unit.

    One named thing costs least, then an attribute, a threshold, a relation; every further literal adds its own cost and
    one more for the joining word; so does every further option of a choice.
    """
    if query.is_choice:
        return sum(_cost(option.literals) for option in query.options) + query.part_count - 1, query.id
    return _cost(query.literals), query.id


def _cost(literals: Sequence[Literal]) -> float:
    return sum(_COST[x.saying.kind] for x in literals) + (len(literals) - 1)
