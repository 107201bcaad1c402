"""A person at a terminal."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from concurrent.futures import TimeoutError as NotYet
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Protocol

from rich.console import Console, Group
from rich.text import Text

from mintpilot.core.errors import DeviceError
from mintpilot.core.inputs import Answered, MoreTimeWanted, OperatorInput, Ordered, QuestionShown
from mintpilot.core.ports import Operator, Understand
from mintpilot.core.query import NO_PART, YES_PART, Answer, Order, Question, Reply, Standing
from mintpilot.core.reading import AnsweredBy, Reading, ReadingKind
from mintpilot.interaction.answers import answer_of
from mintpilot.interaction.keyboard import Keyboard, Typed
from mintpilot.interaction.screen_words import screen_words

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


class Notes(Protocol):
    """What may be shown of an open question beside its words."""

    def draw(self, question: Question) -> tuple[Path, ...]:
        """Writes a map and pictures of what it is about; the files. Raises `OSError` where one cannot be written."""
        ...

    def why(self, question: Question) -> tuple[str, ...]:
        """The figures behind it, in sentences."""
        ...


@dataclass(slots=True)
class _Turn:
    """One question while it is open."""

    question: Question
    patience_s: float
    """From when it was shown last, seconds."""
    shown_s: float | None = None
    """When it was shown first, mission clock."""
    until_s: float | None = None
    """When it ends, mission clock."""
    asked_again: bool = False
    extended: bool = False


class TerminalOperator(Operator):
    """Asks the person at a terminal and hears orders at any time; never waits.

    At a terminal a letter on an empty line answers by itself, and the seconds that are left are counted down; words are
    ended with Enter. Keys typed before a question was shown do not answer it. Lines that were piped in are kept: one
    for each question.
    Ctrl-C raises `KeyboardInterrupt` at once, for the caller to end the mission tidily.

    Args:
        console: where the question is shown; without a terminal plain text is written, no control codes.
        stdin: where the reply is read from, by its file descriptor (nothing else may read from it meanwhile).
        understand: what typed words mean as an answer; it may take its time.
        order_of: the order that a line is, where nothing is asked; None: it is none.
        lang: of what stands around the questions.
        notes: the map, pictures and figures behind a question; None: there are none.

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
        notes: Notes | None = None,
    ) -> None:
        try:
            self._keyboard = Keyboard(stdin.fileno())
        except (OSError, ValueError, AttributeError) as error:
            raise DeviceError(
                f"the terminal operator cannot read from {stdin!r}: it needs an open standard input; "
                "use the scripted operator where nobody is there"
            ) from error
        self._console = console
        self._understand, self._order_of = understand, order_of
        self._words, self._notes = screen_words(lang), notes
        self._drawn: tuple[int, str] | None = None
        self._turn: _Turn | None = None
        self._understanding: tuple[str, str, Future[Reading]] | None = None
        self._pool = ThreadPoolExecutor(1, thread_name_prefix="mintpilot understanding")

    @property
    def attended(self) -> bool:
        """A person sits here: True at a terminal, and of a pipe while an answer may still come through it."""
        return self._keyboard.is_terminal or (self._turn is not None and not self._keyboard.ended)

    @property
    def hears_once(self) -> bool:
        """False: better words are shown below the first ones."""
        return False

    def show(self, question: Question, patience_s: float) -> None:
        """Shows the question with the consequences of Yes and No; better words are shown below the first ones."""
        turn = self._turn
        if turn is not None and turn.question.id == question.id:
            turn.question, turn.patience_s, turn.until_s = question, patience_s, None
            self._end_line()
            if question.read_back is not None:
                self._console.print(Text(self._read_back(question, question.read_back), style="bold"))
            else:
                said = Text(self._words.better, style="bold cyan")
                self._console.print(Group(Text(), said, *self._question_lines(question)))
        else:
            query = question.query
            numbers = "1234"[: query.part_count] if query.is_choice else ""
            self._keyboard.begin(self._words.letters + numbers)
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
        self._over()
        self._keyboard.forget()
        self._console.print(Text(f"({_printable(why)})", style="yellow"))

    def tell(self, text: str) -> None:
        """Prints one message."""
        self._end_line()
        self._console.print(Text(_printable(text)))
        if self._turn is not None:
            self._prompt()

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
        if turn is not None and turn.until_s is None:
            turn.until_s = time_s + turn.patience_s
        while self._understanding is None and (typed := self._keyboard.read(time.monotonic())) is not None:
            line = typed.text
            if not line:
                continue
            if self._turn is None:
                order = self._order_of(line)
                if order is None and not self._keyboard.is_terminal:
                    self._keyboard.put_back(line)  # a later question's
                    break
                events += self._order(line, order, time_s)
                continue
            self._end_line(line)
            future = self._pool.submit(self._understood, typed, self._turn, time_s)
            self._understanding = (self._turn.question.id, line, future)
            heard = self._heard(time_s, _AT_ONCE_S)
            events += heard
            if heard:
                break
        events += self._heard(time_s, 0.0)
        self._count_down(time_s)
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
            if not turn.extended and turn.until_s is not None:
                turn.extended, turn.until_s = True, turn.until_s + turn.patience_s
            return [MoreTimeWanted(time_s=time_s, question=name)]
        if reading.kind in (ReadingKind.REPEAT, ReadingKind.WHY, ReadingKind.WHERE, ReadingKind.SHOW):
            self._console.print(Group(*self._told_back(reading.kind, turn.question)))
            self._prompt()
            return []
        waited_s = time_s - turn.shown_s if turn.shown_s is not None else 0.0
        if reading.kind is ReadingKind.AGAIN:
            return self._again(turn, line, time_s, waited_s)
        answer = answer_of(reading, line, turn.question, latency_s=waited_s)
        if answer.standing is not Standing.UNCONFIRMED:
            self._over()
        return [Answered(time_s=time_s, question=name, answer=answer, operator=NAME)]

    def _again(self, turn: _Turn, line: str, time_s: float, waited_s: float) -> list[OperatorInput]:
        """Asks once more; the second time the words count as "don't know"."""
        turn.question = replace(turn.question, read_back=None)
        if not turn.asked_again:
            turn.asked_again = True
            words = self._words.repeat_choice if turn.question.query.is_choice else self._words.repeat
            self._console.print(Text(words, style="yellow"))
            self._prompt()
            return []
        self._console.print(Text(self._words.given_up, style="yellow"))
        self._over()
        answer = Answer(reply=Reply.UNSURE, latency_s=waited_s, text=line, by="typed", understood_by="rules")
        return [Answered(time_s=time_s, question=turn.question.id, answer=answer, operator=NAME)]

    def _over(self) -> None:
        """Nothing is asked any more."""
        self._end_line()
        self._turn = None
        self._keyboard.end()

    def _understood(self, typed: Typed, turn: _Turn, time_s: float) -> Reading:
        left_s = max(0.0, (turn.until_s or time_s) - time_s)
        read_back = turn.question.read_back
        pending = read_back.reply if read_back is not None else None
        by = AnsweredBy.KEY if typed.alone else AnsweredBy.TYPED
        return self._understand(typed.text, turn.question, left_s, by=by, pending=pending)

    def _read_back(self, question: Question, answer: Answer) -> str:
        part = answer.part if answer.part is not None else NO_PART
        if question.query.is_choice:
            said = answer.text if answer.also else question.query.part_words(part)
        else:
            said = (self._words.yes if part == YES_PART else self._words.no).split()[-1]
        return self._words.read_back.format(_printable(said), _printable(question.means(part)))

    def _told_back(self, kind: ReadingKind, question: Question) -> tuple[Text, ...]:
        """What is said to a question back."""
        said: tuple[Text, ...] = ()
        if kind is ReadingKind.WHERE:
            said = self._places(question)
        elif kind is ReadingKind.WHY and self._notes is not None:
            said = tuple(Text(f"  {_printable(line)}") for line in self._notes.why(question))
        elif kind is ReadingKind.SHOW and self._notes is not None:
            try:
                said = tuple(Text(f"  {file}") for file in self._notes.draw(question))
            except OSError as error:
                said = (Text(f"  {_printable(str(error))}", style="yellow"),)
        if kind in (ReadingKind.WHY, ReadingKind.SHOW) and not said:
            said = (Text(f"  {self._words.nothing_more}"),)
        return (*said, *self._question_lines(question))

    def _places(self, question: Question) -> tuple[Text, ...]:
        """Where the things are that the question is about, on the map."""
        return tuple(
            Text(f"  {_printable(words)}: x {at[0]:.1f} m, y {at[1]:.1f} m")
            for gap in question.gaps
            for _, words, at in gap.spots
        )

    def _show(self, question: Question, patience_s: float) -> None:
        words = self._words
        again = f" ({words.again})" if question.attempt > 1 else ""
        lines = [
            Text(f"{words.asks}{again}:", style="bold cyan"),
            *self._question_lines(question),
            Text.assemble((f"  {words.unsure:<{_KEYS}}", "yellow"), "→ ", words.unsure_means),
            Text(words.back, style="dim"),
            Text(words.orders.format(f"{patience_s:.0f}"), style="dim"),
        ]
        self._console.print(Group(Text(), *lines))

    def _prompt(self) -> None:
        """The line to type on; at a terminal it is drawn again as it changes."""
        self._drawn = None
        if self._counts_down:
            self._count_down(None)
            return
        self._console.print(Text(self._words.prompt, style="bold"), end="")
        self._console.file.flush()

    @property
    def _counts_down(self) -> bool:
        return self._keyboard.is_terminal and self._console.is_terminal

    def _count_down(self, time_s: float | None) -> None:
        """Draws the prompt with the seconds that are left and what is typed, where either has changed."""
        turn = self._turn
        if turn is None or not self._counts_down or self._understanding is not None:
            return
        until_s = turn.until_s
        left_s = turn.patience_s if time_s is None or until_s is None else until_s - time_s
        now = (max(0, math.ceil(left_s)), self._keyboard.unfinished)
        if now == self._drawn:
            return
        self._drawn = now
        self._draw_line(f"{now[0]:3d} s  {self._words.prompt}", now[1])

    def _draw_line(self, head: str, typed: str) -> None:
        room = max(8, self._console.width - len(head) - 1)
        out = self._console.file
        out.write(f"\r\x1b[K{head}{_printable(typed)[-room:]}")
        out.flush()

    def _end_line(self, typed: str = "") -> None:
        """Leaves the line that was being drawn, with what was typed on it."""
        if self._drawn is not None and self._counts_down:
            self._draw_line(self._words.prompt, typed or self._drawn[1])
            self._console.file.write("\n")
        self._drawn = None

    def _question_lines(self, question: Question) -> tuple[Text, ...]:
        """The words with what each answer does to the flight."""
        words = self._words
        if question.query.is_choice:
            return (
                Text(_printable(question.text), style="bold"),
                *(
                    Text.assemble(
                        (f"  {part + 1}  {_printable(question.query.part_words(part)):<{_KEYS - 3}}", "cyan"),
                        "→ ",
                        _printable(means),
                    )
                    for part, means in enumerate(question.option_means)
                ),
            )
        return (
            Text(_printable(question.text), style="bold"),
            Text.assemble((f"  {words.yes:<{_KEYS}}", "green"), "→ ", _printable(question.yes_means)),
            Text.assemble((f"  {words.no:<{_KEYS}}", "red"), "→ ", _printable(question.no_means)),
        )


def _printable(text: str) -> str:
    """The text without control characters: words from a picture or a model must not steer the terminal."""
    return "".join(character if character.isprintable() else " " for character in text)
