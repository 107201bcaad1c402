"""A target gap alone is the game of twenty questions; on the people of the Guess Who game."""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[2]
if str(ROOT) not in sys.path:
    sys.path.insert(0, str(ROOT))

from bench.question_games import answered  # noqa: E402
from bench.twenty_questions import OneEach, opening, people, person_gap, play, twenty_questions  # noqa: E402

from mintpilot.core.mission import AskingSettings  # noqa: E402
from mintpilot.core.ports import Ask  # noqa: E402
from mintpilot.core.tree import StopReason  # noqa: E402
from mintpilot.strategies.mint import MintStrategy  # noqa: E402

needs_data = pytest.mark.skipif(people() is None, reason="../shared/data/twentyq/guess_who.json is not there")


@pytest.mark.long
@needs_data
def test_everybody_is_found_with_as_few_questions_as_there_can_be() -> None:
    result = twenty_questions("information-gain", wrong=0.0)
    assert result.right == 1
    # Eight people with four questions and sixteen with five: no way of asking needs fewer.
    assert result.questions == pytest.approx((8 * 4 + 16 * 5) / 24)


@needs_data
@pytest.mark.slow
def test_one_wrong_answer_in_ten_is_borne() -> None:
    result = twenty_questions("information-gain", wrong=0.1, games=240)
    assert result.right >= 0.95


@pytest.mark.long
@needs_data
def test_wrong_answers_are_borne_in_a_few_games() -> None:
    assert twenty_questions("information-gain", wrong=0.1, games=6).right >= 0.8


@needs_data
def test_people_whom_nothing_tells_apart_end_the_asking() -> None:
    persons = people()[:3]
    twins = [*persons, {**persons[0], "name": "Twin"}]
    gap = person_gap(twins)
    nameless = replace(gap, candidates=tuple(replace(c, description="the person") for c in gap.candidates))
    situation = opening(nameless, AskingSettings(alpha=0.0, goal_entropy_bits=0.0))
    withdrawn = set()
    # The person who answers knows no names: cuts by name are answered 'unsure'.
    strategy = MintStrategy()
    for _ in range(30):
        decision = strategy.decide(situation)
        if not isinstance(decision, Ask):
            break
        query = decision.scored.query
        named = any(x.saying.kind == "value" for x in query.literals)
        if named:
            withdrawn.add(query.id)
            situation = replace(situation, withdrawn=frozenset(withdrawn))
        else:
            situation = answered(situation, query, query.holds({gap.id: "Twin"}))
    assert decision.certificate.reason is StopReason.NO_GAIN
    assert decision.certificate.top_class_probability == pytest.approx(0.5)


@needs_data
def test_one_game_names_the_person() -> None:
    situation = opening(person_gap(people()), AskingSettings(alpha=0.0, goal_entropy_bits=0.0))
    assert isinstance(situation.space, OneEach)
    count, named = play(situation, "Alfred", np.random.default_rng(0))
    assert named == "Alfred"
    assert count in (4, 5)
