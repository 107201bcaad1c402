"""From what browsers want done to what the mission hears: keys, free words, things pointed at, orders."""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from concurrent.futures import TimeoutError as NotYet
from dataclasses import dataclass, replace

from mintpilot.console.desk import Asked
from mintpilot.console.protocol import (
    AnyCommand,
    Confirmed,
    Drew,
    MoreTime,
    Ordering,
    Pointed,
    QuestionSeen,
    Replied,
    Said,
    ToldOf,
    TookBack,
)
from mintpilot.core.inputs import (
    Answered,
    FactConfirmed,
    FactTold,
    FactUndone,
    MoreTimeWanted,
    OperatorInput,
    Ordered,
    QuestionShown,
)
from mintpilot.core.ports import Understand
from mintpilot.core.predicate import Literal, Saying, SayingKind
from mintpilot.core.query import YES_PART, Answer, Evidence, Query, Question, Reply, Standing
from mintpilot.core.reading import AnsweredBy, Reading, ReadingKind, guarded_replies, opposite
from mintpilot.core.told import Fact, KeepOut, RegionBlocked, RegionPassable, RoomSearched, ThisOne
from mintpilot.interaction.answers import answer_of

AT_ONCE_S = 0.02
"""Words that are understood within this time are answered in the same poll, seconds."""
_BACK = (ReadingKind.REPEAT, ReadingKind.WHY, ReadingKind.WHERE, ReadingKind.SHOW)


