"""With exact values, followed to the end, the regret rule's gaps are critical, and no others (method, section 15)."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from bench.policy_judge import costs_to, critical_regions

from mintpilot.conformance.sample import sample_problem
from mintpilot.core.gap import Assumptions
from mintpilot.core.mission import AskingSettings
from mintpilot.core.policy import PolicyState, policy_task, step_lengths, steps
from mintpilot.core.ports import ImpactMetric, Planner
from mintpilot.planning.task_planner import GridPlanner
from mintpilot.policies.exact import ExactPolicy
from mintpilot.policies.metric import QValueMetric
from mintpilot.policies.planner import PolicyPlanner
from mintpilot.reasoning.belief import prior_belief
from mintpilot.reasoning.classes import nodes_of
from mintpilot.reasoning.metrics import FrechetMetric
from mintpilot.reasoning.tree import build_tree
from policies.worlds import Hall, hall

SETTINGS = AskingSettings(delta_c_s=1.0, alpha=0.0, goal_entropy_bits=0.0)


def judged(world: Hall, planner: Planner, metric: ImpactMetric) -> set[int]:
    problem = world.problem
    tree = build_tree(planner.open(problem), prior_belief(problem.gaps), SETTINGS, metric)
    return {int(node.branch_on.rpartition("r")[2]) for node in nodes_of(tree.root) if node.branch_on}


def compare(seeds: range) -> int:
    """How many of these worlds have a critical gap; fails where the judgements differ."""
    some = 0
    for seed in seeds:
        world = hall(seed)
        wanted = critical_regions(world.free, world.regions, world.start, world.goal, SETTINGS.delta_c_s)
        assert judged(world, GridPlanner(), FrechetMetric()) == wanted, f"regret rule, world {seed}"
        exact = QValueMetric().on(world.problem)
        assert judged(world, PolicyPlanner(), exact) == wanted, f"exact values and plans, world {seed}"
        assert judged(world, GridPlanner(), exact) == wanted, f"exact values on the grid's plans, world {seed}"
        some += bool(wanted)
    return some


@pytest.mark.long
def test_exact_values_judge_as_the_regret_rule() -> None:
    assert compare(range(12)) >= 4


@pytest.mark.slow
def test_exact_values_judge_as_the_regret_rule_in_many_worlds() -> None:
    assert compare(range(1000, 1300)) >= 100


def test_exact_values_are_those_of_plain_dijkstra() -> None:
    world = hall(3, shape=(9, 14), regions=1)
    goal = (0, *world.goal)
    task, policy, ahead = policy_task(world.free[None], goal), ExactPolicy(), costs_to(world.free, world.goal)
    for y, x in np.argwhere(world.free):
        values = policy.q_values(PolicyState(task=task, cell=(0, int(y), int(x))))
        for value, step, length, allowed in zip(
            values, steps(task.free.shape), step_lengths(task.free.shape), task.allowed[0, y, x], strict=True
        ):
            if allowed:
                assert value == pytest.approx(-length - ahead.get((y + int(step[1]), x + int(step[2])), np.inf))
            else:
                assert value == -np.inf


def test_the_loss_is_what_the_cautious_plan_costs_more() -> None:
    """Summed along the way: the first action alone, and values that are off by a constant, would not give it."""
    checked = 0
    for seed in range(12):
        world = hall(seed)
        problem = world.problem
        space = GridPlanner().open(problem)
        best, sure = space.optimistic(Assumptions()), space.cautious(Assumptions())
        if best is None or sure is None or sure.cost_s <= best.cost_s:
            continue
        loss_s = QValueMetric().on(problem).loss_s(best, sure, Assumptions())
        assert loss_s == pytest.approx(sure.cost_s - best.cost_s)
        checked += 1
    assert checked >= 4


@pytest.mark.parametrize("home", [False, True])
def test_a_mission_of_several_stops_in_three_dimensions_is_judged_alike(home) -> None:
    problem = sample_problem()
    problem = replace(problem, home_m=problem.start_m if home else None)
    belief = prior_belief(problem.gaps)
    plain = build_tree(GridPlanner().open(problem), belief, SETTINGS, FrechetMetric())
    policy = build_tree(PolicyPlanner().open(problem), belief, SETTINGS, QValueMetric().on(problem))
    shapes = [
        [
            (n.branch_on, n.leaf, round(n.probability, 9), n.plan and round(n.plan.cost_s, 6))
            for n in nodes_of(tree.root)
        ]
        for tree in (plain, policy)
    ]
    assert len(shapes[0]) > 3
    assert shapes[1] == shapes[0]
