"""What an answer says of the thing that is meant: attributes of the candidates, by closed patterns (section 12)."""

from __future__ import annotations

import re
from collections.abc import Iterator

from mintpilot.core.gap import GapKind, KnowledgeGap
from mintpilot.core.query import YES_PART, Literal, Question, Saying, SayingKind
from mintpilot.language.answer_text import folded, listed, spoken, utterance, without_courtesies
from mintpilot.language.answer_words import ANSWER_WORDS
from mintpilot.wording.tongues import TONGUES

Evidence = tuple[tuple[Literal, bool], ...]
_SIDES = ("left", "right")


def evidence_in(text: str, question: Question, lang: str, *, is_voice: bool) -> Evidence:
    """The attributes said (``the red one``), each with whether it was said to hold; empty where nothing else fits.

    The whole text must be of that form, apart from courtesies and a Yes or No before it, and leave a candidate.
    """
    gaps = [gap for gap in question.gaps if gap.kind is GapKind.TARGET and gap.candidates]
    said = spoken(text)
    if len(gaps) != 1 or len(question.gaps) != 1 or re.search(r"[^\w .,;!'¡-]|\.\.", said):
        return ()
    known, terms = ANSWER_WORDS[lang], _terms(gaps[0], lang)
    found: list[tuple[Literal, bool]] = []
    lead: bool | None = None
    for part in re.split(r"[,.;!]", said):
        clause = without_courtesies(part, lang)
        if not clause or clause in listed(known.courtesies):
            continue
        if not found and lead is None and clause in listed(f"{known.yes}|{known.no}"):
            lead = clause in listed(known.yes)
            continue
        is_ambiguous = lang == "es" and is_voice and clause.startswith("no ")
        said_here = () if is_ambiguous else _clause(clause, terms, gaps[0], lang)
        if not said_here:
            return ()
        found += said_here
    left = [v for v in gaps[0].values if all((v in literal.values) == holds for literal, holds in found)]
    if not found or not left or (lead is not None and question.query.is_choice):
        return ()
    answers = {question.query.part_of({gaps[0].id: value}) == YES_PART for value in left}
    if lead is not None and lead not in answers:
        return ()
    adds = lead is not None and len(answers) > 1 and len(question.query.literals) == 1
    return ((question.query.literals[0], bool(lead)), *found) if adds else tuple(found)


def _clause(clause: str, terms: dict[str, Literal], gap: KnowledgeGap, lang: str) -> Evidence:
    """``[no] [it is] [not] [the] attribute … [noun]`` as literals; empty where it is anything else."""
    known = ANSWER_WORDS[lang]
    states, negates, articles = (folded(x) for x in (known.states, known.negates, known.articles))
    lead = "(?:(?:no|yes) )?" if lang == "en" else ""
    nouns = "|".join(map(re.escape, sorted(_nouns(gap, lang), key=len, reverse=True)))
    things = rf"(?:{folded(known.things)}|{nouns})"
    called = "|".join(map(re.escape, sorted(terms, key=len, reverse=True)))
    shape = rf"{lead}(?:(?:{states}) )?(?P<neg>(?:{negates}) )?(?:(?:{articles}) )?(?:{things} )?" \
            rf"(?P<terms>(?:{called})(?: (?:{called}))*)(?: {things})?"  # fmt: skip
    match = re.fullmatch(shape, clause)
    if match is None:
        return ()
    literals = [terms[m] for m in re.findall(rf"(?<!\w)(?:{called})(?!\w)", match["terms"])]
    if match["neg"] and len(literals) > 1:
        return ()
    return tuple((literal, not match["neg"]) for literal in literals)


def _terms(gap: KnowledgeGap, lang: str) -> dict[str, Literal]:
    """Every way to say an attribute, a side or the name of a candidate, with the candidates that it fits."""
    terms: dict[str, Literal] = {}
    for saying, values in _sayings(gap):
        for form in _forms(saying.value, lang):
            terms.setdefault(form, Literal(gap=gap.id, values=frozenset(values), saying=saying))
    return terms


def _sayings(gap: KnowledgeGap) -> Iterator[tuple[Saying, set[str]]]:
    for name, value in sorted({(a.name, a.value) for c in gap.candidates for a in c.attributes if a.value}):
        fitting = {c.id for c in gap.candidates if any((a.name, a.value) == (name, value) for a in c.attributes)}
        yield Saying(kind=SayingKind.ATTRIBUTE, name=name, value=value), fitting
    for side in _SIDES:
        fitting = {c.id for c in gap.candidates if side in c.description.split()}
        if fitting:
            yield Saying(kind=SayingKind.ATTRIBUTE, name="side", value=side), fitting
    for candidate in gap.candidates:
        yield Saying(kind=SayingKind.VALUE, value=candidate.id), {candidate.id}


def _forms(value: str, lang: str) -> set[str]:
    """How an English attribute value is said in that language; the value itself where no table knows it."""
    also = {spoken(word) for word, english in ANSWER_WORDS[lang].attributes.items() if english == value}
    if lang not in TONGUES or value not in TONGUES[lang].adjectives:
        return also | {utterance(spoken(value.replace("_", " ")))}
    forms = TONGUES[lang].adjectives[value].split()
    if TONGUES[lang].ends_by_case:
        return {spoken(stem + end) for stem in (*forms, *also) for end in ("", "e", "en", "er", "es")}
    return also | {spoken(form) for form in forms}


def _nouns(gap: KnowledgeGap, lang: str) -> set[str]:
    """What the candidates are called, without their attributes."""
    attributes = {a.value for c in gap.candidates for a in c.attributes}
    english = {word for c in gap.candidates for word in re.findall(r"\w+", c.description.lower())} - attributes
    english |= set(re.findall(r"\w+", gap.subject.lower()))
    if lang not in TONGUES:
        return english - {"the", "a", "an", "and", "or", "not", *_SIDES}
    nouns = TONGUES[lang].nouns
    return {spoken(nouns[word].split(" ", 1)[1]) for word in english if word in nouns} or {"-"}
