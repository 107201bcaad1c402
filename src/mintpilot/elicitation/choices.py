"""Which choices can be put: up to four named options in one question (method, section 13)."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import combinations

from mintpilot.core.gap import ABSENT, BLOCKED, NOWHERE, PASSABLE, PRESENT, GapKind, KnowledgeGap
from mintpilot.core.query import MAX_PARTS, Combine, Literal, Option, Query, Saying, SayingKind, choice
from mintpilot.elicitation.phrases import plain, shortened, subject_of, thing_called
from mintpilot.elicitation.referents import attribute_values

LEAST_PARTS = 3
"""A choice of two is a yes/no query that takes longer."""
MOST_NAMED = 8
"""Of more candidates, or values of an attribute, than this no three are picked out."""
_PAIRED = {GapKind.OBSTACLE: (PASSABLE, BLOCKED), GapKind.PRESENCE: (PRESENT, ABSENT)}
"""For gaps of these kinds: the value that is asked for, and the other one."""


def choices_about(gaps: Sequence[KnowledgeGap]) -> Iterator[Query]:
    """The choices over some gaps, with three or four parts each.

    Which thing a phrase means, by name or by one attribute; in which of the intervals an ordered value is; and of two
    regions, or two rooms, whether both, one or neither.
    """
    for gap in gaps:
        if gap.kind is GapKind.TARGET:
            yield from _of(gap, _named(gap))
            for name, having in attribute_values(gap).items():
                if not gap.in_doubt and sum(map(len, having.values())) <= len(gap.values):
                    yield from _of(gap, _by_attribute(gap, name, having))
        elif gap.kind is GapKind.VALUE:
            yield from _intervals(gap)
    for chain in chains(gaps):
        if LEAST_PARTS <= len(chain) + 1 <= MAX_PARTS:
            yield _steps(chain)
    for one, other in combinations([gap for gap in gaps if gap.threshold is None], 2):
        if one.kind is other.kind and one.kind in _PAIRED and one.is_thing is other.is_thing:
            yield from _both_or_neither(one, other)


def chains(gaps: Iterable[KnowledgeGap]) -> list[list[KnowledgeGap]]:
    """The open gaps of each ordered value, the lowest threshold first."""
    found: dict[str, list[KnowledgeGap]] = {}
    for gap in gaps:
        if gap.threshold is not None and set(gap.values) == {PASSABLE, BLOCKED}:
            found.setdefault(gap.threshold.of, []).append(gap)
    return [sorted(found[of], key=_at_least) for of in sorted(found)]


def _at_least(gap: KnowledgeGap) -> float:
    return gap.threshold.at_least_m if gap.threshold is not None else 0.0


def _steps(chain: Sequence[KnowledgeGap]) -> Query:
    """Between which thresholds an ordered value is."""
    words = [gap.threshold.words for gap in chain if gap.threshold is not None]
    labels = [f"less than {words[0]}", *map("{} to {}".format, words, words[1:]), f"{words[-1]} or more"]
    options = []
    for free, label in enumerate(labels):
        said = [(gap, PASSABLE) for gap in chain[:free]] + [(gap, BLOCKED) for gap in chain[free : free + 1]]
        literals = tuple(_literal(gap, (value,), SayingKind.THRESHOLD, "in", label) for gap, value in said)
        options.append(Option(label=label, literals=literals, combine=Combine.ALL))
    return Query(options=tuple(options))


def _of(gap: KnowledgeGap, options: Sequence[Option]) -> Iterator[Query]:
    """All options where they are few; else each three of them beside "none of these"."""
    covered = sum(len(x.values) for option in options for x in option.literals)
    if LEAST_PARTS <= len(options) + (covered < len(gap.values)) <= MAX_PARTS:
        yield choice(options, (gap,))
    elif MAX_PARTS <= len(options) <= MOST_NAMED:
        for few in combinations(options, MAX_PARTS - 1):
            yield choice(few, (gap,))


def _named(gap: KnowledgeGap) -> tuple[Option, ...]:
    things = [value for value in gap.values if value not in NOWHERE]
    full = [thing_called(gap, value) for value in things]
    short = [shortened(words) for words in full]
    called = [long if short.count(brief) > 1 else brief for long, brief in zip(full, short, strict=True)]
    return tuple(
        Option(label=words, literals=(_literal(gap, (value,), SayingKind.VALUE, value=value),))
        for words, value in zip(called, things, strict=True)
    )


def _by_attribute(gap: KnowledgeGap, name: str, having: dict[str, set[str]]) -> tuple[Option, ...]:
    return tuple(
        Option(label=plain(value), literals=(_literal(gap, having[value], SayingKind.ATTRIBUTE, name, value),))
        for value in sorted(having)
    )


def _intervals(gap: KnowledgeGap) -> Iterator[Query]:
    """Cuts into three or four intervals; `KnowledgeGap.values` are their lower bounds."""
    for parts in range(LEAST_PARTS, MAX_PARTS + 1):
        for inner in combinations(range(1, len(gap.values)), parts - 1):
            ends = zip((0, *inner), (*inner, len(gap.values)), strict=True)
            yield choice([_interval(gap, first, end) for first, end in ends], (gap,))


def _interval(gap: KnowledgeGap, first: int, end: int) -> Option:
    low, high = gap.values[first], gap.values[end] if end < len(gap.values) else ""
    label = f"less than {high}" if not first else f"{low} to {high}" if high else f"{low} or more"
    return Option(label=label, literals=(_literal(gap, gap.values[first:end], SayingKind.THRESHOLD, "in", low),))


def _both_or_neither(one: KnowledgeGap, other: KnowledgeGap) -> Iterator[Query]:
    wanted, opposite = _PAIRED[one.kind]
    if any(set(gap.values) != {wanted, opposite} for gap in (one, other)):
        return
    names = [shortened(subject_of(gap)) for gap in (one, other)]
    if names[0] == names[1]:
        names = [subject_of(gap) for gap in (one, other)]
    yield Query(
        options=tuple(
            Option(
                label=label,
                literals=tuple(
                    _literal(gap, (value,), SayingKind.VALUE, value=value)
                    for gap, value in zip((one, other), values, strict=True)
                ),
                combine=Combine.ALL,
            )
            for label, values in (
                ("both", (wanted, wanted)),
                (f"only {names[0]}", (wanted, opposite)),
                (f"only {names[1]}", (opposite, wanted)),
                ("neither", (opposite, opposite)),
            )
        )
    )


def _literal(
    gap: KnowledgeGap, values: set[str] | tuple[str, ...], kind: SayingKind, name: str = "", value: str = ""
) -> Literal:
    return Literal(gap=gap.id, values=frozenset(values), saying=Saying(kind=kind, name=name, value=value))
