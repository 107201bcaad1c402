"""Operators without a person."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mintpilot.core.errors import InputError
from mintpilot.core.gap import GapKind, KnowledgeGap
from mintpilot.core.ports import SPEAKING_S
from mintpilot.core.query import Answer, Combine, Literal, Query, Question, Reply, Saying, SayingKind
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


def ask(asked: Question, **options) -> Answer:
    rng = np.random.default_rng(0)
    return ScriptedOperator(Truth(x="a", y="b"), rng=rng, **options).ask(asked, 10.0)


def test_the_truth_is_told():
    assert ask(question(("x", {"a"}))).reply is Reply.YES
    assert ask(question(("x", {"b", "c"}))).reply is Reply.NO
    both = ("x", {"a"}), ("y", {"a"})
    assert ask(question(*both)).reply is Reply.NO
    assert ask(question(*both, combine=Combine.ANY)).reply is Reply.YES


def test_latency_is_reported_and_beyond_the_patience_it_is_silence():
    assert ask(question(("x", {"a"})), latency_s=4.5).latency_s == 4.5
    late = ask(question(("x", {"a"})), latency_s=11)
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
        sure, maybe = plain.ask(asked, 9).reply, doubting.ask(asked, 9).reply
        assert maybe in (sure, Reply.UNSURE)


def test_errors_come_at_their_rate():
    operator = ScriptedOperator(Truth(x="a"), rng=np.random.default_rng(1), answer_error=0.1)
    wrong = sum(operator.ask(question(("x", {"a"})), 9).reply is Reply.NO for _ in range(5000))
    assert 400 < wrong < 600


@pytest.mark.parametrize("options", [{"answer_error": 1.5}, {"unsure_rate": -0.1}, {"silence_rate": float("nan")}])
def test_rates_that_are_none_are_refused(options):
    with pytest.raises(InputError, match="probability from 0 to 1"):
        ScriptedOperator(Truth(), rng=np.random.default_rng(0), **options)


def test_negative_latency_is_refused():
    with pytest.raises(InputError, match="latency_s"):
        ScriptedOperator(Truth(), rng=np.random.default_rng(0), latency_s=-1)


def test_recorded_answers_come_in_order_then_silence():
    slow = Answer(reply=Reply.NO, latency_s=7.0)
    operator = RecordedOperator([Reply.YES, slow])
    asked = question(("x", {"a"}))
    operator.tell("hello")
    answers = [operator.ask(asked, 5.0) for _ in range(3)]
    assert [a.reply for a in answers] == [Reply.YES, Reply.NO, Reply.TIMEOUT]
    assert [a.latency_s for a in answers] == [0.0, 7.0, 5.0]
    assert operator.questions == [asked] * 3
    assert operator.told == ["hello"]


class Words:
    """Better words, or none, and how long they were waited for."""

    done = True

    def __init__(self, words: Question | None) -> None:
        self.words, self.waited_s = words, 0.0

    def wait(self, timeout_s: float) -> Question | None:
        self.waited_s = timeout_s
        return self.words


@pytest.mark.parametrize("has_words", [True, False])
def test_who_hears_the_question_hears_the_better_words_if_they_come_in_time(has_words):
    asked = question(("x", {"a"}))
    words = Words(replace(asked, text="Better?") if has_words else None)
    heard: list[str] = []
    scripted = ScriptedOperator(Truth(x="a"), rng=np.random.default_rng(0))
    recorded = RecordedOperator([Reply.YES])
    function = FunctionOperator(lambda asked, patience_s: heard.append(asked.text) or Reply.YES)
    for operator in (scripted, recorded, function):
        answer = operator.ask(asked, 10.0, words)
        assert answer.reply is Reply.YES
        assert (answer.better_s is not None) is has_words
        assert words.waited_s == SPEAKING_S
    assert [q.text for q in recorded.questions] == heard == ["Better?" if has_words else "?"]


def test_a_function_answers():
    operator = FunctionOperator(lambda asked, patience_s: Reply.YES if patience_s > 3 else Reply.UNSURE)
    assert operator.ask(question(("x", {"a"})), 5).reply is Reply.YES
    assert operator.ask(question(("x", {"a"})), 2).reply is Reply.UNSURE
