from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from mintpilot.core.errors import MissionError
from mintpilot.core.gap import CorrelationGroup
from mintpilot.core.mission import AskingSettings, CriticalityRule
from mintpilot.core.tree import LeafReason, StopReason
from mintpilot.reasoning.belief import prior_belief
from mintpilot.reasoning.certificate import certify
from mintpilot.reasoning.classes import leaves_of
from mintpilot.reasoning.explain import decided, explain_gaps
from mintpilot.reasoning.metrics import FrechetMetric
from mintpilot.reasoning.tree import build_tree
from oracles.worlds import BruteForce, World, random_world

EXACT = AskingSettings(delta_c_s=0.0, goal_entropy_bits=0.0)


def corridor(gates: int = 1, *, goals: int = 1, detour: bool = True, width: int = 9) -> World:
    """A hall with walls that have a gate of doubtful passability each, and a way around them at the far side."""
    free = np.ones((9, 4 + 2 * gates + width % 2), bool)
    regions = {}
    for i in range(gates):
        column = 2 + 2 * i
        free[:, column] = False
        free[4, column] = True
        free[8, column] = detour
        regions[f"r{i:02}"] = frozenset({(4, column)})
    last = free.shape[1] - 1
    places = {f"g{i}": (4 + (-1) ** i * i, last) for i in range(goals)}
    return World(free=free, regions=regions, start=(4, 0), goals=places)


def tree_of(world: World, settings: AskingSettings = EXACT, groups: tuple[CorrelationGroup, ...] = ()):
    space = BruteForce(world)
    return build_tree(space, prior_belief(world.gaps, groups), settings, FrechetMetric()), space


def test_nothing_unknown_is_one_leaf() -> None:
    mint, space = tree_of(corridor(0))
    assert mint.root.leaf is LeafReason.RELIES_ON_NOTHING
    assert mint.nodes == space.calls == 1
    assert mint.belief.gaps == ()
    assert mint.class_of.shape == ()


def test_one_gate_makes_two_classes() -> None:
    mint, _ = tree_of(corridor())
    assert mint.root.branch_on == "r00"
    assert [c.probability for c in mint.classes] == [0.5, 0.5]
    assert mint.root.divergence_m > 2


def test_a_cheap_detour_is_flown_without_asking_under_the_regret_rule_only() -> None:
    world = corridor()
    loose = replace(EXACT, delta_c_s=100.0, delta_d_m=1.0)
    mint, _ = tree_of(world, loose)
    assert mint.root.leaf is LeafReason.CAUTIOUS_IS_GOOD_ENOUGH
    assert mint.root.plan.enters == frozenset()
    critical, _ = tree_of(world, replace(loose, rule=CriticalityRule.PAPER))
    assert critical.root.branch_on == "r00"
    near, _ = tree_of(world, replace(loose, rule=CriticalityRule.PAPER, delta_d_m=50.0))
    assert near.root.leaf is LeafReason.CAUTIOUS_IS_GOOD_ENOUGH


def test_no_way_at_all() -> None:
    world = corridor(detour=False)
    mint, _ = tree_of(world)
    assert sorted(c.plan is None for c in mint.classes) == [False, True]
    world.free[4, 2] = world.free[8, 2] = False
    mint, _ = tree_of(world)
    assert mint.root.leaf is LeafReason.INFEASIBLE


@pytest.mark.parametrize(("prior", "enters"), [((1.0, 0.0), True), ((0.0, 1.0), False)])
def test_priors_of_one_and_zero_do_not_branch(prior: tuple[float, float], enters: bool) -> None:
    world = corridor()
    world.priors["r00"] = prior
    mint, _ = tree_of(world)
    assert mint.root.leaf is LeafReason.RELIES_ON_NOTHING
    assert bool(mint.root.plan.enters) == enters


def test_thirty_gaps_of_which_none_matters_cost_nothing() -> None:
    world = corridor(0)
    world.regions.update({f"x{i:02}": frozenset({(0, 1 + i % 3)}) for i in range(30)})
    mint, space = tree_of(world)
    assert mint.nodes == 1
    assert mint.belief.gaps == ()
    assert space.searches == 1


def test_thirty_gates_in_a_row_stay_bounded_and_safe() -> None:
    mint, space = tree_of(corridor(30), replace(EXACT, max_nodes=31, max_joint=64))
    assert mint.nodes <= 31
    assert space.calls <= 62
    assert mint.belief.probability.size <= 64
    cut_off = [leaf for leaf in leaves_of(mint.root) if leaf.leaf is LeafReason.NOT_EXPANDED]
    assert len(cut_off) == mint.not_expanded > 0
    for leaf in cut_off:
        assert leaf.plan is leaf.cautious
        assert leaf.plan.relies_on == frozenset()
    assert sum(leaf.probability for leaf in leaves_of(mint.root)) == pytest.approx(1)


