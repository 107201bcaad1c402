"""Exactness of the compiled search: published optimal lengths, and an independent Dijkstra on random grids."""

from __future__ import annotations

import itertools
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import dijkstra

from mintpilot.core.errors import InfeasibleError, MapError
from mintpilot.planning.distance_field import DistanceField
from mintpilot.planning.grid_search import GridSearch, distance_field, shortest_path
from mintpilot.planning.workspace import Workspace

DATA = Path(__file__).resolve().parents[3] / "shared" / "data" / "planning"
needs_data = pytest.mark.skipif(not DATA.is_dir(), reason="published maps are not beside the project (../shared/data)")


def read_map(path: Path) -> np.ndarray:
    lines = path.read_text().split("map\n", 1)[1].splitlines()
    return np.array([[c in ".G" for c in line] for line in lines])[None]


def read_3dmap(path: Path) -> np.ndarray:
    lines = path.read_text().splitlines()
    nx, ny, nz = (int(v) for v in lines[0].split()[1:4])
    free = np.ones((nz, ny, nx), bool)
    x, y, z = np.array([line.split()[:3] for line in lines[1:] if line.strip()], int).T
    free[z, y, x] = False
    return free


def no_corner_graph(free: np.ndarray) -> csr_matrix:
    """Every move written out: the oracle's own statement of the rule."""
    padded = np.pad(free, 1)
    number = np.pad(np.arange(free.size).reshape(free.shape), 1)
    rows, columns, lengths = [], [], []
    for step in itertools.product((-1, 0, 1), repeat=3):
        if not any(step):
            continue
        block = itertools.product(*({0, -s} for s in step))
        legal = np.logical_and.reduce([np.roll(padded, part, axis=(0, 1, 2)) for part in block])
        rows.append(number[legal])
        columns.append(np.roll(number, tuple(-s for s in step), axis=(0, 1, 2))[legal])
        lengths.append(np.full(int(legal.sum()), np.linalg.norm(step)))
    triple = (np.concatenate(lengths), (np.concatenate(rows), np.concatenate(columns)))
    return csr_matrix(triple, shape=(free.size, free.size))


def check_path(free: np.ndarray, start: tuple, goal: tuple, cost: float, cells: np.ndarray) -> None:
    assert tuple(cells[0]) == tuple(start)
    assert tuple(cells[-1]) == tuple(goal)
    steps = np.diff(cells, axis=0)
    assert cost == pytest.approx(np.linalg.norm(steps, axis=1).sum(), abs=1e-9)
    assert free[tuple(cells.T)].all()
    for cell, step in zip(cells[:-1], steps, strict=True):
        assert np.abs(step).max() == 1
        assert all(free[tuple(cell + part)] for part in itertools.product(*({0, int(s)} for s in step)))


@needs_data
@pytest.mark.parametrize("name", ["random-64-64-20", "room-64-64-16", "warehouse-10-20-10-2-1"])
def test_every_published_row_in_2d(name: str) -> None:
    free = read_map(DATA / f"{name}.map")
    search = GridSearch(free)
    rows = (DATA / f"{name}-random-1.scen").read_text().splitlines()[1:]
    assert len(rows) == 200
    for row in rows:
        x0, y0, x1, y1 = (int(v) for v in row.split()[4:8])
        found = search.shortest_path((0, y0, x0), (0, y1, x1))
        assert found is not None
        assert found[0] == pytest.approx(float(row.split()[8]), abs=1e-6)
        check_path(free, (0, y0, x0), (0, y1, x1), *found)


@pytest.mark.long
@needs_data
@pytest.mark.parametrize("name", ["Simple", "Complex"])
def test_every_published_row_in_3d(name: str) -> None:
    free = read_3dmap(DATA / f"{name}.3dmap")
    search = GridSearch(free)
    rows = [r.split() for r in (DATA / f"{name}.3dmap.3dscen").read_text().splitlines()]
    rows = [r for r in rows if len(r) == 8]
    assert len(rows) >= 199
    for row in rows:
        x0, y0, z0, x1, y1, z1 = (int(v) for v in row[:6])
        found = search.shortest_path((z0, y0, x0), (z1, y1, x1))
        assert found is not None
        assert found[0] == pytest.approx(float(row[6]), abs=1e-4)
        check_path(free, (z0, y0, x0), (z1, y1, x1), *found)


@settings(deadline=None, max_examples=60)
@given(
    shape=st.sampled_from([(1, 9, 9), (1, 1, 12), (4, 5, 5), (3, 6, 4), (2, 2, 9), (1, 20, 20), (6, 6, 6)]),
    blocked=st.sampled_from([0.0, 0.05, 0.2, 0.35]),
    seed=st.integers(0, 100_000),
)
def test_equals_an_independent_dijkstra(shape: tuple[int, int, int], blocked: float, seed: int) -> None:
    rng = np.random.default_rng(seed)
    free = rng.random(shape) >= blocked
    start = tuple(int(rng.integers(n)) for n in shape)
    free[start] = True
    expected = dijkstra(no_corner_graph(free), indices=np.ravel_multi_index(start, shape)).reshape(shape)
    search = GridSearch(free)
    assert np.allclose(search.distances(start), expected, atol=1e-9)
    near = search.distances(start, 3.0)
    assert np.allclose(near[expected <= 3], expected[expected <= 3], atol=1e-9)
    assert np.isinf(near[expected > 3 + 1e-6]).all()
    for goal in [tuple(int(rng.integers(n)) for n in shape) for _ in range(5)]:
        found = search.shortest_path(start, goal)
        if np.isinf(expected[goal]):
            assert found is None
        else:
            assert found is not None
            assert found[0] == pytest.approx(expected[goal], abs=1e-9)
            check_path(free, start, goal, *found)


