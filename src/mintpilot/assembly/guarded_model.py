"""A language model under guard: whatever it does, it costs bounded time, and its failing is told once."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from contextlib import suppress

from mintpilot.core.errors import DeviceError, MintPilotError
from mintpilot.core.message import Message, message
from mintpilot.core.ports import Completion, LanguageModel
from mintpilot.models.deadline import within

MOST_FAILURES = 3
"""So often in a row, and it is left alone for `REST_S`: a model that hangs must not slow every step down."""
REST_S = 20.0
SLACK_S = 0.3
"""A model's own time-out comes first; this much later it is no longer waited for."""
CLOSING_S = 5.0
_LONGEST = 20_000
"""Characters of an answer; what comes after them is thrown away."""


class GuardedModel(LanguageModel):
    """Passes prompts on. May be called from several threads.

    Args:
        model: the model that is not trusted.
        name: its registered name, for messages.
        clock: seconds, never going back.
    """

    def __init__(self, model: LanguageModel, name: str, *, clock: Callable[[], float] = time.monotonic) -> None:
        self._model = model
        self._name = name
        self._clock = clock
        self._lock = threading.Lock()
        self._failures = 0
        self._rests_until_s = float("-inf")
        self._remarks: list[Message] = []
        self._has_failed = False
        self._closed = False

    @property
    def name(self) -> str:
        """Its registered name."""
        return self._name

    def complete(self, prompt: str, *, schema: type | None, timeout_s: float) -> Completion:
        """One completion; see `LanguageModel.complete`. Every failure is a `DeviceError`."""
        if self._closed:
            raise DeviceError(f"language model '{self._name}' is closed: the mission is over")
        if self._clock() < self._rests_until_s:
            raise DeviceError(f"language model '{self._name}' failed {MOST_FAILURES} times and is left alone for now")
        try:
            answer = within(
                lambda: self._model.complete(prompt, schema=schema, timeout_s=timeout_s),
                timeout_s + SLACK_S,
                f"language model '{self._name}'",
            )
            text = str(answer.text)[:_LONGEST]
            made = Completion(
                text=text, model=str(answer.model)[:100], seconds=float(answer.seconds), tokens=int(answer.tokens)
            )
        except MintPilotError as error:
            self._fail(str(error))
            raise DeviceError(str(error)) from error
        except (AttributeError, TypeError, ValueError, OverflowError) as error:
            self._fail(f"language model '{self._name}' answered with something that is no completion")
            raise DeviceError(f"language model '{self._name}' answered with no completion") from error
        with self._lock:
            self._failures = 0
        return made

    def take_remarks(self) -> tuple[Message, ...]:
        """What there is to tell since it was last called: the first failure, once."""
        with self._lock:
            remarks, self._remarks = tuple(self._remarks), []
        return remarks

    def close(self) -> None:
        """Closes the model, where it can be closed; from now on every call fails. Waits `CLOSING_S` at most."""
        self._closed = True
        close = getattr(self._model, "close", None)
        if callable(close):
            with suppress(DeviceError):  # the mission is over: there is nobody left to be told
                within(close, CLOSING_S, f"language model '{self._name}'")

    def _fail(self, why: str) -> None:
        with self._lock:
            self._failures += 1
            if self._failures >= MOST_FAILURES:
                self._rests_until_s, self._failures = self._clock() + REST_S, 0
            if not self._has_failed:
                self._has_failed = True
                reason = why.removesuffix(": going on without it").rstrip(". ")
                self._remarks.append(
                    message("No help from the language model: {why}. The mission goes on with templates.", why=reason)
                )
