"""Worlds, what is believed of them, and what their gaps are worth."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from tests.benchmark.small import experiment

from mintpilot.assembly.components import Choices, deliberation_parts
from mintpilot.assembly.strategies import make_strategy
from mintpilot.benchmark.calibration import FIRST_SEED, calibrate, committed, nonconformity, quantile
from mintpilot.benchmark.conditions import asking_for, believed_world, misplaced, true_world
from mintpilot.benchmark.experiment import Cell, Condition
from mintpilot.benchmark.experiments import CONDITIONS, MOST_GAPS, gap_parameters, gaps
from mintpilot.benchmark.methods import VARIANTS, method_of
from mintpilot.benchmark.omniscient import survey_world
from mintpilot.benchmark.warm import WarmPlanner
from mintpilot.core.gap import Assumptions
from mintpilot.core.mission import CriticalityRule
from mintpilot.core.plan import Plan
from mintpilot.mission.rehearsal import begin

WAREHOUSE = Cell(scenario="fire-warehouse", methods=())


def test_what_is_believed_changes_but_not_the_truth() -> None:
    world = true_world(WAREHOUSE, 4)
    condition = Condition(believed_passable=0.2, believed_occupied=0.8, misplaced_m=0.5)
    believed = believed_world(world, condition)
    assert believed.scene is world.scene
    assert [r.prior_passable for r in believed.map.regions] == [0.2]
    assert [r.prior_occupied for r in believed.map.rooms] == [0.8]
    assert believed.mission.prior_passable == 0.2
    assert np.array_equal(believed.map.cells, world.map.cells)
    assert believed_world(world, condition).map.regions[0].cells.tolist() == believed.map.regions[0].cells.tolist()
    assert believed_world(world, Condition()).map is world.map


def test_misplaced_things_are_off_by_the_stated_error() -> None:
    world = true_world(WAREHOUSE, 4)
    rng = np.random.default_rng(1)
    off = []
    for _ in range(60):
        moved = misplaced(world.map, 0.5, rng)
        pairs = zip(moved.objects, world.map.objects, strict=True)
        off += [np.subtract(a.position_m, b.position_m) for a, b in pairs]
    assert np.abs(np.mean(off, axis=0)).max() < 0.05
    assert np.std(off, axis=0)[:2] == pytest.approx([0.5, 0.5], abs=0.05)
    assert np.std(off, axis=0)[2] == pytest.approx(0.0, abs=1e-9)
    assert misplaced(world.map, 0.0, rng).regions[0].cells.tolist() == world.map.regions[0].cells.tolist()


def test_methods_get_their_settings_and_only_told_ones() -> None:
    base = true_world(WAREHOUSE, 4).mission.asking
    plain, told = experiment("mint"), experiment("mint", tell_prices=True)
    condition = Condition(answer_error=0.1)
    assert asking_for(base, plain, condition, method_of("mint")) == replace(base, answer_error=0.1, reply_s=0.0)
    thoughtful = experiment("mint", think_s=4.0, think_most_s=8.0)
    assert asking_for(base, thoughtful, condition, method_of("mint")).reply_s == 6.0
    assert asking_for(base, told, condition, method_of("mint")).question_price_s == told.prices.question_s
    assert asking_for(base, plain, Condition(), VARIANTS["mint-paper"]).rule is CriticalityRule.PAPER
    blind = Condition(answer_error=0.1, believed_error=0.0)
    assert asking_for(base, plain, blind, method_of("mint")).answer_error == 0.0
    assert asking_for(base, plain, Condition(), method_of("ec2")).objective == "ec2"


def test_the_mixture_takes_both_stances_over_the_trials() -> None:
    world = true_world(WAREHOUSE, 2)
    parts = deliberation_parts(world, Choices())
    decisions = []
    for seed in range(12):
        strategy = make_strategy(method_of("passive-mixture").strategy, seed=seed)
        thought = begin(replace(parts, strategy=strategy), world.map).deliberated()
        plan = thought.decision.plan
        decisions.append(plan.signature if plan else "")
    assert len(set(decisions)) > 1


def paid(plan: Plan, truth: dict[str, str]) -> float:
    """Seconds of flight, and the prices of what is left undone under that truth."""
    return plan.cost_s + plan.undone_s + sum(s for gap, value, s in plan.stakes if truth.get(gap) == value)


@pytest.mark.parametrize("seed", [2, 3, 5])
def test_a_gap_mattered_exactly_when_flipping_the_truth_changes_the_best_mission(seed: int) -> None:
    world = true_world(WAREHOUSE, seed)
    record = survey_world(world, experiment="table1", cell="")
    parts = deliberation_parts(world, Choices())
    thought = begin(parts, world.map).deliberated()
    truth = {gap.id: gap.truth for gap in record.gaps if gap.truth}
    best = thought.situation.space.optimistic(Assumptions.exactly(truth))
    assert record.possible == (best is not None)
    assert record.best_s == (best.cost_s if best else None)
    for gap in thought.findings.gaps:
        other = next(v for v in gap.values if v != truth[gap.id])
        flipped = thought.situation.space.optimistic(Assumptions.exactly(truth | {gap.id: other}))
        known = (truth, truth | {gap.id: other})
        costs = [paid(plan, told) if plan else np.inf for plan, told in zip((best, flipped), known, strict=True)]
        differs = costs[0] != costs[1] and abs(costs[0] - costs[1]) > parts.settings.delta_c_s
        assert next(g for g in record.gaps if g.id == gap.id).mattered == differs


def test_shared_plans_are_the_plans_of_a_fresh_planner() -> None:
    world = true_world(WAREHOUSE, 3)
    parts = deliberation_parts(world, Choices())
    problem = begin(parts, world.map).deliberated().situation.problem
    warm = WarmPlanner(parts.planner)
    space = warm.open(problem)
    assert warm.open(problem) is space
    assert warm.open(replace(problem, limits=replace(problem.limits, endurance_s=1e6))) is not space
    fresh = parts.planner.open(problem)
    for given in (Assumptions(), Assumptions.exactly({g.id: g.values[0] for g in problem.gaps})):
        plans = [s.optimistic(given) for s in (space, fresh)]
        assert (plans[0] is None) == (plans[1] is None)
        assert plans[0] is None or plans[0].signature == plans[1].signature


def test_conformal_quantiles() -> None:
    scores = [i / 100 for i in range(1, 100)]
    assert quantile(scores, 0.95) == 0.95
    assert quantile([0.1, 0.2], 0.95) == 1.0
    q = committed().quantiles
    assert sorted(q, key=int) == [str(k) for k in range(1, MOST_GAPS + 1)]
    made = gaps(trials=1, seed=0, vehicle="kinematic")
    for k, cell in enumerate(made.cells[:MOST_GAPS], 1):
        knowno = next(m for m in cell.methods if m.name == "knowno")
        assert knowno.arguments == {"quantile": q[str(k)]}
        assert cell.parameters == {**gap_parameters(k), "thinking_s": 10.0 * k}
        assert sum(gap_parameters(k).values()) == k
    assert {cell.name for cell in made.cells[MOST_GAPS:]} == {name for name, _ in CONDITIONS}
    # No experiment flies in worlds that the method was calibrated on.
    assert FIRST_SEED > 10_000


def test_nonconformity_is_what_the_true_class_lacks_of_certainty() -> None:
    cell = Cell(scenario="fire-warehouse", parameters=gap_parameters(2), methods=())
    scores = [nonconformity(true_world(cell, seed)) for seed in range(6)]
    assert all(score is None or 0 <= score < 1 for score in scores)
    assert any(score for score in scores)


@pytest.mark.slow
def test_committed_quantiles_come_from_the_stated_worlds() -> None:
    cell = Cell(scenario="fire-warehouse", parameters=gap_parameters(2), methods=())
    assert calibrate(cell, committed().worlds) == pytest.approx(committed().quantiles["2"], abs=1e-6)
