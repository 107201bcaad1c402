"""Free answers and their readings."""

from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mintpilot.benchmark.language_cases import QUESTIONS, AnswerCase, answer_cases
from mintpilot.core.gap import ABSENT, BLOCKED, PASSABLE
from mintpilot.core.query import Literal, Order, Query, Question, Reply, Saying, SayingKind
from mintpilot.language import Reading, understand_answer

from . import questions

CASES = list(answer_cases())
AGAIN = {"unsure", "other"}
"""Either way it is asked again."""
ALSO: dict[str, set[str]] = {
    "not the small red one": {"box-2", "box-3"},
    "not the red one, the blue one": {"box-2", "box-3"},
    "no, I mean the big blue box": {"box-2"},
    "no the blue one": {"box-2", "box-3"},
    "the blue one": {"box-2", "box-3"},
    "yes, the red one": {"box-1"},
    "not the red one": {"box-2", "box-3"},
    "the large one": {"box-2"},
}
"""What is said beyond the question: the boxes that are left."""


@pytest.mark.parametrize("question", QUESTIONS)
@pytest.mark.parametrize("reading", list(Reading))
def test_answers_are_understood_and_no_yes_is_made_up(question: str, reading: str) -> None:
    cases = [c for c in CASES if c.question is QUESTIONS[question] and c.reading == reading]
    got = {c.text: understand_answer(c.text, c.question).reading for c in cases}
    right = [text for text, read in got.items() if read == reading or {read, reading} <= AGAIN]
    assert cases
    assert len(right) >= 0.95 * len(cases)
    assert reading == Reading.YES or [text for text, read in got.items() if read == Reading.YES] == []


@settings(deadline=None, max_examples=300)
@given(st.sampled_from([c for c in CASES if c.reading != "yes"]), st.sampled_from(["'", ",", "."]))
def test_missing_punctuation_makes_no_yes(case: AnswerCase, mark: str) -> None:
    assert understand_answer(case.text.replace(mark, ""), case.question).reading is not Reading.YES


@pytest.mark.parametrize(
    ("text", "reading"),
    [
        ("I don't think it's safe", "no"),
        ("I think it's safe", "unsure"),
        ("it's not unsafe", "yes"),
        ("it isn't not safe", "other"),
        ("not very dangerous", "unsure"),
        ("we are safe", "other"),
        ("it was safe an hour ago", "unsure"),
        ("no it is not it is toxic", "no"),
        ("yes, no wait, no", "no"),
        ("no sorry I meant yes", "yes"),
        ("yes nto safe", "other"),
        ("yes I thikn", "other"),
        ("it's on safe", "no"),
        ("no toxic fumes", "other"),
        ("I'll come back to you on that", "unsure"),
    ],
)
def test_negation_doubt_and_correction_reach_as_far_as_they_should(text: str, reading: str) -> None:
    assert understand_answer(text, questions.SMOKE).reading == reading


def test_there_are_a_hundred_of_them_of_every_reading() -> None:
    assert len(CASES) >= 100
    assert {case.reading for case in CASES} == set(Reading)


@pytest.mark.parametrize(
    ("name", "text", "reading"),
    [
        ("left", "the left one", "yes"), ("left", "the one on the right", "no"), ("left", "not the left one", "no"),
        ("larger", "the bigger one", "yes"), ("nearest", "the far one", "no"), ("nearest", "the closest", "yes"),
    ],
)  # fmt: skip
def test_relations_are_echoed_or_turned(name: str, text: str, reading: str) -> None:
    saying = Saying(kind=SayingKind.RELATION, name=name, value="box-3")
    literal = Literal(gap=questions.BOX_GAP.id, values=frozenset({"box-1"}), saying=saying)
    related = replace(questions.BOX, query=Query(literals=(literal,)), text="Is it the one that I mean?")
    assert understand_answer(text, related).reading == reading


@pytest.mark.parametrize(("text", "left"), ALSO.items())
def test_what_is_said_beyond_the_question_is_kept(text: str, left: set[str]) -> None:
    also = understand_answer(text, questions.BOX).also
    assert also is not None
    assert also.values == left


