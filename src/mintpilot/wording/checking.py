"""Is a proposed wording safe to ask? A second reading maps it back to its cut (method, section 4).

Only wordings that say exactly what the cut says are let through. Every word must be known: a neutral one, one of the
description, or one for the property asked about. In any doubt the template is used.
"""

from __future__ import annotations

import re

from mintpilot.core.gap import ABSENT, BLOCKED, PASSABLE, PRESENT, Candidate, GapKind, KnowledgeGap
from mintpilot.core.query import Question, SayingKind

MAX_WORDS = 20
_MAX_CHARACTERS = 160
_FORM = re.compile(r"[A-Z][A-Za-z' ,-]*\?")
_OPENING = re.compile(r"(?:is|are|can|could|does|do|did|has|have|should|may|will|would)\b")
_NEGATION = re.compile(
    r"\b(?:not|no|never|none|nobody|nothing|neither|nor|without|un\w+able|\w+n't|avoid|except|but)\b"
)


def _words(text: str) -> frozenset[str]:
    return frozenset(text.split())


_PROPERTY: dict[str, frozenset[str]] = {
    PASSABLE: _words("safe safely passable harmless through"),
    BLOCKED: _words("dangerous unsafe toxic blocked impassable harmful poisonous hazardous danger risky around"),
    PRESENT: _words("somebody someone anybody anyone person people occupied"),
    ABSENT: _words("empty vacant deserted unoccupied"),
}
"""Words that say one value of a gap. The second reading rests on them."""
_SURE = {PASSABLE: _words("safe safely passable harmless")}
"""Of these one must be there."""
_NEUTRAL = _words(
    "a an the is are can could does do did has have should may will would been be it i me my we you your there "
    "this that one ones of to for in into inside at with fly flying go going pass passing drone which who mean "
    "meant want need take pick up referring speaking about looking thing right correct currently now still color "
    "colour colored coloured"
)


def doubt(text: str, question: Question) -> str:
    """Why the wording must not be asked instead of the question's own; empty where nothing speaks against it.

    Args:
        text: the proposed words.
        question: the question as worded by template, with its cut and gaps.
    """
    words = _plain(text)
    if len(text) > _MAX_CHARACTERS or not 3 <= len(words) <= MAX_WORDS:
        return f"{len(words)} words: a question has 3 to {MAX_WORDS}"
    if not _FORM.fullmatch(text) or not _OPENING.match(text.lower()):
        return "not one plain yes/no question"
    if _NEGATION.search(text.lower()):
        return "negated"
    if len(question.query.literals) != 1 or len(question.gaps) != 1:
        return "a cut of several parts is worded by template"
    (gap,) = question.gaps
    reading = _target if gap.kind is GapKind.TARGET else _property
    return reading(words, question, gap)


def _property(words: list[str], question: Question, gap: KnowledgeGap) -> str:
    """For obstacles and rooms: the cut's property, and no other, of the thing just as the gap describes it."""
    (literal,) = question.query.literals
    if len(literal.values) != 1 or gap.kind not in (GapKind.OBSTACLE, GapKind.PRESENCE):
        return "a cut of this kind is worded by template"
    (value,) = literal.values
    called = " ".join(_plain(gap.description.removeprefix("the ")))
    before, found, after = f" {' '.join(words)} ".partition(f" {called} ")
    if not found:
        return f"does not name '{called}'"
    rest = [*before.split(), *after.split()]
    said = {v for v, names in _PROPERTY.items() if names & set(rest)}
    if said != {value} or not _SURE.get(value, _PROPERTY[value]) & set(rest):
        return f"says {sorted(said) or 'nothing'} instead of {value}"
    return _unknown(rest, _PROPERTY[value])


def _target(words: list[str], question: Question, gap: KnowledgeGap) -> str:
    """For referents: only the template's words, and they must leave exactly the candidates of the cut."""
    (literal,) = question.query.literals
    if literal.saying.kind not in (SayingKind.VALUE, SayingKind.ATTRIBUTE):
        return "a relation is worded by template"
    fits = [{c.id for c in gap.candidates if word in _words_of(c)} for word in words]
    said = set(gap.values).intersection(*(some for some in fits if 0 < len(some) < len(gap.candidates)))
    if said != literal.values:
        return f"means {sorted(said) or 'none'} instead of {sorted(literal.values)}"
    nouns = {form for word in _plain(gap.description) for form in (word, f"{word}s", f"{word}es")}
    return _unknown(words, nouns | set(_plain(question.text)))


def _words_of(candidate: Candidate) -> set[str]:
    """Words that the candidate's attributes and its description are made of."""
    return set(_plain(" ".join((*(a.value for a in candidate.attributes), candidate.description))))


def _plain(text: str) -> list[str]:
    return re.findall(r"[a-z']+", text.lower().replace("-", " "))


def _unknown(words: list[str], allowed: frozenset[str] | set[str]) -> str:
    strange = sorted(set(words) - _NEUTRAL - allowed)
    return f"adds {', '.join(strange)}" if strange else ""
