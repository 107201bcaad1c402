"""A price counts in every strategy's stop rule (method, section 11)."""

from __future__ import annotations

from dataclasses import replace

import pytest
from tests.strategies.test_strategies import EXACT, gate

from drivers.play import open_situation
from mintpilot.core.ports import Ask, Fly, Strategy
from mintpilot.core.tree import StopReason
from mintpilot.strategies.exhaustive import ExhaustiveStrategy
from mintpilot.strategies.gap_by_gap import GapByGapStrategy
from mintpilot.strategies.mint import MintStrategy
from mintpilot.strategies.priced import CountsPrice, worth_s
from mintpilot.strategies.random_query import RandomQueryStrategy

ASKING: list[type[Strategy]] = [MintStrategy, ExhaustiveStrategy, GapByGapStrategy, RandomQueryStrategy]


def saved_s() -> float:
    """What knowing the gate saves on average: half the difference of the two ways."""
    situation = open_situation(gate(), EXACT)
    through, around = sorted(one.plan.cost_s for one in MintStrategy().decide(situation).mint.classes)
    return (around - through) / 2


@pytest.mark.parametrize("strategy", ASKING)
def test_it_asks_up_to_what_an_answer_saves_and_no_further(strategy: type[Strategy]) -> None:
    for price_s, asks in ((0.0, True), (0.9 * saved_s(), True), (1.1 * saved_s(), False)):
        situation = open_situation(gate(), replace(EXACT, question_price_s=price_s))
        decision = CountsPrice(strategy()).decide(situation)
        assert isinstance(decision, Ask) == asks
        if isinstance(decision, Fly):
            assert decision.certificate.reason is StopReason.PRICE
            assert decision.plan is not None
            assert not decision.plan.enters


def test_two_questions_that_save_only_together_are_looked_ahead() -> None:
    world = gate()
    world.free[4, 5] = True
    world.regions["second"] = frozenset({(4, 4), (3, 4), (5, 4), (2, 4), (6, 4), (1, 4), (0, 4), (7, 4)})
    situation = open_situation(world, replace(EXACT, question_price_s=0.1))
    mint = MintStrategy().decide(situation).mint
    assert mint is not None
    acting_s, asking_s = worth_s(situation, mint)
    assert asking_s < acting_s
    dear = replace(situation, settings=replace(situation.settings, question_price_s=100.0))
    assert worth_s(dear, mint)[1] >= worth_s(dear, mint)[0]
    none_left = replace(situation, settings=replace(situation.settings, max_questions=0))
    assert worth_s(none_left, mint)[1] == float("inf")
