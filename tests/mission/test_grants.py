"""A yes covers the outline that was shown, grown by one voxel, for a time (method, section 12)."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from mintpilot.core.gap import obstacle_id
from mintpilot.core.geometry import GridFrame
from mintpilot.core.mission import AskingSettings
from mintpilot.core.observation import RegionKind
from mintpilot.core.semantic_map import Cell, Knowledge, Region, SemanticMap
from mintpilot.mission.belief_state import BeliefState
from mintpilot.mission.grants import granted, reopened
from mintpilot.reasoning.belief import prior_belief

SHAPE = (1, 9, 9)
ASKING = AskingSettings(answer_valid_s=100.0)
SMOKE = obstacle_id("smoke-1")


def square(middle: tuple[int, int], half: int) -> np.ndarray:
    flags = np.zeros(SHAPE, bool)
    y, x = middle
    flags[0, y - half : y + half + 1, x - half : x + half + 1] = True
    return np.flatnonzero(flags)


def map_with(cells: np.ndarray, passable: Knowledge = Knowledge.YES) -> SemanticMap:
    frame = GridFrame(origin_m=(0.0, 0.0, 0.0), resolution_m=0.2, shape=SHAPE)
    region = Region(id="smoke-1", kind=RegionKind.SMOKE, cells=cells, passable=passable)
    return SemanticMap(frame=frame, cells=np.full(SHAPE, Cell.FREE, np.uint8), regions=(region,))


def after_a_yes() -> BeliefState:
    shown = map_with(square((4, 4), 1))
    state = BeliefState(map=shown, belief=prior_belief(()), confirmed=frozenset({SMOKE}))
    return granted(state, {SMOKE}, shown, now_s=50.0)


def is_open(state: BeliefState) -> bool:
    (region,) = state.map.regions
    return region.passable is Knowledge.OPEN and SMOKE not in state.confirmed and not state.grants


def test_what_stays_the_same_stays_permitted() -> None:
    state = after_a_yes()
    assert reopened(state, ASKING, 149.0) is state


@pytest.mark.parametrize(
    ("cells", "opens"),
    [
        (square((4, 4), 0), False),
        (square((4, 4), 2), False),
        (square((4, 4), 3), True),
        (np.union1d(square((4, 4), 1), square((4, 7), 0)), True),
    ],
    ids=["shrunk", "grown by a voxel", "grown by two", "merged with another"],
)
def test_growth_and_merging_reopen(cells: np.ndarray, opens: bool) -> None:
    state = replace(after_a_yes(), map=map_with(cells))
    assert is_open(reopened(state, ASKING, 60.0)) == opens


def test_age_reopens() -> None:
    assert is_open(reopened(after_a_yes(), ASKING, 150.0))


def test_a_map_that_calls_a_region_passable_grants_nothing() -> None:
    state = BeliefState(map=map_with(square((4, 4), 1)), belief=prior_belief(()))
    assert is_open(reopened(state, ASKING, 0.0))
    assert reopened(state, ASKING, 0.0, known=frozenset({SMOKE})) is state
