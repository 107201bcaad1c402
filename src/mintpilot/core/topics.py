"""What an operator does not know, told by answers of "I don't know" (method, section 5)."""

from __future__ import annotations

from dataclasses import dataclass

from mintpilot.core.gap import ABSENT, BLOCKED, PASSABLE, PRESENT
from mintpilot.core.predicate import Literal, SayingKind
from mintpilot.core.query import Query

MOST_ATTRIBUTES = 2
"""After so many attributes of a target that the operator does not know, the whole target counts as not known."""


@dataclass(frozen=True, slots=True, kw_only=True, order=True)
class Topic:
    """Something that one may know or not: a gap, or one attribute of a target."""

    gap: str
    """Id of the gap."""
    attribute: str = ""
    """Of a target, what is asked about it; empty: the gap as a whole."""


def topics_of(query: Query) -> frozenset[Topic]:
    """What a query turns on: attributes of targets, all other gaps as a whole."""
    return frozenset(_topic(literal) for literal in query.every_literal)


def turns_on(query: Query, unknown: frozenset[Topic]) -> bool:
    """Whether the answer to a query hangs on something that is not known, whatever else it speaks of."""
    return any(t in unknown or Topic(gap=t.gap) in unknown for t in topics_of(query))


def with_unknown(unknown: frozenset[Topic], query: Query) -> frozenset[Topic]:
    """What is not known after the answer "I don't know" to that query."""
    found = unknown | topics_of(query)
    for gap in query.gap_ids:
        attributes = [t for t in found if t.gap == gap and t.attribute]
        if len(attributes) >= MOST_ATTRIBUTES:
            found |= {Topic(gap=gap)}
    return found


def _topic(literal: Literal) -> Topic:
    said = literal.saying
    if said.kind in (SayingKind.ATTRIBUTE, SayingKind.RELATION):
        return Topic(gap=literal.gap, attribute=f"{said.kind} {said.name}")
    if said.kind is SayingKind.VALUE and not literal.values & {PASSABLE, BLOCKED, PRESENT, ABSENT}:
        # Which one is meant is one matter, whatever candidate is named.
        return Topic(gap=literal.gap, attribute="which")
    return Topic(gap=literal.gap)
