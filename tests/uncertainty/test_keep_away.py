"""Distances that are to be kept: exact by brute force, kept by plans, and given up only by asking."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mintpilot.core.observation import RegionKind
from mintpilot.core.plan import VehicleLimits
from mintpilot.core.semantic_map import Knowledge, MapObject, Region, SemanticMap
from mintpilot.core.task import Action, KeepAway, Reference, SubGoal, Task
from mintpilot.planning.checks import check_path
from mintpilot.uncertainty import find_gaps, with_keep_away

from .worlds import START_M, smoke, step, thing, world

LIMITS = VehicleLimits(radius_m=0.3, margin_m=0.1)
PEOPLE = Reference(phrase="people", label="person", every=True)
BOX = thing("box-1", "box", (17, 7, 1))


def task(*wishes: KeepAway, goal: SubGoal | None = None) -> Task:
    return Task(instruction="", subgoals=(goal or step(Action.GO, "the box", "box"),), keep_away=wishes)


def drawn(map: SemanticMap, wish: KeepAway, goal: SubGoal | None = None) -> list[Region]:
    seen = with_keep_away(map, task(wish, goal=goal), start_m=START_M)
    return [region for region in seen.regions if region.id.startswith("keep-away-")]


def least_gap_m(cell_centre: np.ndarray, half_m: float, person: MapObject) -> float:
    """By sampling: the least distance between points of a cell and the box."""
    offsets = np.linspace(-half_m, half_m, 5)
    points = cell_centre + np.stack(np.meshgrid(offsets, offsets, offsets), -1).reshape(-1, 3)
    nearest = np.clip(points, person.box_m.lo_m, person.box_m.hi_m)
    return float(np.linalg.norm(points - nearest, axis=1).min())


@pytest.mark.long
@given(
    st.tuples(st.floats(5, 18), st.floats(2, 13), st.floats(0.5, 3)),
    st.floats(0.3, 2.5),
    st.lists(st.integers(0, 8 * 30 * 40 - 1), min_size=20, max_size=20),
)
def test_a_cell_belongs_to_the_region_where_any_part_of_it_is_too_near(
    at_m: tuple[float, float, float], distance_m: float, cells: list[int]
) -> None:
    person = thing("person-1", "person", at_m, edge_m=0.6)
    map = world([BOX, person])
    (region,) = drawn(map, KeepAway(reference=PEOPLE, distance_m=distance_m))
    inside = set(region.cells.tolist())
    for cell in [*cells, *region.cells[:: max(1, len(region.cells) // 10)].tolist()]:
        centre = map.frame.centres_of([np.unravel_index(cell, map.frame.shape)])[0]
        if (gap_m := least_gap_m(centre, 0.25, person)) < distance_m - 1e-9:
            assert cell in inside
        elif gap_m > distance_m + 0.25 * math.sqrt(3):
            assert cell not in inside


def test_the_last_check_keeps_the_bodys_clearance_from_the_person() -> None:
    map = world([BOX, thing("person-1", "person", (10, 7.5, 1))])
    seen = with_keep_away(map, task(KeepAway(reference=PEOPLE)), start_m=START_M)
    straight, aside = np.array([START_M, (17.0, 7.5, 1.0)]), np.array([START_M, (10.0, 12.5, 1.0), (17.0, 7.5, 1.0)])
    assert "keep-away-1" in str(check_path(straight, seen, LIMITS))
    assert not check_path(aside, seen, LIMITS)
    assert not check_path(straight, map, LIMITS)


def test_it_is_a_wish_that_opens_its_gap_only_when_it_is_given_up() -> None:
    wishful = task(KeepAway(reference=PEOPLE, distance_m=1.5))
    seen = with_keep_away(world([BOX, thing("person-1", "person", (10, 7.5, 1))]), wishful, start_m=START_M)
    kept = find_gaps(seen, wishful, start_m=START_M)
    assert (kept.gaps, kept.wishes) == ((), ("keep-away-1",))
    (gap,) = find_gaps(seen, wishful, start_m=START_M, honour_wishes=False).gaps
    assert (gap.id, gap.description) == ("obstacle:keep-away-1", "the space within 1.5 m of people")


def test_the_one_who_is_gone_to_is_no_reason_to_stay_away() -> None:
    hurt, other = thing("person-1", "person", (15, 7, 1), condition="injured"), thing("person-2", "person", (8, 3, 1))
    goal = step(Action.GO, "the injured person", "person", condition="injured")
    healthy = thing("person-2", "person", (8, 3, 1), condition="healthy")
    (region,) = drawn(world([hurt, healthy]), KeepAway(reference=PEOPLE), goal)
    (alone,) = drawn(world([healthy]), KeepAway(reference=PEOPLE), goal)
    assert region.cells.tolist() == alone.cells.tolist()
    assert drawn(world([hurt]), KeepAway(reference=PEOPLE), goal) == []
    assert len(drawn(world([hurt, other]), KeepAway(reference=PEOPLE), goal)) == 1


@pytest.mark.parametrize(
    "reference", [Reference(phrase="smoke", label="smoke"), Reference(phrase="smoke-1", object_id="smoke-1")]
)
def test_regions_are_kept_away_from_by_kind_and_by_id(reference: Reference) -> None:
    map = world([BOX], [smoke("smoke-1", 5000)])
    (region,) = drawn(map, KeepAway(reference=reference, distance_m=1.0))
    assert set(range(5000, 5004)) <= set(region.cells.tolist())
    assert region.kind is RegionKind.AREA
    assert 4 < len(region.cells) < 400


def test_what_was_allowed_stays_so_until_the_region_grows() -> None:
    wishful = task(KeepAway(reference=PEOPLE))
    first = thing("person-1", "person", (10, 7.5, 1))
    seen = with_keep_away(world([BOX, first]), wishful, start_m=START_M)
    allowed = seen.with_region("keep-away-1", Knowledge.YES)
    again = with_keep_away(world([BOX, first]), wishful, start_m=START_M, previous=allowed)
    assert again.regions[0].passable is Knowledge.YES
    more = world([BOX, first, thing("person-2", "person", (14, 3, 1))])
    grown = with_keep_away(more, wishful, start_m=START_M, previous=allowed)
    assert grown.regions[0].passable is Knowledge.OPEN


def test_without_a_wish_the_map_is_left_alone() -> None:
    map = world([BOX])
    assert with_keep_away(map, task(), start_m=START_M) is map
