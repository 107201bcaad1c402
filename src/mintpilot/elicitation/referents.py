"""What can be said of the thing that a phrase means: its name, its attributes, its relations to other things."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from mintpilot.core.gap import NO_THING, Candidate, KnowledgeGap
from mintpilot.core.geometry import Vec3
from mintpilot.core.query import Literal, Saying, SayingKind

LARGER, LEFT, RIGHT, NEAREST, FARTHEST = "larger than", "left of", "right of", "nearest", "farthest"
NOTHING = ("", "no", "none")
"""Values that say that something is missing: asking for them would be a negated question."""
START = "start"
"""Stands for the drone's place in a relation."""
CLEARLY_LARGER = 1.3
"""A thing is called larger than another only if its longest edge is at least this many times as long."""
CLEARLY_ASIDE_RAD = 0.05
"""A thing is called left or right of another only if they are at least this far apart in direction."""
CLEARLY_NEARER = 1.15
"""The nearest thing is called so only if the next one is at least this many times as far."""


def referent_literals(gap: KnowledgeGap, start_m: Vec3 | None) -> tuple[Literal, ...]:
    """Names, attributes and relations of a target gap's candidates, as literals.

    Where it may be none of them only names are asked for: what is meant may be red too, and yet in no picture.
    """
    if gap.in_doubt:
        return tuple(_names(gap))
    return (*_names(gap), *_attributes(gap), *_relations(gap, start_m))


def name_of(candidate: Candidate) -> str:
    """The candidate as the operator can see it."""
    return candidate.description or f"the {candidate.id}"


def _names(gap: KnowledgeGap) -> Iterator[Literal]:
    for value in gap.values:
        if value in NO_THING:
            continue
        yield Literal(gap=gap.id, values=frozenset({value}), saying=Saying(kind=SayingKind.VALUE, value=value))


def attribute_values(gap: KnowledgeGap) -> dict[str, dict[str, set[str]]]:
    """The attributes of the candidates by name: each of their values with the candidates that have it."""
    having: dict[str, dict[str, set[str]]] = {}
    for candidate in gap.candidates:
        for attribute in candidate.attributes:
            if attribute.value not in NOTHING:
                having.setdefault(attribute.name, {}).setdefault(attribute.value, set()).add(candidate.id)
    return having


def _attributes(gap: KnowledgeGap) -> Iterator[Literal]:
    for name, having in sorted(attribute_values(gap).items()):
        for value, values in sorted(having.items()):
            if len(values) < len(gap.values):
                saying = Saying(kind=SayingKind.ATTRIBUTE, name=name, value=value)
                yield Literal(gap=gap.id, values=frozenset(values), saying=saying)


def _relations(gap: KnowledgeGap, start_m: Vec3 | None) -> Iterator[Literal]:
    unique = [c for c in gap.candidates if [name_of(o) for o in gap.candidates].count(name_of(c)) == 1]
    for reference in unique:
        yield from _related(gap, LARGER, reference, _larger(gap, reference))
        if start_m is not None:
            yield from _related(gap, LEFT, reference, _aside(gap, reference, start_m, 1.0))
            yield from _related(gap, RIGHT, reference, _aside(gap, reference, start_m, -1.0))
    if start_m is not None and len(gap.candidates) > 1:
        far = sorted(gap.candidates, key=lambda c: (_distance(c, start_m), c.id))
        away = [_distance(c, start_m) for c in far]
        if away[1] >= CLEARLY_NEARER * away[0]:
            yield from _related(gap, NEAREST, None, {far[0].id})
        if away[-1] >= CLEARLY_NEARER * away[-2]:
            yield from _related(gap, FARTHEST, None, {far[-1].id})


def _related(gap: KnowledgeGap, name: str, reference: Candidate | None, values: set[str] | None) -> Iterator[Literal]:
    if values and len(values) < len(gap.values):
        saying = Saying(kind=SayingKind.RELATION, name=name, value=reference.id if reference else START)
        yield Literal(gap=gap.id, values=frozenset(values), saying=saying)


def _larger(gap: KnowledgeGap, reference: Candidate) -> set[str] | None:
    """Candidates that are clearly larger; None where for some of them it is hard to say."""
    size = max(reference.size_m)
    larger = set()
    for other in gap.candidates:
        if other is not reference and max(other.size_m) > size:
            if max(other.size_m) < CLEARLY_LARGER * size:
                return None
            larger.add(other.id)
    return larger if size > 0 else None


def _aside(gap: KnowledgeGap, reference: Candidate, start_m: Vec3, sign: float) -> set[str] | None:
    """Candidates left (+1) or right (-1) of the reference, seen from the start; None where some are hard to tell."""
    aside = set()
    for other in gap.candidates:
        if other is not reference:
            angle = _turn(reference.position_m, other.position_m, start_m)
            if abs(angle) < CLEARLY_ASIDE_RAD or abs(angle) > np.pi / 2:
                return None
            if sign * angle > 0:
                aside.add(other.id)
    return aside


def _turn(one_m: Vec3, other_m: Vec3, start_m: Vec3) -> float:
    """How far to the left one must turn, at the start, from the one place to the other, radians."""
    a, b = np.subtract(one_m, start_m)[:2], np.subtract(other_m, start_m)[:2]
    return float(np.arctan2(a[0] * b[1] - a[1] * b[0], a @ b))


def _distance(candidate: Candidate, start_m: Vec3) -> float:
    return float(np.linalg.norm(np.subtract(candidate.position_m, start_m)))
