"""A person at a terminal."""

from __future__ import annotations

import os
import select
import termios
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from concurrent.futures import TimeoutError as NotYet
from dataclasses import dataclass, replace
from typing import Protocol

from rich.console import Console, Group
from rich.text import Text

from mintpilot.core.errors import DeviceError
from mintpilot.core.gap import GapKind
from mintpilot.core.inputs import Answered, MoreTimeWanted, OperatorInput, Ordered, QuestionShown
from mintpilot.core.ports import Operator, Understand
from mintpilot.core.query import Answer, Order, Question, Reply, Standing
from mintpilot.core.reading import AnsweredBy, Reading, ReadingKind
from mintpilot.interaction.answers import answer_of
from mintpilot.interaction.screen_words import screen_words

_LONGEST_LINE = 4096
"""Bytes; what is typed beyond them without a line's end is thrown away."""
_KEYS = 18
"""Columns for what may be typed."""
_AT_ONCE_S = 0.05
"""Words that are understood within this time are answered in the same poll, seconds."""
NAME = "terminal"


class Readable(Protocol):
    """Anything with a file descriptor: ``sys.stdin``, a pipe, a pseudo-terminal."""

    def fileno(self) -> int:
        """The file descriptor."""
        ...


@dataclass(slots=True)
class _Turn:
    """One question while it is open."""

    question: Question
    patience_s: float
    shown_s: float | None = None
    asked_again: bool = False


