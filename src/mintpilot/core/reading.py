"""What free words, typed, spoken or chosen by a key, were read as (method, section 12)."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

from mintpilot.core.gap import ABSENT, PASSABLE, GapKind
from mintpilot.core.query import PARTS, Literal, Order, Question, Reply, SayingKind, answer_for


class ReadingKind(StrEnum):
    """What kind of thing was said."""

    YES = "yes"
    NO = "no"
    UNSURE = "unsure"
    OPTION = "option"
    """One of the question's numbered options."""
    EVIDENCE = "evidence"
    """Attributes of the thing meant, beyond what was asked: ``the blue one``."""
    ORDER = "order"
    READ_BACK = "read-back"
    """Agreement with a guarded reply that takes effect only after it was read back and confirmed."""
    WAIT = "wait"
    WHERE = "where"
    SHOW = "show"
    WHY = "why"
    REPEAT = "repeat"
    AGAIN = "again"
    """Not understood, or not plain enough: ask for the answer again."""


class AnsweredBy(StrEnum):
    """How the words came."""

    KEY = "key"
    """A key, button or menu choice for the open question."""
    TYPED = "typed"
    VOICE = "voice"


@dataclass(frozen=True, slots=True, kw_only=True)
class Reading:
    """What an answer was read as. It has no effect by itself: the mission state decides what it changes."""

    kind: ReadingKind
    reply: Reply | None = None
    """For YES, NO and UNSURE the reply; for READ_BACK the reply that must be confirmed."""
    option: int | None = None
    """For OPTION, and READ_BACK of one: its number as shown, from 1. None: the option that was read back."""
    order: Order | None = None
    """For ORDER."""
    evidence: tuple[tuple[Literal, bool], ...] = ()
    """For EVIDENCE: literals over one target gap, each with whether it was said to hold. A set of candidates narrowed
    to one enlarges permissions, so it needs a read-back like any other guarded update."""
    vetoes: tuple[str, ...] = ()
    """The words and marks that forbade a guarded reply, in order of appearance."""
    by: str = "rules"
    """Who read it: ``rules``, ``key`` or ``model``."""

    @property
    def label(self) -> str:
        """The reading as one word for commands and records: ``yes``, ``read-back:no``, ``evidence:colour=red``."""
        detail: object = ""
        if self.kind is ReadingKind.READ_BACK and self.reply is not None:
            detail = self.reply.value if self.option is None else f"{self.reply.value}:{self.option}"
        elif self.kind is ReadingKind.ORDER and self.order is not None:
            detail = self.order.value
        elif self.kind is ReadingKind.OPTION:
            detail = self.option
        elif self.kind is ReadingKind.EVIDENCE:
            detail = ",".join(_said(literal, holds) for literal, holds in self.evidence)
        return f"{self.kind.value}:{detail}" if detail else self.kind.value


def plain_reply(reply: Reply, *, by: str = "rules", vetoes: tuple[str, ...] = ()) -> Reading:
    """The reading of a plain YES, NO or UNSURE. Raises `ValueError` for silence, which is nothing that was said."""
    return Reading(kind=ReadingKind(reply.value), reply=reply, by=by, vetoes=vetoes)


def guarded_replies(question: Question) -> frozenset[Reply]:
    """The replies that may enlarge what the drone may do, judged from the query alone.

    Calling a region passable, calling a place empty, and any statement about which thing is meant or how large a value
    is may enlarge permissions. The mission state may know better; this errs on the side of guarding.
    """
    if question.query.is_choice:
        return frozenset((Reply.OPTION,))
    kinds = {gap.id: gap.kind for gap in question.gaps}
    guarded: set[Reply] = set()
    for literal in question.query.literals:
        kind = kinds.get(literal.gap)
        if kind is GapKind.GO:
            guarded.add(Reply.YES)
            continue
        if kind not in (GapKind.OBSTACLE, GapKind.PRESENCE):
            return frozenset((Reply.YES, Reply.NO))
        frees = PASSABLE if kind is GapKind.OBSTACLE else ABSENT
        guarded.add(Reply.YES if frees in literal.values else Reply.NO)
    return frozenset(guarded)


def opposite(reply: Reply) -> Reply | None:
    """NO for YES and YES for NO; None for the others."""
    return {Reply.YES: Reply.NO, Reply.NO: Reply.YES}.get(reply)


def reply_of(reading: Reading, question: Question) -> Reply:
    """The plain reply to the question: of evidence, what follows for it; UNSURE where nothing does."""
    if reading.kind is not ReadingKind.EVIDENCE:
        is_plain = reading.reply is not None and reading.kind is not ReadingKind.READ_BACK
        return reading.reply if is_plain and reading.reply is not None else Reply.UNSURE
    part = part_said(reading, question)
    return Reply.UNSURE if part is None else answer_for(question.query, part).reply


def part_said(reading: Reading, question: Question) -> int | None:
    """The part of the query that a reading names, read back or not; None where it names none.

    Of evidence: the one part in which all candidates lie that it leaves.
    """
    query, read_back = question.query, question.read_back
    if reading.kind is ReadingKind.EVIDENCE:
        values = possible_values(reading, question)
        parts = {query.part_of({reading.evidence[0][0].gap: value}) for value in values}
        return parts.pop() if len(parts) == 1 else None
    is_option = reading.kind is ReadingKind.OPTION or reading.reply is Reply.OPTION
    if is_option and reading.option is None:
        return read_back.part if read_back is not None else None
    if is_option and reading.option is not None:
        return reading.option - 1 if query.is_choice and 1 <= reading.option <= query.part_count else None
    return None if query.is_choice or reading.reply is None else PARTS.get(reading.reply)


def possible_values(reading: Reading, question: Question) -> tuple[str, ...]:
    """The candidates that evidence leaves, in the gap's order; empty for other readings."""
    names = {literal.gap for literal, _ in reading.evidence}
    return tuple(
        value
        for gap in question.gaps
        if gap.id in names
        for value in gap.values
        if all((value in literal.values) == holds for literal, holds in reading.evidence)
    )


def _said(literal: Literal, holds: bool) -> str:
    name = "id" if literal.saying.kind is SayingKind.VALUE else literal.saying.name
    return f"{name}{'=' if holds else '!='}{literal.saying.value}"
