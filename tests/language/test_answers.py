"""Free answers and their readings."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mintpilot.core.gap import ABSENT, BLOCKED, PASSABLE
from mintpilot.core.query import Command, Literal, Query, Question, Reply, Saying, SayingKind
from mintpilot.language import Reading, understand_answer

from . import answers, questions

CASES = [
    *((text, questions.SMOKE, reading) for text, reading in answers.SMOKE.items()),
    *((text, questions.ROOM, reading) for text, reading in answers.ROOM.items()),
    *((text, questions.BOX, reading) for text, reading in answers.BOX.items()),
]


@pytest.mark.parametrize(("text", "question", "reading"), CASES)
def test_answers_are_understood(text: str, question: Question, reading: str) -> None:
    assert understand_answer(text, question).reading == reading


def test_there_are_a_hundred_of_them_of_every_reading() -> None:
    assert len(CASES) >= 100
    assert {reading for _, _, reading in CASES} == set(Reading)


@pytest.mark.parametrize(("text", "left"), answers.ALSO.items())
def test_what_is_said_beyond_the_question_is_kept(text: str, left: set[str]) -> None:
    also = understand_answer(text, questions.BOX).also
    assert also is not None
    assert also.values == left


@pytest.mark.parametrize(
    ("text", "command"),
    [
        ("stop", Command.HOLD),
        ("hold position!", Command.HOLD),
        ("abort", Command.ABORT),
        ("cancel the mission", Command.ABORT),
        ("come back", Command.RETURN),
        ("stop and come back", Command.RETURN),
        ("return to base immediately", Command.RETURN),
    ],
)
def test_orders_come_before_answers(text: str, command: Command) -> None:
    understood = understand_answer(text, questions.SMOKE)
    assert (understood.reading, understood.command) == (Reading.COMMAND, command)


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