def test_correlated_gates_open_together() -> None:
    both = CorrelationGroup(gaps=("r00", "r01"), joint=((("passable", "passable"), 0.5), (("blocked", "blocked"), 0.5)))
    mint, _ = tree_of(corridor(2), groups=(both,))
    # The second gate needs no branch of its own, yet the tree knows that the plan rests on it.
    assert mint.nodes == 3
    assert [g.id for g in mint.belief.gaps] == ["r00", "r01"]
    assert len(mint.classes) == 2
    held = {(int(a), int(b)) for a, b in np.argwhere(mint.class_of >= 0)}
    assert held == {(0, 0), (1, 1)}


def test_a_clear_target_is_taken_and_an_unclear_one_asked_about() -> None:
    world = corridor(0, goals=2)
    world.priors["target"] = (0.97, 0.03)
    mint, _ = tree_of(world, replace(EXACT, goal_entropy_bits=0.3))
    assert mint.root.leaf is LeafReason.TARGET_IS_CLEAR_ENOUGH
    assert mint.root.plan.binds == (("target", "g0"),)
    assert 0 < mint.root.entropy_bits <= 0.3
    world.priors["target"] = (0.6, 0.4)
    unclear, _ = tree_of(world, replace(EXACT, goal_entropy_bits=0.3))
    assert unclear.root.branch_on == "target"


def test_a_plan_that_relies_on_an_unknown_gap_is_an_error() -> None:
    world = corridor()
    with pytest.raises(MissionError, match="r00"):
        build_tree(BruteForce(world), prior_belief(()), EXACT, FrechetMetric())


def test_the_explanation_of_every_gap_has_figures() -> None:
    world = corridor(1, goals=2)
    world.regions["aside"] = frozenset({(0, 0)})
    mint, space = tree_of(world)
    worth = explain_gaps(space, prior_belief(world.gaps), mint, EXACT, FrechetMetric())
    explanations = tuple(decided(one, one.gap_id == "r00") for one in worth)
    aside, gate, target = explanations
    assert [a.gap_id for a in explanations] == ["aside", "r00", "target"]
    assert (aside.relevant, aside.asked) == (False, False)
    assert aside.cost_if_favourable_s == aside.cost_if_unfavourable_s
    assert aside.gain_bits == aside.regret_saved_s == 0
    assert "not worth a question" in str(aside.why)
    assert gate.relevant
    assert gate.asked
    assert str(gate.why).startswith("Asked:")
    assert gate.cost_if_unfavourable_s > gate.cost_if_favourable_s
    assert gate.divergence_m > 0
    assert gate.gain_bits > 0
    assert gate.regret_saved_s >= 0
    assert target.relevant
    assert target.entropy_bits == 1
    assert "bits are not known" in str(target.why)


def test_explanations_say_where_there_is_no_way() -> None:
    world = corridor(detour=False)
    mint, space = tree_of(world)
    (gate,) = explain_gaps(space, prior_belief(world.gaps), mint, EXACT, FrechetMetric())
    assert gate.cost_if_unfavourable_s is None
    assert "none the other way" in str(gate.why)


def test_the_certificate_bounds_what_answers_could_change() -> None:
    world = corridor()
    mint, _ = tree_of(world)
    belief = prior_belief(world.gaps)
    around = mint.root.cautious
    sure = certify(StopReason.BUDGET, around, mint, belief, EXACT)
    assert sure.bound_s == pytest.approx(around.cost_s - mint.root.optimistic.cost_s)
    assert f"{sure.bound_s:.1f} s" in str(sure.text)
    through = next(c.plan for c in mint.classes if c.plan.enters)
    assert math.isinf(certify(StopReason.BUDGET, through, mint, belief, EXACT).bound_s)
    assert math.isinf(certify(StopReason.SILENCE, None, mint, belief, EXACT).bound_s)
    assert sure.entropy_bits == 1
    assert sure.top_class_probability == 0.5


def test_trees_of_random_worlds_do_not_depend_on_the_search_before() -> None:
    world = random_world(np.random.default_rng(11), regions=4, goals=2, rooms=1)
    one, space = tree_of(world)
    again = build_tree(space, prior_belief(world.gaps), EXACT, FrechetMetric())
    assert np.array_equal(one.class_of, again.class_of)
    assert [c.plan.signature if c.plan else "" for c in one.classes] == [
        c.plan.signature if c.plan else "" for c in again.classes
    ]
