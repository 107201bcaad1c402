"""Plans under rules in time: against brute force over grid and automaton, and what they leave undone (section 14)."""

from __future__ import annotations

import heapq
import itertools

import numpy as np
import pytest
from tests.oracles import ltlf

from mintpilot.core.gap import Assumptions, GapKind, KnowledgeGap
from mintpilot.core.geometry import GridFrame
from mintpilot.core.observation import RegionKind
from mintpilot.core.plan import PlanningProblem, Shortage, Site, Stop, VehicleLimits
from mintpilot.core.rule import Rule
from mintpilot.core.semantic_map import Cell, Knowledge, Region, SemanticMap
from mintpilot.core.task import Action, Reference, SubGoal, Task
from mintpilot.planning.task_planner import GridPlanner
from mintpilot.rules.compiling import compile_rules
from mintpilot.uncertainty import ruling_of

LIMITS = VehicleLimits(radius_m=0.01, margin_m=0.0, cruise_mps=1.0)


def problem_of(free, areas, goals, rules, *, smoke=(), start=(0, 0), home=False, limits=LIMITS):
    """A flat map with cells of a metre; ``areas`` are flown through freely, ``smoke`` has a gap each."""
    frame = GridFrame(origin_m=(0, 0, 0), resolution_m=1.0, shape=(1, *free.shape))
    cells = np.where(free, Cell.FREE, Cell.OCCUPIED).astype(np.uint8)[None]
    regions = [Region(id=name, kind=RegionKind.AREA, cells=np.flatnonzero(mask), passable=Knowledge.YES)
               for name, mask in areas.items()]  # fmt: skip
    regions += [Region(id=name, kind=RegionKind.SMOKE, cells=np.flatnonzero(mask), passable=Knowledge.OPEN)
                for name, mask in dict(smoke).items()]  # fmt: skip
    map_ = SemanticMap(frame=frame, cells=cells, regions=tuple(regions))
    gaps = tuple(
        KnowledgeGap(id=f"obstacle:{name}", kind=GapKind.OBSTACLE, subject=name, description=name,
                     values=("passable", "blocked"), prior=(0.5, 0.5), position_m=(0, 0, 0))
        for name in sorted(dict(smoke))
    )  # fmt: skip
    middle = lambda cell: (cell[1] + 0.5, cell[0] + 0.5, 0.5)  # noqa: E731
    stops = tuple(
        Stop(id=f"go:{i}", action=Action.GO, sites=(Site(position_m=middle(cell), reach_m=0.1),), dwell_s=0.0)
        for i, cell in enumerate(goals.values(), start=1)
    )
    task = Task(
        instruction="",
        subgoals=tuple(SubGoal(action=Action.GO, reference=Reference(phrase=n), id=n) for n in goals),
        rules=tuple(Rule(text=r, formula=r) for r in rules),
    )
    ruling = ruling_of(map_, task, compile_rules(task.rules), stops) if rules else None
    return PlanningProblem(map=map_, start_m=middle(start), stops=stops, gaps=gaps, limits=limits, ruling=ruling,
                           home_m=middle(start) if home else None)  # fmt: skip


def free(rows=7, columns=9):
    return np.ones((rows, columns), bool)


def box(rows, columns, shape=(7, 9)):
    mask = np.zeros(shape, bool)
    mask[rows[0] : rows[1], columns[0] : columns[1]] = True
    return mask


def cautious(*arguments, **named):
    return GridPlanner().open(problem_of(*arguments, **named)).cautious(Assumptions())


def cells(plan):
    return {(int(y), int(x)) for x, y, _ in plan.path_m}


def test_a_rule_that_the_shortest_way_keeps_changes_nothing():
    bare = cautious(free(), {}, {"a": (6, 8)}, ())
    ruled = cautious(free(), {"zone": box((0, 1), (5, 9))}, {"a": (6, 8)}, ("G !touches(zone)",))
    assert ruled.signature == bare.signature


