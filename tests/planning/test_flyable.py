"""Clearance against a direct, independent computation over all pairs of cells."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mintpilot.core.geometry import GridFrame
from mintpilot.core.observation import RegionKind
from mintpilot.core.plan import VehicleLimits
from mintpilot.core.semantic_map import Cell, Knowledge, Region, SemanticMap
from mintpilot.planning.flyable import flyable_cells, known_flyable, region_reach


def make_map(cells: np.ndarray, resolution_m: float = 0.5, regions: tuple[Region, ...] = ()) -> SemanticMap:
    frame = GridFrame(origin_m=(1.0, -2.0, 0.0), resolution_m=resolution_m, shape=cells.shape)
    return SemanticMap(frame=frame, cells=cells.astype(np.uint8), regions=regions)


def make_region(cells: list[int], passable: Knowledge = Knowledge.OPEN, name: str = "r") -> Region:
    return Region(id=name, kind=RegionKind.AREA, cells=np.array(sorted(set(cells)), np.int64), passable=passable)


def cube_distance(cell: np.ndarray, other: np.ndarray, resolution_m: float, flat: bool) -> float:
    gap = np.maximum(np.abs(cell - other) - 0.5, 0.0)
    if flat:
        gap[0] = 0.0
    return float(np.linalg.norm(gap) * resolution_m)


def touching(shape: tuple[int, int, int], solid: set[tuple[int, ...]], radius_m: float, resolution_m: float) -> set:
    found = set()
    for cell in np.ndindex(*shape):
        near = (cube_distance(np.array(cell, float), np.array(o, float), resolution_m, shape[0] == 1) for o in solid)
        if any(d < radius_m * (1 - 1e-9) for d in near):
            found.add(cell)
    return found


@settings(deadline=None, max_examples=40)
@given(
    shape=st.tuples(st.integers(1, 4), st.integers(1, 6), st.integers(1, 6)),
    radius=st.sampled_from([1e-6, 0.2, 0.26, 0.4, 0.75, 0.8, 1.3]),
    seed=st.integers(0, 10_000),
)
def test_clearance_equals_all_pairs(shape: tuple[int, int, int], radius: float, seed: int) -> None:
    rng = np.random.default_rng(seed)
    cells = rng.choice([Cell.FREE, Cell.FREE, Cell.FREE, Cell.FREE, Cell.OCCUPIED, Cell.UNKNOWN], size=shape)
    limits = VehicleLimits(radius_m=radius, margin_m=0.05)
    body = radius + 0.05
    solid = {tuple(c) for c in np.argwhere(cells != Cell.FREE)}
    ring = {
        (z, y, x)
        for z in (range(1) if shape[0] == 1 else range(-1, shape[0] + 1))
        for y in range(-1, shape[1] + 1)
        for x in range(-1, shape[2] + 1)
        if not (0 <= z < shape[0] and 0 <= y < shape[1] and 0 <= x < shape[2])
    }
    expected = np.ones(shape, bool)
    for cell in touching(shape, solid | ring, body, 0.5) | solid:
        expected[cell] = False
    assert np.array_equal(flyable_cells(make_map(cells), limits), expected)


@settings(deadline=None, max_examples=30)
@given(
    shape=st.tuples(st.integers(1, 4), st.integers(1, 6), st.integers(1, 6)),
    radius=st.sampled_from([1e-6, 0.3, 0.6, 1.1]),
    seed=st.integers(0, 10_000),
)
def test_region_reach_equals_all_pairs(shape: tuple[int, int, int], radius: float, seed: int) -> None:
    rng = np.random.default_rng(seed)
    size = int(np.prod(shape))
    region = make_region([int(c) for c in rng.integers(0, size, size=rng.integers(1, 5))])
    own = {tuple(int(i) for i in np.unravel_index(c, shape)) for c in region.cells}
    expected = sorted(int(np.ravel_multi_index(c, shape)) for c in own | touching(shape, own, radius, 0.5))
    world = make_map(np.full(shape, Cell.FREE), regions=(region,))
    assert region_reach(world, region, VehicleLimits(radius_m=radius, margin_m=0.0)).tolist() == expected


def test_empty_region_reaches_nothing() -> None:
    world = make_map(np.full((2, 3, 3), Cell.FREE))
    assert region_reach(world, make_region([]), VehicleLimits()).size == 0


@pytest.mark.parametrize(("passable", "usable"), [(Knowledge.YES, 9), (Knowledge.NO, 8), (Knowledge.OPEN, 8)])
def test_only_regions_known_passable_are_usable(passable: Knowledge, usable: int) -> None:
    world = make_map(np.full((1, 3, 3), Cell.FREE), 1.0, (make_region([4], passable),))
    assert known_flyable(world, VehicleLimits(radius_m=0.01, margin_m=0.0)).sum() == usable


def test_a_wider_body_never_flies_more() -> None:
    rng = np.random.default_rng(3)
    world = make_map(rng.choice([Cell.FREE] * 9 + [Cell.OCCUPIED], size=(3, 12, 12)), 0.2)
    thin = flyable_cells(world, VehicleLimits(radius_m=0.1, margin_m=0.05))
    wide = flyable_cells(world, VehicleLimits(radius_m=0.25, margin_m=0.05))
    assert not (wide & ~thin).any()
    assert wide.sum() < thin.sum()
