"""All plan classes at once, against one independent search per joint hypothesis."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.sparse.csgraph import dijkstra

from mintpilot.planning.joint_search import Effort, JointSearch
from mintpilot.planning.lazy import lazy_paths

from .test_grid_search import check_path, no_corner_graph


def random_world(shape: tuple[int, int, int], blocked: float, k: int, seed: int) -> tuple:
    """A grid with k boxes that may overlap, cover start or goal, or lie in matter."""
    rng = np.random.default_rng(seed)
    free = rng.random(shape) >= blocked
    ends = [tuple(int(rng.integers(n)) for n in shape) for _ in range(2)]
    for end in ends:
        free[end] = True
    regions = []
    for _ in range(k):
        lo = [int(rng.integers(n)) for n in shape]
        box = np.zeros(shape, bool)
        box[tuple(slice(a, a + int(rng.integers(1, 4))) for a in lo)] = True
        regions.append(np.flatnonzero(box).astype(np.int64))
    return free, regions, *ends


def brute_force(free: np.ndarray, regions: list, start: tuple, goal: tuple, blocked: int) -> float:
    left = free.copy()
    for r, cells in enumerate(regions):
        if blocked >> r & 1:
            left.ravel()[cells] = False
    if not (left[start] and left[goal]):
        return np.inf
    source, target = (int(np.ravel_multi_index(c, free.shape)) for c in (start, goal))
    return float(dijkstra(no_corner_graph(left), indices=source)[target])


worlds = st.tuples(
    st.sampled_from([(1, 8, 8), (1, 12, 5), (3, 5, 5), (4, 4, 4)]),
    st.sampled_from([0.0, 0.1, 0.3]),
    st.integers(0, 4),
    st.integers(0, 1_000_000),
)


@pytest.mark.long
@settings(deadline=None, max_examples=60)
@given(world=worlds, tight=st.booleans())
def test_equals_replanning_under_every_hypothesis(world: tuple, tight: bool) -> None:
    free, regions, start, goal = random_world(*world)
    search = JointSearch(free, regions, Effort(labels=40) if tight else None)
    found = search.between(start, goal)
    assert found.complete
    assert search.searches == 1
    for blocked in range(1 << len(regions)):
        expected = brute_force(free, regions, start, goal, blocked)
        way = found.best(blocked)
        alone = search.under(start, goal, blocked)
        if np.isinf(expected):
            assert way is None
            assert alone is None
            continue
        assert way is not None
        assert alone is not None
        assert way.cost == pytest.approx(expected, abs=1e-9)
        assert alone[0] == pytest.approx(expected, abs=1e-9)
        left = free.copy()
        for r, cells in enumerate(regions):
            if blocked >> r & 1:
                left.ravel()[cells] = False
        check_path(left, start, goal, way.cost, way.path)


class BlackBox:
    """A planner of which nothing is known but its answers."""

    def __init__(self, search: JointSearch, ends: tuple) -> None:
        self.search, self.ends, self.calls = search, ends, 0

    def path(self, blocked: frozenset[int]) -> tuple | None:
        self.calls += 1
        found = self.search.under(*self.ends, sum(1 << r for r in blocked))
        if found is None:
            return None
        cells = {tuple(c) for c in found[1]}
        for a, b in zip(found[1][:-1], found[1][1:], strict=True):
            lo, hi = np.minimum(a, b), np.maximum(a, b)
            cells |= {tuple(lo + c) for c in np.ndindex(*(hi - lo + 1))}
        flat = {int(np.ravel_multi_index(c, self.search.grid.lattice.shape)) for c in cells}
        entered = frozenset(r for r, nodes in enumerate(self.regions) if flat & nodes)
        return found[0], found[1], entered

    @property
    def regions(self) -> list[set[int]]:
        lattice = self.search.grid.lattice
        return [{int(np.ravel_multi_index(c, lattice.shape)) for c in lattice.cells(r)} for r in self.search.regions]


@settings(deadline=None, max_examples=40)
@given(world=worlds)
def test_lazy_branching_agrees(world: tuple) -> None:
    free, regions, start, goal = random_world(*world)
    search = JointSearch(free, regions)
    box = BlackBox(search, (start, goal))
    lazy = lazy_paths(box)
    joint = search.between(start, goal)
    assert box.calls <= 1 << len(regions)
    for blocked in range(1 << len(regions)):
        a, b = lazy.best(blocked), joint.best(blocked)
        assert (a is None) == (b is None)
        if a is not None and b is not None:
            assert a.cost == pytest.approx(b.cost, abs=1e-9)


def corridor(k: int) -> tuple:
    """k doors in series, each with a detour of its own: the list grows like 2^k."""
    length = 8
    free = np.zeros((1, 12, length * k + 1), bool)
    free[0, 0] = True
    regions = []
    for i in range(k):
        x = i * length + 4
        depth = 2 + i % 7
        free[0, : depth + 1, x - 2] = free[0, : depth + 1, x + 2] = True
        free[0, depth, x - 2 : x + 3] = True
        regions.append(np.array([x], np.int64))
    return free, regions, (0, 0, 0), (0, 0, length * k)


def test_thirty_gaps_are_bounded_and_safe() -> None:
    free, regions, start, goal = corridor(30)
    search = JointSearch(free, regions, Effort(labels=20_000, searches=50))
    found = search.between(start, goal)
    assert not found.complete
    assert found.not_expanded > 0
    everything = (1 << 30) - 1
    safe = found.best(everything)
    assert safe is not None
    assert safe.mask == 0
    assert safe.cost == pytest.approx(search.under(start, goal, everything)[0])
    assert found.best(0).cost == pytest.approx(240)
    for way in found.paths:
        assert way.cost >= 240
        check_path(free, start, goal, way.cost, way.path)


def test_more_regions_than_bits() -> None:
    free, regions, start, goal = corridor(4)
    far = [np.array([free.shape[2] * 11 + x % 33], np.int64) for x in range(66)]
    found = JointSearch(free, [*far[:40], *regions, *far[40:]]).between(start, goal)
    plain = JointSearch(free, regions).between(start, goal)
    assert not found.complete
    assert len(found.left_out) == 70 - 63
    assert not set(found.left_out) & {40, 41, 42, 43}
    assert [round(w.cost, 9) for w in found.paths] == [round(w.cost, 9) for w in plain.paths]
    assert [w.mask >> 40 for w in found.paths] == [w.mask for w in plain.paths]


def test_no_regions_is_one_shortest_path() -> None:
    free, _, start, goal = corridor(3)
    (way,) = JointSearch(free, []).between(start, goal).paths
    assert (way.cost, way.mask) == (24, 0)


def test_start_is_goal_inside_a_region() -> None:
    (way,) = JointSearch(np.ones((1, 3, 3), bool), [np.array([4])]).between((0, 1, 1), (0, 1, 1)).paths
    assert (way.cost, way.mask) == (0, 1)


def test_blocked_ends_have_no_way() -> None:
    free = np.ones((1, 3, 3), bool)
    free[0, 0, 0] = False
    assert JointSearch(free, [np.array([4])]).between((0, 0, 0), (0, 2, 2)).paths == ()


def test_a_diagonal_move_touches_the_regions_beside_it() -> None:
    free = np.ones((1, 2, 2), bool)
    paths = JointSearch(free, [np.array([1])]).between((0, 0, 0), (0, 1, 1)).paths
    assert [(round(w.cost, 6), w.mask) for w in paths] == [(1.414214, 1), (2.0, 0)]
