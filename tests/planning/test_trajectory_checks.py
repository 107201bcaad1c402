"""The last gate: nothing that enters what is not known flyable passes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from mintpilot.core.geometry import GridFrame
from mintpilot.core.observation import RegionKind
from mintpilot.core.plan import VehicleLimits
from mintpilot.core.semantic_map import Cell, Knowledge, Region, SemanticMap
from mintpilot.core.trajectory import Trajectory
from mintpilot.planning.checks import check_path, check_trajectory
from mintpilot.planning.flyable import known_flyable

LIMITS = VehicleLimits()
POINT_ROBOT = VehicleLimits(radius_m=1e-3, margin_m=0.0)
FRAME = GridFrame(origin_m=(0.0, 0.0, 0.0), resolution_m=0.2, shape=(10, 30, 30))


def hall(**changes: object) -> SemanticMap:
    cells = np.full(FRAME.shape, Cell.FREE, np.uint8)
    return replace(SemanticMap(frame=FRAME, cells=cells), **changes)


def with_cell(state: Cell, cell: tuple[int, int, int]) -> SemanticMap:
    cells = np.full(FRAME.shape, Cell.FREE, np.uint8)
    cells[cell] = state
    return hall(cells=cells)


def cloud(passable: Knowledge) -> Region:
    block = np.zeros(FRAME.shape, bool)
    block[:, 12:18, 12:18] = True
    return Region(id="smoke-1", kind=RegionKind.SMOKE, cells=np.flatnonzero(block), passable=passable)


inside = st.floats(0.6, 5.4)
heights = st.floats(0.6, 1.4)


@pytest.mark.long
@settings(deadline=None, max_examples=150)
@given(a=st.tuples(inside, inside, heights), b=st.tuples(inside, inside, heights), share=st.floats(0.02, 0.98))
@pytest.mark.parametrize("state", [Cell.UNKNOWN, Cell.OCCUPIED])
def test_no_path_through_a_bad_cell_passes(
    state: Cell, a: tuple[float, float, float], b: tuple[float, float, float], share: float
) -> None:
    a_m, b_m = np.asarray(a), np.asarray(b)
    spot = a_m + share * (b_m - a_m)
    within = spot / 0.2 - np.floor(spot / 0.2)
    assume(((within > 1e-3) & (within < 1 - 1e-3)).all())
    map = with_cell(state, tuple(int(i) for i in FRAME.cells_of(spot)[0]))
    path = np.stack([a_m, b_m])
    for limits in (LIMITS, POINT_ROBOT):
        assert check_path(path, map, limits)
    assert not check_path(path, hall(), POINT_ROBOT)


@settings(deadline=None, max_examples=60)
@given(a=st.tuples(inside, inside, heights), b=st.tuples(inside, inside, heights), known=st.sampled_from(Knowledge))
def test_regions_are_entered_only_with_yes(
    a: tuple[float, float, float], b: tuple[float, float, float], known: Knowledge
) -> None:
    map = hall(regions=(cloud(known),))
    path = np.stack([a, b])
    points = path[0] + np.linspace(0, 1, 500)[:, None] * (path[1] - path[0])
    enters = np.isin(np.ravel_multi_index(tuple(FRAME.cells_of(points).T), FRAME.shape), map.regions[0].cells).any()
    words = str(check_path(path, map, POINT_ROBOT))
    if known is Knowledge.YES:
        assert words == ""
    elif enters:
        assert "region 'smoke-1'" in words


def test_one_yes_does_not_open_an_overlapping_region() -> None:
    yes, still_open = cloud(Knowledge.YES), replace(cloud(Knowledge.OPEN), id="smoke-2")
    path = np.array([[0.7, 3.0, 1.0], [5.3, 3.0, 1.0]])
    assert "smoke-2" in str(check_path(path, hall(regions=(yes, still_open)), LIMITS))
    assert not check_path(path, hall(regions=(yes, replace(still_open, passable=Knowledge.YES))), LIMITS)


def test_the_sentence_says_where_and_why() -> None:
    path = np.array([[0.7, 3.1, 1.1], [5.3, 3.1, 1.1]])
    assert "(15, 15)" in str(check_path(path, with_cell(Cell.UNKNOWN, (5, 15, 15)), POINT_ROBOT)).replace("(5, ", "(")
    assert "never seen" in str(check_path(path, with_cell(Cell.UNKNOWN, (5, 15, 15)), POINT_ROBOT))
    assert "is occupied" in str(check_path(path, with_cell(Cell.OCCUPIED, (5, 15, 15)), POINT_ROBOT))
    assert "nearer than 0.40 m to cell (5, 17, 15), which is occupied" in str(
        check_path(path, with_cell(Cell.OCCUPIED, (5, 17, 15)), LIMITS)
    )
    beside = np.array([[0.7, 2.3, 1.1], [5.3, 2.3, 1.1]])
    closed = hall(regions=(cloud(Knowledge.NO),))
    assert "nearer than 0.40 m to region 'smoke-1'" in str(check_path(beside, closed, LIMITS))
    assert "leaves the map" in str(check_path(np.array([[1.0, 1.0, 1.0], [1e9, 1.0, 1.0]]), hall(), LIMITS))
    assert "way-point 1 is not a finite" in str(
        check_path(np.array([[1.0, 1.0, 1.0], [np.inf, 1.0, 1.0]]), hall(), LIMITS)
    )
    assert "shape" in str(check_path(np.zeros((0, 3)), hall(), LIMITS))


def wall_beside() -> SemanticMap:
    cells = np.full(FRAME.shape, Cell.FREE, np.uint8)
    cells[:, :, :5] = Cell.OCCUPIED
    return hall(cells=cells)


def test_a_start_beside_something_may_leave_it_straight() -> None:
    start, out, on = (1.15, 3.1, 1.1), (1.5, 3.1, 1.1), (1.5, 5.0, 1.1)
    assert not known_flyable(wall_beside(), LIMITS)[tuple(FRAME.cells_of(start)[0])]
    assert not check_path(np.array([start, out, on]), wall_beside(), LIMITS)
    assert check_path(np.array([on, out, start]), wall_beside(), LIMITS), "the end has no such licence"
    along = np.array([start, (1.15, 3.9, 1.1), (1.5, 3.9, 1.1)])
    assert check_path(along, wall_beside(), LIMITS), "too far along the wall"
    crooked = np.array([start, (1.15, 3.3, 1.1), (1.5, 3.3, 1.1)])
    assert check_path(crooked, wall_beside(), LIMITS), "not straight"


def test_the_licence_to_leave_ends_at_what_is_not_free() -> None:
    path = np.array([(1.15, 3.1, 1.1), (1.5, 3.1, 1.1)])
    cells = np.array(wall_beside().cells)
    cells[5, 15, 5] = Cell.UNKNOWN
    assert "never seen" in str(check_path(path, hall(cells=cells), LIMITS))
    here = np.ravel_multi_index((5, 15, 5), FRAME.shape)
    region = Region(id="area-1", kind=RegionKind.AREA, cells=np.array([here]))
    assert "area-1" in str(check_path(path, replace(wall_beside(), regions=(region,)), LIMITS))


def make_trajectory(position: np.ndarray, time: np.ndarray) -> Trajectory:
    still = np.zeros_like(position)
    return Trajectory(
        time_s=time, position_m=position, velocity_mps=still, acceleration_mps2=still, yaw_rad=np.zeros(len(position))
    )


def test_trajectories_are_checked_between_their_samples() -> None:
    map = with_cell(Cell.OCCUPIED, (5, 15, 15))
    jump = np.array([[0.7, 3.1, 1.1], [5.3, 3.1, 1.1]])
    assert "occupied" in str(check_trajectory(make_trajectory(jump, np.array([0.0, 0.1])), map, POINT_ROBOT))
    assert not check_trajectory(make_trajectory(jump, np.array([0.0, 0.1])), hall(), LIMITS)
    assert "do not ascend" in str(check_trajectory(make_trajectory(jump, np.array([0.0, 0.0])), hall(), LIMITS))
