"""One short sentence for a query. Never negated; of a yes/no query, yes means what the query says."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from mintpilot.core.gap import GapKind, KnowledgeGap
from mintpilot.core.query import Combine, Literal, Query, SayingKind
from mintpilot.core.threshold import Threshold, ValueKind
from mintpilot.elicitation.phrases import (
    inset,
    is_adjective,
    is_possession,
    joined,
    noun_of,
    plain,
    plural,
    relation_phrase,
    shortened,
    subject_of,
    thing_called,
)

MAX_WORDS = 20
"""A question has no more words than this."""
MAX_CHOICE_WORDS = 40
"""The same where it names up to four options."""


def sentence(query: Query, gaps: Mapping[str, KnowledgeGap], attempt: int = 1) -> str:
    """The query as a question; a second attempt uses other words, a third the first ones again.

    Descriptions are shortened only where the sentence would pass `MAX_WORDS`.
    """
    most = MAX_CHOICE_WORDS if query.is_choice else MAX_WORDS
    for name in (subject_of, lambda gap: shortened(subject_of(gap))):
        text = _sentence(query, gaps, attempt, name)
        if len(text.split()) <= most:
            return text
    words = text.rstrip("?").split()
    return f"{' '.join(words[:most])}?"


def is_sayable(query: Query, gaps: Mapping[str, KnowledgeGap]) -> bool:
    """Whether the query fits into `MAX_WORDS` words and one form, everything called by its full description.

    A choice may have `MAX_CHOICE_WORDS`.
    """
    owned = {is_possession(x.saying.name) for x in query.every_literal if x.saying.kind is SayingKind.ATTRIBUTE}
    if len(owned) > 1 and not query.is_choice:
        return False
    most = MAX_CHOICE_WORDS if query.is_choice else MAX_WORDS
    return all(len(_sentence(query, gaps, attempt, subject_of).split()) <= most for attempt in (1, 2))


def _sentence(query: Query, gaps: Mapping[str, KnowledgeGap], attempt: int, name: Callable[[KnowledgeGap], str]) -> str:
    first = attempt % 2 == 1
    if query.is_choice:
        return _choice(query, gaps, first, name)
    threshold = highest(query, gaps)
    if threshold is not None:
        return _threshold(threshold, first)
    subjects = [name(gaps[x.gap]) for x in query.literals]
    kinds = {gaps[x.gap].kind for x in query.literals}
    if kinds == {GapKind.OBSTACLE}:
        return _obstacles(subjects, query.combine, first)
    if kinds == {GapKind.PRESENCE} and all(gaps[x.gap].is_thing for x in query.literals):
        return _people(subjects, query.combine, first)
    if kinds == {GapKind.PRESENCE} and not any(gaps[x.gap].is_thing for x in query.literals):
        return _rooms(subjects, query.combine, first)
    if kinds == {GapKind.TARGET} and len(query.gap_ids) == 1:
        return _referent(query, gaps[query.gap_ids[0]], first)
    if kinds == {GapKind.VALUE} and len(query.literals) == 1:
        value = query.literals[0].saying.value
        it = inset(subjects[0])
        return f"Is {it} {value} or more?" if first else f"Is {it} at least {value}?"
    word = "and" if query.combine is Combine.ALL else "or"
    facts = joined([_fact(x, gaps[x.gap], name) for x in query.literals], word)
    return f"Is it true that {facts}?" if first else f"Is this right: {facts}?"


def highest(query: Query, gaps: Mapping[str, KnowledgeGap]) -> Threshold | None:
    """The largest threshold of a query about one ordered value, joined by *and*; None for other queries."""
    found = [gaps[x.gap].threshold for x in query.literals if x.saying.kind is SayingKind.THRESHOLD]
    known = [threshold for threshold in found if threshold is not None]
    if not known or len(known) < len(query.literals) or len({t.of for t in known}) > 1:
        return None
    return max(known, key=lambda threshold: threshold.at_least_m)


def _threshold(threshold: Threshold, first: bool) -> str:
    it, how = _measured(threshold)
    value = threshold.words
    return f"Is {it} at least {value} {how}?" if first else f"Is it right that {it} is {value} {how} or more?"


def _measured(value: Threshold) -> tuple[str, str]:
    """What is measured, and the adjective that goes with it."""
    subject = inset(value.subject)
    if value.kind is ValueKind.CLEARANCE:
        return subject, "wide"
    return f"the lower edge of {subject}", "high"


def _choice(query: Query, gaps: Mapping[str, KnowledgeGap], first: bool, name: Callable[[KnowledgeGap], str]) -> str:
    """The options with their numbers, as they stand on screens and are answered by voice."""
    offered = joined([f"{part + 1} {query.part_words(part)}" for part in range(query.part_count)], "or")
    kinds = {gaps[x.gap].kind for x in query.every_literal}
    saying = query.every_literal[0].saying
    value = gaps[query.every_literal[0].gap].threshold
    if value is not None:
        it, how = _measured(value)
        return f"How {how} is {it}: {offered}?" if first else f"Which is right, how {how} {it} is: {offered}?"
    if kinds == {GapKind.OBSTACLE}:
        return f"Which is safe to fly through: {offered}?" if first else f"What can the drone fly through: {offered}?"
    if kinds == {GapKind.PRESENCE}:
        if all(gaps[x.gap].is_thing for x in query.every_literal):
            return f"Which is a person: {offered}?" if first else f"Which of these is somebody: {offered}?"
        return f"Where is somebody inside: {offered}?" if first else f"Which of these holds a person: {offered}?"
    if kinds == {GapKind.VALUE}:
        it = inset(name(gaps[query.gap_ids[0]]))
        return f"How much is {it}: {offered}?" if first else f"Which is right for {it}: {offered}?"
    if saying.kind is SayingKind.ATTRIBUTE:
        what = plain(saying.name)
        return f"What is its {what}: {offered}?" if first else f"Which {what} has the one you mean: {offered}?"
    return f"Which one do you mean: {offered}?" if first else f"Which of these is it: {offered}?"


def _obstacles(subjects: list[str], combine: Combine, first: bool) -> str:
    if len(subjects) == 1:
        s = subjects[0]
        return f"Is {inset(s)} safe to fly through?" if first else f"Can the drone fly safely through {s}?"
    if combine is Combine.ANY:
        either = joined(subjects, "or")
        return f"Is it safe to fly through {either}?" if first else f"Can the drone fly safely through {either}?"
    both = "both" if len(subjects) == 2 else "all"
    every = joined(subjects, "and")
    return f"Are {inset(every)} {both} safe to fly through?" if first else f"Is it safe to fly through {both}, {every}?"


def _people(subjects: list[str], combine: Combine, first: bool) -> str:
    if len(subjects) == 1:
        return f"Is {inset(subjects[0])} a person?" if first else f"Is this somebody: {subjects[0]}?"
    if combine is Combine.ANY:
        either = joined(subjects, "or")
        return f"Is {inset(either)} a person?" if first else f"Is one of these a person: {either}?"
    every = joined(subjects, "and")
    return f"Are {inset(every)} all people?" if first else f"Is each of these a person: {every}?"


def _rooms(subjects: list[str], combine: Combine, first: bool) -> str:
    if combine is Combine.ALL and len(subjects) > 1:
        every = joined(subjects, "and")
        both = "both" if len(subjects) == 2 else "all of"
        return f"Are there people in {both} {every}?" if first else f"Is somebody inside each of these: {every}?"
    either = joined(subjects, "or")
    return f"Is somebody inside {either}?" if first else f"Is there a person in {either}?"


def _referent(query: Query, gap: KnowledgeGap, first: bool) -> str:
    kinds = {x.saying.kind for x in query.literals}
    word = "and" if query.combine is Combine.ALL else "or"
    if kinds == {SayingKind.VALUE}:
        things = joined([thing_called(gap, x.saying.value) for x in query.literals], word)
        if gap.is_search:
            return f"Is {gap.subject} in {things}?" if first else f"Is this where {gap.subject} is: {things}?"
        return f"Is it {things}?" if first else f"Do you mean {things}?"
    if kinds == {SayingKind.RELATION} and len(query.literals) == 1:
        saying = query.literals[0].saying
        relation = relation_phrase(saying.name, saying.value, gap)
        return f"Is it {relation}?" if first else f"Is the one that you mean {relation}?"
    if kinds == {SayingKind.ATTRIBUTE}:
        return _attributes(query, gap, word, first)
    facts = joined([_fact(x, gap, subject_of) for x in query.literals], word)
    return f"Is it true that {facts}?" if first else f"Is this right: {facts}?"


def _attributes(query: Query, gap: KnowledgeGap, word: str, first: bool) -> str:
    sayings = [x.saying for x in query.literals]
    values = [plain(s.value) for s in sayings]
    if all(is_adjective(s.name) for s in sayings):
        if len(sayings) == 1:
            noun = noun_of(gap)
            return f"Is it one of the {values[0]} {plural(noun)}?" if first else f"Is the {noun} you mean {values[0]}?"
        both = "both " if word == "and" and len(sayings) == 2 else ""
        return f"Is it {both}{joined(values, word)}?" if first else f"Is the one you mean {both}{joined(values, word)}?"
    it = "it" if first else "the one that you mean"
    if all(is_possession(s.name) for s in sayings):
        return f"Does {it} have {joined(values, word)}?"
    if len({s.name for s in sayings}) == 1:
        facts = f"{plain(sayings[0].name)} {joined(values, word)}"
        return f"Is its {facts}?" if first else f"Does {it} have {facts}?"
    facts = joined([f"{plain(s.name)} {v}" for s, v in zip(sayings, values, strict=True)], f"{word} its")
    return f"Is its {facts}?" if first else f"Does the one that you mean have {facts.replace(' its ', ' ')}?"


def _fact(literal: Literal, gap: KnowledgeGap, name: Callable[[KnowledgeGap], str]) -> str:
    saying = literal.saying
    if gap.kind is GapKind.OBSTACLE:
        return f"{name(gap)} is safe"
    if gap.is_thing:
        return f"{name(gap)} is a person"
    if gap.kind is GapKind.PRESENCE:
        return f"somebody is inside {name(gap)}"
    if saying.kind is SayingKind.THRESHOLD:
        return f"{name(gap)} is {saying.value} or more"
    if saying.kind is SayingKind.VALUE:
        return f"it is {thing_called(gap, saying.value)}"
    if saying.kind is SayingKind.ATTRIBUTE:
        return f"its {plain(saying.name)} is {plain(saying.value)}"
    return f"it is {relation_phrase(saying.name, saying.value, gap)}"