@pytest.mark.parametrize(
    ("text", "command"),
    [
        ("stop", Order.HOLD),
        ("hold position!", Order.HOLD),
        ("abort", Order.ABORT),
        ("cancel the mission", Order.ABORT),
        ("come back", Order.RETURN),
        ("stop and come back", Order.RETURN),
        ("return to base immediately", Order.RETURN),
        ("that is enough, land it now", Order.ABORT),
    ],
)
def test_orders_come_before_answers(text: str, command: Order) -> None:
    understood = understand_answer(text, questions.SMOKE)
    assert (understood.reading, understood.command) == (Reading.COMMAND, command)


@pytest.mark.parametrize(
    "text", ["it landed on the crate", "there is room to land", "don't land", "I put it down there"]
)
def test_what_tells_of_landing_is_no_order(text: str) -> None:
    assert understand_answer(text, questions.SMOKE).reading is not Reading.COMMAND


def test_words_about_the_world_are_answers_to_the_cut_whichever_way_it_is_put() -> None:
    saying = Saying(kind=SayingKind.VALUE, value=BLOCKED)
    literal = Literal(gap=questions.SMOKE_GAP.id, values=frozenset({BLOCKED}), saying=saying)
    turned = Question(
        query=Query(literals=(literal,)),
        text="Must I stay out of the smoke?",
        yes_means="I fly around it",
        no_means="I fly through it",
        gaps=(questions.SMOKE_GAP,),
    )
    assert understand_answer("it is toxic", turned).reply is Reply.YES
    assert understand_answer("it is safe", turned).reply is Reply.NO
    assert understand_answer("it is toxic", questions.SMOKE).reply is Reply.NO
    for turned_at_but in ("it was toxic but it is fine", "no, but there is a beam in the way"):
        assert understand_answer(turned_at_but, turned).reply is not Reply.NO


def test_a_statement_about_one_of_two_clouds_settles_nothing() -> None:
    other = type(questions.SMOKE_GAP)(
        **{
            name: getattr(questions.SMOKE_GAP, name)
            for name in ("kind", "description", "values", "prior", "position_m", "candidates")
        },
        id="obstacle:smoke-2",
        subject="smoke-2",
    )
    literals = tuple(
        Literal(gap=gap.id, values=frozenset({PASSABLE}), saying=Saying(kind=SayingKind.VALUE, value=PASSABLE))
        for gap in (questions.SMOKE_GAP, other)
    )
    both = Question(
        query=Query(literals=literals),
        text="Are both clouds safe?",
        yes_means="I fly through them",
        no_means="I fly around them",
        gaps=(questions.SMOKE_GAP, other),
    )
    assert understand_answer("it is safe", both).reading is Reading.OTHER
    assert understand_answer("yes", both).reading is Reading.YES


def test_what_is_not_clear_leaves_the_belief_alone() -> None:
    for text in ("banana", "yes no", "maybe", "stop"):
        assert understand_answer(text, questions.SMOKE).reply is Reply.UNSURE


NEGATIVE = st.sampled_from(["no", "nope", "not safe", "it is toxic", "do not", "never", "stay out", "dangerous"])
FILLER = st.lists(st.sampled_from(["please", "the", "smoke", "through", "it", "so", "drone", "is", ","]), max_size=4)


@settings(deadline=None, max_examples=150)
@given(st.text(max_size=60) | st.binary(max_size=60).map(lambda raw: raw.decode("latin-1")))
def test_any_text_is_read_without_a_crash(text: str) -> None:
    for question in (questions.SMOKE, questions.ROOM, questions.BOX):
        assert understand_answer(text, question).reading in Reading


@settings(deadline=None, max_examples=150)
@given(FILLER, NEGATIVE, FILLER)
def test_a_plain_refusal_is_never_read_as_yes(before: list[str], refusal: str, after: list[str]) -> None:
    text = " ".join([*before, refusal, *after])
    assert understand_answer(text, questions.SMOKE).reading is not Reading.YES


def test_an_empty_room_is_a_no_and_means_that_nobody_is_there() -> None:
    understood = understand_answer("it's empty", questions.ROOM)
    assert understood.reply is Reply.NO
    assert not questions.ROOM.query.holds({questions.ROOM_GAP.id: ABSENT})
