"""A person at a terminal."""

from __future__ import annotations

import os
import select
import termios
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Protocol

from rich.console import Console, Group
from rich.text import Text

from mintpilot.core.errors import DeviceError
from mintpilot.core.ports import BetterWords, Operator, Understand
from mintpilot.core.query import Answer, Order, Query, Question, Reply
from mintpilot.core.reading import ReadingKind, reply_of
from mintpilot.interaction.screen_words import screen_words

_LONGEST_LINE = 4096
"""Bytes; what is typed beyond them without a line's end is thrown away."""
_KEYS = 18
"""Columns for what may be typed."""
_ANSWERS = (ReadingKind.YES, ReadingKind.NO, ReadingKind.UNSURE, ReadingKind.EVIDENCE)
"""Readings that answer; what would have to be read back is asked for again."""
_GLANCE_S = 0.05
"""While better words may come, it is looked for them so often."""


class Readable(Protocol):
    """Anything with a file descriptor: ``sys.stdin``, a pipe, a pseudo-terminal."""

    def fileno(self) -> int:
        """The file descriptor."""
        ...


@dataclass(slots=True)
class _Turn:
    """One question while it is open."""

    started_s: float
    patience_s: float
    better: BetterWords | None
    better_s: float | None = field(default=None, init=False)

    @property
    def deadline_s(self) -> float:
        return self.started_s + self.patience_s


class TerminalOperator(Operator):
    """Asks the person at a terminal, and never waits longer than it was told.

    Keys typed before a question was shown do not answer it. Lines that were piped in are kept: one for each question.
    Ctrl-C raises `KeyboardInterrupt` at once, for the caller to end the mission tidily.

    Args:
        console: where the question is shown; without a terminal plain text is written, no control codes.
        stdin: where the reply is read from, by its file descriptor (nothing else may read from it meanwhile).
        understand: what typed words mean.
        lang: of what stands around the questions.
        clock: seconds, never going back.

    Raises:
        DeviceError: ``stdin`` has no file descriptor to read from.
        UnknownNameError: the language is not known.
    """

    def __init__(
        self,
        console: Console,
        stdin: Readable,
        *,
        understand: Understand,
        lang: str = "en",
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        try:
            self._fd = stdin.fileno()
        except (OSError, ValueError, AttributeError) as error:
            raise DeviceError(
                f"the terminal operator cannot read from {stdin!r}: it needs an open standard input; "
                "use the scripted operator where nobody is there"
            ) from error
        self._console = console
        self._understand = understand
        self._words = screen_words(lang)
        self._clock = clock
        self._pending = b""
        self._ended = False

    def ask(self, question: Question, patience_s: float, better: BetterWords | None = None) -> Answer:
        """Shows the question with the consequences of Yes and No, and reads a reply for at most ``patience_s``.

        Better words are shown below the first ones when they come; the person may answer before. Words that do not map
        to an answer are asked for again once, within the same patience; then they count as "don't know". An empty line
        says nothing. The end of the input counts as silence.
        """
        self._drop_typed_ahead()
        turn = _Turn(self._clock(), patience_s, better)
        self._show(question, patience_s)
        asked_again = False
        while True:
            line = self._read_line(turn)
            if line is None:
                self._console.print(Text(self._words.silence, style="yellow"))
                return self._answer(turn, Reply.TIMEOUT)
            if line:
                reading = self._understand(line, question, max(0.0, turn.deadline_s - self._clock()))
                said = Answer(
                    reply=reply_of(reading, question),
                    latency_s=self._clock() - turn.started_s,
                    text=line,
                    command=reading.order if reading.order is not Order.CONTINUE else None,
                    also=tuple((Query(literals=(literal,)), holds) for literal, holds in reading.evidence),
                    understood_by=reading.by,
                    better_s=turn.better_s,
                )
                if reading.kind in _ANSWERS or said.command is not None:
                    return said
                if asked_again:
                    self._console.print(Text(self._words.given_up, style="yellow"))
                    return said
                asked_again = True
                self._console.print(Text(self._words.repeat, style="yellow"))
            self._prompt()

    def tell(self, text: str) -> None:
        """Prints one message."""
        self._console.print(Text(_printable(text)))

    def _answer(self, turn: _Turn, reply: Reply) -> Answer:
        return Answer(reply=reply, latency_s=self._clock() - turn.started_s, better_s=turn.better_s)

    def _show(self, question: Question, patience_s: float) -> None:
        words = self._words
        again = f" ({words.again})" if question.attempt > 1 else ""
        lines = [
            Text(f"{words.asks}{again}:", style="bold cyan"),
            *self._question_lines(question),
            Text.assemble((f"  {words.unsure:<{_KEYS}}", "yellow"), "→ ", words.unsure_means),
            Text(words.orders.format(f"{patience_s:.0f}"), style="dim"),
        ]
        self._console.print(Group(Text(), *lines))
        self._prompt()

    def _show_better(self, turn: _Turn) -> None:
        """Shows better words that have come; the consequences stand beside them again."""
        question = turn.better.wait(0.0) if turn.better is not None else None
        turn.better = None
        if question is not None:
            turn.better_s = self._clock() - turn.started_s
            said = Text(self._words.better, style="bold cyan")
            self._console.print(Group(Text(), said, *self._question_lines(question)))
            self._prompt()

    def _prompt(self) -> None:
        self._console.print(Text(self._words.prompt, style="bold"), end="")
        self._console.file.flush()

    def _question_lines(self, question: Question) -> tuple[Text, ...]:
        """The words with what Yes and what No do to the flight."""
        words = self._words
        return (
            Text(_printable(question.text), style="bold"),
            Text.assemble((f"  {words.yes:<{_KEYS}}", "green"), "→ ", _printable(question.yes_means)),
            Text.assemble((f"  {words.no:<{_KEYS}}", "red"), "→ ", _printable(question.no_means)),
        )

    def _drop_typed_ahead(self) -> None:
        if os.isatty(self._fd):
            termios.tcflush(self._fd, termios.TCIFLUSH)
            self._pending = b""

    def _read_line(self, turn: _Turn) -> str | None:
        """The next line without its end; None when the time is over or the input has ended."""
        while b"\n" not in self._pending:
            if self._ended or not self._wait_for_input(turn):
                self._pending = b""
                return None
            try:
                chunk = os.read(self._fd, 1024)
            except OSError:  # the terminal was closed
                chunk = b""
            if chunk:
                self._pending = (self._pending + chunk)[-_LONGEST_LINE:]
            elif self._pending:
                self._pending += b"\n"
                self._ended = True
            else:
                self._ended = True
        line, _, self._pending = self._pending.partition(b"\n")
        return line.decode("utf-8", errors="replace").strip()

    def _wait_for_input(self, turn: _Turn) -> bool:
        """Whether there is something to read before the time is over; shows better words when they come meanwhile."""
        while (left_s := turn.deadline_s - self._clock()) > 0:
            waits = left_s if turn.better is None else min(left_s, _GLANCE_S)
            if select.select([self._fd], [], [], waits)[0]:
                return True
            if turn.better is not None and turn.better.done:
                self._show_better(turn)
        return False


def _printable(text: str) -> str:
    """The text without control characters: words from a picture or a model must not steer the terminal."""
    return "".join(character if character.isprintable() else " " for character in text)
