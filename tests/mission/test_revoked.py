"""An answer that is taken back later: only caution is added (method, sections 8 and 12)."""

from __future__ import annotations

import numpy as np
import pytest

from mintpilot.core.gap import ABSENT, BLOCKED, PASSABLE, PRESENT, GapKind, KnowledgeGap, obstacle_id, presence_id
from mintpilot.core.geometry import Box, GridFrame
from mintpilot.core.mission import AskingSettings
from mintpilot.core.observation import RegionKind
from mintpilot.core.predicate import Literal, Saying, SayingKind
from mintpilot.core.query import NO_PART, YES_PART, Evidence, Query
from mintpilot.core.semantic_map import Cell, Knowledge, Region, Room, SemanticMap
from mintpilot.mission.belief_state import BeliefState
from mintpilot.mission.grants import granted
from mintpilot.mission.permissions import enlarges, permissions, revoke
from mintpilot.reasoning.belief import prior_belief

SMOKE, ROOM = obstacle_id("smoke-1"), presence_id("room-1")


def about(gap: str, value: str) -> Query:
    said = Saying(kind=SayingKind.VALUE, value=value)
    return Query(literals=(Literal(gap=gap, values=frozenset({value}), saying=said),))


SAFE, DANGEROUS = about(SMOKE, PASSABLE), about(SMOKE, BLOCKED)
SOMEBODY, NOBODY = about(ROOM, PRESENT), about(ROOM, ABSENT)
BOTH = Query(literals=(*SAFE.literals, *NOBODY.literals))


def state() -> BeliefState:
    """The smoke was said to be safe, and the room to be empty."""
    frame = GridFrame(origin_m=(0.0, 0.0, 0.0), resolution_m=0.2, shape=(1, 9, 9))
    smoke = Region(id="smoke-1", kind=RegionKind.SMOKE, cells=np.arange(9), passable=Knowledge.YES)
    door = Box(lo_m=(0.2, 1.0, 0.0), hi_m=(0.6, 1.2, 0.2))
    room = Room(id="room-1", door_m=door, viewpoint_m=(0.4, 0.8, 0.1), occupied=Knowledge.NO)
    map = SemanticMap(frame=frame, cells=np.full(frame.shape, Cell.FREE, np.uint8), regions=(smoke,), rooms=(room,))
    gap = KnowledgeGap(
        id=SMOKE, kind=GapKind.OBSTACLE, subject="smoke-1", description="the smoke", values=(PASSABLE, BLOCKED),
        prior=(0.5, 0.5), position_m=(0.0, 0.0, 0.0),
    )  # fmt: skip
    made = BeliefState(
        map=map,
        belief=prior_belief((gap,)),
        confirmed=frozenset({SMOKE}),
        asked=(Evidence(query=SAFE, part=YES_PART), Evidence(query=SOMEBODY, part=NO_PART)),
    )
    return granted(made, {SMOKE}, map, now_s=5.0)


@pytest.mark.parametrize(
    ("query", "part", "passable", "occupied"),
    [
        (SAFE, NO_PART, Knowledge.NO, Knowledge.NO),
        (DANGEROUS, YES_PART, Knowledge.NO, Knowledge.NO),
        (SAFE, YES_PART, Knowledge.OPEN, Knowledge.NO),
        (SOMEBODY, YES_PART, Knowledge.YES, Knowledge.YES),
        (NOBODY, NO_PART, Knowledge.YES, Knowledge.YES),
        (NOBODY, YES_PART, Knowledge.YES, Knowledge.OPEN),
        (SOMEBODY, NO_PART, Knowledge.YES, Knowledge.OPEN),
        (BOTH, NO_PART, Knowledge.OPEN, Knowledge.OPEN),
    ],
)
def test_what_was_said_is_taken_back_and_the_opposite_counts_where_it_is_one_thing(query, part, passable, occupied):
    before = state()
    after = revoke(before, query, part)
    assert after.map.regions[0].passable is passable
    assert after.map.rooms[0].occupied is occupied
    assert not enlarges(before, after, AskingSettings())
    gaps = set(query.gap_ids)
    assert not gaps & after.confirmed
    assert not gaps & {grant.gap for grant in after.grants}
    assert not gaps & {name for one in after.asked for name in one.query.gap_ids}
    assert not gaps & {gap.id for gap in after.belief.gaps}


def test_what_is_permitted_is_what_was_said():
    allowed = permissions(state(), AskingSettings())
    assert (allowed.enter, allowed.leave_out) == (frozenset({SMOKE}), frozenset({ROOM}))
