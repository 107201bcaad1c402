"""Which regions an answer says outright to be passable."""

from __future__ import annotations

import pytest

from mintpilot.core.gap import BLOCKED, PASSABLE, GapKind, KnowledgeGap, obstacle_id
from mintpilot.core.predicate import Combine, Literal, Saying, SayingKind
from mintpilot.core.query import NO_PART, YES_PART, Query
from mintpilot.mission.belief_state import confirmed_by

NAMES = (obstacle_id("a"), obstacle_id("b"))
GAPS = tuple(
    KnowledgeGap(
        id=name,
        kind=GapKind.OBSTACLE,
        subject=name,
        description="the smoke",
        values=(PASSABLE, BLOCKED),
        prior=(0.5, 0.5),
        position_m=(0.0, 0.0, 0.0),
    )
    for name in NAMES
)


@pytest.mark.parametrize(
    ("combine", "part", "confirmed"),
    [
        (Combine.ANY, YES_PART, ()),
        (Combine.ALL, YES_PART, NAMES),
        (Combine.ALL, NO_PART, ()),
        (Combine.ANY, NO_PART, ()),
    ],
)
def test_only_an_all_of_yes_confirms_several(combine: Combine, part: int, confirmed: tuple[str, ...]) -> None:
    saying = Saying(kind=SayingKind.VALUE, value=PASSABLE)
    literals = tuple(Literal(gap=name, values=frozenset({PASSABLE}), saying=saying) for name in NAMES)
    assert confirmed_by(Query(literals=literals, combine=combine), part, GAPS) == set(confirmed)
