"""The body keeps its clearance, whatever the cell size: planned, checked and flown, against a checker of its own."""

from __future__ import annotations

import numpy as np
import pytest
from bench.clearance import ROUNDING_M, fly
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.oracles.clearance import densely, distances

from mintpilot.core.errors import InfeasibleError
from mintpilot.core.geometry import GridFrame
from mintpilot.core.observation import RegionKind
from mintpilot.core.plan import VehicleLimits
from mintpilot.core.semantic_map import Cell, Knowledge, Region, SemanticMap
from mintpilot.planning.checks import check_path
from mintpilot.planning.flyable import known_flyable
from mintpilot.planning.grid_search import shortest_path
from mintpilot.planning.trajectory import plan_trajectory

cells_m = st.sampled_from([0.02, 0.05, 0.1, 0.25, 0.5, 0.8, 1.0, 2.0])
bodies_m = st.sampled_from([0.05, 0.3, 0.4, 0.7, 1.0])
seeds = st.integers(0, 10**6)


def random_world(seed: int, cell_m: float, *, tall: bool = False) -> tuple[SemanticMap, np.ndarray]:
    """A map with walls, unknown cells and a region of any knowledge; and the cells that bar the way."""
    rng = np.random.default_rng(seed)
    edge = int(np.clip(6 / cell_m, 8, 60))
    shape = (7, min(edge, 16), min(edge, 16)) if tall else (1, edge, edge)
    cells = rng.choice([Cell.FREE] * 40 + [Cell.OCCUPIED, Cell.UNKNOWN], size=shape).astype(np.uint8)
    block = np.zeros(shape, bool)
    block[tuple(slice(a, a + 1 + n // 6) for a, n in zip(rng.integers(0, shape), shape, strict=True))] = True
    known = rng.choice(list(Knowledge))
    region = Region(id="area", kind=RegionKind.AREA, cells=np.flatnonzero(block), passable=Knowledge(known))
    frame = GridFrame(origin_m=(-3.7, 11.3, 0.5), resolution_m=cell_m, shape=shape)
    barred = (cells != Cell.FREE) | (block if known != Knowledge.YES else False)
    return SemanticMap(frame=frame, cells=cells, regions=(region,)), barred


@pytest.mark.long
@settings(deadline=None, max_examples=60)
@given(seed=seeds, cell_m=cells_m, body_m=bodies_m, tall=st.booleans())
def test_the_check_agrees_with_dense_sampling(seed: int, cell_m: float, body_m: float, tall: bool) -> None:
    map, barred = random_world(seed, cell_m, tall=tall)
    body_m = min(body_m, (3 if tall else 8) * cell_m)
    rng = np.random.default_rng(seed)
    box = map.frame.box
    path = rng.uniform(box.lo_m, box.hi_m, size=(2, 3))
    path[1] = path[0] + (path[1] - path[0]) * rng.choice([0.0, 0.1, 1.0])
    spacing = float(np.linalg.norm(path[1] - path[0])) / 400 + 1e-9
    gaps = distances(densely(path, spacing), barred, map.frame.origin_m, cell_m, body_m + cell_m)
    refused = check_path(path, map, VehicleLimits(radius_m=body_m / 2, margin_m=body_m / 2))
    if gaps[0] >= body_m:  # what begins too near may leave, which is tested elsewhere
        assert not refused or gaps.min() <= body_m + spacing
        assert refused or gaps.min() >= body_m - 1e-6


@pytest.mark.long
@settings(deadline=None, max_examples=50)
@given(seed=seeds, cell_m=cells_m, body_m=bodies_m, tall=st.booleans())
def test_every_path_of_the_search_and_its_trajectory_keep_the_clearance(
    seed: int, cell_m: float, body_m: float, tall: bool
) -> None:
    map, barred = random_world(seed, cell_m, tall=tall)
    body_m = min(body_m, (3 if tall else 12) * cell_m)
    limits = VehicleLimits(radius_m=body_m, margin_m=0.0)
    flyable = np.argwhere(known_flyable(map, limits))
    if not len(flyable):
        return
    rng = np.random.default_rng(seed)
    start, goal = (tuple(int(i) for i in cell) for cell in flyable[rng.integers(len(flyable), size=2)])
    try:
        path = map.frame.centres_of(shortest_path(known_flyable(map, limits), start, goal)[1])
    except InfeasibleError:
        return
    assert not check_path(path, map, limits)
    trajectory = plan_trajectory(path, map=map, limits=limits)
    for way in (path, trajectory.position_m):
        gaps = distances(densely(way, max(cell_m / 4, 0.02)), barred, map.frame.origin_m, cell_m, body_m + 0.01)
        assert gaps.min() >= body_m - 1e-6


def two_walls() -> SemanticMap:
    """Two cells that touch at a corner."""
    cells = np.full((1, 3, 4), Cell.FREE, np.uint8)
    cells[0, 0, 2] = cells[0, 1, 1] = Cell.OCCUPIED
    return SemanticMap(frame=GridFrame(origin_m=(0, 0, 0.5), resolution_m=1.0, shape=(1, 3, 4)), cells=cells)


@pytest.mark.parametrize("body_m", [1e-3, 0.1, 0.4])
def test_nothing_flies_between_two_walls_that_touch_at_a_corner(body_m: float) -> None:
    limits = VehicleLimits(radius_m=body_m, margin_m=0.0)
    through = np.array([[1.5, 0.5, 1.0], [2.5, 1.5, 1.0]])
    assert "which is occupied" in str(check_path(through, two_walls(), limits))
    with pytest.raises(InfeasibleError, match="cannot be flown"):
        plan_trajectory(through, map=two_walls(), limits=limits)


def test_position_uncertainty_adds_three_sigma() -> None:
    cells = np.full((1, 40, 40), Cell.FREE, np.uint8)
    cells[0, :10] = Cell.OCCUPIED
    map = SemanticMap(frame=GridFrame(origin_m=(0, 0, 0.9), resolution_m=0.1, shape=cells.shape), cells=cells)
    beside = np.array([[1.0, 1.5, 1.0], [3.0, 1.5, 1.0]])
    assert not check_path(beside, map, VehicleLimits(radius_m=0.3, margin_m=0.1, position_sigma_m=0.03))
    assert "0.52 m" in str(check_path(beside, map, VehicleLimits(radius_m=0.3, margin_m=0.1, position_sigma_m=0.04)))


@pytest.mark.long
@settings(deadline=None, max_examples=5)
@given(seed=st.integers(0, 10**6))
def test_whole_missions_stay_away_from_all_that_is_not_known_free(seed: int) -> None:
    assert fly(seed).spare_m >= -ROUNDING_M
