"""delta_c is spent once, and what is certain but has no explicit yes is asked about (method, section 6)."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from drivers.play import open_situation, play
from mintpilot.core.gap import CorrelationGroup
from mintpilot.core.mission import AskingSettings
from mintpilot.core.ports import Ask, Fly
from mintpilot.core.query import Combine
from mintpilot.core.tree import StopReason
from mintpilot.strategies.mint import MintStrategy
from oracles.worlds import BruteForce, World, hypotheses, random_world

EXACT = AskingSettings(delta_c_s=0.0, alpha=0.0, floor=0.0, goal_entropy_bits=0.0, max_questions=60)


@pytest.mark.long
@settings(max_examples=40, deadline=None)
@given(seed=st.integers(0, 100_000), regions=st.integers(1, 4), delta=st.sampled_from([0.0, 1.0, 2.0, 4.0]))
def test_what_is_flown_is_within_delta_of_the_best_under_each_hypothesis_left(
    seed: int, regions: int, delta: float
) -> None:
    world = random_world(np.random.default_rng(seed), regions=regions)
    situation = open_situation(world, replace(EXACT, delta_c_s=delta))
    space = BruteForce(world)
    for truth, prior in hypotheses(world):
        if prior == 0:
            continue
        game = play(MintStrategy(), situation, truth)
        certificate = game.fly.certificate
        if certificate.reason is StopReason.GOOD_FOR_ALL:
            assert certificate.bound_s <= delta + 1e-6
        if game.fly.plan is None or certificate.reason not in (StopReason.GOOD_FOR_ALL, StopReason.ONE_CLASS):
            continue
        best = space.cost_under(truth)
        assert game.fly.plan.cost_s <= best + delta + 1e-6, (certificate, truth)


def corridor(**priors: float) -> World:
    """One way of 16 cells with regions in it, and no way round."""
    regions = {name: frozenset({(0, 3 * n + 3)}) for n, name in enumerate(priors)}
    known = {name: (p, 1.0 - p) for name, p in priors.items()}
    free = np.ones((1, 16), bool)
    return World(free=free, regions=regions, start=(0, 0), goals={"goal": (0, 15)}, priors=known)


def test_what_is_certain_and_needed_is_asked_about_in_one_question() -> None:
    world = corridor(a=1.0, b=1.0, c=1.0)
    decision = MintStrategy().decide(open_situation(world, EXACT))
    assert isinstance(decision, Ask)
    query = decision.scored.query
    assert query.gap_ids == ("a", "b", "c")
    assert query.combine is Combine.ALL
    game = play(MintStrategy(), open_situation(world, EXACT), dict.fromkeys("abc", "passable"))
    assert len(game.queries) == 1
    assert game.fly.plan is not None
    assert game.fly.plan.enters == frozenset("abc")


def test_what_is_doubtful_is_asked_about_first_and_by_itself() -> None:
    world = corridor(a=1.0, b=0.5, c=1.0)
    decision = MintStrategy().decide(open_situation(world, EXACT))
    assert isinstance(decision, Ask)
    assert decision.scored.query.gap_ids == ("b",)


def test_a_gate_that_is_certain_by_inference_is_no_reason_to_give_up() -> None:
    """Two ways behind a certain gate, which differ by less than a question is worth: still the gate must be asked."""
    free = np.ones((3, 16), bool)
    free[:, 3] = [False, True, False]
    regions = {"gate": frozenset({(1, 3)}), "one": frozenset({(1, 8)}), "two": frozenset({(1, 11)})}
    priors = {"gate": (1.0, 0.0), "one": (0.6, 0.4), "two": (0.4, 0.6)}
    world = World(free=free, regions=regions, start=(1, 0), goals={"goal": (1, 15)}, priors=priors)
    group = CorrelationGroup(
        gaps=("one", "two"),
        joint=((("passable", "blocked"), 0.5), (("blocked", "passable"), 0.2), (("blocked", "blocked"), 0.3)),
    )
    situation = open_situation(world, replace(EXACT, delta_c_s=2.0), groups=(group,))
    truth = {"gate": "passable", "one": "passable", "two": "blocked"}
    game = play(MintStrategy(), situation, truth)
    assert game.fly.plan is not None
    assert "gate" in game.fly.plan.enters
    assert {"gate"} <= {gap for query in game.queries for gap in query.gap_ids}


@pytest.mark.parametrize(("silent", "budget"), [(True, 60), (False, 0)])
def test_without_anybody_to_say_yes_nothing_is_entered(silent: bool, budget: int) -> None:
    situation = open_situation(corridor(a=1.0), replace(EXACT, max_questions=budget))
    decision = MintStrategy().decide(replace(situation, silent=silent))
    assert isinstance(decision, Fly)
    assert decision.plan is None


def test_other_reasons_state_the_mass_outside() -> None:
    world = corridor(a=0.5)
    decision = MintStrategy().decide(replace(open_situation(world, EXACT), silent=True))
    assert isinstance(decision, Fly)
    assert decision.certificate.mass_outside == pytest.approx(0.5)
