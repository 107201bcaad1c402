"""How long a plan under a rule of five clauses takes on 200 x 200 cells, in CPU time. `python -m bench.rule_scale`."""

from __future__ import annotations

import argparse
import time
from collections.abc import Iterator

import numpy as np
from tests.planning.test_ruled_plans import problem_of

from bench.sections import Section, Table, keep
from mintpilot.core.errors import MintPilotError
from mintpilot.core.gap import Assumptions
from mintpilot.core.geometry import Bools
from mintpilot.core.plan import PlanningProblem, VehicleLimits
from mintpilot.planning.task_planner import GridPlanner
from mintpilot.rules.compiling import compile_formula
from mintpilot.rules.parsing import parse
from mintpilot.rules.satisfying import can_be_kept

SIDE, CLAUSES, STOPS = 200, 5, 3
AREAS, GOALS = ("hall", "yard", "store", "ramp"), ("p", "q", "r")
LIMITS = VehicleLimits(radius_m=0.3, margin_m=0.1, cruise_mps=2.0)
MUST_MS = 100


def clause(rng: np.random.Generator) -> str:
    """One clause, of the patterns that mission files have."""
    zone, other = rng.choice(AREAS, 2, replace=False)
    a, b = rng.choice(GOALS, 2, replace=False)
    return str(
        rng.choice(
            (
                f"G !touches({zone})",
                f"(did({a}) R (!touches({zone}) | did({a})))",
                f"(in({zone}) R (!in({other}) | in({zone})))",
                f"((!did({b}) U in({zone})) & F did({b}))",
                f"G (!at({a}) | F in({zone}))",
                f"G (!in({zone}) | F in({other}))",
                f"F G in({zone})",
                f"(F in({zone}) | F did({a}))",
            )
        )
    )


def drawn(number: int) -> tuple[PlanningProblem, int]:
    """World and rule of that number, and the states of its automaton: blocks, four areas, two clouds, three places."""
    for draw in range(1000):
        rng = np.random.default_rng([14, number, draw])
        rule = " & ".join(clause(rng) for _ in range(CLAUSES))
        try:
            automaton = compile_formula(parse(rule))
        except MintPilotError:
            continue
        if not can_be_kept(automaton):
            continue
        free = np.ones((SIDE, SIDE), bool)
        while free.mean() > 0.88:
            free &= ~_box(rng, 4, 14)
        areas = {name: _box(rng, 20, 60) for name in AREAS}
        smoke = {f"smoke-{i}": _box(rng, 15, 40) for i in (1, 2)}
        cells = [tuple(int(v) for v in rng.integers(4, SIDE - 4, 2)) for _ in range(STOPS + 1)]
        for y, x in cells:
            free[y - 3 : y + 4, x - 3 : x + 4] = True
        start, *places = cells
        goals = dict(zip(GOALS, places, strict=True))
        if any(mask[cell] for mask in smoke.values() for cell in cells):
            continue
        problem: PlanningProblem = problem_of(  # type: ignore[no-untyped-call]
            free, areas, goals, (rule,), smoke=smoke, start=start, limits=LIMITS
        )
        try:
            GridPlanner().open(problem)
        except MintPilotError:  # nothing can be reached at all
            continue
        return problem, automaton.size
    raise AssertionError


def _box(rng: np.random.Generator, low: int, high: int) -> Bools:
    h, w = rng.integers(low, high, 2)
    y, x = rng.integers(0, SIDE - h), rng.integers(0, SIDE - w)
    mask = np.zeros((SIDE, SIDE), bool)
    mask[y : y + h, x : x + w] = True
    return mask


def timed(worlds: int) -> Iterator[tuple[float, float, int, int, bool]]:
    """CPU milliseconds to open a problem and of both plans, searches, states, and whether there is a plan."""
    for number in range(-3, worlds):  # the first ones compile
        problem, states = drawn(abs(number))
        begun = time.process_time()
        space = GridPlanner().open(problem)
        optimistic = space.optimistic(Assumptions())
        between = time.process_time()
        cautious = space.cautious(Assumptions())
        ended = time.process_time()
        if number >= 0:
            found = optimistic is not None or cautious is not None
            yield 1000 * (between - begun), 1000 * (ended - begun), space.searches, states, found


def main() -> None:
    """Measures, writes the section."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--worlds", type=int, default=200)
    parser.add_argument("--keep", action="store_true", help="write the section of docs/results.md")
    given = parser.parse_args()
    found = list(timed(given.worlds))
    rows = []
    for name, column in (("the best plan if all turns out well", 0), ("that and the cautious one", 1)):
        ms = np.array([one[column] for one in found])
        rows.append((name, str(len(ms)), *(f"{np.percentile(ms, q):.0f} ms" for q in (50, 95, 100)),
                     f"{MUST_MS} ms at 95 %", str(int((ms > MUST_MS).sum()))))  # fmt: skip
    plans = sum(one[4] for one in found)
    searches, states = ([one[i] for one in found] for i in (2, 3))
    note = (f"{plans} of {len(found)} have a plan; searches {np.median(searches):.0f} in the median, at most "
            f"{max(searches)}; states {np.median(states):.0f} in the median, at most {max(states)}.")  # fmt: skip
    for row in rows:
        print(*row, sep=" | ")
    print(note)
    if given.keep:
        keep(
            Section(
                name="46-rule-scale",
                title="Rules on a large map",
                command=f"python -m bench.rule_scale --worlds {given.worlds} --keep",
                how="200 x 200 cells with blocks over 12 % of them, four areas, two clouds, three places to go to in "
                "order, and a rule of five clauses drawn from the patterns of mission files; body 0.8 m. CPU time of "
                "one core, warm, from the problem to the plan, the clearance and the rules' cells included.",
                tables=[Table(caption="", header=("plan", "worlds", "median", "p95", "longest", "must", "above"),
                              rows=rows)],
                notes=[note],
            )
        )  # fmt: skip


if __name__ == "__main__":
    main()
