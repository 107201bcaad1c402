"""What waiting for an answer may lose (method, section 10)."""

from __future__ import annotations

from dataclasses import replace

import pytest
from tests.strategies.test_strategies import EXACT, gate

from drivers.play import open_situation
from mintpilot.core.ports import Ask, Fly, Situation
from mintpilot.core.tree import StopReason
from mintpilot.reasoning.waiting import in_time, longest_wait_s, spare_s
from mintpilot.strategies.flying import cautious_plan
from mintpilot.strategies.mint import MintStrategy
from mintpilot.strategies.waiting import CountsWaiting


def with_battery(spare: float, **asking: float) -> Situation:
    """The gate, with a battery that lasts so much longer than the cautious plan."""
    settings = replace(EXACT, **asking)
    free = open_situation(gate(), settings)
    need_s = cautious_plan(free).cost_s
    limits = replace(free.problem.limits, endurance_s=need_s + spare)
    return replace(free, problem=replace(free.problem, limits=limits))


@pytest.mark.parametrize(("spare", "asks"), [(0.1, False), (30.0, True)])
def test_it_asks_only_where_there_is_time_for_an_answer(spare: float, asks: bool) -> None:
    decision = CountsWaiting(MintStrategy()).decide(with_battery(spare))
    assert isinstance(decision, Ask) == asks
    if isinstance(decision, Fly):
        assert decision.certificate.reason is StopReason.WAITING
        assert decision.plan is not None
        assert not decision.plan.enters


def test_who_answers_at_once_is_always_asked() -> None:
    assert isinstance(CountsWaiting(MintStrategy()).decide(with_battery(0.1, reply_s=0.0)), Ask)


def test_the_wait_ends_when_the_cautious_plan_must_begin() -> None:
    situation = with_battery(10.0)
    plan, limits = cautious_plan(situation), situation.problem.limits
    assert spare_s(plan, limits) == pytest.approx(10.0)
    assert spare_s(plan, replace(limits, reserve_s=4.0)) == pytest.approx(6.0)
    assert spare_s(replace(plan, home_s=3.0), limits) == pytest.approx(7.0)
    assert 0 < longest_wait_s(plan, limits) < 10.0
    assert longest_wait_s(plan, replace(limits, reserve_s=20.0)) == 0
    assert longest_wait_s(None, limits) == float("inf")


def test_the_chance_of_an_answer_grows_with_the_wait() -> None:
    chances = [in_time(t, EXACT) for t in (0, 1, 5, 10, 29, 30, 100)]
    assert chances == sorted(chances)
    assert chances[0] == 0
    assert chances[-2:] == [1, 1]
    assert in_time(0, replace(EXACT, reply_s=0)) == 1