def test_never_touches_is_flown_around():
    wall = box((0, 5), (4, 5))
    plan = cautious(free(), {"zone": wall}, {"a": (0, 8)}, ("G !touches(zone)",))
    assert not cells(plan) & {tuple(c) for c in np.argwhere(wall)}
    assert plan.cost_s > 8 + 1e-6


def test_never_before_takes_the_other_stop_first_though_it_comes_later():
    wall = box((0, 7), (4, 5))
    goals = {"beyond": (3, 8), "room": (6, 0)}
    plan = cautious(free(), {"zone": wall}, goals, ("did(room) R (!touches(zone) | did(room))",))
    assert [leg.stop.id for leg in plan.legs] == ["go:2"]  # the order of the stops is kept: one is left undone
    assert [(one.stop.id, one.resource) for one in plan.leaves_undone] == [("go:1", Shortage.RULE)]
    assert "did(room) R" in str(plan.leaves_undone[0].reason)
    plan = cautious(free(), {"zone": wall}, dict(reversed(goals.items())),
                    ("did(room) R (!touches(zone) | did(room))",))  # fmt: skip
    assert [leg.stop.id for leg in plan.legs] == ["go:1", "go:2"]


def test_always_within_leaves_undone_what_is_outside():
    hall = box((0, 7), (0, 6))
    plan = cautious(free(), {"hall": hall}, {"out": (3, 8), "in": (6, 1)}, ("G in(hall)",))
    assert [leg.stop.id for leg in plan.legs] == ["go:2"]


def test_the_flight_ends_where_a_rule_wants_it():
    plan = cautious(free(), {"pad": box((5, 7), (0, 3))}, {"a": (0, 8)}, ("F G in(pad)",))
    assert plan.legs[-1].stop.id == "end"
    assert plan.legs[-1].stop.price_s == 0
    x, y, _ = plan.path_m[-1]
    assert y >= 5
    assert x < 3


def test_the_way_home_keeps_the_rules_too():
    zone = box((3, 7), (0, 3))
    rules = ("G(at(a) -> F in(zone))",)
    plan = cautious(free(), {"zone": zone}, {"a": (0, 8)}, rules, home=True)
    assert [leg.stop.id for leg in plan.legs] == ["go:1"]
    assert plan.home_s > 8


def test_what_no_flight_can_keep_is_no_plan():
    assert cautious(free(), {"pad": box((5, 7), (0, 3))}, {"a": (0, 8)}, ("G in(pad)",)) is None


def test_rules_are_kept_under_every_hypothesis_of_smoke():
    smoke = {"smoke": box((0, 6), (4, 5))}
    problem = problem_of(free(), {"low": box((6, 7), (3, 6))}, {"a": (0, 8)}, ("G !touches(low)",), smoke=smoke)
    space = GridPlanner().open(problem)
    assert space.cautious(Assumptions()) is None
    plan = space.optimistic(Assumptions())
    assert plan.relies_on == {"obstacle:smoke"}
    assert plan.cost_s == pytest.approx(8)
    assert space.optimistic(Assumptions.exactly({"obstacle:smoke": "blocked"})) is None


class _LargeError(Exception):
    """More than this oracle can go through."""


