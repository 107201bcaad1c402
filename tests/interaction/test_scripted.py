"""Operators without a person."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.driving import ask as put

from mintpilot.core.errors import InputError
from mintpilot.core.gap import GapKind, KnowledgeGap
from mintpilot.core.inputs import Ordered, QuestionShown
from mintpilot.core.query import Answer, Combine, Literal, Order, Query, Question, Reply, Saying, SayingKind
from mintpilot.core.think_time import ThinkTime
from mintpilot.interaction.scripted import FunctionOperator, RecordedOperator, ScriptedOperator


def gap(name: str) -> KnowledgeGap:
    return KnowledgeGap(
        id=name, kind=GapKind.OBSTACLE, subject=name, description=f"the {name}", values=("a", "b", "c"),
        prior=(0.5, 0.25, 0.25), position_m=(0, 0, 0),
    )  # fmt: skip


def question(*literals: tuple[str, set[str]], combine: Combine = Combine.ALL) -> Question:
    said = Saying(kind=SayingKind.VALUE)
    parts = tuple(Literal(gap=name, values=frozenset(values), saying=said) for name, values in literals)
    query = Query(literals=parts, combine=combine)
    return Question(query=query, text="?", yes_means="", no_means="", gaps=tuple(gap(g) for g in query.gap_ids))


class Truth:
    """Knows what it is given."""

    def __init__(self, **values: str) -> None:
        self.values = values

    def value_of(self, gap: KnowledgeGap) -> str | None:
        return self.values.get(gap.id)


def ask(asked: Question, seed: int = 0, **options) -> Answer:
    rng = np.random.default_rng(seed)
    return put(ScriptedOperator(Truth(x="a", y="b"), rng=rng, **options), asked, 10.0)


def test_the_truth_is_told():
    assert ask(question(("x", {"a"}))).reply is Reply.YES
    assert ask(question(("x", {"b", "c"}))).reply is Reply.NO
    both = ("x", {"a"}), ("y", {"a"})
    assert ask(question(*both)).reply is Reply.NO
    assert ask(question(*both, combine=Combine.ANY)).reply is Reply.YES


def test_latency_is_reported_and_beyond_the_patience_it_is_silence():
    assert ask(question(("x", {"a"})), think=ThinkTime(4.5, 4.5)).latency_s == 4.5
    late = ask(question(("x", {"a"})), think=ThinkTime(11, 11))
    assert (late.reply, late.latency_s) == (Reply.TIMEOUT, 10.0)


def test_what_has_no_truth_is_unsure():
    assert ask(question(("z", {"a"}))).reply is Reply.UNSURE
    assert ask(question(("x", {"a"}), ("z", {"a"}), combine=Combine.ANY)).reply is Reply.UNSURE


def test_certain_rates():
    asked = question(("x", {"a"}))
    assert ask(asked, answer_error=1).reply is Reply.NO
    assert ask(asked, unsure_rate=1).reply is Reply.UNSURE
    assert ask(asked, silence_rate=1).reply is Reply.TIMEOUT


@settings(deadline=None, max_examples=20)
@given(seed=st.integers(0, 10_000), unsure=st.floats(0, 1))
def test_doubt_does_not_change_who_errs(seed, unsure):
    """The same seed errs at the same questions, whatever the other rates are."""
    asked = question(("x", {"a"}))
    plain = ScriptedOperator(Truth(x="a"), rng=np.random.default_rng(seed), answer_error=0.3)
    doubting = ScriptedOperator(Truth(x="a"), rng=np.random.default_rng(seed), answer_error=0.3, unsure_rate=unsure)
    for _ in range(30):
        sure, maybe = put(plain, asked, 9).reply, put(doubting, asked, 9).reply
        assert maybe in (sure, Reply.UNSURE)


def test_errors_come_at_their_rate():
    operator = ScriptedOperator(Truth(x="a"), rng=np.random.default_rng(1), answer_error=0.1)
    wrong = sum(put(operator, question(("x", {"a"})), 9).reply is Reply.NO for _ in range(5000))
    assert 400 < wrong < 600


@pytest.mark.parametrize("options", [{"answer_error": 1.5}, {"unsure_rate": -0.1}, {"silence_rate": float("nan")}])
def test_rates_that_are_none_are_refused(options):
    with pytest.raises(InputError, match="probability from 0 to 1"):
        ScriptedOperator(Truth(), rng=np.random.default_rng(0), **options)


def test_negative_latency_is_refused():
    with pytest.raises(InputError, match="from 0 on"):
        ScriptedOperator(Truth(), rng=np.random.default_rng(0), think=ThinkTime(-1, 2))


def test_recorded_answers_come_in_order_then_silence():
    slow = Answer(reply=Reply.NO, latency_s=7.0)
    operator = RecordedOperator([Reply.YES, slow])
    asked = question(("x", {"a"}))
    operator.tell("hello")
    answers = [put(operator, asked, 8.0 if n == 1 else 5.0) for n in range(3)]
    assert [a.reply for a in answers] == [Reply.YES, Reply.NO, Reply.TIMEOUT]
    assert [a.latency_s for a in answers] == [0.0, 7.0, 5.0]
    assert [q.text for q in operator.questions] == [asked.text] * 3
    assert operator.told == ["hello"]


def test_an_answer_takes_its_time_and_better_words_change_nothing():
    asked = question(("x", {"a"}))
    operator = ScriptedOperator(Truth(x="a"), rng=np.random.default_rng(0), think=ThinkTime(2.0, 2.0))
    operator.show(replace(asked, id="q1"), 10.0)
    shown = operator.poll(5.0)
    assert [type(event) for event in shown] == [QuestionShown]
    operator.show(replace(asked, id="q1", text="Better?"), 9.0)
    assert operator.poll(6.9) == ()
    (answered,) = operator.poll(7.5)
    assert (answered.time_s, answered.question, answered.answer.reply) == (7.0, "q1", Reply.YES)
    assert operator.poll(20.0) == ()


def test_thinking_is_drawn_between_its_bounds_and_disturbs_no_answer():
    times = [ask(question(("x", {"a"})), think=ThinkTime(2, 8), seed=s).latency_s for s in range(50)]
    assert 2 <= min(times) < 3 < 7 < max(times) <= 8
    same = [ask(question(("x", {"a"})), unsure_rate=0.5, think=t, seed=3).reply for t in (ThinkTime(), ThinkTime(2, 8))]
    assert same[0] is same[1]


def test_who_thinks_longer_than_the_patience_still_answers_while_the_question_is_open():
    operator = ScriptedOperator(Truth(x="a"), rng=np.random.default_rng(0), think=ThinkTime(5, 5))
    operator.show(replace(question(("x", {"a"})), id="q1"), 3.0)
    operator.poll(0.0)
    assert [event.answer.reply for event in operator.poll(5.0)] == [Reply.YES]


def test_what_is_withdrawn_is_not_answered():
    operator = ScriptedOperator(Truth(x="a"), rng=np.random.default_rng(0), think=ThinkTime(2.0, 2.0))
    operator.show(replace(question(("x", {"a"})), id="q1"), 10.0)
    operator.poll(0.0)
    operator.withdraw("q1", "nobody needs to know any more")
    assert operator.poll(5.0) == ()


def test_recorded_orders_come_when_their_time_has_come_and_instead_of_answers():
    operator = RecordedOperator([Order.LAND], orders=[(1.0, Order.HOLD), (3.0, Order.CONTINUE)])
    assert operator.poll(0.5) == ()
    assert [event.order for event in operator.poll(1.0)] == [Order.HOLD]
    operator.show(replace(question(("x", {"a"})), id="q1"), 10.0)
    orders = [event.order for event in operator.poll(3.5) if isinstance(event, Ordered)]
    assert orders == [Order.CONTINUE, Order.LAND]


def test_a_function_answers():
    operator = FunctionOperator(lambda asked, patience_s: Reply.YES if patience_s > 3 else Reply.UNSURE)
    assert put(operator, question(("x", {"a"})), 5).reply is Reply.YES
    assert put(operator, question(("x", {"a"})), 2).reply is Reply.UNSURE
