"""Plans against a brute-force oracle that knows only cells, sets and Dijkstra (method, sections 2 and 7)."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import dijkstra

from mintpilot.core.errors import InfeasibleError
from mintpilot.core.gap import ABSENT, BLOCKED, PASSABLE, PRESENT, Assumptions, GapKind, KnowledgeGap
from mintpilot.core.geometry import GridFrame
from mintpilot.core.observation import RegionKind
from mintpilot.core.plan import Plan, PlanningProblem, Site, Stop, VehicleLimits
from mintpilot.core.semantic_map import Cell, Region, SemanticMap
from mintpilot.core.task import Action
from mintpilot.planning.task_planner import GridPlanner, LazyPlanner

RESOLUTION_M = 0.5
LIMITS = VehicleLimits(radius_m=0.01, margin_m=0.0, cruise_mps=1.25)


def gap_of(name: str, kind: GapKind, values: tuple[str, ...], subject: str = "") -> KnowledgeGap:
    share = tuple([1 / len(values)] * len(values))
    return KnowledgeGap(
        id=name, kind=kind, subject=subject, description=name, values=values, prior=share, position_m=(0, 0, 0)
    )


def random_problem(shape: tuple[int, int, int], k: int, candidates: int, rooms: int, seed: int) -> PlanningProblem:
    """A small world with all three kinds of gap; boxes of regions may overlap and cover anything."""
    rng = np.random.default_rng(seed)
    cells = np.where(rng.random(shape) < 0.2, Cell.OCCUPIED, Cell.FREE).astype(np.uint8)
    frame = GridFrame(origin_m=(-1.0, 2.0, 0.0), resolution_m=RESOLUTION_M, shape=shape)

    def place() -> tuple[float, float, float]:
        cell = [int(rng.integers(n)) for n in shape]
        cells[tuple(cell)] = Cell.FREE
        x, y, z = (float(v) for v in frame.centres_of([cell])[0])
        return (x, y, z)

    start = place()

    def price() -> float:
        """Half of them are worth any flight; no two are equal."""
        return float(rng.uniform(1, 15) if rng.random() < 0.5 else rng.uniform(500, 600))

    regions, gaps, stops = [], [], []
    for i in range(k):
        box = np.zeros(shape, bool)
        box[tuple(slice(a, a + int(rng.integers(1, 4))) for a in (int(rng.integers(n)) for n in shape))] = True
        regions.append(Region(id=f"r{i}", kind=RegionKind.AREA, cells=np.flatnonzero(box).astype(np.int64)))
        gaps.append(gap_of(f"obstacle:r{i}", GapKind.OBSTACLE, (PASSABLE, BLOCKED), f"r{i}"))
    if candidates:
        values = tuple(f"box-{i}" for i in range(candidates))
        gaps.append(gap_of("target:box", GapKind.TARGET, values, "the box"))
        sites = tuple(Site(position_m=place(), reach_m=0.1, value=v) for v in values)
        stops.append(Stop(id="pick", action=Action.PICK, sites=sites, gap="target:box", dwell_s=3.0, price_s=price()))
    site = Site(position_m=place(), reach_m=0.1)
    stops.append(Stop(id="go", action=Action.GO, sites=(site,), dwell_s=1.0, price_s=price()))
    if candidates and rng.random() < 0.5:
        site = Site(position_m=place(), reach_m=0.1)
        stops.append(Stop(id="give", action=Action.DELIVER, sites=(site,), dwell_s=0.5, price_s=price()))
    for i in range(rooms):
        gaps.append(gap_of(f"presence:room-{i}", GapKind.PRESENCE, (PRESENT, ABSENT), f"room-{i}"))
        site = Site(position_m=place(), reach_m=0.1, value=PRESENT)
        look = Stop(id=f"look-{i}", action=Action.LOOK, sites=(site,), gap=f"presence:room-{i}", optional=True)
        stops.append(replace(look, price_s=price()))
    home, endurance_s = start if rng.random() < 0.5 else None, float(rng.choice([np.inf, rng.uniform(2, 20)]))
    return PlanningProblem(
        map=SemanticMap(frame=frame, cells=cells, regions=tuple(regions)),
        start_m=start,
        stops=tuple(stops),
        gaps=tuple(sorted(gaps, key=lambda g: g.id)),
        limits=replace(LIMITS, endurance_s=endurance_s, reserve_s=0.5),
        home_m=home,
    )


class Oracle:
    """Best costs by trying every set and order of stops on a Dijkstra of its own."""

    def __init__(self, problem: PlanningProblem) -> None:
        self.problem = problem
        self.memo: dict[frozenset[str], np.ndarray] = {}

    def hypotheses(self, given: Assumptions) -> list[dict[str, str]]:
        gaps = self.problem.gaps
        return [
            dict(zip([g.id for g in gaps], values, strict=True))
            for values in itertools.product(*(given.possible(g) for g in gaps))
        ]

    def best(self, hypotheses: list[dict[str, str]]) -> float:
        """Flight and prices of the best plan that can be flown under all of these; infinite: not one stop can be done.

        What may be needed and is not done counts with its whole price.
        """
        blocked = {g.subject for h in hypotheses for g in self.problem.gaps if h[g.id] == BLOCKED}
        wanted: list[tuple[Stop, tuple[float, float, float] | None]] = []
        for stop in self.problem.stops:
            if stop.optional and all(h[stop.gap] == ABSENT for h in hypotheses):
                continue
            sites = {
                s for s in stop.sites if stop.optional or not stop.gap or s.value in {h[stop.gap] for h in hypotheses}
            }
            one_place = len({s.position_m for s in sites}) == 1
            wanted.append((stop, next(iter(sites)).position_m if one_place else None))
        if not wanted:
            return 0.0
        limits, costs = self.problem.limits, []
        for count in range(1, len(wanted) + 1):
            for order in itertools.permutations(range(len(wanted)), count):
                fixed = [i for i in order if not wanted[i][0].optional]
                done = [wanted[i][0].id for i in order]
                places = [self.problem.start_m, *(wanted[i][1] for i in order)]
                if fixed != sorted(fixed) or None in places or ("give" in done and "pick" not in done):
                    continue
                flight_s = sum(self.apart_m(a, b, blocked) for a, b in itertools.pairwise(places)) / LIMITS.cruise_mps
                flight_s += sum(wanted[i][0].dwell_s for i in order)
                home_m = self.problem.home_m
                home_s = self.apart_m(places[-1], home_m, blocked) / LIMITS.cruise_mps if home_m is not None else 0.0
                if flight_s + home_s <= limits.endurance_s - limits.reserve_s + 1e-9:
                    costs.append(flight_s + sum(s.price_s for i, (s, _) in enumerate(wanted) if i not in order))
        return min(costs, default=np.inf)

    def apart_m(self, a: tuple, b: tuple, blocked: set[str]) -> float:
        frame = self.problem.map.frame
        key = frozenset(blocked)
        if key not in self.memo:
            free = (self.problem.map.cells == Cell.FREE).copy()
            for region in self.problem.map.regions:
                if region.id in blocked:
                    free.ravel()[region.cells] = False
            self.memo[key] = all_pairs(free)
        i, j = (int(np.ravel_multi_index(tuple(frame.cells_of([p])[0]), frame.shape)) for p in (a, b))
        return float(self.memo[key][i, j]) * RESOLUTION_M


def all_pairs(free: np.ndarray) -> np.ndarray:
    inside = {tuple(c) for c in np.argwhere(free)}
    rows, columns, lengths = [], [], []
    for cell in inside:
        for step in itertools.product((-1, 0, 1), repeat=3):
            block = itertools.product(*({0, s} for s in step))
            if any(step) and all(tuple(np.add(cell, part)) in inside for part in block):
                rows.append(np.ravel_multi_index(cell, free.shape))
                columns.append(np.ravel_multi_index(tuple(np.add(cell, step)), free.shape))
                lengths.append(np.linalg.norm(step))
    graph = csr_matrix((lengths, (rows, columns)), shape=(free.size, free.size))
    table = dijkstra(graph)
    table[~free.ravel(), :] = np.inf
    return table


def cost(plan: Plan | None, hypotheses: Sequence[dict[str, str]] = (), *, hopeful: bool = False) -> float:
    """Flight and prices: of rooms, where some hypothesis (hopeful: each of them) says that somebody is there."""
    if plan is None:
        return np.inf
    among = all if hopeful else any
    stakes = (price for gap, value, price in plan.stakes if among(h[gap] == value for h in hypotheses))
    return plan.cost_s + plan.undone_s + sum(stakes)


def check_plan(problem: PlanningProblem, plan: Plan) -> None:
    at = np.array(problem.start_m)
    for leg in plan.legs:
        assert np.allclose(leg.path_m[0], at)
        assert np.allclose(leg.path_m[-1], leg.site.position_m)
        length = np.linalg.norm(np.diff(leg.path_m, axis=0), axis=1).sum()
        assert leg.length_m == pytest.approx(length)
        assert leg.duration_s == pytest.approx(length / LIMITS.cruise_mps + leg.stop.dwell_s)
        at = leg.path_m[-1]
    assert plan.cost_s == pytest.approx(sum(leg.duration_s for leg in plan.legs))


problems = st.builds(
    random_problem,
    shape=st.sampled_from([(1, 6, 6), (1, 4, 9), (2, 4, 4), (3, 3, 4)]),
    k=st.integers(0, 3),
    candidates=st.integers(0, 3),
    rooms=st.integers(0, 2),
    seed=st.integers(0, 1_000_000),
)


def space_of(problem: PlanningProblem, planner: GridPlanner | LazyPlanner | None = None):
    try:
        return (planner or GridPlanner()).open(problem)
    except InfeasibleError:
        return None


HOME_IN_A_REGION = random_problem((1, 6, 6), 2, 0, 2, 14337)
ONLY_WAY_HOME_IN_TIME_IS_OPEN = random_problem((1, 6, 6), 3, 1, 1, 407517)


@pytest.mark.long
@settings(deadline=None, max_examples=50)
@given(problem=problems, seed=st.integers(0, 1000))
@example(problem=HOME_IN_A_REGION, seed=0)
@example(problem=ONLY_WAY_HOME_IN_TIME_IS_OPEN, seed=3)
def test_plans_equal_brute_force(problem: PlanningProblem, seed: int) -> None:
    space, oracle = space_of(problem), Oracle(problem)
    everything = oracle.hypotheses(Assumptions())
    if space is None:
        assert all(np.isinf(oracle.best([h])) for h in everything)
        return
    best = {tuple(sorted(h.items())): oracle.best([h]) for h in everything}
    for h in everything:
        given = Assumptions.exactly(h)
        optimistic, cautious = space.optimistic(given), space.cautious(given)
        assert cost(optimistic, [h]) == pytest.approx(best[tuple(sorted(h.items()))])
        assert (optimistic is None) == (cautious is None)
        if optimistic is not None and cautious is not None:
            assert optimistic.signature == cautious.signature
            assert not optimistic.relies_on
            check_plan(problem, optimistic)
    rng = np.random.default_rng(seed)
    for _ in range(6):
        given = Assumptions.of(
            {
                g.id: rng.choice(g.values, size=rng.integers(1, len(g.values) + 1), replace=False).tolist()
                for g in problem.gaps
                if rng.random() < 0.6
            }
        )
        left = oracle.hypotheses(given)
        optimistic, cautious = space.optimistic(given), space.cautious(given)
        if optimistic is not None and not optimistic.legs and optimistic.leaves_undone:
            nobody = [h for h in left if all(h[gap] == ABSENT for gap in optimistic.skips)]
            assert optimistic.relies_on
            assert all(np.isinf(best[tuple(sorted(h.items()))]) for h in nobody)
        else:
            least = min(best[tuple(sorted(h.items()))] for h in left)
            assert cost(optimistic, left, hopeful=True) == pytest.approx(least)
        assert cost(cautious, left) == pytest.approx(oracle.best(left))
        if optimistic is not None and optimistic.legs:
            check_relies_on(problem, optimistic, left, best)
        if cautious is not None:
            assert not cautious.relies_on


def check_relies_on(problem: PlanningProblem, plan: Plan, left: list[dict[str, str]], best: dict) -> None:
    """Wherever the gaps it relies on turn out well, the plan is the best one."""
    for h in left:
        broken = {g for g in plan.enters if h[g] == BLOCKED} | {g for g in plan.skips if h[g] == PRESENT}
        broken |= {gap for gap, value in plan.binds if h[gap] != value}
        if not broken & plan.relies_on:
            assert cost(plan, [h]) == pytest.approx(best[tuple(sorted(h.items()))])
    for gap in plan.relies_on:
        assert len({h[gap] for h in left}) > 1


@pytest.mark.long
@settings(deadline=None, max_examples=20)
@given(problem=problems, seed=st.integers(0, 1000))
def test_the_order_of_gaps_and_values_never_matters(problem: PlanningProblem, seed: int) -> None:
    rng = np.random.default_rng(seed)
    gaps = [replace(g, values=tuple(rng.permutation(g.values).tolist())) for g in problem.gaps]
    stops = [s for s in problem.stops if not s.optional] + [s for s in problem.stops[::-1] if s.optional]
    regions = tuple(problem.map.regions[::-1])
    shuffled = replace(
        problem,
        gaps=tuple(gaps[i] for i in rng.permutation(len(gaps))),
        stops=tuple(stops),
        map=replace(problem.map, regions=regions),
    )
    one, two = space_of(problem), space_of(shuffled)
    assert (one is None) == (two is None)
    if one is not None and two is not None:
        for h in Oracle(problem).hypotheses(Assumptions())[::-1]:
            a, b = one.optimistic(Assumptions.exactly(h)), two.optimistic(Assumptions.exactly(h))
            assert (a and a.signature) == (b and b.signature)
        a, b = one.optimistic(Assumptions()), two.optimistic(Assumptions())
        assert (a and (a.signature, a.relies_on)) == (b and (b.signature, b.relies_on))


def is_free(free: np.ndarray, cell: tuple) -> bool:
    return all(0 <= i < n for i, n in zip(cell, free.shape, strict=True)) and bool(free[cell])


def dijkstra_path(free: np.ndarray, start: tuple, goal: tuple):
    """A black box: a path by walking down an all-pairs table of the oracle."""
    table = all_pairs(free)
    source, target = (int(np.ravel_multi_index(c, free.shape)) for c in (start, goal))
    if np.isinf(table[source, target]):
        return None
    cells = [start]
    while cells[-1] != goal:
        here = cells[-1]
        for step in itertools.product((-1, 0, 1), repeat=3):
            block = [tuple(np.add(here, part)) for part in itertools.product(*({0, s} for s in step))]
            if not any(step) or not all(
                all(0 <= i < n for i, n in zip(c, free.shape, strict=True)) and free[c] for c in block
            ):
                continue
            there = tuple(int(i) for i in np.add(here, step))
            a, b = (int(np.ravel_multi_index(c, free.shape)) for c in (here, there))
            if abs(table[a, target] - table[b, target] - np.linalg.norm(step)) < 1e-9:
                cells.append(there)
                break
    return float(table[source, target]), np.array(cells)


@pytest.mark.long
@settings(deadline=None, max_examples=10)
@given(problem=problems)
def test_a_black_box_planner_agrees(problem: PlanningProblem) -> None:
    grid, lazy = space_of(problem), space_of(problem, LazyPlanner(dijkstra_path))
    assert (grid is None) == (lazy is None)
    if grid is None or lazy is None:
        return
    for h in Oracle(problem).hypotheses(Assumptions()):
        given = Assumptions.exactly(h)
        assert cost(grid.optimistic(given)) == pytest.approx(cost(lazy.optimistic(given)))
    places = 2 + sum(len(s.sites) for s in problem.stops)
    assert grid.searches <= places * places
    assert lazy.searches >= grid.searches
