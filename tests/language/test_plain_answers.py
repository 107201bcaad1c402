"""Plain answers of ordinary people: a No that explains itself, and confirmations that are none."""

from __future__ import annotations

from itertools import product

import pytest

from mintpilot.core.query import Question
from mintpilot.language import Reading, understand_answer

from . import questions

NOES = ("no", "nope", "nah", "negative", "no sorry")
OF_WAYS = ("please go around it", "it is not safe", "it is toxic", "find another way", "you should go around")
OF_ROOMS = ("we've searched it, it's empty", "they all came out", "all my patients are out", "here is nobody")
OF_THINGS = ("is other one", "is not this", "wrong one", "that one leaks", "not the red one")
DENIED = ("unable to", "cannot", "can't", "couldn't", "wouldn't", "not able to")
PENDING = ("let me", "will", "the lab must", "need to", "hard to", "failed to", "please", "who can", "waiting to")


@pytest.mark.parametrize(
    ("question", "reasons"), [(questions.SMOKE, OF_WAYS), (questions.ROOM, OF_ROOMS), (questions.BOX, OF_THINGS)]
)
def test_a_plain_no_stands_when_the_rest_says_the_same(question: Question, reasons: tuple[str, ...]) -> None:
    for no, reason in product(NOES, reasons):
        assert understand_answer(f"{no}, {reason}.", question).reading is Reading.NO, (no, reason)


@pytest.mark.parametrize("question", [questions.SMOKE, questions.ROOM, questions.BOX])
@pytest.mark.parametrize("verb", ["confirm", "confirm that", "say yes"])
def test_a_denied_or_pending_confirmation_settles_nothing(question: Question, verb: str) -> None:
    for head in (*DENIED, *PENDING):
        assert understand_answer(f"{head} {verb}", question).reply.value == "unsure", head
    assert understand_answer("I can confirm", question).reading is Reading.YES


@pytest.mark.parametrize(
    "text", ["you can go left", "please go up", "just go somewhere else", "the weather is fine", "visibility is fine"]
)
def test_consent_to_something_else_opens_no_region(text: str) -> None:
    assert understand_answer(text, questions.SMOKE).reading is not Reading.YES


@pytest.mark.parametrize("text", ["I can't breathe", "ok, not yet", "not all of them", "roger, out", "nobody is safe"])
def test_what_is_beside_the_point_empties_no_room(text: str) -> None:
    assert understand_answer(text, questions.ROOM).reading is not Reading.NO
