"""Looking ahead, going back, and exploring: on small maps drawn by hand."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from mintpilot.core.geometry import GridFrame
from mintpilot.core.observation import RegionKind
from mintpilot.core.plan import VehicleLimits
from mintpilot.core.semantic_map import Cell, Knowledge, Region, SemanticMap
from mintpilot.core.trajectory import VehicleState
from mintpilot.mission.path_monitor import CONFIRMING_LOOKS, PathMonitor
from mintpilot.mission.way_back import is_stranded, way_back
from mintpilot.planning.checks import check_path
from mintpilot.planning.flyable import known_flyable
from mintpilot.planning.reach import LookAround, next_view, way_to
from mintpilot.planning.sight import inspect, view_gain_m3

LIMITS = VehicleLimits(radius_m=0.2, margin_m=0.05)
FRAME = GridFrame(origin_m=(0.0, 0.0, 0.0), resolution_m=0.2, shape=(10, 20, 50))


def hall() -> SemanticMap:
    """10 m x 4 m x 2 m of free space with a floor."""
    cells = np.full(FRAME.shape, Cell.FREE, np.uint8)
    cells[0] = Cell.OCCUPIED
    return SemanticMap(frame=FRAME, cells=cells)


def with_cloud(world: SemanticMap, x: tuple[float, float]) -> SemanticMap:
    mask = np.zeros(FRAME.shape, bool)
    mask[:, :, int(x[0] / 0.2) : int(x[1] / 0.2)] = True
    cloud = Region(id="smoke-1", kind=RegionKind.SMOKE, cells=np.flatnonzero(mask & (world.cells == Cell.FREE)))
    return replace(world, regions=(cloud,))


def at(x: float) -> VehicleState:
    return VehicleState(time_s=0.0, position_m=(x, 2.0, 1.0), velocity_mps=(0.0, 0.0, 0.0), yaw_rad=0.0)


WAY = np.column_stack([np.linspace(1.0, 9.0, 81), np.full(81, 2.0), np.full(81, 1.0)])


def test_a_free_way_is_no_trouble() -> None:
    monitor = PathMonitor(WAY, LIMITS)
    assert not any(monitor.assess(hall(), tuple(p)) for p in WAY[::10])


def test_trouble_close_ahead_stops_at_once() -> None:
    assert "smoke-1" in str(PathMonitor(WAY, LIMITS).assess(with_cloud(hall(), (2.0, 3.0)), (1.0, 2.0, 1.0)))


def test_trouble_far_ahead_must_be_seen_again() -> None:
    monitor, clouded = PathMonitor(WAY, LIMITS), with_cloud(hall(), (7.0, 8.0))
    looks = [monitor.assess(clouded, (1.0, 2.0, 1.0)) for _ in range(CONFIRMING_LOOKS)]
    assert not any(looks[:-1])
    assert looks[-1]


def test_trouble_that_flickers_is_forgotten() -> None:
    monitor, clouded = PathMonitor(WAY, LIMITS), with_cloud(hall(), (7.0, 8.0))
    for world in (clouded, hall(), clouded, hall()):
        assert not monitor.assess(world, (1.0, 2.0, 1.0))


def test_what_is_behind_is_no_trouble() -> None:
    monitor = PathMonitor(WAY, LIMITS)
    for x in (2.0, 4.0, 6.0):
        monitor.assess(hall(), (x, 2.0, 1.0))
    assert not monitor.assess(with_cloud(hall(), (1.0, 2.0)), (6.0, 2.0, 1.0))


def test_a_cloud_around_the_drone_strands_it_and_it_goes_back() -> None:
    world, track = with_cloud(hall(), (4.0, 7.0)), WAY[:51]
    assert not is_stranded(hall(), LIMITS, at(6.0))
    assert is_stranded(world, LIMITS, at(6.0))
    back = way_back(world, LIMITS, at(6.0), track)
    assert back is not None
    end = back.position_m[-1]
    assert end[0] < 4.0
    assert not check_path(end[None], world, LIMITS)


def test_the_way_back_never_goes_through_matter() -> None:
    world = with_cloud(hall(), (4.0, 7.0))
    cells = world.cells.copy()
    cells[:, :, 25] = Cell.OCCUPIED
    assert way_back(replace(world, cells=cells), LIMITS, at(6.0), WAY[:51]) is None


def test_what_is_flyable_behind_a_wall_is_no_place_to_start_from() -> None:
    cells = hall().cells.copy()
    cells[:, :, 25:31] = Cell.UNKNOWN
    cells[:, :, 31] = Cell.OCCUPIED
    boxed_in, dot = replace(hall(), cells=cells), VehicleLimits(radius_m=0.05, margin_m=0.0)
    assert known_flyable(boxed_in, dot)[5, 10, 32]  # 0.4 m away, behind the wall
    assert is_stranded(boxed_in, dot, at(6.1))
    cells = cells.copy()
    cells[:, :, 30:32] = Cell.FREE
    assert not is_stranded(replace(hall(), cells=cells.copy()), dot, at(6.02))


def test_the_way_back_may_use_up_the_margin() -> None:
    world = with_cloud(hall(), (4.0, 7.0))
    cells = world.cells.copy()
    cells[:, 11, 22:25] = Cell.OCCUPIED  # 0.2 m from the track's line: nearer than radius and margin, not than radius
    tight = replace(world, cells=cells)
    narrow = replace(LIMITS, radius_m=0.15, margin_m=0.15)
    assert check_path(WAY[30:51], tight, narrow)
    assert way_back(tight, narrow, at(6.0), WAY[:51]) is not None


def test_without_a_track_there_is_no_way_back() -> None:
    assert way_back(with_cloud(hall(), (4.0, 7.0)), LIMITS, at(6.0), np.zeros((0, 3))) is None


def half_known() -> SemanticMap:
    world = hall()
    cells = world.cells.copy()
    cells[1:, :, 25:] = Cell.UNKNOWN
    return replace(world, cells=cells)


def test_exploring_goes_towards_the_unknown_through_the_known() -> None:
    world = half_known()
    inspected = np.ones(FRAME.shape, bool)
    look = LookAround(lowest_m=0.4)
    way = next_view(
        world,
        LIMITS,
        start_m=(1.0, 2.0, 1.0),
        seen_from_m=np.array([[1.0, 2.0, 1.0]]),
        inspected=inspected,
        settings=look,
    )
    assert way is not None
    assert way[-1, 0] > 3.0
    assert not check_path(way, world, LIMITS)


def test_exploring_ends_when_nothing_is_unknown() -> None:
    arguments = {"start_m": (1.0, 2.0, 1.0), "seen_from_m": np.array([[1.0, 2.0, 1.0]])}
    inspected = np.ones(FRAME.shape, bool)
    assert next_view(hall(), LIMITS, inspected=inspected, settings=LookAround(), **arguments) is None


def test_walls_hide_the_unknown() -> None:
    world = half_known()
    cells = world.cells.copy()
    cells[:, :, 24] = Cell.OCCUPIED
    look = {"reach_m": 5.0, "close_m": 4.0, "elevation_rad": (-0.6, 0.3)}
    places, inspected = np.array([[3.0, 2.0, 1.0]]), np.ones(FRAME.shape, bool)
    assert view_gain_m3(world, inspected, places, **look)[0] > 1.0
    assert view_gain_m3(replace(world, cells=cells), inspected, places, **look)[0] == 0.0


def test_smoke_hides_the_unknown() -> None:
    look = {"reach_m": 5.0, "close_m": 4.0, "elevation_rad": (-0.6, 0.3)}
    places, inspected = np.array([[3.0, 2.0, 1.0]]), np.ones(FRAME.shape, bool)
    assert view_gain_m3(with_cloud(half_known(), (4.0, 5.0)), inspected, places, **look)[0] == 0.0


def test_a_surface_is_news_until_it_was_looked_at() -> None:
    world = hall()
    cells = world.cells.copy()
    cells[:, :, 30] = Cell.OCCUPIED
    world = replace(world, cells=cells)
    look = {"close_m": 4.0, "elevation_rad": (-0.6, 0.3)}
    place, inspected = np.array([4.0, 2.0, 1.0]), np.zeros(FRAME.shape, bool)
    before = view_gain_m3(world, inspected, place[None], reach_m=5.0, **look)[0]
    inspect(world, inspected, place, **look)
    after = view_gain_m3(world, inspected, place[None], reach_m=5.0, **look)[0]
    assert before > 0.5
    assert after < 0.1 * before


@pytest.mark.parametrize("passable", [Knowledge.OPEN, Knowledge.NO, Knowledge.YES])
def test_ways_lead_through_regions_only_when_they_are_known_passable(passable: Knowledge) -> None:
    world = with_cloud(hall(), (4.0, 5.0)).with_region("smoke-1", passable)
    way = way_to(world, LIMITS, start_m=(1.0, 2.0, 1.0), goal_m=(9.0, 2.0, 1.0))
    assert (way is not None) is (passable is Knowledge.YES)
