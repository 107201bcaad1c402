"""Sentences with what they mean: answers by question, and the three questions that they answer."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from importlib.resources import files
from typing import Any

import yaml

from mintpilot.core.gap import ABSENT, BLOCKED, PASSABLE, PRESENT, Candidate, GapKind, KnowledgeGap, target_id
from mintpilot.core.observation import Attribute
from mintpilot.core.query import Literal, Query, Question, Saying, SayingKind

_ANSWERS = "phrasings.yaml"


@dataclass(frozen=True, slots=True, kw_only=True)
class AnswerCase:
    """An answer, the question that it is given to, and what it means."""

    text: str
    question: Question
    reading: str
    """``yes``, ``no``, ``unsure``, ``other`` or ``command``."""


def answer_cases() -> Iterator[AnswerCase]:
    """The written-down answers, in the order of the file."""
    for name, readings in _read(_ANSWERS).items():
        for reading, texts in readings.items():
            for text in texts:
                yield AnswerCase(text=text, question=QUESTIONS[name], reading=reading)


def _read(name: str) -> dict[str, Any]:
    rows: dict[str, Any] = yaml.safe_load((files("mintpilot.benchmark") / name).read_text("utf-8"))
    return rows


def box(name: str, size: str, colour: str) -> Candidate:
    """A box that is told apart by size and colour."""
    attributes = (Attribute(name="size", value=size), Attribute(name="colour", value=colour))
    return Candidate(id=name, position_m=(0.0, 0.0, 0.0), attributes=attributes, description=f"the {size} {colour} box")


def asked(gap: KnowledgeGap, values: set[str], saying: Saying, text: str, *, yes: str, no: str) -> Question:
    """A question with one literal."""
    query = Query(literals=(Literal(gap=gap.id, values=frozenset(values), saying=saying),))
    return Question(query=query, text=text, yes_means=yes, no_means=no, gaps=(gap,))


def _gap(name: str, kind: GapKind, called: str, values: tuple[str, ...]) -> KnowledgeGap:
    prior = tuple(1 / len(values) for _ in values)
    return KnowledgeGap(
        id=f"{kind}:{name}", kind=kind, subject=name, description=called, values=values, prior=prior,
        position_m=(1.0, 2.0, 1.0),
    )  # fmt: skip


_BOXES = (box("box-1", "small", "red"), box("box-2", "large", "blue"), box("box-3", "small", "blue"))
QUESTIONS: dict[str, Question] = {
    "smoke": asked(
        _gap("smoke-1", GapKind.OBSTACLE, "the grey smoke near the gate", (PASSABLE, BLOCKED)),
        {PASSABLE},
        Saying(kind=SayingKind.VALUE, value=PASSABLE),
        "Is the grey smoke near the gate safe to fly through?",
        yes="I fly through it",
        no="I fly around it",
    ),
    "room": asked(
        _gap("room-1", GapKind.PRESENCE, "the closed room with the brown door", (PRESENT, ABSENT)),
        {PRESENT},
        Saying(kind=SayingKind.VALUE, value=PRESENT),
        "Is somebody in the closed room with the brown door?",
        yes="I look inside",
        no="I fly past it",
    ),
    "box": asked(
        KnowledgeGap(
            id=target_id(1, "box"), kind=GapKind.TARGET, subject="the box", description="the box",
            values=tuple(c.id for c in _BOXES), prior=(0.25, 0.25, 0.5), position_m=(5.0, 2.0, 1.0), candidates=_BOXES,
        ),
        {"box-1"},
        Saying(kind=SayingKind.ATTRIBUTE, name="colour", value="red"),
        "Do you mean the red box?",
        yes="I fly to the small red box",
        no="I ask further: 2 others are left",
    ),
}  # fmt: skip
"""Name → question: may a region be crossed, is somebody there, which thing is meant."""