class TerminalOperator(Operator):
    """Asks the person at a terminal and hears orders at any time; never waits.

    Keys typed before a question was shown do not answer it. Lines that were piped in are kept: one for each question.
    Ctrl-C raises `KeyboardInterrupt` at once, for the caller to end the mission tidily.

    Args:
        console: where the question is shown; without a terminal plain text is written, no control codes.
        stdin: where the reply is read from, by its file descriptor (nothing else may read from it meanwhile).
        understand: what typed words mean as an answer; it may take its time.
        order_of: the order that a line is, where nothing is asked; None: it is none.
        lang: of what stands around the questions.

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
        order_of: Callable[[str], Order | None],
        lang: str = "en",
    ) -> None:
        try:
            self._fd = stdin.fileno()
        except (OSError, ValueError, AttributeError) as error:
            raise DeviceError(
                f"the terminal operator cannot read from {stdin!r}: it needs an open standard input; "
                "use the scripted operator where nobody is there"
            ) from error
        self._console = console
        self._understand, self._order_of = understand, order_of
        self._words = screen_words(lang)
        self._pending = b""
        self._ended = False
        self._turn: _Turn | None = None
        self._understanding: tuple[str, str, Future[Reading]] | None = None
        self._pool = ThreadPoolExecutor(1, thread_name_prefix="mintpilot understanding")

    @property
    def attended(self) -> bool:
        """A person sits here: True at a terminal, and of a pipe while an answer may still come through it."""
        return os.isatty(self._fd) or (self._turn is not None and not self._ended)

    @property
    def hears_once(self) -> bool:
        """False: better words are shown below the first ones."""
        return False

    def show(self, question: Question, patience_s: float) -> None:
        """Shows the question with the consequences of Yes and No; better words are shown below the first ones."""
        turn = self._turn
        if turn is not None and turn.question.id == question.id:
            turn.question = question
            if question.read_back is not None:
                self._console.print(Text(self._read_back(question, question.read_back), style="bold"))
            else:
                said = Text(self._words.better, style="bold cyan")
                self._console.print(Group(Text(), said, *self._question_lines(question)))
        else:
            self._drop_typed_ahead()
            self._turn = _Turn(question, patience_s)
            self._show(question, patience_s)
        self._prompt()

    def withdraw(self, question: str, why: str) -> None:
        """The question is no longer open; where it was not answered here, that is said."""
        turn, self._turn = self._turn, None
        if turn is None:
            return
        if turn.question.id != question:
            self._turn = turn
            return
        self._pending = self._pending[: self._pending.rfind(b"\n") + 1]  # half a word answers no later question
        self._console.print(Text(f"({_printable(why)})", style="yellow"))

    def tell(self, text: str) -> None:
        """Prints one message."""
        self._console.print(Text(_printable(text)))

    def poll(self, time_s: float) -> tuple[OperatorInput, ...]:
        """What was typed since the last call.

        Words that do not map to an answer are asked for again once; then they count as "don't know". An empty line
        says nothing. Where nothing is asked, a line counts if it is an order.
        """
        events: list[OperatorInput] = []
        turn = self._turn
        if turn is not None and turn.shown_s is None:
            turn.shown_s = time_s
            events.append(QuestionShown(time_s=time_s, question=turn.question.id))
        while self._understanding is None and (line := self._read_line()) is not None:
            if not line:
                continue
            if self._turn is None:
                order = self._order_of(line)
                if order is None and not os.isatty(self._fd):
                    self._pending = line.encode() + b"\n" + self._pending  # a later question's
                    break
                events += self._order(line, order, time_s)
                continue
            future = self._pool.submit(self._understood, line, self._turn, time_s)
            self._understanding = (self._turn.question.id, line, future)
            heard = self._heard(time_s, _AT_ONCE_S)
            events += heard
            if heard:
                break
        events += self._heard(time_s, 0.0)
        return tuple(events)

    def _order(self, line: str, order: Order | None, time_s: float) -> list[OperatorInput]:
        if order is None:
            self._console.print(Text(self._words.nothing_asked, style="yellow"))
            return []
        return [Ordered(time_s=time_s, order=order, operator=NAME, text=line)]

    def _heard(self, time_s: float, wait_s: float) -> list[OperatorInput]:
        """What became of the line that is being understood, if that is known within so many seconds."""
        if self._understanding is None:
            return []
        name, line, future = self._understanding
        try:
            reading = future.result(timeout=wait_s)
        except NotYet:
            return []
        self._understanding = None
        turn = self._turn
        if reading.order is not None:
            return [Ordered(time_s=time_s, order=reading.order, operator=NAME, text=line)]
        if turn is None or turn.question.id != name:
            return [Answered(time_s=time_s, question=name, answer=answer_of(reading, line, None), operator=NAME)]
        if reading.kind is ReadingKind.WAIT:
            return [MoreTimeWanted(time_s=time_s, question=name)]
        if reading.kind in (ReadingKind.REPEAT, ReadingKind.WHY, ReadingKind.WHERE, ReadingKind.SHOW):
            self._console.print(Group(*self._question_lines(turn.question), *self._places(turn.question)))
            self._prompt()
            return []
        waited_s = time_s - turn.shown_s if turn.shown_s is not None else 0.0
        if reading.kind is ReadingKind.AGAIN:
            return self._again(turn, line, time_s, waited_s)
        answer = answer_of(reading, line, turn.question, latency_s=waited_s)
        if answer.standing is not Standing.UNCONFIRMED:
            self._turn = None
        return [Answered(time_s=time_s, question=name, answer=answer, operator=NAME)]

    def _again(self, turn: _Turn, line: str, time_s: float, waited_s: float) -> list[OperatorInput]:
        """Asks once more; the second time the words count as "don't know"."""
        turn.question = replace(turn.question, read_back=None)
        if not turn.asked_again:
            turn.asked_again = True
            self._console.print(Text(self._words.repeat, style="yellow"))
            self._prompt()
            return []
        self._console.print(Text(self._words.given_up, style="yellow"))
        self._turn = None
        answer = Answer(reply=Reply.UNSURE, latency_s=waited_s, text=line, by="typed", understood_by="rules")
        return [Answered(time_s=time_s, question=turn.question.id, answer=answer, operator=NAME)]

    def _understood(self, line: str, turn: _Turn, time_s: float) -> Reading:
        left_s = max(0.0, turn.patience_s - (time_s - (turn.shown_s or time_s)))
        read_back = turn.question.read_back
        pending = read_back.reply if read_back is not None else None
        return self._understand(line, turn.question, left_s, by=AnsweredBy.TYPED, pending=pending)

    def _read_back(self, question: Question, answer: Answer) -> str:
        means = question.yes_means if answer.reply is Reply.YES else question.no_means
        said = self._words.yes if answer.reply is Reply.YES else self._words.no
        return self._words.read_back.format(said.split()[-1], _printable(means))

    def _places(self, question: Question) -> tuple[Text, ...]:
        """Where the things are that the question is about, on the map."""
        return tuple(
            Text(f"  {_printable(gap.description)}: x {gap.position_m[0]:.1f} m, y {gap.position_m[1]:.1f} m")
            for gap in question.gaps
            if gap.kind is not GapKind.GO
        )

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

    def _read_line(self) -> str | None:
        """The next line without its end; None where there is none yet, or no more."""
        while b"\n" not in self._pending:
            if self._ended or not select.select([self._fd], [], [], 0)[0]:
                return None
            try:
                chunk = os.read(self._fd, 1024)
            except OSError:  # the terminal was closed
                chunk = b""
            if chunk:
                self._pending = (self._pending + chunk)[-_LONGEST_LINE:]
                continue
            self._ended = True
            if self._pending:
                self._pending += b"\n"
        line, _, self._pending = self._pending.partition(b"\n")
        return line.decode("utf-8", errors="replace").strip()


def _printable(text: str) -> str:
    """The text without control characters: words from a picture or a model must not steer the terminal."""
    return "".join(character if character.isprintable() else " " for character in text)
