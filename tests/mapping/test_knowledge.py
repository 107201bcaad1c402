from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mintpilot.core.gap import ABSENT, BLOCKED, PASSABLE, PRESENT, Belief, GapKind, Joint, KnowledgeGap
from mintpilot.core.geometry import Box, GridFrame
from mintpilot.core.mission import AskingSettings
from mintpilot.core.observation import RegionKind
from mintpilot.core.semantic_map import Knowledge, Region, Room, SemanticMap
from mintpilot.mapping.knowledge import apply_knowledge

OBSTACLE, PRESENCE = "obstacle:smoke-1", "presence:room-1"


def a_map() -> SemanticMap:
    frame = GridFrame(origin_m=(0.0, 0.0, 0.0), resolution_m=1.0, shape=(1, 2, 2))
    door = Box(lo_m=(0, 0, 0), hi_m=(1, 0.1, 2))
    return SemanticMap(
        frame=frame,
        cells=np.ones(frame.shape, np.uint8),
        regions=(Region(id="smoke-1", kind=RegionKind.SMOKE, cells=np.array([1])),),
        rooms=(Room(id="room-1", door_m=door, viewpoint_m=(0.5, 1.0, 1.0)),),
    )


def belief(passable: float, present: float) -> Belief:
    def gap(identity: str, kind: GapKind, values: tuple[str, str], p: float) -> KnowledgeGap:
        return KnowledgeGap(
            id=identity,
            kind=kind,
            subject=identity.split(":")[1],
            description="it",
            values=values,
            prior=(p, 1 - p),
            position_m=(0.0, 0.0, 0.0),
        )

    gaps = (
        gap(OBSTACLE, GapKind.OBSTACLE, (PASSABLE, BLOCKED), passable),
        gap(PRESENCE, GapKind.PRESENCE, (PRESENT, ABSENT), present),
    )
    return Belief(
        factors=tuple(
            Joint(gaps=(g,), probability=np.array([p, 1 - p])) for g, p in zip(gaps, (passable, present), strict=True)
        )
    )


@pytest.mark.parametrize(
    ("passable", "confirmed", "known"),
    [
        (1.0, True, Knowledge.YES),
        (1.0, False, Knowledge.OPEN),
        (0.95, True, Knowledge.OPEN),
        (0.5, True, Knowledge.OPEN),
        (0.005, False, Knowledge.NO),
        (0.0, True, Knowledge.NO),
    ],
)
def test_a_region_needs_certainty_and_an_explicit_yes(passable: float, confirmed: bool, known: Knowledge) -> None:
    said = frozenset({OBSTACLE}) if confirmed else frozenset()
    assert apply_knowledge(a_map(), belief(passable, 0.5), said, AskingSettings()).regions[0].passable is known


@pytest.mark.parametrize(("present", "known"), [(0.97, Knowledge.YES), (0.5, Knowledge.OPEN), (0.02, Knowledge.NO)])
def test_rooms_are_settled_by_the_posterior(present: float, known: Knowledge) -> None:
    assert apply_knowledge(a_map(), belief(0.5, present), frozenset(), AskingSettings()).rooms[0].occupied is known


@given(passable=st.floats(0, 1), present=st.floats(0, 1))
@settings(deadline=None, max_examples=50)
def test_without_an_explicit_yes_no_region_ever_becomes_passable(passable: float, present: float) -> None:
    settled = apply_knowledge(a_map(), belief(passable, present), frozenset({PRESENCE}), AskingSettings())
    assert settled.regions[0].passable is not Knowledge.YES


def test_what_is_settled_stays() -> None:
    known = a_map().with_region("smoke-1", Knowledge.NO).with_room("room-1", occupied=Knowledge.YES)
    again = apply_knowledge(known, belief(1.0, 0.0), frozenset({OBSTACLE}), AskingSettings())
    assert again.regions[0].passable is Knowledge.NO
    assert again.rooms[0].occupied is Knowledge.YES
