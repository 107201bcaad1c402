"""Better words that come later, and answers that say more than was asked."""

from __future__ import annotations

import threading
from dataclasses import replace

import numpy as np
import pytest
from tests.language import questions

from mintpilot.core.gap import PASSABLE
from mintpilot.core.mission import AskingSettings
from mintpilot.core.query import (
    NO_PART,
    YES_PART,
    Answer,
    Evidence,
    Literal,
    Query,
    Question,
    Reply,
    Saying,
    SayingKind,
)
from mintpilot.mission.belief_state import BeliefState, update
from mintpilot.mission.rewording import Rewording
from mintpilot.reasoning.belief import prior_belief

SETTINGS = AskingSettings()


def better(question: Question) -> Question:
    return replace(question, text="Better?", worded_by="tiny", yes_means="lies", no_means="lies")


def test_better_words_come_while_the_first_ones_are_shown() -> None:
    go_on = threading.Event()

    def improve(question: Question) -> Question:
        go_on.wait(20)
        return better(question)

    words = Rewording(improve, questions.SMOKE)
    assert words.wait(0.0) is None
    assert not words.done
    go_on.set()
    made = words.wait(20.0)
    assert made is not None
    assert (made.text, made.worded_by) == ("Better?", "tiny")


def test_only_words_are_taken_over() -> None:
    def improve(question: Question) -> Question:
        return better(questions.ROOM)

    made = Rewording(improve, questions.SMOKE).wait(20.0)
    assert made is not None
    assert replace(made, text=questions.SMOKE.text, worded_by=questions.SMOKE.worded_by) == questions.SMOKE


def broken(question: Question) -> Question:
    raise ConnectionResetError


@pytest.mark.parametrize("improve", [broken, lambda question: question, lambda question: None])
def test_without_better_words_there_is_nothing_to_wait_for(improve) -> None:
    words = Rewording(improve, questions.SMOKE)
    assert words.wait(20.0) is None
    assert words.done


def cut(gap: str, *values: str) -> Query:
    said = Saying(kind=SayingKind.VALUE, value=values[0])
    return Query(literals=(Literal(gap=gap, values=frozenset(values), saying=said),))


def said(query: Query) -> Evidence:
    return Evidence(query=query, part=YES_PART)


def beliefs() -> BeliefState:
    gaps = (questions.SMOKE_GAP, questions.BOX_GAP)
    return BeliefState(map=None, belief=prior_belief(gaps))  # type: ignore[arg-type]


def heard(query: Query, reply: Reply, *also: Evidence, error: float = 0.0):
    answer = Answer(reply=reply, latency_s=1.0, also=also)
    return update(beliefs(), query, answer, replace(SETTINGS, answer_error=error))


BOX = questions.BOX_GAP.id
RED = questions.BOX.query


def test_what_is_said_beyond_the_question_is_learnt() -> None:
    result = heard(RED, Reply.NO, said(cut(BOX, "box-2")))
    assert result.state.belief.probability_of(BOX, "box-2") == 1.0
    assert result.state.asked == (Evidence(query=RED, part=NO_PART),)
    assert not result.extra_refused


def test_one_utterance_is_one_piece_of_evidence() -> None:
    """``Not the red one, the blue one`` may be wrong as a whole: it counts as one answer to 'is it blue'."""
    result = heard(RED, Reply.NO, said(cut(BOX, "box-2")), error=0.1)
    prior = np.array(questions.BOX_GAP.prior)
    mass = prior * np.array([0.1, 0.9, 0.1])
    assert result.state.belief.marginal(BOX) == pytest.approx(mass / mass.sum())


def test_what_goes_against_the_answer_is_left_out() -> None:
    result = heard(RED, Reply.YES, said(cut(BOX, "box-2")))
    assert result.extra_refused
    assert result.state.belief.probability_of(BOX, "box-1") == 1.0


def test_beyond_the_question_no_region_is_opened() -> None:
    smoke = questions.SMOKE_GAP.id
    result = heard(RED, Reply.NO, said(cut(smoke, PASSABLE)))
    assert result.state.belief.probability_of(smoke, PASSABLE) == 1.0
    assert smoke not in result.state.confirmed


@pytest.mark.parametrize("reply", [Reply.UNSURE, Reply.TIMEOUT])
def test_without_an_answer_nothing_is_learnt(reply: Reply) -> None:
    assert heard(RED, reply, said(cut(BOX, "box-2"))).state.belief.marginal(BOX) == pytest.approx(
        questions.BOX_GAP.prior
    )


def test_cuts_about_what_nobody_knows_are_ignored() -> None:
    result = heard(RED, Reply.NO, said(cut("target:9", "x")))
    assert result.state.belief.probability_of(BOX, "box-1") == 0.0
    assert not result.extra_refused
