"""Check of operators: whoever answers."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import replace
from typing import TypeVar

from mintpilot.conformance.sample import require, sample_problem
from mintpilot.core.inputs import Answered, OperatorInput, Ordered, QuestionShown
from mintpilot.core.ports import Operator
from mintpilot.core.query import Literal, Order, Query, Question, Reply, Saying, SayingKind

MOST_S = 0.5
"""A call that takes longer blocks: the drone would hear no order meanwhile."""
_HOSTILE = "Is it <b>the box</b>?\n\x1b[31m" + "very " * 200 + "red \N{BLACK STAR}"
_T = TypeVar("_T")


def check_operator(make: Callable[[], Operator], *, patience_s: float = 1.0) -> None:
    """Puts questions about each gap of a small mission, in hostile words and with better ones too; tells something.

    Args:
        make: makes a fresh operator; called more than once. Nobody needs to be there: silence is a valid reply.
        patience_s: how long an answer is waited for, seconds of mission clock.

    Raises:
        ConformanceError: it breaks the contract of `mintpilot.core.ports.Operator`.
    """
    operator = make()
    require(isinstance(operator.attended, bool), operator, f"attended = {operator.attended!r}: True or False")
    for text in ("The drone is on its way.", _HOSTILE):
        _timely(operator, "tell", lambda text=text: operator.tell(text))  # type: ignore[misc]
    time_s = 0.0
    for number, gap in enumerate(sample_problem().gaps):
        literal = Literal(gap=gap.id, values=frozenset(gap.values[:1]), saying=Saying(kind=SayingKind.VALUE))
        question = Question(
            query=Query(literals=(literal,)),
            text=f"Is {gap.description} as hoped?",
            yes_means="I fly on",
            no_means="I fly round",
            gaps=(gap,),
            id=f"q{number}",
        )
        _check_question(operator, question, time_s, patience_s)
        time_s += 2 * patience_s
    _timely(operator, "withdraw", lambda: operator.withdraw("never shown", "nobody asked that"))
    require(_poll(operator, time_s) == (), operator, "it answers though nothing is open")


def _check_question(operator: Operator, question: Question, time_s: float, patience_s: float) -> None:
    """Shows it, shows it again in other words, polls through its patience, and withdraws it."""
    _timely(operator, "show", lambda: operator.show(question, patience_s))
    events = list(_poll(operator, time_s))
    if not any(isinstance(event, Answered) for event in events):
        _timely(operator, "show", lambda: operator.show(replace(question, text=_HOSTILE), patience_s))
    for share in (0.25, 0.5, 0.75, 1.0):
        events += _poll(operator, time_s + share * patience_s)
    answers = [e for e in events if isinstance(e, Answered)]
    shown = [e for e in events if isinstance(e, QuestionShown)]
    require(len(shown) <= 1, operator, f"one question was shown {len(shown)} times; better words are no new question")
    require(len(answers) <= 1, operator, f"{len(answers)} answers to one question; one at most")
    for event in events:
        rule = f"it brings {event!r} with a time outside {time_s:g} to {time_s + patience_s:g} s"
        require(time_s <= event.time_s <= time_s + patience_s, operator, rule)
    for event in answers:
        require(event.question == question.id, operator, f"it answers '{event.question}'; '{question.id}' was asked")
        answer = event.answer
        require(isinstance(answer.reply, Reply), operator, f"replied {answer.reply!r}; one of {[*Reply]} it must be")
        sound = math.isfinite(answer.latency_s) and answer.latency_s >= 0
        require(sound, operator, f"latency_s = {answer.latency_s}: finite and not below 0 it must be")
    for event in events:
        if isinstance(event, Ordered):
            require(isinstance(event.order, Order), operator, f"ordered {event.order!r}; one of {[*Order]} it must be")
    _timely(operator, "withdraw", lambda: operator.withdraw(question.id, "the time is over"))


def _poll(operator: Operator, time_s: float) -> tuple[OperatorInput, ...]:
    return _timely(operator, "poll", lambda: operator.poll(time_s))


def _timely(operator: Operator, name: str, call: Callable[[], _T]) -> _T:
    begun = time.perf_counter()
    result = call()
    seconds = time.perf_counter() - begun
    require(seconds <= MOST_S, operator, f"`{name}` took {seconds:.2f} s; no method may block, {MOST_S} s at most")
    return result
