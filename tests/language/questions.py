"""Three questions as the drone would ask them."""

from __future__ import annotations

from mintpilot.core.gap import ABSENT, BLOCKED, PASSABLE, PRESENT, Candidate, GapKind, KnowledgeGap
from mintpilot.core.observation import Attribute
from mintpilot.core.query import Literal, Query, Question, Saying, SayingKind


def _candidate(name: str, **attributes: str) -> Candidate:
    pairs = tuple(Attribute(name=key, value=value) for key, value in attributes.items())
    words = " ".join(attributes.values())
    return Candidate(id=name, position_m=(0.0, 0.0, 0.0), attributes=pairs, description=f"the {words} box")


def _question(gap: KnowledgeGap, values: set[str], saying: Saying, text: str, yes: str, no: str) -> Question:
    query = Query(literals=(Literal(gap=gap.id, values=frozenset(values), saying=saying),))
    return Question(query=query, text=text, yes_means=yes, no_means=no, gaps=(gap,))


SMOKE_GAP = KnowledgeGap(
    id="obstacle:smoke-1",
    kind=GapKind.OBSTACLE,
    subject="smoke-1",
    description="the grey smoke near the gate",
    values=(PASSABLE, BLOCKED),
    prior=(0.5, 0.5),
    position_m=(1.0, 2.0, 1.0),
)
ROOM_GAP = KnowledgeGap(
    id="presence:room-1",
    kind=GapKind.PRESENCE,
    subject="room-1",
    description="the closed room with the brown door",
    values=(PRESENT, ABSENT),
    prior=(0.5, 0.5),
    position_m=(3.0, 2.0, 1.0),
)
BOX_GAP = KnowledgeGap(
    id="target:1:box",
    kind=GapKind.TARGET,
    subject="the box",
    description="the box",
    values=("box-1", "box-2", "box-3"),
    prior=(0.25, 0.25, 0.5),
    position_m=(5.0, 2.0, 1.0),
    candidates=(
        _candidate("box-1", size="small", colour="red"),
        _candidate("box-2", size="large", colour="blue"),
        _candidate("box-3", size="small", colour="blue"),
    ),
)
SMOKE = _question(
    SMOKE_GAP,
    {PASSABLE},
    Saying(kind=SayingKind.VALUE, value=PASSABLE),
    "Is the grey smoke near the gate safe to fly through?",
    "I fly through it",
    "I fly around it",
)
ROOM = _question(
    ROOM_GAP,
    {PRESENT},
    Saying(kind=SayingKind.VALUE, value=PRESENT),
    "Is somebody in the closed room with the brown door?",
    "I look inside",
    "I fly past it",
)
BOX = _question(
    BOX_GAP,
    {"box-1"},
    Saying(kind=SayingKind.ATTRIBUTE, name="colour", value="red"),
    "Do you mean the red box?",
    "I fly to the small red box",
    "I ask further which one it is",
)
