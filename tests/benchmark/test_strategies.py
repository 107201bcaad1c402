"""The askers that MINT is compared with."""

from __future__ import annotations

import pytest
from tests.benchmark.small import experiment

from mintpilot.assembly.registry import load, names
from mintpilot.benchmark.conditions import true_world
from mintpilot.benchmark.experiment import Cell, Condition
from mintpilot.benchmark.experiments import gap_parameters
from mintpilot.benchmark.methods import Method, method_of
from mintpilot.benchmark.records import TrialRecord
from mintpilot.benchmark.trial import RAISED, fly_trial
from mintpilot.core.errors import InputError
from mintpilot.strategies.entropy_threshold import EntropyThresholdStrategy
from mintpilot.strategies.knowno import KnowNoStrategy

FOUR = Cell(scenario="fire-warehouse", parameters=gap_parameters(4), methods=())


def flown(method: Method, seed: int = 1, condition: Condition | None = None) -> TrialRecord:
    cell = FOUR.model_copy(update={"condition": condition or Condition()})
    trial = fly_trial(experiment("mint"), cell, method, true_world(FOUR, seed))
    assert trial.outcome != RAISED, trial.error
    return trial


def test_both_are_in_the_registry() -> None:
    assert {"knowno", "entropy-threshold"} <= set(names("strategy"))
    assert load("strategy", "knowno") is KnowNoStrategy


def test_entropy_threshold_asks_all_that_is_even_and_nothing_above_a_bit() -> None:
    even = method_of("entropy-threshold")
    assert flown(even).questions == 4
    assert flown(even.model_copy(update={"arguments": {"threshold_bits": 1.0}})).questions == 0
    with pytest.raises(InputError, match="must not be below 0"):
        EntropyThresholdStrategy(-1.0)


@pytest.mark.long
def test_conformal_set_grows_with_the_quantile_and_so_do_the_questions() -> None:
    asked = [
        flown(method_of("knowno").model_copy(update={"arguments": {"quantile": q}})).questions for q in (0.0, 0.9, 1.0)
    ]
    assert asked[0] == 0
    assert asked == sorted(asked)
    assert asked[-1] >= flown(method_of("mint")).questions
    with pytest.raises(InputError, match="from 0 to 1"):
        KnowNoStrategy(1.5)


@pytest.mark.long
@pytest.mark.parametrize("name", ["knowno", "entropy-threshold"])
@pytest.mark.parametrize("condition", [Condition(answer_error=0.2), Condition(unsure_rate=1.0)])
def test_neither_enters_what_is_not_known_passable(name: str, condition: Condition) -> None:
    trial = flown(method_of(name), condition=condition)
    assert trial.outcome != "toxic-smoke" or condition.answer_error
    assert trial.questions <= 20


def test_an_operator_who_never_knows_is_not_asked_twice_the_same() -> None:
    trial = flown(method_of("entropy-threshold"), condition=Condition(unsure_rate=1.0))
    assert trial.unsure == trial.questions == 4
    assert len({a.query for a in trial.asked}) == trial.questions
