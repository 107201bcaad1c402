"""A model may suggest a reading to be read back, and nothing else."""

from __future__ import annotations

import json

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mintpilot.core.query import Question, Reply
from mintpilot.core.reading import AnsweredBy, Reading, ReadingKind, guarded_replies
from mintpilot.language.answer_model import read_with_model
from mintpilot.language.answers import read_answer
from mintpilot.models.doubles import FunctionModel, NoModel

from . import questions

HOSTILE = st.one_of(
    st.text(max_size=200),
    st.sampled_from(["yes", "no", "unsure", "other", "land"]).map(lambda word: json.dumps({"reading": word})),
)
STRANGE = "the crimson fellow yonder"


def _agreeing(prompt: str) -> str:
    return json.dumps({"reading": "no" if "the opposite" in prompt else "yes"})


def _says(reading: str) -> FunctionModel:
    return FunctionModel(lambda _: json.dumps({"reading": reading}))


def _read(text: str, question: Question, model: object, **more: object) -> Reading:
    return read_with_model(text, question, model, guarded=guarded_replies(question), **more)  # type: ignore[arg-type]


def test_a_model_that_agrees_with_itself_suggests_what_the_rules_do_not_know() -> None:
    assert _read(STRANGE, questions.BOX, NoModel()).kind is ReadingKind.AGAIN
    suggested = _read(STRANGE, questions.BOX, FunctionModel(_agreeing))
    assert (suggested.label, suggested.by) == ("read-back:yes", "model")


def test_a_model_that_always_says_the_same_is_not_believed() -> None:
    for reading in ("yes", "no", "unsure", "other", "command"):
        assert _read(STRANGE, questions.BOX, _says(reading)).kind is ReadingKind.AGAIN


def test_the_rules_come_first() -> None:
    for text in ("no", "stop", "the blue one", "why?", "I don't know"):
        plain = read_answer(text, questions.BOX, guarded=guarded_replies(questions.BOX))
        assert _read(text, questions.BOX, FunctionModel(_agreeing)) == plain


@pytest.mark.parametrize(
    "text",
    [
        "splendid air but not for long",
        "splendid air?",
        "splendid air 🚫",
        "ｓplendid air",
        "perhaps splendid air",
        "splendid air, they say",
    ],
)
def test_a_veto_keeps_the_model_out(text: str) -> None:
    asked: list[str] = []
    model = FunctionModel(lambda prompt: asked.append(prompt) or _agreeing(prompt))
    assert _read(text, questions.SMOKE, model).kind is ReadingKind.AGAIN
    assert not asked


def test_an_answer_to_a_read_back_is_never_given_to_a_model() -> None:
    model = FunctionModel(_agreeing)
    assert _read(STRANGE, questions.SMOKE, model, pending=Reply.YES).kind is ReadingKind.AGAIN
    assert _read(STRANGE, questions.SMOKE, model, by=AnsweredBy.KEY).kind is ReadingKind.AGAIN


@settings(deadline=None, max_examples=200)
@given(st.text(max_size=60), HOSTILE, st.sampled_from([questions.SMOKE, questions.ROOM, questions.BOX]))
def test_no_model_settles_anything_plainly(answer: str, said: str, question: Question) -> None:
    plain = read_answer(answer, question, guarded=guarded_replies(question))
    for model in (FunctionModel(_agreeing), FunctionModel(lambda _: said)):
        read = _read(answer, question, model)
        assert read == plain or (read.kind is ReadingKind.READ_BACK and read.by == "model")
