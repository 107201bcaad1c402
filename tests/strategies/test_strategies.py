from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from drivers.play import open_situation, play, told
from mintpilot.assembly.registry import load
from mintpilot.core.mission import AskingSettings
from mintpilot.core.ports import Ask, Fly, Strategy
from mintpilot.core.query import Reply
from mintpilot.core.tree import StopReason
from mintpilot.strategies.exhaustive import ExhaustiveStrategy
from mintpilot.strategies.gap_by_gap import GapByGapStrategy
from mintpilot.strategies.mint import MintStrategy
from mintpilot.strategies.passive import ConservativeStrategy, PassiveMixtureStrategy, RiskyStrategy
from mintpilot.strategies.random_query import RandomQueryStrategy
from oracles.worlds import BruteForce, World, hypotheses, random_world

EXACT = AskingSettings(delta_c_s=0.5, goal_entropy_bits=0.0)
ALL: list[type[Strategy]] = [
    MintStrategy,
    ExhaustiveStrategy,
    GapByGapStrategy,
    RandomQueryStrategy,
    ConservativeStrategy,
    RiskyStrategy,
    PassiveMixtureStrategy,
]


def gate(*, prior: float = 0.5, detour: bool = True, goals: int = 1, rooms: int = 0) -> World:
    free = np.ones((9, 7), bool)
    free[:, 3] = False
    free[4, 3], free[8, 3] = True, detour
    return World(
        free=free,
        regions={"smoke": frozenset({(4, 3)})},
        start=(4, 0),
        goals={f"g{i}": (4 - i, 6) for i in range(goals)},
        rooms={f"room{i}": (0, 1) for i in range(rooms)},
        priors={"smoke": (prior, 1 - prior)},
    )


def test_mint_asks_about_the_gate_and_flies_what_the_answer_allows() -> None:
    situation = open_situation(gate(), EXACT)
    ask = MintStrategy().decide(situation)
    assert isinstance(ask, Ask)
    assert ask.scored.query.gap_ids == ("smoke",)
    assert ask.scored.gain_bits == 1
    through = MintStrategy().decide(told(situation, ask.scored.query, Reply.YES))
    around = MintStrategy().decide(told(situation, ask.scored.query, Reply.NO))
    assert isinstance(through, Fly)
    assert isinstance(around, Fly)
    assert through.plan.enters == {"smoke"}
    assert around.plan.enters == frozenset()
    assert through.certificate.reason is around.certificate.reason is StopReason.ONE_CLASS
    assert through.certificate.bound_s == around.certificate.bound_s == 0


def test_nothing_that_bears_on_the_task_is_not_asked() -> None:
    world = gate()
    world.regions["aside"] = frozenset({(0, 0)})
    for truth, _ in hypotheses(world):
        game = play(MintStrategy(), open_situation(world, EXACT), truth)
        assert {q.gap_ids for q in game.queries} == {("smoke",)}
    world.regions.pop("smoke")
    fly = MintStrategy().decide(open_situation(world, EXACT))
    assert isinstance(fly, Fly)
    assert fly.certificate.reason is StopReason.NO_GAPS


def test_silence_flies_the_cautious_plan_or_stays() -> None:
    for detour in (True, False):
        fly = MintStrategy().decide(told(open_situation(gate(detour=detour), EXACT), _any(), Reply.TIMEOUT))
        assert isinstance(fly, Fly)
        assert fly.certificate.reason is StopReason.SILENCE
        assert (fly.plan is not None) == detour
        if fly.plan:
            assert fly.plan.enters == frozenset()
            assert 0 < fly.certificate.bound_s < math.inf


def _any():
    ask = MintStrategy().decide(open_situation(gate(), EXACT))
    assert isinstance(ask, Ask)
    return ask.scored.query


def test_unsure_withdraws_the_cut() -> None:
    situation = told(open_situation(gate(), EXACT), _any(), Reply.UNSURE)
    fly = MintStrategy().decide(situation)
    assert isinstance(fly, Fly)
    assert fly.certificate.reason is StopReason.NO_GAIN
    assert fly.plan.enters == frozenset()


def test_the_budget_is_kept() -> None:
    fly = MintStrategy().decide(open_situation(gate(), replace(EXACT, max_questions=0)))
    assert isinstance(fly, Fly)
    assert fly.certificate.reason is StopReason.BUDGET
    assert fly.certificate.best_gain_bits == 1
    assert fly.plan.enters == frozenset()


def test_no_way_at_all_is_infeasible() -> None:
    world = gate(detour=False)
    world.free[4, 3] = False
    fly = MintStrategy().decide(open_situation(world, EXACT))
    assert isinstance(fly, Fly)
    assert fly.certificate.reason is StopReason.INFEASIBLE
    assert fly.plan is None
    assert fly.certificate.bound_s == 0


@pytest.mark.parametrize("prior", [1.0, 0.97])
def test_likely_is_not_known_so_a_yes_is_asked_for(prior: float) -> None:
    situation = open_situation(gate(prior=prior), EXACT)
    ask = MintStrategy().decide(situation)
    assert isinstance(ask, Ask)
    assert ask.scored.query.gap_ids == ("smoke",)
    fly = MintStrategy().decide(told(situation, ask.scored.query, Reply.YES))
    assert isinstance(fly, Fly)
    assert fly.plan.enters == {"smoke"}
    # A no against a prior of one is a contradiction: asked again once; then the way around is flown.
    after = told(situation, ask.scored.query, Reply.NO)
    if isinstance(again := MintStrategy().decide(after), Ask):
        assert prior == 1.0
        assert again.scored.query == ask.scored.query
        after = told(after, ask.scored.query, Reply.NO, attempts=(ask.scored.query.id,))
    fly = MintStrategy().decide(after)
    assert isinstance(fly, Fly)
    assert fly.plan.enters == frozenset()


