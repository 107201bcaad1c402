"""Operators without a person: one who knows the truth, one who repeats, one made of a function."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace

import numpy as np

from mintpilot.core.errors import InputError
from mintpilot.core.gap import GapKind, kind_of
from mintpilot.core.inputs import Answered, OperatorInput, Ordered, QuestionShown
from mintpilot.core.ports import Operator, TruthOracle
from mintpilot.core.query import YES_PART, Answer, Order, Question, Reply, answer_for
from mintpilot.core.think_time import ThinkTime


@dataclass(slots=True)
class _Shown:
    """A question that is open."""

    question: Question
    patience_s: float
    answer: Answer | None = None
    """None until it is known when it was shown."""
    due_s: float = 0.0


class _Script(Operator):
    """What the operators of this file share: questions are seen at once, and answered after the answer's latency."""

    attended = False
    hears_once = True

    def __init__(self, name: str) -> None:
        self._name = name
        self._open: dict[str, _Shown] = {}

    def show(self, question: Question, patience_s: float) -> None:
        """Sees the question; better words for an open one change nothing."""
        if question.id in self._open:
            self._open[question.id].question = question
        else:
            self._open[question.id] = _Shown(question, patience_s)

    def withdraw(self, question: str, why: str) -> None:  # noqa: ARG002
        """Answers no more."""
        self._open.pop(question, None)

    def tell(self, text: str) -> None:
        """Nobody is there: nothing happens."""

    def poll(self, time_s: float) -> tuple[OperatorInput, ...]:
        """Questions that were shown, and answers whose time has come."""
        events: list[OperatorInput] = []
        for name, shown in tuple(self._open.items()):
            if shown.answer is None:
                events.append(QuestionShown(time_s=time_s, question=name))
                made = self._reply(shown.question, shown.patience_s)
                if isinstance(made, Order):
                    del self._open[name]
                    events.append(Ordered(time_s=time_s, order=made, operator=self._name, text=made.value))
                    continue
                shown.answer, shown.due_s = made, time_s + made.latency_s
            if shown.due_s <= time_s:
                del self._open[name]
                if shown.answer.reply is not Reply.TIMEOUT:
                    answered = Answered(time_s=shown.due_s, question=name, answer=shown.answer, operator=self._name)
                    events.append(answered)
        return tuple(events)

    def _reply(self, question: Question, patience_s: float) -> Answer | Order:
        raise NotImplementedError


