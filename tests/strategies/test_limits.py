"""A bound on the work ends in the cautious plan with a notice, whichever strategy meets it, and never in an abort."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from drivers.play import open_situation, play, told
from mintpilot.assembly.registry import BUILT_IN
from mintpilot.assembly.strategies import make_strategy
from mintpilot.core.errors import LimitError
from mintpilot.core.gap import Assumptions, CorrelationGroup
from mintpilot.core.mission import AskingSettings, CriticalityRule
from mintpilot.core.ports import Ask, Fly
from mintpilot.core.query import Reply
from mintpilot.core.tree import StopReason
from mintpilot.strategies.mint import MintStrategy
from oracles.worlds import hypotheses, random_world
from strategies.test_strategies import EXACT, gate


class Overwhelmed:
    """Every piece of work is too much for it."""

    def scores(self, situation: object) -> None:
        raise LimitError("the situation is too large")

    def divergence(self, a_m: object, b_m: object) -> float:
        raise LimitError("the paths are too long")


@pytest.mark.parametrize("name", BUILT_IN["strategy"])
def test_where_the_tree_itself_is_too_large_the_cautious_plan_is_flown(name: str) -> None:
    situation = replace(open_situation(gate(), EXACT), metric=Overwhelmed())
    decision = make_strategy(name, seed=0).decide(situation)
    assert isinstance(decision, Fly)
    assert decision.certificate.reason is StopReason.LIMIT
    assert decision.certificate.bound_s == np.inf
    assert decision.plan == situation.space.cautious(Assumptions())
    assert decision.plan.enters == frozenset()
    assert tuple(map(str, decision.notices)) == ("the paths are too long",)
    assert not decision.unsafe


@pytest.mark.parametrize("name", BUILT_IN["strategy"])
def test_where_the_objective_meets_a_bound_nothing_is_raised(name: str) -> None:
    world = random_world(np.random.default_rng(3), regions=3, goals=2)
    situation = open_situation(world, EXACT, objective=Overwhelmed())
    for truth, _ in hypotheses(world)[:4]:
        game = play(make_strategy(name, seed=0), situation, truth)
        assert isinstance(game.fly, Fly)
        if name == "mint":
            assert game.fly.certificate.reason is StopReason.LIMIT
            assert game.fly.mint is not None
            assert game.questions == 0


def test_optimal_with_wrong_answers_flies_cautiously_instead_of_failing() -> None:
    asking = replace(EXACT, answer_error=0.1, objective="optimal")
    fly = make_strategy("mint", seed=0).decide(open_situation(gate(), asking))
    assert isinstance(fly, Fly)
    assert fly.plan.enters == frozenset()
    assert "use 'information-gain'" in str(fly.notices[0])


@pytest.mark.long
@settings(max_examples=15, deadline=None)
@given(st.integers(0, 999), st.sampled_from([2, 4, 8]), st.sampled_from([0.0, 0.1]))
def test_no_answer_couples_more_than_max_joint_values(seed: int, most: int, error: float) -> None:
    world = random_world(np.random.default_rng(seed), regions=5, uneven=True)
    asking = replace(EXACT, max_joint=most, answer_error=error, rule=CriticalityRule.PAPER, delta_d_m=0.0)
    situation = open_situation(world, asking)
    rng = np.random.default_rng(seed)
    attempts: tuple[str, ...] = ()
    for _ in range(asking.question_budget):
        decision = MintStrategy().decide(situation)
        if not isinstance(decision, Ask):
            break
        query = decision.scored.query
        situation = told(situation, query, Reply.YES if rng.random() < 0.5 else Reply.NO, attempts)
        attempts = (*attempts, query.id)
        assert max((f.probability.size for f in situation.belief.factors), default=1) <= most


def test_queries_that_the_belief_could_not_take_in_are_not_asked() -> None:
    """Two pairs of correlated clouds: a query about one of each would make one table of all four."""
    world = random_world(np.random.default_rng(5), regions=4)
    names = [g.id for g in world.gaps]
    even = tuple(((a, b), 0.25) for a in ("passable", "blocked") for b in ("passable", "blocked"))
    groups = tuple(CorrelationGroup(gaps=tuple(names[i : i + 2]), joint=even) for i in (0, 2))
    queries = []
    for most in (4, 16):
        situation = open_situation(world, replace(EXACT, max_joint=most), groups=groups)
        ask = MintStrategy().decide(situation)
        assert isinstance(ask, Ask)
        queries.append([s.query for s in (ask.scored, *ask.alternatives)])
    pairs = [set(names[:2]), set(names[2:])]
    assert all(any(set(q.gap_ids) <= pair for pair in pairs) for q in queries[0])


def test_the_budget_follows_the_error_of_answers_unless_one_is_given() -> None:
    budgets = [AskingSettings(answer_error=error).question_budget for error in (0.0, 0.05, 0.1, 0.2, 0.3, 0.49)]
    assert budgets == sorted(budgets)
    assert (budgets[0], budgets[2], budgets[-1]) == (20, 60, 200)
    assert AskingSettings(answer_error=0.2, max_questions=6).question_budget == 6
