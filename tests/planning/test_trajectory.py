"""Trajectories: limits, ends, headings, clearness over random worlds, duration."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from tests.oracles.clearance import densely, distances

from mintpilot.core.errors import InfeasibleError, InputError
from mintpilot.core.geometry import Floats, GridFrame
from mintpilot.core.plan import VehicleLimits
from mintpilot.core.semantic_map import Cell, SemanticMap
from mintpilot.core.trajectory import Trajectory
from mintpilot.planning.checks import check_path, check_trajectory
from mintpilot.planning.flyable import known_flyable
from mintpilot.planning.grid_search import shortest_path
from mintpilot.planning.motion import SMOOTHING_S
from mintpilot.planning.trajectory import YAW_RATE_RAD_S, plan_trajectory

LIMITS = VehicleLimits()
STEP_S = 0.02


def open_hall(shape: tuple[int, int, int] = (10, 50, 60)) -> SemanticMap:
    frame = GridFrame(origin_m=(-1.0, 2.0, 0.0), resolution_m=0.2, shape=shape)
    return SemanticMap(frame=frame, cells=np.full(shape, Cell.FREE, np.uint8))


def cluttered_hall(seed: int) -> SemanticMap:
    rng = np.random.default_rng(seed)
    cells = np.full((10, 40, 50), Cell.FREE, np.uint8)
    for _ in range(10):
        y, x, top = rng.integers(0, 36), rng.integers(2, 46), rng.integers(3, 11)
        kind = Cell.OCCUPIED if rng.random() < 0.7 else Cell.UNKNOWN
        cells[:top, y : y + rng.integers(1, 10), x : x + rng.integers(1, 5)] = kind
    frame = GridFrame(origin_m=(0.0, 0.0, 0.0), resolution_m=0.2, shape=cells.shape)
    return SemanticMap(frame=frame, cells=cells)


def random_path(map: SemanticMap, seed: int) -> Floats | None:
    """A shortest grid path between two random flyable cells; None where they are not connected."""
    free = known_flyable(map, LIMITS)
    cells = np.argwhere(free)
    if len(cells) == 0:
        return None
    start, goal = (tuple(int(i) for i in c) for c in cells[np.random.default_rng(seed).integers(len(cells), size=2)])
    try:
        return map.frame.centres_of(shortest_path(free, start, goal)[1])
    except InfeasibleError:
        return None


def assert_within_limits(t: Trajectory, speed_mps: float) -> None:
    velocity = np.diff(t.position_m, axis=0) / np.diff(t.time_s)[:, None]
    acceleration = np.diff(velocity, axis=0) / np.diff(t.time_s)[1:, None]
    for rates, most in (
        (t.velocity_mps, speed_mps),
        (velocity, speed_mps),
        (t.acceleration_mps2, LIMITS.max_acceleration_mps2),
        (acceleration, LIMITS.max_acceleration_mps2),
    ):
        assert np.linalg.norm(rates, axis=1).max(initial=0.0) <= most * (1 + 1e-6)
    turns = np.abs(np.diff(t.yaw_rad))
    assert turns.max(initial=0.0) <= YAW_RATE_RAD_S * np.diff(t.time_s).max() * (1 + 1e-9)
    for ends in (t.velocity_mps[[0, -1]], t.acceleration_mps2[[0, -1]]):
        assert not ends.any()


@pytest.mark.long
@settings(deadline=None, max_examples=40)
@given(seed=st.integers(0, 10**6), speed=st.sampled_from([None, 0.5, 3.0]))
@example(seed=91207, speed=None)
def test_random_paths_stay_clear_and_within_limits(seed: int, speed: float | None) -> None:
    map = cluttered_hall(seed)
    path = random_path(map, seed)
    if path is None:
        return
    assert not check_path(path, map, LIMITS)
    t = plan_trajectory(path, map=map, limits=LIMITS, speed_mps=speed)
    assert not check_trajectory(t, map, LIMITS)
    assert_within_limits(t, speed or LIMITS.cruise_mps)
    np.testing.assert_allclose(t.position_m[[0, -1]], path[[0, -1]], atol=1e-9)
    fine = densely(t.position_m, 0.01)
    barred = map.cells != Cell.FREE
    assert distances(fine, barred, map.frame.origin_m, 0.2, 0.5).min() >= LIMITS.clearance_m - 1e-6


@settings(deadline=None, max_examples=40)
@given(seed=st.integers(0, 10**6))
def test_duration_is_near_length_over_cruise(seed: int) -> None:
    map = cluttered_hall(seed)
    path = random_path(map, seed)
    if path is None or len(path) < 2:
        return
    t = plan_trajectory(path, map=map, limits=LIMITS)
    length = np.linalg.norm(np.diff(path, axis=0), axis=1).sum()
    start_and_stop = LIMITS.cruise_mps / LIMITS.max_acceleration_mps2 + SMOOTHING_S
    assert t.duration_s <= 1.15 * length / LIMITS.cruise_mps + start_and_stop + 1.0
    assert t.length_m <= length + 1e-6


def test_straight_flight_takes_the_least_time_of_its_limits() -> None:
    path = np.array([[0.1, 5.1, 1.1], [9.1, 5.1, 1.1]])
    t = plan_trajectory(path, map=open_hall(), limits=LIMITS)
    assert t.duration_s == pytest.approx(9.0 / 1.5 + 1.5 / 2.0 + SMOOTHING_S, abs=STEP_S)
    assert np.ptp(t.position_m[:, 1:], axis=0).max() < 1e-9
    assert np.abs(np.diff(t.acceleration_mps2, axis=0)).max() <= 2.0 / SMOOTHING_S * STEP_S * (1 + 1e-6)


def test_open_space_is_crossed_straight_whatever_the_path() -> None:
    path = np.array([[1.1, 4.1, 1.1], [1.1, 9.1, 1.1], [7.1, 9.1, 1.1], [7.1, 4.1, 1.1]])
    t = plan_trajectory(path, map=open_hall(), limits=LIMITS)
    assert t.length_m == pytest.approx(6.0, abs=1e-6)


def narrow_bend() -> tuple[SemanticMap, Floats]:
    """A corridor whose flyable part is one cell wide, with a right angle."""
    cells = np.full((10, 40, 40), Cell.OCCUPIED, np.uint8)
    cells[:, 3:8, 3:33] = Cell.FREE
    cells[:, 3:33, 28:33] = Cell.FREE
    frame = GridFrame(origin_m=(0.0, 0.0, 0.0), resolution_m=0.2, shape=cells.shape)
    map = SemanticMap(frame=frame, cells=cells)
    return map, frame.centres_of([[5, 5, 5], [5, 5, 30], [5, 30, 30]])


def test_narrow_bends_are_flown_slowly() -> None:
    map, path = narrow_bend()
    assert known_flyable(map, LIMITS)[5, 5].sum() < 30
    t = plan_trajectory(path, map=map, limits=LIMITS)
    assert not check_trajectory(t, map, LIMITS)
    near = np.linalg.norm(t.position_m - path[1], axis=1) < 0.3
    assert np.linalg.norm(t.velocity_mps[near], axis=1).min() < 0.8 * LIMITS.cruise_mps


def test_a_one_point_path_hovers() -> None:
    here = np.array([[2.1, 5.1, 1.1]])
    t = plan_trajectory(here, map=open_hall(), limits=LIMITS, start_yaw_rad=0.3)
    assert 0 < t.duration_s < 1
    assert (t.position_m == here).all()
    assert (t.yaw_rad == 0.3).all()
    turned = plan_trajectory(here, map=open_hall(), limits=LIMITS, start_yaw_rad=3.0, end_yaw_rad=-3.0)
    assert turned.yaw_rad[-1] == pytest.approx(-3.0 + 2 * np.pi)


@settings(deadline=None, max_examples=30)
@given(start=st.floats(-7, 7), end=st.floats(-7, 7), way=st.floats(-3.1, 3.1), length=st.floats(0.3, 4))
def test_headings_start_and_end_as_asked(start: float, end: float, way: float, length: float) -> None:
    here = np.array([5.0, 7.0, 1.1])
    there = here + np.array([length * np.cos(way), length * np.sin(way), 0.0])
    path = np.stack([here, there])
    t = plan_trajectory(path, map=open_hall(), limits=LIMITS, start_yaw_rad=start, end_yaw_rad=end)
    assert t.yaw_rad[0] == start
    assert np.cos(t.yaw_rad[-1] - end) == pytest.approx(1.0)
    assert_within_limits(t, LIMITS.cruise_mps)


def test_heading_follows_the_motion() -> None:
    path = np.array([[1.1, 4.1, 1.1], [1.1, 10.1, 1.1]])
    t = plan_trajectory(path, map=open_hall(), limits=LIMITS, start_yaw_rad=-np.pi)
    assert t.yaw_rad[-1] == pytest.approx(-1.5 * np.pi), "the short way round, unwrapped"


def test_equal_inputs_give_equal_trajectories() -> None:
    map = cluttered_hall(3)
    path = random_path(map, 5)
    assert path is not None
    a, b = (plan_trajectory(path, map=map, limits=LIMITS) for _ in range(2))
    assert (a.position_m == b.position_m).all()
    assert (a.yaw_rad == b.yaw_rad).all()


def test_take_off_beside_a_wall_goes_straight_into_flyable_space() -> None:
    cells = np.full((10, 40, 40), Cell.FREE, np.uint8)
    cells[:, :, :5] = Cell.OCCUPIED
    frame = GridFrame(origin_m=(0.0, 0.0, 0.0), resolution_m=0.2, shape=cells.shape)
    map = SemanticMap(frame=frame, cells=cells)
    path = np.array([[1.15, 2.0, 1.1], [1.5, 2.1, 1.1], [1.5, 6.1, 1.1]])
    assert not known_flyable(map, LIMITS)[tuple(frame.cells_of(path[0])[0])]
    t = plan_trajectory(path, map=map, limits=LIMITS)
    assert not check_trajectory(t, map, LIMITS)
    assert np.linalg.norm(t.position_m - path[1], axis=1).min() < 1e-3


def test_paths_through_what_is_not_known_flyable_are_refused() -> None:
    map, path = narrow_bend()
    with pytest.raises(InfeasibleError, match="occupied"):
        plan_trajectory(path[[0, 2]], map=map, limits=LIMITS)


@pytest.mark.parametrize(
    ("path", "more", "words"),
    [
        (np.zeros((0, 3)), {}, "n at least 1"),
        (np.zeros((2, 2)), {}, "shape"),
        (np.array([[1.0, np.nan, 1.0]]), {}, "not a finite"),
        (np.array([[1.1, 4.1, 1.1]]), {"speed_mps": 0.0}, "speed_mps"),
        (np.array([[1.1, 4.1, 1.1]]), {"sample_s": float("nan")}, "sample_s"),
        (np.array([[1.1, 4.1, 1.1]]), {"sample_s": 0.5}, "0.1 s"),
        (np.array([[1.1, 4.1, 1.1]]), {"end_yaw_rad": float("inf")}, "headings"),
    ],
)
def test_bad_arguments_are_refused(path: Floats, more: dict[str, float], words: str) -> None:
    with pytest.raises(InputError, match=words):
        plan_trajectory(path, map=open_hall(), limits=LIMITS, **more)