@dataclass(slots=True)
class Turn:
    """One question while it is open."""

    question: Question
    patience_s: float
    shown_s: float | None = None
    again: bool = False
    """Whether words were not understood once."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Heard:
    """What a command came to."""

    events: tuple[OperatorInput, ...] = ()
    changed: bool = False
    """Whether the question has to be shown anew: words were not understood, or a read-back was denied."""
    show: str = ""
    """What was asked back: ``where``, ``why``, ``repeat``."""


@dataclass(frozen=True, slots=True)
class _Waiting:
    asked: Asked
    said: Said
    question: str
    future: Future[Reading]


class Answering:
    """Keeps the open question, and reads words in a thread of its own.

    Args:
        understand: what free words mean as an answer; it may take its time.
    """

    def __init__(self, understand: Understand) -> None:
        self._understand = understand
        self.turn: Turn | None = None
        self._waiting: list[_Waiting] = []
        self._pool = ThreadPoolExecutor(1, thread_name_prefix="mintpilot console reading")

    def close(self) -> None:
        """Reads nothing more."""
        self._pool.shutdown(wait=False, cancel_futures=True)

    def hear(self, asked: Asked, time_s: float) -> Heard:
        """What one command comes to; free words may come later, by `read`."""
        command: AnyCommand = asked.command
        match command:
            case Ordering():
                order = Ordered(time_s=time_s, order=command.order, operator=asked.who, text=command.order.value)
                return Heard(events=(order,))
            case QuestionSeen():
                return self._seen(command.question, time_s)
            case MoreTime():
                return Heard(events=(MoreTimeWanted(time_s=time_s, question=command.question),))
            case Replied():
                return self._replied(asked, command, time_s)
            case Pointed():
                return self._pointed(asked, command, time_s)
            case Said():
                return self._said(asked, command, time_s)
            case Drew():
                return _told(KeepOut(corners_m=command.corners), asked, time_s)
            case ToldOf():
                return _told(_fact(command), asked, time_s)
            case Confirmed():
                done = FactConfirmed(time_s=time_s, told=command.told, operator=asked.who)
                return Heard(events=(done,))
            case TookBack():
                return Heard(events=(FactUndone(time_s=time_s, told=command.told, operator=asked.who),))
            case _:
                return Heard()

    def read(self, time_s: float) -> Iterator[Heard]:
        """What became of the words that are being read."""
        for waiting in tuple(self._waiting):
            if waiting.future.done():
                self._waiting.remove(waiting)
                yield self._was_read(waiting, waiting.future.result(), time_s)

    def _open(self, question: str) -> Turn | None:
        turn = self.turn
        return turn if turn is not None and turn.question.id == question else None

    def _seen(self, question: str, time_s: float) -> Heard:
        turn = self._open(question)
        if turn is None or turn.shown_s is not None:
            return Heard()
        turn.shown_s = time_s
        return Heard(events=(QuestionShown(time_s=time_s, question=question),))

    def _replied(self, asked: Asked, command: Replied, time_s: float) -> Heard:
        reply = Reply(command.reply)
        option = command.option if reply is Reply.OPTION else None
        turn = self._open(command.question)
        if (reply is Reply.OPTION) is not (option is not None):
            return Heard()
        if turn is None:
            late = Answer(reply=reply, option=option, latency_s=0.0, text=command.reply)
            return _answered(command.question, late, asked, time_s)
        query = turn.question.query
        if option is not None and (not query.is_choice or option >= query.part_count):
            return Heard()
        read_back = turn.question.read_back
        if command.confirms is not (read_back is not None):
            return Heard(changed=True)  # the screen showed something else when the key was pressed
        standing = Standing.PLAIN
        if read_back is not None and reply is Reply.YES:
            reply, option, standing = read_back.reply, read_back.option, Standing.CONFIRMED
        elif read_back is not None and reply is Reply.NO:
            other = opposite(read_back.reply)
            if other is None or other in guarded_replies(turn.question):
                return self._ask_again(turn)
            reply = other
        elif query.is_choice and reply in (Reply.YES, Reply.NO):
            return Heard(changed=True)
        answer = Answer(
            reply=reply, option=option, latency_s=_waited(turn, time_s), text=command.reply, standing=standing
        )
        return _answered(command.question, answer, asked, time_s)

    def _pointed(self, asked: Asked, command: Pointed, time_s: float) -> Heard:
        """A thing was pointed at: evidence about the open question, read back where it allows more."""
        turn = self._open(command.question)
        gap = next((g for g in turn.question.gaps if command.thing in g.values), None) if turn is not None else None
        if turn is None or gap is None or not gap.candidates:
            return Heard()
        literal = Literal(
            gap=gap.id,
            values=frozenset({command.thing}),
            saying=Saying(kind=SayingKind.VALUE, value=command.thing),
        )
        query, waited_s = turn.question.query, _waited(turn, time_s)
        meant = next(c.description or c.id for c in gap.candidates if c.id == command.thing)
        if query.gap_ids != (gap.id,):
            return Heard(changed=True)
        part = query.part_of({gap.id: command.thing})
        answer = Answer(
            reply=Reply.OPTION if query.is_choice else Reply.YES if part == YES_PART else Reply.NO,
            option=part if query.is_choice else None,
            latency_s=waited_s,
            text=meant,
            also=(Evidence(query=Query(literals=(literal,)), part=YES_PART),),
            standing=Standing.UNCONFIRMED,
        )
        return _answered(command.question, answer, asked, time_s)

    def _said(self, asked: Asked, command: Said, time_s: float) -> Heard:
        turn = self._open(command.question) or self.turn
        if turn is None:
            return Heard()  # orders outside of questions are read by the caller
        future = self._pool.submit(self._reading, command.text, turn, time_s)
        waiting = _Waiting(asked, command, turn.question.id, future)
        try:
            reading = future.result(timeout=AT_ONCE_S)
        except NotYet:
            self._waiting.append(waiting)
            return Heard()
        return self._was_read(waiting, reading, time_s)

    def _reading(self, text: str, turn: Turn, time_s: float) -> Reading:
        pending = turn.question.read_back.reply if turn.question.read_back is not None else None
        left_s = max(0.0, turn.patience_s - _waited(turn, time_s))
        return self._understand(text, turn.question, left_s, by=AnsweredBy.TYPED, pending=pending)

    def _was_read(self, waiting: _Waiting, reading: Reading, time_s: float) -> Heard:
        text, asked, name = waiting.said.text, waiting.asked, waiting.question
        if reading.order is not None:
            return Heard(events=(Ordered(time_s=time_s, order=reading.order, operator=asked.who, text=text),))
        turn = self._open(name)
        if turn is None:
            return _answered(name, answer_of(reading, text, None), asked, time_s)
        if reading.kind is ReadingKind.WAIT:
            return Heard(events=(MoreTimeWanted(time_s=time_s, question=name),))
        if reading.kind in _BACK:
            return Heard(show=reading.kind.value)
        if reading.kind is ReadingKind.OPTION and reading.option is not None:
            return self._option(turn, reading.option - 1, asked, text, time_s)
        if reading.kind is ReadingKind.AGAIN:
            if not turn.again or turn.question.read_back is not None:
                return self._ask_again(turn)
            given_up = Answer(
                reply=Reply.UNSURE, latency_s=_waited(turn, time_s), text=text, by="typed", understood_by="rules"
            )
            return _answered(name, given_up, asked, time_s)
        return _answered(name, answer_of(reading, text, turn.question, latency_s=_waited(turn, time_s)), asked, time_s)

    def _option(self, turn: Turn, option: int, asked: Asked, text: str, time_s: float) -> Heard:
        query = turn.question.query
        if not query.is_choice or not 0 <= option < query.part_count:
            return self._ask_again(turn)
        waited_s = _waited(turn, time_s)
        answer = Answer(reply=Reply.OPTION, option=option, latency_s=waited_s, text=text, by="typed")
        return _answered(turn.question.id, answer, asked, time_s)

    def _ask_again(self, turn: Turn) -> Heard:
        turn.question = replace(turn.question, read_back=None)
        turn.again = True
        return Heard(changed=True)


def _told(fact: Fact, asked: Asked, time_s: float) -> Heard:
    return Heard(events=(FactTold(time_s=time_s, fact=fact, operator=asked.who),))


def _fact(command: ToldOf) -> Fact:
    match command.fact:
        case "blocked":
            return RegionBlocked(region=command.subject)
        case "passable":
            return RegionPassable(region=command.subject)
        case "searched":
            return RoomSearched(room=command.subject)
        case "this-one":
            return ThisOne(thing=command.subject)


def _answered(question: str, answer: Answer, asked: Asked, time_s: float) -> Heard:
    return Heard(events=(Answered(time_s=time_s, question=question, answer=answer, operator=asked.who),))


def _waited(turn: Turn, time_s: float) -> float:
    return max(0.0, time_s - turn.shown_s) if turn.shown_s is not None else 0.0