@pytest.mark.long
@settings(deadline=None, max_examples=60)
@given(
    shape=st.sampled_from([(1, 20, 30), (1, 40, 9), (5, 8, 9)]),
    blocked=st.sampled_from([0.0, 0.1, 0.3]),
    seed=st.integers(0, 100_000),
    step=st.sampled_from([0.3, 2.0, 50.0]),
)
def test_a_field_grown_piece_by_piece_is_exact_and_guides_exactly(
    shape: tuple[int, int, int], blocked: float, seed: int, step: float
) -> None:
    rng = np.random.default_rng(seed)
    free = rng.random(shape) >= blocked
    start, goal = (tuple(int(rng.integers(n)) for n in shape) for _ in range(2))
    free[start] = free[goal] = True
    graph = no_corner_graph(free)
    expected = dijkstra(graph, indices=np.ravel_multi_index(goal, shape)).reshape(shape)
    search = GridSearch(free)
    lattice = search.lattice
    ends = lattice.node(start), lattice.node(goal)
    ahead = DistanceField(lattice, Workspace(lattice.size), ends[1], ends[0], lattice.allowed)
    ahead.grow(hold=True)
    assert ahead.at(ends[0]) == pytest.approx(expected[start])
    if np.isfinite(expected[start]):
        # Fewer moves than the field was grown over: some cells are closed.
        closed = free & (rng.random(shape) >= 0.1)
        closed[start] = closed[goal] = True
        fewer = GridSearch(closed).lattice.allowed
        alone = dijkstra(no_corner_graph(closed), indices=np.ravel_multi_index(start, shape)).reshape(shape)
        cost, _ = search.node_path(*ends, fewer, ahead)
        assert cost == pytest.approx(alone[goal], abs=1e-9)
    for _ in range(4):
        ahead.grow(ahead.reach + step)
        apart = np.abs(np.argwhere(np.ones(shape, bool)) - start)
        apart.sort(axis=1)
        octile = apart @ np.array([3**0.5 - 2**0.5, 2**0.5 - 1, 1.0])
        sure = (expected.ravel() + octile < ahead.reach - 1e-9) & np.isfinite(expected.ravel())  # rounding: neither
        nodes = lattice.nodes_of_flat(np.flatnonzero(sure))
        assert np.allclose(ahead.everywhere()[nodes], expected.ravel()[sure], atol=1e-9)


def test_start_is_goal() -> None:
    cost, cells = shortest_path(np.ones((2, 3, 3), bool), (1, 1, 1), (1, 1, 1))
    assert cost == 0
    assert cells.tolist() == [[1, 1, 1]]


def test_no_corner_is_cut() -> None:
    free = np.ones((1, 2, 2), bool)
    free[0, 0, 1] = False
    assert shortest_path(free, (0, 0, 0), (0, 1, 1))[0] == 2


def test_disconnected_cells_have_no_path() -> None:
    free = np.ones((1, 3, 3), bool)
    free[0, 1] = False
    assert np.isinf(distance_field(free, (0, 0, 0))[0, 2]).all()
    with pytest.raises(InfeasibleError, match=r"\(0, 0, 0\)"):
        shortest_path(free, (0, 0, 0), (0, 2, 2))


@pytest.mark.parametrize("cell", [(0, 0, 3), (-1, 0, 0), (1, 0, 0)])
def test_cells_outside_are_refused(cell: tuple[int, int, int]) -> None:
    with pytest.raises(MapError, match="outside the grid"):
        shortest_path(np.ones((1, 3, 3), bool), (0, 0, 0), cell)


def test_an_empty_grid_is_refused() -> None:
    with pytest.raises(MapError, match="shape"):
        GridSearch(np.ones((0, 3, 3), bool))


def test_the_queue_grows() -> None:
    free = np.random.default_rng(1).random((20, 20, 20)) > 0.2
    free[10, 10, 10] = True
    search = GridSearch(free)
    expected = search.distances((10, 10, 10))
    search.work.pool = search.work.pool[:16].copy()
    assert np.array_equal(search.distances((10, 10, 10)), expected)
    assert search.work.pool.size > 16
    search.work.pool = search.work.pool[:16].copy()
    found = search.shortest_path((10, 10, 10), np.argwhere(np.isfinite(expected))[-1])
    assert found is not None
    assert found[0] == pytest.approx(expected[np.isfinite(expected)][-1])
