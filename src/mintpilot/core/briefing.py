"""What is shown before take-off: the mission as it was understood, and the question go or no-go."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from mintpilot.core.gap import FLY, STAY, GapKind, KnowledgeGap
from mintpilot.core.message import Message
from mintpilot.core.query import Literal, Query, Question, Saying, SayingKind

GO_GAP: Final = KnowledgeGap(
    id=f"{GapKind.GO}:mission",
    kind=GapKind.GO,
    subject="mission",
    description="the mission as it was understood",
    values=(FLY, STAY),
    prior=(0.5, 0.5),
    position_m=(0.0, 0.0, 0.0),
)
"""What the question is about; it is never planned with."""
GO_QUERY: Final = Query(
    literals=(Literal(gap=GO_GAP.id, values=frozenset({FLY}), saying=Saying(kind=SayingKind.VALUE, value=FLY)),)
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Briefing:
    """Shown on the ground; only an explicit yes to the question lets the drone take off."""

    lines: tuple[Message, ...]
    """The steps as they were read, what is stayed out of, what is not known, and battery against need."""
    question: Question
    """About `GO_QUERY`; yes means fly."""
