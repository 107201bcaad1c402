"""Learned policies: do their values call the same gaps critical?

python -m bench.policies [--worlds 100] [--learned 20] [--dry]
"""

from __future__ import annotations

import argparse
import itertools
import math
import sys
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from bench.policy_judge import costs_to, critical_regions, flown_length, shortest
from bench.question_games import answered, first_situation, random_problem
from bench.questions import SETTINGS
from bench.sections import Section, Table, keep
from mintpilot.assembly.components import Choices, deliberation_parts
from mintpilot.assembly.worlds import build_world
from mintpilot.benchmark.intervals import wilson
from mintpilot.core.gap import BLOCKED, Assumptions
from mintpilot.core.plan import Plan, PlanningProblem
from mintpilot.core.policy import policy_task
from mintpilot.core.ports import Ask, Decision, ImpactMetric, PlanMetric, Planner, Policy, Situation
from mintpilot.mission.rehearsal import begin
from mintpilot.mission_file.reader import read_mission
from mintpilot.planning.task_planner import GridPlanner
from mintpilot.policies.exact import ExactPolicy
from mintpilot.policies.files import load_policy
from mintpilot.policies.following import checked_values, follow
from mintpilot.policies.grid import PolicyGrid, grid_of
from mintpilot.policies.metric import QValueMetric
from mintpilot.policies.planner import PolicyPlanner
from mintpilot.policies.q_learning import Training, learn
from mintpilot.reasoning.classes import nodes_of
from mintpilot.reasoning.metrics import FrechetMetric
from mintpilot.reasoning.tree import build_tree
from mintpilot.strategies.mint import MintStrategy

# Fixed before the run.
REGIONS = 3
TRANSITIONS = (1_000_000, 3_000_000, 10_000_000)
FIRST = 5_000
"""Number of the first world: no test and no other bench draws these."""
EXAMPLE = Path(__file__).resolve().parent.parent / "examples" / "my-policy"
Cell = tuple[int, int]


@dataclass(frozen=True, kw_only=True)
class Case:
    """One problem, seen by the judge: costs in seconds are edges, at 1 m a cell and 1 m/s."""

    situation: Situation
    grid: PolicyGrid
    start: Cell
    goal: Cell
    wanted: frozenset[int]
    """Regions that the regret rule calls critical, by the oracle."""

    @property
    def problem(self) -> PlanningProblem:
        return self.situation.problem

    def free(self, mask: int) -> np.ndarray:
        """(ny, nx) under a joint hypothesis."""
        free = self.grid.free[0].copy()
        for number, cells in enumerate(self.grid.regions):
            if mask >> number & 1:
                free.ravel()[cells] = False
        return free


@dataclass(frozen=True, kw_only=True)
class Outcome:
    """One way of judging and flying in one world."""

    judged: frozenset[int]
    wanted: frozenset[int]
    questions: float
    possible: float
    """Probability of truths in which something can be flown."""
    arrived: float
    """Probability of those in which the plan that was flown is a way through free cells to the goal."""
    entered: float
    """Probability that it leads through what is not free: never, or the flight was not safe."""
    worse: float
    """Probability that it costs more than delta_c above the shortest way, or does not arrive though there is a way."""


class FirstActions(PlanMetric):
    """The loss at the start alone, by exact values: what the method warns of."""

    def __init__(self, case: Case) -> None:
        self._case = case

    def divergence(self, a_m, b_m):
        return FrechetMetric().divergence(a_m, b_m)

    def on(self, _problem):
        return self

    def loss_s(self, _best: Plan, sure: Plan, given: Assumptions) -> float:
        """What the first action of the cautious plan loses where all that is open turns out well."""
        case = self._case
        shut = [BLOCKED in given.possible(gap) and not given.is_open(gap) for gap in case.problem.gaps]
        mask = sum(1 << number for number, one in enumerate(shut) if one)
        task = policy_task(case.free(mask)[None], (0, *case.goal))
        one, two = cells_of(sure)[:2]
        ahead = costs_to(case.free(mask), case.goal)
        step = math.hypot(two[0] - one[0], two[1] - one[1])
        return float(ahead.get(two, math.inf) + step + checked_values(ExactPolicy(), task, (0, *one)).max())


