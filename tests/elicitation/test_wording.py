from __future__ import annotations

import re
from itertools import combinations, product

import pytest

from mintpilot.core.gap import GapKind, KnowledgeGap
from mintpilot.core.query import Combine, Literal, Query, Saying, SayingKind
from mintpilot.elicitation.candidates import gap_literals
from mintpilot.elicitation.wording import word_question

from .gaps import ALL, START, boxes, figure, smoke

LITERALS = {g.id: gap_literals(g, START) for g in ALL}
SINGLES = [Query(literals=(x,)) for several in LITERALS.values() for x in several]
SAME_KIND = [
    Query(literals=(LITERALS[a.id][0], LITERALS[b.id][0]), combine=combine)
    for a, b in combinations(ALL, 2)
    for combine in Combine
    if a.kind is b.kind and a.kind in (GapKind.OBSTACLE, GapKind.PRESENCE)
]
PAIRS = [
    Query(literals=pair, combine=Combine.ANY)
    for pair in combinations(LITERALS["target:box"], 2)
    if pair[0].saying.kind is pair[1].saying.kind is SayingKind.ATTRIBUTE
]


def first(gap_id: str, kind: SayingKind, name: str = "", value: str = "") -> Literal:
    return next(
        x
        for x in LITERALS[gap_id]
        if x.saying.kind is kind and (not name or x.saying.name == name) and (not value or x.saying.value == value)
    )


def text(*literals: Literal, combine: Combine = Combine.ALL, attempt: int = 1) -> str:
    return word_question(Query(literals=literals, combine=combine), ALL, None, attempt=attempt).text


@pytest.mark.parametrize("attempt", [1, 2, 3])
@pytest.mark.parametrize("query", [*SINGLES, *SAME_KIND, *PAIRS], ids=lambda q: q.id)
def test_every_question_is_one_short_yes_or_no_question_without_negation(query: Query, attempt: int) -> None:
    words = word_question(query, ALL, None, attempt=attempt).text
    assert re.match(r"^(Is|Are|Can|Do|Does) [a-z]", words)
    assert words.endswith("?")
    assert words.count("?") == 1
    assert len(words.split()) <= 20
    assert not re.search(r"\b(not|no|none|never|without|isn't|n't|obstacle:|presence:|target:)\b", words)
    assert "  " not in words
    assert "_" not in words


@pytest.mark.parametrize("query", [*SINGLES, *SAME_KIND, *PAIRS], ids=lambda q: q.id)
def test_a_second_attempt_uses_other_words(query: Query) -> None:
    one, two = (word_question(query, ALL, None, attempt=n) for n in (1, 2))
    assert one.text != two.text
    assert one.query == two.query
    assert (one.attempt, two.attempt) == (1, 2)


def test_of_a_thing_it_is_asked_whether_it_is_a_person_and_not_who_is_inside() -> None:
    about = figure()
    query = Query(literals=gap_literals(about, START))
    said = word_question(query, [about], None)
    assert said.text == "Is the chest-high grey thing on the floor a person?"
    assert (said.yes_means, said.no_means) == ("I fly to it", "I fly past it")
    assert word_question(query, [about], None, attempt=2).text == (
        "Is this somebody: the chest-high grey thing on the floor?"
    )


def test_different_single_cuts_are_worded_differently() -> None:
    words = [word_question(q, ALL, None).text for q in SINGLES]
    assert len(set(words)) == len(words)


def test_the_thing_is_named_by_what_the_operator_can_see() -> None:
    a, b = LITERALS["obstacle:a"][0], LITERALS["obstacle:b"][0]
    assert text(a) == "Is the grey smoke near the gate safe to fly through?"
    assert text(LITERALS["obstacle:c"][0]) == (
        "Is the grey smoke on the west side, the northern one, safe to fly through?"
    )
    assert text(a, b, combine=Combine.ANY) == (
        "Is it safe to fly through the grey smoke near the gate or the grey smoke by the rack?"
    )
    assert text(a, b) == "Are the grey smoke near the gate and the grey smoke by the rack both safe to fly through?"
    assert text(LITERALS["presence:r"][0]) == "Is somebody inside the closed room in the north corner?"
    assert text(first("target:box", SayingKind.VALUE)) == "Is it the large red box?"
    assert text(first("target:box", SayingKind.VALUE), attempt=2) == "Do you mean the large red box?"
    assert text(first("target:box", SayingKind.ATTRIBUTE, "size", "large")) == "Is it one of the large boxes?"
    assert text(first("target:box", SayingKind.RELATION, "larger than")) == "Is it larger than the small red box?"
    assert text(LITERALS["value:width"][0]) == "Is the width of the gate in metres 2 or more?"


def test_attributes_that_are_no_adjectives_are_asked_as_a_property() -> None:
    eyes = Literal(
        gap="target:box",
        values=frozenset({"box-1"}),
        saying=Saying(kind=SayingKind.ATTRIBUTE, name="eye_colour", value="blue"),
    )
    glasses = Literal(
        gap="target:box",
        values=frozenset({"box-2"}),
        saying=Saying(kind=SayingKind.ATTRIBUTE, name="accessories", value="glasses"),
    )
    assert text(eyes) == "Is its eye colour blue?"
    assert text(glasses) == "Does it have glasses?"


def test_long_descriptions_are_shortened_to_twenty_words() -> None:
    gap = smoke("long", "the very thick grey smoke " + "beside the long red rack " * 6)
    query = Query(literals=gap_literals(gap))
    words = word_question(query, (gap,), None).text
    assert words == "Is the very thick grey smoke safe to fly through?"


def test_things_called_alike_are_told_apart_by_their_names() -> None:
    gap = boxes()
    twins = KnowledgeGap(
        id=gap.id,
        kind=gap.kind,
        subject=gap.subject,
        description=gap.description,
        values=gap.values[:2],
        prior=(0.5, 0.5),
        position_m=gap.position_m,
        candidates=tuple(type(c)(id=c.id, position_m=c.position_m, description="the box") for c in gap.candidates[:2]),
    )
    words = {
        word_question(Query(literals=(x,)), (twins,), None).text
        for x in gap_literals(twins)
        if x.saying.kind is SayingKind.VALUE
    }
    assert words == {"Is it the box (box-1)?", "Is it the box (box-2)?"}


def test_mixed_literals_can_still_be_said() -> None:
    for one, other in product(LITERALS["obstacle:a"], LITERALS["presence:r"]):
        words = text(one, other, combine=Combine.ANY)
        assert words == "Is it true that the grey smoke is safe or somebody is inside the closed room?"
