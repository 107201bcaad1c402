"""From the reading of words to an answer: how far it may be relied on (method, section 12)."""

from __future__ import annotations

from dataclasses import replace

from mintpilot.core.query import (
    NO_PART,
    PARTS,
    YES_PART,
    Answer,
    Evidence,
    Query,
    Question,
    Reply,
    Standing,
    answer_for,
)
from mintpilot.core.reading import AnsweredBy, Reading, ReadingKind, part_said


def answer_of(
    reading: Reading,
    text: str,
    question: Question | None,
    *,
    latency_s: float = 0.0,
    by: AnsweredBy = AnsweredBy.TYPED,
) -> Answer:
    """What a reading answers. Agreement that is not plain, and evidence, are read back where they take caution away.

    Args:
        reading: of the words; of what is no answer (an order, a question back) it makes UNSURE.
        text: the raw words.
        question: the open question, with what is being read back; None: it is no longer open.
        latency_s: from when it was shown, seconds.
        by: how the words came.
    """
    part = part_said(reading, question) if question is not None else PARTS.get(reading.reply or Reply.UNSURE)
    plain = reading.kind in (ReadingKind.YES, ReadingKind.NO, ReadingKind.UNSURE, ReadingKind.OPTION)
    standing = Standing.PLAIN if plain else Standing.UNCONFIRMED
    read_back = question.read_back if question is not None else None
    if plain and read_back is not None and part is not None and read_back.part == part:
        standing = Standing.CONFIRMED
    also = tuple(
        Evidence(query=Query(literals=(literal,)), part=YES_PART if holds else NO_PART)
        for literal, holds in reading.evidence
    )
    said = Answer(reply=Reply.UNSURE, latency_s=latency_s)
    if part is not None:
        said = (
            answer_for(question.query, part)
            if question is not None
            else replace(said, reply=reading.reply or Reply.UNSURE)
        )
    return replace(
        said,
        latency_s=latency_s,
        text=text,
        also=also,
        understood_by=reading.by,
        standing=standing,
        by=by.value,
    )
