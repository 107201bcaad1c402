"""Better words for a question, made on a thread of their own while the first ones are already shown."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from dataclasses import replace
from typing import TypeAlias

from mintpilot.core.query import Question

Improve: TypeAlias = Callable[[Question], Question]
"""Makes better words, or gives the question back as it is. May take long, or fail."""


class Rewording:
    """Begins to make better words at once. A daemon thread: one that hangs stops neither mission nor program.

    Only words are taken over: the query, the gaps and the consequences stay those of the question.

    Attributes:
        seconds: how long it took, once it is done.
    """

    def __init__(self, improve: Improve, question: Question) -> None:
        self._improve = improve
        self._question = question
        self._better: Question | None = None
        self._begun = time.monotonic()
        self.seconds = 0.0
        self._finished = threading.Event()
        threading.Thread(target=self._work, daemon=True, name="mintpilot rewording").start()

    @property
    def done(self) -> bool:
        """True when there is nothing left to wait for: better words are here, or will never be."""
        return self._finished.is_set()

    def wait(self, timeout_s: float) -> Question | None:
        """The question in better words, after at most ``timeout_s`` seconds; None while there are none. No errors."""
        return self._better if self._finished.wait(max(0.0, timeout_s)) else None

    def _work(self) -> None:
        try:
            made = self._improve(self._question)
            if made.text != self._question.text:
                self._better = replace(self._question, text=made.text, worded_by=made.worded_by)
        except Exception:  # a stranger's model may fail in any way; the first words are good enough
            self._better = None
        finally:
            self.seconds = time.monotonic() - self._begun
            self._finished.set()