class ScriptedOperator(_Script):
    """Answers from the truth, with as much error, doubt and silence as is asked for.

    Each yes/no question draws the same amount of random numbers, so that one rate does not disturb the others; a wrong
    answer to a choice draws one more.

    Args:
        truth: knows the value of every gap.
        rng: decides on errors, doubt and silence.
        answer_error: probability that an answer names another part of the query than the true one [e]; all others are
            equally likely.
        unsure_rate: probability of "I don't know".
        silence_rate: probability of no answer at all.
        think: mission time that an answer takes; longer than the patience is silence.

    Raises:
        InputError: a rate is not a probability.
    """

    def __init__(
        self,
        truth: TruthOracle,
        *,
        rng: np.random.Generator,
        answer_error: float = 0.0,
        unsure_rate: float = 0.0,
        silence_rate: float = 0.0,
        think: ThinkTime = ThinkTime(),  # noqa: B008  (a value)
    ) -> None:
        super().__init__("scripted")
        for name, rate in (
            ("answer_error", answer_error),
            ("unsure_rate", unsure_rate),
            ("silence_rate", silence_rate),
        ):
            if not 0 <= rate <= 1:
                raise InputError(f"scripted operator {name} = {rate}: must be a probability from 0 to 1")
        self._truth = truth
        self._rng = rng
        self._answer_error = answer_error
        self._unsure_rate = unsure_rate
        self._silence_rate = silence_rate
        self._think = think
        self._thinking = rng.spawn(1)[0]

    def answer(self, question: Question, patience_s: float) -> Answer:
        """The true answer to the question's query (its words are not looked at), or what the rates make of it.

        A query that speaks of a gap without a true value is answered UNSURE; a briefing before take-off with yes.
        """
        answer = self._thought_of(question)
        late = answer is None or answer.latency_s > patience_s
        return Answer(reply=Reply.TIMEOUT, latency_s=patience_s) if late or answer is None else answer

    def _thought_of(self, question: Question) -> Answer | None:
        """What it says once it has thought, however long that takes; None: nothing."""
        if any(kind_of(name) is GapKind.GO for name in question.query.gap_ids):
            return answer_for(question.query, YES_PART, text="yes")
        wrong, unsure, silent = self._rng.random(3) < (self._answer_error, self._unsure_rate, self._silence_rate)
        latency_s = self._think.draw(self._thinking)
        if silent:
            return None
        part = self._true_part(question)
        if part is None or unsure:
            return Answer(reply=Reply.UNSURE, latency_s=latency_s, text="don't know")
        query = question.query
        if wrong:
            others = [other for other in range(query.part_count) if other != part]
            # The only other part of a yes/no query needs no draw.
            part = others[0] if len(others) == 1 else others[int(self._rng.integers(len(others)))]
        return answer_for(query, part, latency_s=latency_s, text=query.part_words(part))

    def _reply(self, question: Question, patience_s: float) -> Answer:
        # A deadline may move while the drone does: who thinks for longer is told by the question's end.
        return self._thought_of(question) or Answer(reply=Reply.TIMEOUT, latency_s=patience_s)

    def _true_part(self, question: Question) -> int | None:
        values = {gap.id: value for gap in question.gaps if (value := self._truth.value_of(gap)) is not None}
        if any(gap_id not in values for gap_id in question.query.gap_ids):
            return None
        return question.query.part_of(values)


class RecordedOperator(_Script):
    """Gives recorded answers in their order, then stays silent; gives recorded orders when their time has come.

    Args:
        answers: what to reply to the first question, the second …; a bare `Reply` takes no time, an `Order` is given
            instead of an answer.
        orders: (mission clock in seconds, order), in their order.

    Attributes:
        questions: the questions that came, oldest first.
        told: the messages that came, oldest first.
    """

    def __init__(self, answers: Iterable[Answer | Reply | Order], orders: Iterable[tuple[float, Order]] = ()) -> None:
        super().__init__("recorded")
        self._answers = iter(answers)
        self._orders = deque(orders)
        self.questions: list[Question] = []
        self.told: list[str] = []

    def tell(self, text: str) -> None:
        """Keeps the message."""
        self.told.append(text)

    def poll(self, time_s: float) -> tuple[OperatorInput, ...]:
        """What is due: orders first, then answers."""
        given: list[OperatorInput] = []
        while self._orders and self._orders[0][0] <= time_s:
            _, order = self._orders.popleft()
            given.append(Ordered(time_s=time_s, order=order, operator=self._name, text=order.value))
        return (*given, *super().poll(time_s))

    def _reply(self, question: Question, patience_s: float) -> Answer | Order:
        self.questions.append(question)
        return _as_answer(next(self._answers, Reply.TIMEOUT), patience_s)


class FunctionOperator(_Script):
    """Answers with whatever a function returns.

    Args:
        answer: called with the question and the patience in seconds.
    """

    def __init__(self, answer: Callable[[Question, float], Answer | Reply | Order]) -> None:
        super().__init__("function")
        self._function = answer

    def _reply(self, question: Question, patience_s: float) -> Answer | Order:
        return _as_answer(self._function(question, patience_s), patience_s)


def _as_answer(answer: Answer | Reply | Order, patience_s: float) -> Answer | Order:
    """A bare reply as an answer; silence takes the whole patience."""
    if isinstance(answer, Order):
        return answer
    if isinstance(answer, Answer):
        return replace(answer)
    silent = answer is Reply.TIMEOUT
    return Answer(reply=answer, latency_s=patience_s if silent else 0.0, text="" if silent else answer.value)
