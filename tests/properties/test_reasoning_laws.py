"""Every line of method section 7 about reasoning and asking, against brute force over all joint hypotheses."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from drivers.play import open_situation, play, told
from mintpilot.assembly.registry import load
from mintpilot.core.gap import Assumptions, Joint
from mintpilot.core.mission import AskingSettings, CriticalityRule
from mintpilot.core.ports import Ask
from mintpilot.core.query import Reply
from mintpilot.core.tree import LeafReason, Mint, Node, StopReason
from mintpilot.elicitation.candidates import candidate_queries
from mintpilot.elicitation.choose import choose
from mintpilot.reasoning.belief import prior_belief
from mintpilot.reasoning.classes import class_entropy_bits, leaves_of
from mintpilot.reasoning.entropy import entropy_bits
from mintpilot.reasoning.metrics import FrechetMetric
from mintpilot.reasoning.situation import regret_matrix
from mintpilot.reasoning.tree import build_tree
from mintpilot.strategies.exhaustive import ExhaustiveStrategy
from mintpilot.strategies.mint import MintStrategy
from mintpilot.strategies.random_query import RandomQueryStrategy
from oracles.worlds import BruteForce, World, hypotheses, random_world

EXACT = AskingSettings(delta_c_s=0.0, alpha=0.0, alpha_safe=0.0, goal_entropy_bits=0.0)
REPLIES = [Reply.YES, Reply.NO, Reply.UNSURE, Reply.TIMEOUT]
few = settings(max_examples=25, deadline=None)
very_few = settings(max_examples=10, deadline=None)
worlds = st.builds(
    lambda seed, regions, goals, rooms, uneven: random_world(
        np.random.default_rng(seed), regions=regions, goals=goals, rooms=rooms, uneven=uneven
    ),
    st.integers(0, 2**32 - 1),
    st.integers(0, 3),
    st.integers(1, 3),
    st.integers(0, 1),
    st.booleans(),
)
obstacle_worlds = st.builds(
    lambda seed, regions: random_world(np.random.default_rng(seed), regions=regions),
    st.integers(0, 2**32 - 1),
    st.integers(1, 4),
)


def tree(world: World, asking: AskingSettings, space: BruteForce | None = None) -> Mint:
    return build_tree(space or BruteForce(world), prior_belief(world.gaps), asking, FrechetMetric())


def flown_cost(game: object) -> float:
    plan = game.fly.plan  # type: ignore[attr-defined]
    return plan.cost_s if plan else math.inf


def expected_questions(make: object, world: World, asking: AskingSettings, space: BruteForce) -> float:
    return sum(p * play(make(), open_situation(world, asking, space=space), t).questions for t, p in hypotheses(world))  # type: ignore[operator]


def matches(truth: dict[str, str], given_: Assumptions) -> bool:
    return all(truth[gap] in values for gap, values in given_.items)


def nodes(node: Node) -> int:
    return 1 + sum(nodes(child) for child in node.children)


@few
@given(st.lists(st.floats(0, 1), min_size=1, max_size=12))
def test_entropy_is_between_nothing_and_log2_of_the_cells(mass: list[float]) -> None:
    assert 0 <= entropy_bits(mass) <= math.log2(len(mass))


@few
@given(worlds)
def test_the_two_parts_of_a_cut_cover_and_its_gain_is_at_most_a_bit(world: World) -> None:
    mint = tree(world, EXACT)
    regret = regret_matrix(mint, EXACT)
    for name in ("information-gain", "ec2", "value-of-information"):
        for scored in choose(candidate_queries(mint), mint, regret, load("objective", name)(), EXACT):
            parts = scored.query.part_table(mint.belief)
            assert 0 <= scored.gain_bits <= 1
            assert 0 < scored.yes_probability < 1
            assert mint.belief.probability[parts == 0].sum() == pytest.approx(scored.yes_probability)
            for cell in np.ndindex(parts.shape):
                truth = {g.id: g.values[i] for g, i in zip(mint.belief.gaps, cell, strict=True)}
                assert scored.query.part_of(truth) == parts[cell]


@few
@given(worlds)
def test_gain_is_the_fall_of_the_class_entropy(world: World) -> None:
    mint = tree(world, replace(EXACT, rule=CriticalityRule.PAPER, delta_d_m=0.0))
    p, classes = mint.belief.probability.ravel(), mint.class_of.ravel()
    asking = replace(EXACT, rule=CriticalityRule.PAPER)
    for scored in choose(
        candidate_queries(mint), mint, regret_matrix(mint, asking), load("objective", "ec2")(), asking
    )[:9]:
        left = 0.0
        parts = scored.query.part_table(mint.belief).ravel()
        for part in (parts == 0, parts == 1):
            mass = [p[part & (classes == c)].sum() for c in range(len(mint.classes))]
            left += sum(mass) * entropy_bits(mass)
        assert scored.gain_bits == pytest.approx(class_entropy_bits(mint) - left, abs=1e-9)


@pytest.mark.long
@few
@given(worlds, st.sampled_from([0.0, 0.5, 2.0]))
def test_every_leaf_plan_succeeds_and_is_within_delta_of_the_best(world: World, delta_s: float) -> None:
    space, asking = BruteForce(world), replace(EXACT, delta_c_s=delta_s)
    for leaf in leaves_of(tree(world, asking, space).root):
        assert leaf.leaf in (
            LeafReason.RELIES_ON_NOTHING,
            LeafReason.CAUTIOUS_IS_GOOD_ENOUGH,
            LeafReason.INFEASIBLE,
        )
        for truth, _ in hypotheses(world):
            if matches(truth, leaf.given):
                best = space.cost_under(truth)
                if leaf.plan is None:
                    assert math.isinf(best)
                    continue
                assert all(truth[r] == "passable" for r in leaf.plan.enters)
                assert all(truth[r] == "absent" for r in leaf.plan.skips)
                assert all(truth[g] == v for g, v in leaf.plan.binds)
                assert leaf.plan.cost_s <= best + delta_s + 1e-9


@pytest.mark.long
@few
@given(worlds)
def test_leaves_and_classes_hold_all_the_mass_and_answers_never_add_a_leaf(world: World) -> None:
    situation = open_situation(world, EXACT)
    mint = tree(world, EXACT)
    assert sum(leaf.probability for leaf in leaves_of(mint.root)) == pytest.approx(1)
    assert sum(c.probability for c in mint.classes) == pytest.approx(1)
    assert nodes(mint.root) == mint.nodes
    for index, one in enumerate(mint.classes):
        assert mint.belief.probability[mint.class_of == index].sum() == pytest.approx(one.probability)
    decision = MintStrategy().decide(situation)
    if isinstance(decision, Ask) and len(decision.scored.query.literals) == 1:
        for reply in (Reply.YES, Reply.NO):
            after = told(situation, decision.scored.query, reply)
            pruned = build_tree(BruteForce(world), after.belief, EXACT, FrechetMetric())
            assert len(list(leaves_of(pruned.root))) <= len(list(leaves_of(mint.root)))


@few
@given(worlds)
def test_the_tree_finds_the_cost_of_every_joint_hypothesis(world: World) -> None:
    space = BruteForce(world)
    mint = tree(world, EXACT, space)
    for truth, p in hypotheses(world):
        cell = tuple(g.values.index(truth[g.id]) for g in mint.belief.gaps)
        if p > EXACT.floor:
            plan = mint.classes[int(mint.class_of[cell])].plan
            assert (plan.cost_s if plan else math.inf) == pytest.approx(space.cost_under(truth))


@pytest.mark.long
@very_few
@given(worlds, st.sampled_from(["information-gain", "ec2"]))
def test_with_true_answers_and_no_tolerance_the_flight_is_the_omniscient_one(world: World, objective: str) -> None:
    space, asking = BruteForce(world), replace(EXACT, objective=objective)
    for truth, p in hypotheses(world):
        if p > 1e-4:
            game = play(MintStrategy(), open_situation(world, asking, space=space), truth)
            assert flown_cost(game) == pytest.approx(space.cost_under(truth))
            assert game.fly.certificate.bound_s <= 1e-9
            if game.fly.plan:
                assert game.fly.plan.enters <= game.situation.confirmed


@very_few
@given(obstacle_worlds, st.sampled_from([0.5, 2.0]), st.integers(0, 99))
def test_any_order_of_questions_flies_within_delta_and_only_through_confirmed_regions(
    world: World, delta_s: float, seed: int
) -> None:
    space, asking = BruteForce(world), replace(EXACT, delta_c_s=delta_s)
    for truth, _ in hypotheses(world):
        game = play(RandomQueryStrategy(seed), open_situation(world, asking, space=space), truth)
        if not math.isinf(space.cost_under(truth)):
            assert flown_cost(game) <= space.cost_under(truth) + delta_s + 1e-9
        if game.fly.plan:
            assert game.fly.plan.enters <= game.situation.confirmed


@pytest.mark.long
@very_few
@given(obstacle_worlds)
def test_good_objectives_are_near_the_optimum_and_never_ask_more_than_all(world: World) -> None:
    space = BruteForce(world)
    count = {
        name: expected_questions(lambda n=name: MintStrategy(load("objective", n)()), world, EXACT, space)
        for name in ("optimal", "information-gain", "ec2")
    }
    everything = expected_questions(ExhaustiveStrategy, world, EXACT, space)
    for name in ("information-gain", "ec2"):
        assert count[name] <= everything + 1e-9
        # Single worlds may be worse than the few percent that hold on average (see the benchmark).
        assert count[name] <= 1.35 * count["optimal"] + 1e-9


@few
@given(worlds, st.sampled_from(list(CriticalityRule)), st.floats(0, 3), st.floats(0, 3))
def test_a_larger_delta_never_makes_a_gap_critical(
    world: World, rule: CriticalityRule, small: float, more: float
) -> None:
    space = BruteForce(world)
    tight = replace(EXACT, rule=rule, delta_c_s=small, delta_d_m=small)
    loose = replace(tight, delta_c_s=small + more, delta_d_m=small + more)
    branched = [set(_branched(tree(world, a, space).root)) for a in (tight, loose)]
    assert branched[1] <= branched[0]


def _branched(node: Node) -> set[str]:
    return {node.branch_on} - {""} | {g for child in node.children for g in _branched(child)}


@pytest.mark.long
@very_few
@given(obstacle_worlds, st.floats(0, 2), st.floats(0, 2))
def test_a_larger_delta_never_raises_the_expected_questions_of_optimal(world: World, small: float, more: float) -> None:
    space = BruteForce(world)
    tight, loose = (
        expected_questions(
            lambda: MintStrategy(load("objective", "optimal")()), world, replace(EXACT, delta_c_s=delta), space
        )
        for delta in (small, small + more)
    )
    assert loose <= tight + 1e-9


@pytest.mark.long
@few
@given(worlds, st.randoms(use_true_random=False))
def test_the_order_of_gaps_does_not_change_the_question(world: World, shuffler: object) -> None:
    gaps = list(world.gaps)
    shuffler.shuffle(gaps)  # type: ignore[attr-defined]
    situation = open_situation(world, EXACT)
    shuffled = replace(situation, belief=prior_belief(gaps), problem=replace(situation.problem, gaps=tuple(gaps)))
    one, other = (MintStrategy().decide(s) for s in (situation, shuffled))
    assert type(one) is type(other)
    if isinstance(one, Ask) and isinstance(other, Ask):
        assert one.scored == other.scored
        assert one.alternatives == other.alternatives


@pytest.mark.long
@few
@given(worlds, st.integers(0, 9))
def test_same_seed_same_game(world: World, seed: int) -> None:
    truth = hypotheses(world)[seed % len(hypotheses(world))][0]
    one, other = (play(RandomQueryStrategy(seed), open_situation(world, EXACT), truth) for _ in range(2))
    assert one.queries == other.queries
    assert one.fly.certificate == other.fly.certificate


@few
@given(worlds, st.integers(1, 12))
def test_planner_calls_are_bounded_by_the_nodes(world: World, bound: int) -> None:
    space = BruteForce(world)
    mint = tree(world, replace(EXACT, max_nodes=bound), space)
    assert mint.nodes <= bound
    assert space.calls <= 2 * mint.nodes
    for leaf in leaves_of(mint.root):
        if leaf.leaf is LeafReason.NOT_EXPANDED:
            assert leaf.plan is leaf.cautious


@pytest.mark.long
@few
@given(worlds, st.integers(0, 3), st.lists(st.sampled_from(REPLIES), max_size=30), st.sampled_from([0.0, 0.1]))
def test_whatever_is_answered_nothing_unknown_is_entered_and_the_budget_holds(
    world: World, budget: int, replies: list[Reply], error: float
) -> None:
    situation = open_situation(world, replace(EXACT, max_questions=budget, answer_error=error, alpha_safe=0.01))
    for put, reply in enumerate([*replies, Reply.TIMEOUT], start=1):
        decision = MintStrategy().decide(situation)
        if not isinstance(decision, Ask):
            break
        assert not situation.silent
        assert put <= budget
        situation = told(situation, decision.scored.query, reply)
    decision = MintStrategy().decide(situation)
    assume(not isinstance(decision, Ask))
    if decision.plan is not None:
        for gap in decision.plan.enters:
            assert gap in situation.confirmed
            assert situation.belief.probability_of(gap, "passable") >= 0.99
    assert decision.certificate.reason in StopReason


def test_a_joint_distribution_is_one_axis_per_gap() -> None:
    world = random_world(np.random.default_rng(3), regions=3)
    mint = tree(world, EXACT)
    assert isinstance(mint.belief, Joint)
    assert mint.class_of.shape == mint.belief.probability.shape
