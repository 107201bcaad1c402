"""What somebody hears who cannot be shown a question twice: better words if they come soon enough, else the first."""

from __future__ import annotations

import time
from collections.abc import Callable

from mintpilot.core.ports import SPEAKING_S, BetterWords
from mintpilot.core.query import Question


def words_to_speak(
    question: Question, better: BetterWords | None, *, clock: Callable[[], float] = time.monotonic
) -> tuple[Question, float | None]:
    """The question as it is spoken, and how long its words were waited for, seconds; None where they are the first.

    Args:
        question: in its first words.
        better: better ones that may be ready within `SPEAKING_S`; None: there will be none.
        clock: seconds, never going back.
    """
    if better is None:
        return question, None
    begun_s = clock()
    other = better.wait(SPEAKING_S)
    return (question, None) if other is None else (other, clock() - begun_s)
