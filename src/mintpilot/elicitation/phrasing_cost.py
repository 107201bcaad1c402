"""How easily a cut is said and answered: the tie-break between equally good ones (method, section 4)."""

from __future__ import annotations

from functools import lru_cache

from mintpilot.core.query import Query, SayingKind

_EFFORT = {
    SayingKind.VALUE: 1.0,
    SayingKind.ATTRIBUTE: 1.2,
    SayingKind.THRESHOLD: 1.4,
    SayingKind.RELATION: 1.6,
}


def effort(query: Query) -> float:
    """Effort of saying and answering a cut, without unit; lower is easier.

    One named thing is easiest, then an attribute, a threshold, a relation; every further literal adds its own effort
    and one more for the joining word.
    """
    return sum(_EFFORT[x.saying.kind] for x in query.literals) + (len(query.literals) - 1)


@lru_cache(maxsize=1 << 14)
def phrasing_cost(query: Query) -> tuple[float, str]:
    """Orders cuts: easier ones first, then by id."""
    return effort(query), query.id