def _best(problem, formulas, goals, areas, blocked):
    """Least seconds of all flights that do all stops in order and keep the rules; by search over (cell, stops, rules).

    Of its own: neighbours, labels (what holds within half a diagonal of a centre), and formulas by rewriting.
    """
    grid = np.asarray(problem.map.cells[0] == Cell.FREE) & ~blocked
    shape = grid.shape

    def truths(cell, names):
        """Every truth of the areas that may be met around a cell."""
        options = []
        for name in names:
            inside = areas[name]
            around = [inside[y, x] for y in range(max(cell[0] - 1, 0), min(cell[0] + 2, shape[0]))
                      for x in range(max(cell[1] - 1, 0), min(cell[1] + 2, shape[1]))]  # fmt: skip
            options.append({True} if all(around) else {True, False} if any(around) else {False})
        return [frozenset(n for n, v in zip(names, values, strict=True) if v) for values in itertools.product(*options)]

    names = sorted(areas)
    stops = [tuple(goal) for goal in goals.values()]
    letters = list(goals)

    def after(rules, held, cell):
        """All conjunctions that may be left after a stay of any length."""
        found, coming = set(), set(rules)
        options = truths(cell, names)
        while coming:
            new = {tuple(ltlf.progressed(f, option | held) for f in rule) for rule in coming for option in options}
            coming = new - found
            found |= new
            if len(found) > 40:
                raise _LargeError
        return frozenset(found)

    start = (0, 0)
    begins = frozenset(name for name in names if areas[name][start])  # where it starts is known exactly
    first = after({tuple(ltlf.progressed(("now", f), begins) for f in formulas)}, frozenset(), start)
    heap, seen, ticks = [(0.0, 0, start, 0, first)], set(), itertools.count(1)
    while heap:
        cost, _, cell, done, rules = heapq.heappop(heap)
        if (cell, done, rules) in seen or any(False in rule for rule in rules):
            continue
        seen.add((cell, done, rules))
        if len(seen) > 2000:
            raise _LargeError
        if done == len(stops) and all(ltlf.may_end(f) for rule in rules for f in rule):
            return cost
        held = frozenset(letters[:done])
        if done < len(stops) and cell == stops[done]:
            there = after(rules, held | {letters[done]}, cell)
            heapq.heappush(heap, (cost, next(ticks), cell, done + 1, there))
        for dy, dx in itertools.product((-1, 0, 1), repeat=2):
            to = (cell[0] + dy, cell[1] + dx)
            swept = {to, (cell[0] + dy, cell[1]), (cell[0], cell[1] + dx)}
            if to == cell or not all(0 <= y < shape[0] and 0 <= x < shape[1] and grid[y, x] for y, x in swept):
                continue
            far = cost + np.hypot(dy, dx)
            heapq.heappush(heap, (far, next(ticks), to, done, after(rules, held, to)))
    return None


@pytest.mark.parametrize("seed", range(30))
def test_costs_are_those_of_brute_force(seed):
    rng = np.random.default_rng([14, seed])
    shape = (6, 7)
    ground = rng.random(shape) > 0.1
    areas = {}
    for name in ("p", "q"):
        y, x = rng.integers(0, 4, 2)
        areas[name] = box((y, y + rng.integers(2, 5)), (x, x + rng.integers(2, 5)), shape)
    goals = {"a": tuple(int(v) for v in rng.integers(0, shape)), "b": tuple(int(v) for v in rng.integers(0, shape))}
    for cell in ((0, 0), *goals.values()):
        ground[cell] = True
    formulas = [ltlf.drawn(rng, ["p", "q", "a", "b"], 2) for _ in range(2)]
    said = [ltlf.text(f, {"p": "in", "q": "in", "a": "did", "b": "did"}) for f in formulas]
    smoke = {"smoke": box((2, 4), (2, 5), shape)}
    problem = problem_of(ground, areas, goals, said, smoke=smoke)
    if problem.ruling.automaton.size > 12:
        pytest.skip("large")
    try:
        space = GridPlanner().open(problem)
    except Exception:  # nothing can be reached at all
        return
    for value, blocked in (("passable", np.zeros(shape, bool)), ("blocked", smoke["smoke"])):
        try:
            wanted = _best(problem, formulas, goals, areas, blocked)
        except _LargeError:
            pytest.skip("large")
        plan = space.optimistic(Assumptions.exactly({"obstacle:smoke": value}))
        if wanted is None:
            assert plan is None or plan.leaves_undone
        elif any(blocked[c] for c in ((0, 0), *goals.values())):
            continue
        else:
            assert plan is not None, (said, wanted)
            assert not plan.leaves_undone, (said, wanted)
            assert plan.cost_s == pytest.approx(wanted), said