def test_a_confirmation_that_is_not_worth_its_price_is_not_asked_for() -> None:
    dear = replace(EXACT, question_price_s=100.0)
    fly = MintStrategy().decide(open_situation(gate(prior=1.0), dear))
    assert isinstance(fly, Fly)
    assert fly.plan.enters == frozenset()
    assert fly.certificate.reason is StopReason.NO_GAIN
    near = MintStrategy().decide(open_situation(gate(prior=1.0), replace(EXACT, delta_c_s=50.0)))
    assert isinstance(near, Fly)
    assert near.certificate.reason is StopReason.GOOD_FOR_ALL


def test_with_wrong_answers_one_yes_is_not_enough() -> None:
    situation = open_situation(gate(), replace(EXACT, answer_error=0.1, alpha_safe=0.01))
    count = 0
    while isinstance(decision := MintStrategy().decide(situation), Ask):
        situation = told(situation, decision.scored.query, Reply.YES)
        count += 1
    assert count == 3
    assert decision.plan.enters == {"smoke"}
    assert situation.belief.probability_of("smoke", "passable") >= 0.99


def test_with_wrong_answers_a_short_budget_is_not_begun() -> None:
    fly = MintStrategy().decide(open_situation(gate(prior=0.97), replace(EXACT, answer_error=0.3, max_questions=1)))
    assert isinstance(fly, Fly)
    assert fly.plan.enters == frozenset()
    assert fly.certificate.reason is StopReason.BUDGET


@pytest.mark.long
def test_exhaustive_asks_about_everything_and_mint_about_less() -> None:
    world = gate(goals=2, rooms=1)
    world.regions["aside"] = frozenset({(0, 0)})
    space = BruteForce(world)
    for truth, _ in hypotheses(world):
        everything = play(ExhaustiveStrategy(), open_situation(world, EXACT, space=space), truth)
        mint = play(MintStrategy(), open_situation(world, EXACT, space=space), truth)
        assert {g for q in everything.queries for g in q.gap_ids} == {g.id for g in world.gaps}
        assert mint.questions < everything.questions
        for game in (everything, mint):
            assert game.fly.plan.cost_s <= space.cost_under(truth) + EXACT.delta_c_s + 1e-9


@pytest.mark.long
def test_gap_by_gap_misses_what_interacts() -> None:
    # Two gates one after the other beside a long way around: each alone is critical only while the other is open.
    worse = 0.0
    for seed in range(12):
        world = random_world(np.random.default_rng(seed), regions=4)
        space = BruteForce(world)
        for truth, p in hypotheses(world):
            game = play(GapByGapStrategy(), open_situation(world, EXACT, space=space), truth)
            best = space.cost_under(truth)
            if game.fly.plan is not None:
                assert game.fly.plan.enters <= game.situation.confirmed
            flown = game.fly.plan.cost_s if game.fly.plan else math.inf
            worse += p * (flown > best + EXACT.delta_c_s + 1e-9)
    assert worse > 0


def test_passive_methods_do_what_the_paper_says() -> None:
    situation = open_situation(gate(goals=2, rooms=1), EXACT)
    conservative, risky = (s().decide(situation) for s in (ConservativeStrategy, RiskyStrategy))
    assert isinstance(conservative, Fly)
    assert isinstance(risky, Fly)
    assert (conservative.plan.enters, conservative.unsafe) == (frozenset(), False)
    assert (risky.plan.enters, risky.unsafe) == (frozenset({"smoke"}), True)
    for fly in (conservative, risky):
        assert fly.certificate.reason is StopReason.NEVER_ASKS
        assert fly.plan.binds == (("target", "g0"),)
        assert fly.plan.skips == {"room0"}


@pytest.mark.long
def test_the_passive_mixture_is_seeded() -> None:
    situation = open_situation(gate(goals=2, rooms=1), EXACT)
    flown = [PassiveMixtureStrategy(seed).decide(situation) for seed in range(40)]
    again = [PassiveMixtureStrategy(seed).decide(situation) for seed in range(40)]
    assert [f.plan.signature for f in flown] == [f.plan.signature for f in again]
    assert {f.unsafe for f in flown} == {True, False}
    assert {f.plan.binds for f in flown} == {(("target", "g0"),), (("target", "g1"),)}
    assert {f.plan.skips for f in flown} == {frozenset(), frozenset({"room0"})}


@pytest.mark.long
@pytest.mark.parametrize("kind", ALL)
def test_every_method_ends_and_marks_what_is_not_safe(kind: type[Strategy]) -> None:
    for seed in range(4):
        world = random_world(np.random.default_rng(seed), regions=3, goals=2, rooms=1)
        space = BruteForce(world)
        for truth, _ in hypotheses(world)[::5]:
            game = play(kind(), open_situation(world, EXACT, space=space), truth)
            if game.fly.plan is not None and not game.fly.unsafe:
                assert game.fly.plan.enters <= game.situation.confirmed


@pytest.mark.parametrize("objective", ["information-gain", "ec2", "optimal", "value-of-information", "random"])
def test_every_objective_ends(objective: str) -> None:
    world = random_world(np.random.default_rng(5), regions=3, goals=2)
    strategy = MintStrategy(load("objective", objective)())
    for truth, _ in hypotheses(world):
        assert play(strategy, open_situation(world, EXACT), truth).questions <= 20