def case_of(problem: PlanningProblem, situation: Situation | None = None) -> Case:
    """The problem with what the oracle says of it."""
    grid = grid_of(problem)
    x, y, _ = problem.start_m
    start, goal = (int(y), int(x)), grid.goals[0][1:]
    regions = [{(int(c) // grid.free.shape[2], int(c) % grid.free.shape[2]) for c in cells} for cells in grid.regions]
    wanted = critical_regions(grid.free[0], regions, start, goal, SETTINGS.delta_c_s)
    situation = situation or first_situation(problem, SETTINGS)
    return Case(situation=situation, grid=grid, start=start, goal=goal, wanted=frozenset(wanted))


def cells_of(plan: Plan) -> list[Cell]:
    """The cells of a plan, each once."""
    cells = [(int(y), int(x)) for x, y, _ in plan.path_m.tolist()]
    return [cell for cell, _ in itertools.groupby(cells)]


def outcome(case: Case, planner: Planner, metric: ImpactMetric) -> Outcome:
    """Judges, and follows every answer to what is flown."""
    metric = metric.on(case.problem) if isinstance(metric, PlanMetric) else metric
    situation = replace(case.situation, space=planner.open(case.problem), metric=metric, settings=SETTINGS)
    tree = build_tree(situation.space, situation.belief, SETTINGS, metric)
    numbers = {gap.id: number for number, gap in enumerate(case.problem.gaps)}
    judged = frozenset(numbers[node.branch_on] for node in nodes_of(tree.root) if node.branch_on)
    sums, known = np.zeros(5), {}
    for mask in range(case.grid.masks):
        sums += _played(case, situation, mask, known) / case.grid.masks
    questions, possible, arrived, entered, worse = sums.tolist()
    return Outcome(judged=judged, wanted=case.wanted, questions=questions, possible=possible, arrived=arrived,
                   entered=entered, worse=worse)  # fmt: skip


def _played(case: Case, situation: Situation, mask: int, known: dict[tuple[int, ...], Decision]) -> np.ndarray:
    """(questions, possible, arrived, entered, worse) where that joint hypothesis is the truth.

    ``known`` holds the decisions after each history of answers, worked out once for all truths.
    """
    gaps = case.problem.gaps
    truth = {gap.id: BLOCKED if mask >> number & 1 else "passable" for number, gap in enumerate(gaps)}
    history: tuple[int, ...] = ()
    while True:
        if history not in known:
            known[history] = MintStrategy().decide(situation)
        decision = known[history]
        if not isinstance(decision, Ask):
            break
        query = decision.scored.query
        situation, history = answered(situation, query, query.part_of(truth)), (*history, query.part_of(truth))
    free = case.free(mask)
    best = shortest(free, case.start, case.goal)
    flown = None if decision.plan is None else flown_length(free, cells_of(decision.plan), case.start, case.goal)
    possible, arrived = best < math.inf, flown is not None
    entered = decision.plan is not None and bool(decision.plan.legs) and not arrived
    worse = possible and (flown is None or flown > best + SETTINGS.delta_c_s + 1e-6)
    return np.array([len(history), possible, arrived, entered, worse], float)


@dataclass(frozen=True, kw_only=True)
class Misled:
    """How far learned values are from exact ones, in one world."""

    transitions: int
    error_s: float
    """Learned value of the start less the exact one, mean over joint hypotheses from which there is a way."""
    loss_error_s: float
    """Of the loss that decides at the root, absolute; not a number where no loss is to be judged there."""
    lost: int
    """Joint hypotheses under which the policy does not arrive though there is a way."""
    longer_s: float
    """By how much its ways are longer than the shortest, mean over those that arrive."""
    ways: int


def misled(case: Case, policy: Policy, transitions: int) -> Misled:
    """Measures one learned policy."""
    errors, longer, lost, ways = [], [], 0, 0
    for mask in range(case.grid.masks):
        best = shortest(case.free(mask), case.start, case.goal)
        if best == math.inf or best == 0:
            continue
        ways += 1
        task = policy_task(case.free(mask)[None], (0, *case.goal))
        errors.append(float(checked_values(policy, task, (0, *case.start)).max()) + best)
        way = follow(policy, task, (0, *case.start))
        lost += way is None
        longer += [] if way is None else [way.cost - best]
    space = GridPlanner().open(case.problem)
    loss_error = math.nan
    best_plan, sure = space.optimistic(Assumptions()), space.cautious(Assumptions())
    if best_plan is not None and sure is not None and best_plan.relies_on:
        loss = QValueMetric(policy, case.problem).loss_s(best_plan, sure, Assumptions())
        loss_error = abs(loss - (sure.cost_s - best_plan.cost_s))
    return Misled(transitions=transitions, error_s=float(np.mean(errors)), loss_error_s=loss_error, lost=lost,
                  longer_s=float(np.mean(longer)) if longer else math.nan, ways=ways)  # fmt: skip


def measure(worlds: int, learned: int) -> tuple[dict[str, list[Outcome]], list[Misled]]:
    """All ways of judging, learned ones in the first ``learned`` worlds; Ctrl-C ends it with those finished."""
    found: dict[str, list[Outcome]] = {}
    errors: list[Misled] = []
    for number in range(worlds):
        try:
            outcomes, off = measured(number, learns=number < learned)
        except KeyboardInterrupt:
            break
        for name, one in outcomes.items():
            found.setdefault(name, []).append(one)
        errors += off
        print(f"world {number + 1} of {worlds}", file=sys.stderr, flush=True)
    return found, errors


def measured(number: int, *, learns: bool) -> tuple[dict[str, Outcome], list[Misled]]:
    """One world."""
    case = case_of(random_problem(np.random.default_rng([REGIONS, FIRST + number]), REGIONS))
    exact = ExactPolicy()
    found = {
        RULE: outcome(case, GridPlanner(), FrechetMetric()),
        EXACT: outcome(case, PolicyPlanner(exact), QValueMetric(exact)),
        FIRST_ACTION: outcome(case, GridPlanner(), FirstActions(case)),
    }
    errors = []
    for transitions in TRANSITIONS if learns else ():
        policy, name = learn(case.grid, Training(transitions=transitions, seed=number)), learned_name(transitions)
        found[f"{name}: judges and flies"] = outcome(case, PolicyPlanner(policy), QValueMetric(policy))
        found[f"{name}: judges, shortest ways are flown"] = outcome(case, GridPlanner(), QValueMetric(policy))
        found[f"{name}: flies, the rule judges its ways"] = outcome(case, PolicyPlanner(policy), FrechetMetric())
        errors.append(misled(case, policy, transitions))
    return found, errors


def notes(found: dict[str, list[Outcome]], errors: Sequence[Misled]) -> list[str]:
    """Where values mislead, with the figures."""
    alike = [sum(o.judged == o.wanted for o in found[name]) for name in (RULE, EXACT)]
    n = len(found[RULE])
    first = found[FIRST_ACTION]
    made = [
        f"The regret rule agrees with the oracle in {alike[0]} of {n} worlds, exact values followed to the end in "
        f"{alike[1]} of {n} (tests/policies/test_law.py: 300 more worlds, none differs).",
        f"The first action alone misses {sum(len(o.wanted - o.judged) for o in first)} of "
        f"{sum(len(o.wanted) for o in first)} critical gaps: where ways part, the first moves of "
        "both are often as good.",
    ]
    for transitions in TRANSITIONS:
        mine = [e for e in errors if e.transitions == transitions]
        losses = [e.loss_error_s for e in mine if not math.isnan(e.loss_error_s)]
        judged = found.get(f"{learned_name(transitions)}: judges, shortest ways are flown", [])
        flown = found.get(f"{learned_name(transitions)}: judges and flies", [])
        if not flown:
            continue
        made.append(
            f"After {transitions // 1_000_000} M transitions {sum(e.lost for e in mine)} of "
            f"{sum(e.ways for e in mine)} flights do not arrive; the loss that decides first is off by "
            f"{np.mean(losses):.2f} s on average. Of "
            f"{sum(len(o.wanted) for o in judged)} critical gaps its values miss "
            f"{sum(len(o.wanted - o.judged) for o in judged)} on the shortest ways "
            f"({sum(len(o.judged - o.wanted) for o in judged)} others are called critical), and "
            f"{sum(len(o.wanted - o.judged) for o in flown)} where it flies too."
        )
    made += [
        "Learned values promise too much where little was tried. The loss of a gap is summed over just those actions: "
        "the cautious way under the hypothesis that all is well, which a policy for that hypothesis has no reason to "
        "try. So its ways can be the shortest while the loss is still wrong.",
        "A policy that does not arrive makes the flight no less safe, but worse: a way that it does not find does not "
        "exist for its planner, so there is nothing to ask about, and what could be done is left undone. The plan's "
        "notes say so.",
    ]
    return made


RULE = "regret rule, shortest ways"
EXACT = "exact values, followed to the end"
FIRST_ACTION = "exact values, first action only"


def learned_name(transitions: int) -> str:
    """How a length of training is called."""
    return f"learned, {transitions // 1_000_000} M transitions"


def rows(found: dict[str, list[Outcome]]) -> list[list[str]]:
    """One row for each way of judging."""
    made = []
    for name, outcomes in found.items():
        n, gaps = len(outcomes), REGIONS * len(outcomes)
        alike = sum(REGIONS - len(o.judged ^ o.wanted) for o in outcomes)
        whole = sum(o.judged == o.wanted for o in outcomes)
        low, high = wilson(whole, n)
        possible = sum(o.possible for o in outcomes)
        made.append(
            [
                name,
                str(n),
                f"{100 * alike / gaps:.1f} % of {gaps}",
                f"{100 * whole / n:.1f} % [{100 * low:.1f}, {100 * high:.1f}]",
                str(sum(len(o.wanted - o.judged) for o in outcomes)),
                str(sum(len(o.judged - o.wanted) for o in outcomes)),
                f"{np.mean([o.questions for o in outcomes]):.3f}",
                f"{100 * sum(o.arrived for o in outcomes) / possible:.1f} %",
                f"{100 * sum(o.worse for o in outcomes) / possible:.1f} %",
                f"{100 * sum(o.entered for o in outcomes) / n:.1f} %",
            ]
        )
    return made


HEADER = (
    "judged and flown by",
    "worlds",
    "gaps judged as by the oracle",
    "worlds with all gaps alike [95 %]",
    "missed",
    "needless",
    "questions",
    "success where possible",
    "worse than delta_c",
    "entered what is not free",
)


def error_rows(errors: Sequence[Misled]) -> list[list[str]]:
    """One row for each length of training."""
    made = []
    for transitions in TRANSITIONS:
        mine = [e for e in errors if e.transitions == transitions]
        losses = [e.loss_error_s for e in mine if not math.isnan(e.loss_error_s)]
        longer = [e.longer_s for e in mine if not math.isnan(e.longer_s)]
        ways, lost = sum(e.ways for e in mine), sum(e.lost for e in mine)
        made.append(
            [
                f"{transitions // 1_000_000} M",
                f"{len(mine)}",
                f"{np.mean([e.error_s for e in mine]):+.2f} s",
                f"{lost} of {ways}",
                f"{np.mean(longer):.2f} s" if longer else "-",
                f"{np.median(losses):.2f} s, worst {max(losses):.2f} s, of {len(losses)}" if losses else "-",
            ]
        )
    return made


ERROR_HEADER = (
    "transitions",
    "worlds",
    "value of the start less the exact one, mean",
    "flights that do not arrive",
    "ways longer than the shortest, mean",
    "error of the loss that decides first, median and worst",
)


def example_case() -> Case:
    """The hall of the example with the network."""
    path = EXAMPLE / "mission.yaml"
    world = build_world(read_mission(path), base=path.parent, seed=None)
    situation = begin(deliberation_parts(world, Choices()), world.map).deliberated().situation
    return case_of(situation.problem, situation)


def example_rows() -> list[list[str]]:
    """The example's network on its own hall, beside exact values and the rule."""
    case, made = example_case(), []
    policies: dict[str, Policy] = {"exact values": ExactPolicy(), "DQN network": load_policy(EXAMPLE / "dqn.npz")}
    for name, policy in policies.items():
        ways = lost = 0
        longer, errors = [], []
        for mask in range(case.grid.masks):
            task = policy_task(case.free(mask)[None], (0, *case.goal))
            for cell, cost in costs_to(case.free(mask), case.goal).items():
                if cost:
                    way = follow(policy, task, (0, *cell))
                    ways, lost = ways + 1, lost + (way is None)
                    longer += [] if way is None else [way.cost - cost]
                    errors.append(float(checked_values(policy, task, (0, *cell)).max()) + cost)
        done = outcome(case, PolicyPlanner(policy), QValueMetric(policy))
        made.append(
            [
                name,
                f"{ways - lost} of {ways}",
                f"{np.mean(longer):.2f} s" if longer else "-",
                f"{np.mean(errors):+.2f} s (spread {np.std(errors):.2f})",
                f"{REGIONS_OF_EXAMPLE - len(done.judged ^ done.wanted)} of {REGIONS_OF_EXAMPLE}",
                f"{done.questions:.2f}",
                f"{100 * done.arrived / done.possible:.0f} %",
                f"{100 * done.worse / done.possible:.0f} %",
            ]
        )
    return made


REGIONS_OF_EXAMPLE = 2
EXAMPLE_HEADER = ("policy", "cells from which it arrives", "longer than the shortest, mean",
                  "value less the exact one, mean", "gaps judged as by the oracle", "questions",
                  "success where possible", "worse than delta_c")  # fmt: skip
HOW = (
    f"Worlds of section *Questions* with {REGIONS} regions: 24 x 40 cells of 1 m, 15 % obstacles, each region passable "
    "with probability one half, delta_c = 1 s, answers right; other seeds. Every truth is played, so figures of a "
    "world are exact. *Critical* is a gap that the tree branches on under some answers to the others. The oracle is "
    "plain Dijkstra for every set of blocked regions with a recursion of its own; it shares no code with what it "
    "judges, and it judges the flown cells too. *Missed*: critical gaps that were not called so; *needless*: the "
    "other way round. Learned policies: Q-learning in numpy on each world by itself, all 8 joint hypotheses at once, "
    "in the first worlds only."
)


def main() -> None:
    """Measures, prints, and keeps the section."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--worlds", type=int, default=100)
    parser.add_argument("--learned", type=int, default=20, help="worlds in which policies are learned")
    parser.add_argument("--dry", action="store_true", help="print the section, keep nothing")
    options = parser.parse_args()
    found, errors = measure(options.worlds, options.learned)
    worlds = len(found[RULE])
    tables = [
        Table(caption="Criticality by values", header=HEADER, rows=rows(found)),
        Table(caption="How far learned values are off", header=ERROR_HEADER, rows=error_rows(errors)),
        Table(
            caption="A network of Stable-Baselines3 on its own hall (examples/my-policy, 2 regions)",
            header=EXAMPLE_HEADER,
            rows=example_rows(),
        ),
    ]
    made = Section(
        name="60-policies",
        title="Learned policies",
        command=f"python -m bench.policies --worlds {worlds} --learned {min(worlds, options.learned)}",
        how=HOW,
        tables=tables,
        notes=notes(found, errors),
    )
    print(made.markdown()) if options.dry else keep(made)


if __name__ == "__main__":
    main()
