"""A person at a terminal."""

from __future__ import annotations

import os
import select
import termios
import time
from collections.abc import Callable
from typing import Protocol

from rich.console import Console, Group
from rich.text import Text

from mintpilot.core.errors import DeviceError
from mintpilot.core.ports import Operator
from mintpilot.core.query import Answer, Command, Question, Reply
from mintpilot.interaction.replies import ACCEPTED, understand

_LONGEST_LINE = 4096
"""Bytes; what is typed beyond them without a line's end is thrown away."""


class Readable(Protocol):
    """Anything with a file descriptor: ``sys.stdin``, a pipe, a pseudo-terminal."""

    def fileno(self) -> int:
        """The file descriptor."""
        ...


class TerminalOperator(Operator):
    """Asks the person at a terminal, and never waits longer than it was told.

    Keys typed before a question was shown do not answer it. Lines that were piped in are kept: one for each question.
    Ctrl-C raises `KeyboardInterrupt` at once, for the caller to end the mission tidily.

    Args:
        console: where the question is shown; without a terminal plain text is written, no control codes.
        stdin: where the reply is read from, by its file descriptor (nothing else may read from it meanwhile).
        clock: seconds, never going back.

    Raises:
        DeviceError: ``stdin`` has no file descriptor to read from.
    """

    def __init__(self, console: Console, stdin: Readable, *, clock: Callable[[], float] = time.monotonic) -> None:
        try:
            self._fd = stdin.fileno()
        except (OSError, ValueError, AttributeError) as error:
            raise DeviceError(
                f"the terminal operator cannot read from {stdin!r}: it needs an open standard input; "
                "use the scripted operator where nobody is there"
            ) from error
        self._console = console
        self._clock = clock
        self._pending = b""
        self._ended = False

    def ask(self, question: Question, patience_s: float) -> Answer:
        """Shows the question with the consequences of Yes and No, and reads a reply for at most ``patience_s``.

        Words that are not understood are answered with what is accepted, within the same patience. The end of the
        input counts as silence.
        """
        self._drop_typed_ahead()
        started_s = self._clock()
        self._show(question, patience_s)
        while True:
            line = self._read_line(started_s + patience_s)
            latency_s = self._clock() - started_s
            if line is None:
                self._console.print(Text("No answer: going on the careful way.", style="yellow"))
                return Answer(reply=Reply.TIMEOUT, latency_s=latency_s)
            meaning = understand(line)
            if isinstance(meaning, Command):
                return Answer(reply=Reply.UNSURE, latency_s=latency_s, text=line, command=meaning)
            if meaning is not None:
                return Answer(reply=meaning, latency_s=latency_s, text=line)
            self._console.print(Text(f"Please type {ACCEPTED}.", style="yellow"))
            self._prompt()

    def tell(self, text: str) -> None:
        """Prints one message."""
        self._console.print(Text(_printable(text)))

    def _show(self, question: Question, patience_s: float) -> None:
        again = " (asked again in other words)" if question.attempt > 1 else ""
        lines = [
            Text(f"The drone asks{again}:", style="bold cyan"),
            Text(_printable(question.text), style="bold"),
            Text.assemble(("  y  yes         ", "green"), "→ ", _printable(question.yes_means)),
            Text.assemble(("  n  no          ", "red"), "→ ", _printable(question.no_means)),
            Text.assemble(("  ?  don't know  ", "yellow"), "→ it asks something else, or takes the careful way"),
            Text(
                f"Orders: hold, return, abort. Without an answer in {patience_s:.0f} s it takes the careful way.", "dim"
            ),
        ]
        self._console.print(Group(Text(), *lines))
        self._prompt()

    def _prompt(self) -> None:
        self._console.print(Text("Your answer: ", style="bold"), end="")
        self._console.file.flush()

    def _drop_typed_ahead(self) -> None:
        if os.isatty(self._fd):
            termios.tcflush(self._fd, termios.TCIFLUSH)
            self._pending = b""

    def _read_line(self, deadline_s: float) -> str | None:
        """The next line without its end; None when the time is over or the input has ended."""
        while b"\n" not in self._pending:
            left_s = deadline_s - self._clock()
            if self._ended or left_s <= 0 or not select.select([self._fd], [], [], left_s)[0]:
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


def _printable(text: str) -> str:
    """The text without control characters: words from a picture or a model must not steer the terminal."""
    return "".join(character if character.isprintable() else " " for character in text)
