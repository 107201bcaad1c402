"""Check of operators: whoever answers."""

from __future__ import annotations

import math
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from concurrent.futures import TimeoutError as Late
from dataclasses import replace

from mintpilot.conformance.sample import require, sample_problem
from mintpilot.core.errors import ConformanceError
from mintpilot.core.ports import BetterWords, Operator
from mintpilot.core.query import Answer, Literal, Query, Question, Reply, Saying, SayingKind

HANGS_S = 20.0
"""An operator that has not come back so long after its patience has run out hangs."""
_HOSTILE = "Is it <b>the box</b>?\n\x1b[31m" + "very " * 200 + "red \N{BLACK STAR}"


def check_operator(make: Callable[[], Operator], *, patience_s: float = 1.0) -> None:
    """Puts questions about each gap of a small mission, in hostile words and with better ones too; tells something.

    Args:
        make: makes a fresh operator; called more than once. Nobody needs to be there: silence is a valid reply.
        patience_s: how long an answer is waited for, seconds.

    Raises:
        ConformanceError: it breaks the contract of `mintpilot.core.ports.Operator`.
    """
    operator = make()
    operator.tell("The drone is on its way.")
    operator.tell(_HOSTILE)
    for gap in sample_problem().gaps:
        literal = Literal(gap=gap.id, values=frozenset(gap.values[:1]), saying=Saying(kind=SayingKind.VALUE))
        for text in (f"Is {gap.description} as hoped?", _HOSTILE):
            question = Question(
                query=Query(literals=(literal,)), text=text, yes_means="I fly on", no_means="I fly round", gaps=(gap,)
            )
            _check_answer(_asked(operator, question, patience_s), operator, patience_s)
    later = _asked(operator, question, patience_s, _Better(question))
    _check_answer(later, operator, patience_s)
    impatient = _asked(make(), question, 0.0)
    _check_answer(impatient, operator, math.inf)


class _Better(BetterWords):
    """Better words that are ready at once."""

    done = True

    def __init__(self, question: Question) -> None:
        self._question = replace(question, text="Is it so?")

    def wait(self, timeout_s: float) -> Question | None:  # noqa: ARG002
        """The question."""
        return self._question


def _asked(operator: Operator, question: Question, patience_s: float, better: BetterWords | None = None) -> Answer:
    pool = ThreadPoolExecutor(1)
    given = () if better is None else (better,)
    try:
        return pool.submit(operator.ask, question, patience_s, *given).result(patience_s + HANGS_S)
    except TypeError as error:
        raise ConformanceError(
            f"{type(operator).__name__}: `ask` cannot be called with better words ({error}); it takes the question, "
            "the patience and, optionally, `better`"
        ) from error
    except Late:
        raise ConformanceError(
            f"{type(operator).__name__}: `ask` has not returned {HANGS_S:g} s after its patience of {patience_s:g} s "
            "ran out; silence must come back as Reply.TIMEOUT"
        ) from None
    finally:
        pool.shutdown(wait=False)


def _check_answer(answer: Answer, operator: Operator, patience_s: float) -> None:
    require(isinstance(answer.reply, Reply), operator, f"replied {answer.reply!r}; one of {[*Reply]} it must be")
    sound = math.isfinite(answer.latency_s) and answer.latency_s >= 0
    require(sound, operator, f"latency_s = {answer.latency_s}: finite and not below 0 it must be")
    late = answer.reply is not Reply.TIMEOUT and answer.command is None and answer.latency_s > patience_s + HANGS_S
    require(not late, operator, f"answered after {answer.latency_s:.1f} s, its patience was {patience_s:g} s")
