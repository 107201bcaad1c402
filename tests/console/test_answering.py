"""From clicks, keys and words to what the mission hears."""

from __future__ import annotations

import time
from dataclasses import replace

import pytest
from tests.language.questions import BOX, SMOKE

from mintpilot.assembly.talk import Talk
from mintpilot.console.answering import Answering, Heard, Turn
from mintpilot.console.desk import Asked
from mintpilot.console.protocol import MoreTime, Ordering, Pointed, QuestionSeen, Replied, Said
from mintpilot.core.inputs import Answered, MoreTimeWanted, Ordered, QuestionShown
from mintpilot.core.query import Answer, Order, Question, Reply, Standing

WHO = "console:abcd@127.0.0.1"
ASKED = replace(SMOKE, id="q1")
"""Yes lets the drone through the smoke."""


@pytest.fixture
def answering():
    made = Answering(Talk().understand)
    made.turn = Turn(ASKED, 30.0)
    yield made
    made.close()


def hear(answering: Answering, command, time_s: float = 5.0) -> Heard:
    heard = answering.hear(Asked(command=command, who=WHO), time_s)
    until = time.monotonic() + 5
    while heard == Heard() and isinstance(command, Said) and time.monotonic() < until:
        heard = next(answering.read(time_s), heard)
    return heard


def answer_in(heard: Heard) -> Answer:
    (event,) = heard.events
    assert isinstance(event, Answered)
    assert event.operator == WHO
    return event.answer


@pytest.mark.parametrize("reply", ["yes", "no", "unsure"])
def test_a_key_is_a_plain_answer(answering, reply):
    answering.turn.shown_s = 2.0
    answer = answer_in(hear(answering, Replied(n=1, question="q1", reply=reply)))
    assert (answer.reply, answer.standing, answer.by) == (Reply(reply), Standing.PLAIN, "key")
    assert answer.latency_s == 3.0


def test_the_question_counts_as_shown_once(answering):
    (event,) = hear(answering, QuestionSeen(n=1, question="q1")).events
    assert event == QuestionShown(time_s=5.0, question="q1")
    assert hear(answering, QuestionSeen(n=2, question="q1")) == Heard()


def test_an_answer_to_an_earlier_question_keeps_its_id(answering):
    (event,) = hear(answering, Replied(n=1, question="q0", reply="yes")).events
    assert isinstance(event, Answered)
    assert event.question == "q0"


def test_a_key_pressed_for_the_question_does_not_confirm_a_read_back(answering):
    pending = Answer(reply=Reply.YES, latency_s=1.0, standing=Standing.UNCONFIRMED)
    answering.turn.question = replace(ASKED, read_back=pending)
    heard = hear(answering, Replied(n=1, question="q1", reply="yes"))
    assert heard.changed
    assert heard.events == ()
    answer = answer_in(hear(answering, Replied(n=2, question="q1", reply="yes", confirms=True)))
    assert (answer.reply, answer.standing) == (Reply.YES, Standing.CONFIRMED)


def test_a_denied_read_back_asks_again_or_adds_caution(answering):
    guarded = Answer(reply=Reply.NO, latency_s=1.0, standing=Standing.UNCONFIRMED)
    answering.turn.question = replace(ASKED, read_back=guarded)
    heard = hear(answering, Replied(n=1, question="q1", reply="no", confirms=True))
    assert heard.changed
    assert heard.events == ()
    assert answering.turn.question.read_back is None
    answering.turn.question = replace(ASKED, read_back=replace(guarded, reply=Reply.YES))
    assert answer_in(hear(answering, Replied(n=2, question="q1", reply="no", confirms=True))).reply is Reply.NO


def test_words_are_read_as_typed_ones(answering):
    plain = answer_in(hear(answering, Said(n=1, question="q1", text="no")))
    assert (plain.reply, plain.standing, plain.by) == (Reply.NO, Standing.PLAIN, "typed")
    (order,) = hear(answering, Said(n=2, question="q1", text="stop")).events
    assert isinstance(order, Ordered)
    assert order.order is Order.HOLD
    assert hear(answering, Said(n=3, question="q1", text="why do you ask?")).show == "why"


def test_words_that_are_not_understood_are_asked_for_once_more(answering):
    first = hear(answering, Said(n=1, question="q1", text="purple monday"))
    assert first.changed
    assert first.events == ()
    assert answer_in(hear(answering, Said(n=2, question="q1", text="purple monday"))).reply is Reply.UNSURE


def test_more_time_and_orders(answering):
    assert hear(answering, MoreTime(n=1, question="q1")).events == (MoreTimeWanted(time_s=5.0, question="q1"),)
    (order,) = hear(answering, Ordering(n=2, order=Order.LAND)).events
    assert isinstance(order, Ordered)
    assert (order.order, order.operator) == (Order.LAND, WHO)


def test_pointing_is_evidence_that_has_to_be_read_back(answering):
    box: Question = replace(BOX, id="q2")
    answering.turn = Turn(box, 30.0)
    (gap,) = box.gaps
    for thing in gap.values:
        answer = answer_in(hear(answering, Pointed(n=1, question="q2", thing=thing)))
        assert answer.standing is Standing.UNCONFIRMED
        assert (answer.reply is Reply.YES) is box.query.holds({gap.id: thing})
        (evidence,) = answer.also
        assert [v for v in gap.values if evidence.query.holds({gap.id: v})] == [thing]
    assert hear(answering, Pointed(n=9, question="q2", thing="nothing")) == Heard()
