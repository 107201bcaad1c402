"""Operators without a person: one who knows the truth, one who repeats, one made of a function."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace

import numpy as np

from mintpilot.core.errors import InputError
from mintpilot.core.ports import BetterWords, Operator, TruthOracle
from mintpilot.core.query import Answer, Question, Reply, answer_for
from mintpilot.interaction.hearing import words_to_speak


class ScriptedOperator(Operator):
    """Answers from the truth, with as much error, doubt and silence as is asked for.

    Each yes/no question draws the same amount of random numbers, so that one rate does not disturb the others; a wrong
    answer to a choice draws one more. The latency
    is reported, not slept.

    Args:
        truth: knows the value of every gap.
        rng: decides on errors, doubt and silence.
        answer_error: probability that an answer names another part of the query than the true one [e]; all others are
            equally likely.
        unsure_rate: probability of "I don't know".
        silence_rate: probability of no answer at all.
        latency_s: seconds that an answer takes; longer than the patience is silence.

    Raises:
        InputError: a rate is not a probability, or the latency is negative.
    """

    def __init__(
        self,
        truth: TruthOracle,
        *,
        rng: np.random.Generator,
        answer_error: float = 0.0,
        unsure_rate: float = 0.0,
        silence_rate: float = 0.0,
        latency_s: float = 3.0,
    ) -> None:
        for name, rate in (
            ("answer_error", answer_error),
            ("unsure_rate", unsure_rate),
            ("silence_rate", silence_rate),
        ):
            if not 0 <= rate <= 1:
                raise InputError(f"scripted operator {name} = {rate}: must be a probability from 0 to 1")
        if not latency_s >= 0:
            raise InputError(f"scripted operator latency_s = {latency_s}: must be 0 or more seconds")
        self._truth = truth
        self._rng = rng
        self._answer_error = answer_error
        self._unsure_rate = unsure_rate
        self._silence_rate = silence_rate
        self._latency_s = latency_s

    def ask(self, question: Question, patience_s: float, better: BetterWords | None = None) -> Answer:
        """The true answer to the question's query (its words are not looked at), or what the rates make of it.

        A query that speaks of a gap without a true value is answered UNSURE. Better words are waited for as by somebody
        to whom the question is spoken; they are no part of the latency.
        """
        _, better_s = words_to_speak(question, better)
        return replace(self._answer(question, patience_s), better_s=better_s)

    def _answer(self, question: Question, patience_s: float) -> Answer:
        wrong, unsure, silent = self._rng.random(3) < (self._answer_error, self._unsure_rate, self._silence_rate)
        if silent or self._latency_s > patience_s:
            return Answer(reply=Reply.TIMEOUT, latency_s=patience_s)
        part = self._true_part(question)
        if part is None or unsure:
            return Answer(reply=Reply.UNSURE, latency_s=self._latency_s, text="don't know")
        query = question.query
        if wrong:
            others = [other for other in range(query.part_count) if other != part]
            # The only other part of a yes/no query needs no draw.
            part = others[0] if len(others) == 1 else others[int(self._rng.integers(len(others)))]
        return answer_for(query, part, latency_s=self._latency_s, text=query.part_words(part))

    def tell(self, text: str) -> None:
        """Nobody is there: nothing happens."""

    def _true_part(self, question: Question) -> int | None:
        values = {gap.id: value for gap in question.gaps if (value := self._truth.value_of(gap)) is not None}
        if any(gap_id not in values for gap_id in question.query.gap_ids):
            return None
        return question.query.part_of(values)


class RecordedOperator(Operator):
    """Gives recorded answers in their order, then stays silent. Keeps what it was asked and told.

    Args:
        answers: what to reply to the first question, the second …; a bare `Reply` takes no time.

    Attributes:
        questions: the questions that came, oldest first.
        told: the messages that came, oldest first.
    """

    def __init__(self, answers: Iterable[Answer | Reply]) -> None:
        self._answers = iter(answers)
        self.questions: list[Question] = []
        self.told: list[str] = []

    def ask(self, question: Question, patience_s: float, better: BetterWords | None = None) -> Answer:
        """The next recorded answer; `Reply.TIMEOUT` when none is left."""
        spoken, better_s = words_to_speak(question, better)
        self.questions.append(spoken)
        return _as_answer(next(self._answers, Reply.TIMEOUT), patience_s, better_s)

    def tell(self, text: str) -> None:
        """Keeps the message."""
        self.told.append(text)


class FunctionOperator(Operator):
    """Answers with whatever a function returns.

    Args:
        answer: called with the question and the patience in seconds.
    """

    def __init__(self, answer: Callable[[Question, float], Answer | Reply]) -> None:
        self._answer = answer

    def ask(self, question: Question, patience_s: float, better: BetterWords | None = None) -> Answer:
        """What the function says."""
        spoken, better_s = words_to_speak(question, better)
        return _as_answer(self._answer(spoken, patience_s), patience_s, better_s)

    def tell(self, text: str) -> None:
        """Nobody is there: nothing happens."""


def _as_answer(answer: Answer | Reply, patience_s: float, better_s: float | None) -> Answer:
    """A bare reply as an answer; silence takes the whole patience."""
    if isinstance(answer, Answer):
        return replace(answer, better_s=better_s)
    silent = answer is Reply.TIMEOUT
    return Answer(
        reply=answer,
        latency_s=patience_s if silent else 0.0,
        text="" if silent else answer.value,
        better_s=better_s,
    )
