"""A choice is asked, answered and acted on like any query."""

from __future__ import annotations

import numpy as np
import pytest

from drivers.play import open_situation, play
from mintpilot.core.gap import KnowledgeGap
from mintpilot.core.ports import Ask, Decision, Situation, Strategy
from mintpilot.core.query import Literal, Option, Query, Reply, Saying, SayingKind, choice
from mintpilot.elicitation.choose import choose
from mintpilot.elicitation.wording import word_question
from mintpilot.interaction.scripted import ScriptedOperator
from mintpilot.reasoning.situation import regret_matrix
from mintpilot.strategies.exhaustive import scored_alone
from mintpilot.strategies.flying import tree_of
from mintpilot.strategies.mint import MintStrategy
from mintpilot.strategies.proposals import gain_bound_bits, sound_proposals
from oracles.worlds import World, hypotheses
from strategies.test_strategies import EXACT, gate


def which(gap: KnowledgeGap, *values: str) -> Query:
    options = [
        Option(label=f"the box {v}", literals=(Literal(gap=gap.id, values=frozenset({v}), saying=_called(v)),))
        for v in values
    ]
    return choice(options, (gap,))


def _called(value: str) -> Saying:
    return Saying(kind=SayingKind.VALUE, value=value)


def hall(goals: int) -> World:
    """Several boxes, and nothing in the way."""
    world = gate(goals=goals)
    return World(free=world.free, regions={}, start=world.start, goals=world.goals)


class ChoosesFirst(Strategy):
    """Asks one choice, then does as MINT does."""

    def __init__(self, *values: str) -> None:
        self.values = values

    def decide(self, situation: Situation) -> Decision:
        if situation.asked:
            return MintStrategy().decide(situation)
        mint = tree_of(situation)
        query = which(mint.belief.gaps[0], *self.values)
        regret = regret_matrix(mint, situation.settings)
        (scored,) = choose((query,), mint, regret, situation.objective, situation.settings)
        return Ask(scored=scored, mint=mint)


@pytest.mark.parametrize(("boxes", "offered"), [(3, 3), (4, 4), (4, 3), (4, 2)])
def test_one_choice_settles_what_halving_takes_more_questions_for(boxes: int, offered: int) -> None:
    world = hall(boxes)
    values = [f"g{i}" for i in range(offered)]
    for truth, _ in hypotheses(world):
        game = play(ChoosesFirst(*values), open_situation(world, EXACT), truth)
        assert dict(game.fly.plan.binds) == truth
        left = boxes - offered
        assert game.questions == (1 if truth["target"] in values or left == 1 else 2)


def test_the_bound_on_gain_holds_for_every_choice_and_is_reached_by_an_even_one() -> None:
    situation = open_situation(hall(4), EXACT)
    mint = tree_of(situation)
    regret = regret_matrix(mint, EXACT)
    for parts, values in ((3, ("g0", "g1")), (4, ("g0", "g1", "g2"))):
        (scored,) = choose(
            (which(mint.belief.gaps[0], *values),), mint, regret, situation.objective, situation.settings
        )
        bound = gain_bound_bits(situation, mint, regret, parts=parts)
        assert scored.gain_bits <= bound + 1e-9
        assert len(scored.reply_probabilities) == parts
    assert scored.gain_bits == pytest.approx(bound) == pytest.approx(2.0)


def test_a_proposed_choice_is_sound_once_and_only_in_the_predicate_language() -> None:
    situation = open_situation(hall(4), EXACT)
    mint = tree_of(situation)
    gap = mint.belief.gaps[0]
    good, again = which(gap, "g0", "g1", "g2"), which(gap, "g1", "g0", "g3")
    foreign = Query(options=good.options[:2], none_of_these=True)
    odd = Option(label="the odd one", literals=(Literal(gap=gap.id, values=frozenset({"g3"}), saying=_called("g0")),))
    assert sound_proposals(situation, mint, (good, again, foreign)) == (good, foreign)
    assert sound_proposals(situation, mint, (choice([good.options[0], odd], (gap,)),)) == ()


def test_a_choice_about_one_gap_tells_its_entropy() -> None:
    situation = open_situation(hall(4), EXACT)
    gap = situation.belief.gaps[0]
    scored = scored_alone(which(gap, "g0", "g1", "g2"), gap, situation)
    assert scored.gain_bits == pytest.approx(2.0)
    assert scored.reply_probabilities == pytest.approx((0.25,) * 4)


class Truth:
    def value_of(self, gap: KnowledgeGap) -> str:
        return "g1"


def test_a_scripted_person_picks_the_true_option_and_errs_evenly_over_the_others() -> None:
    gap = open_situation(hall(4), EXACT).belief.gaps[0]
    question = word_question(which(gap, "g0", "g1", "g2"), (gap,), None)
    right = ScriptedOperator(Truth(), rng=np.random.default_rng(0)).answer(question, 20.0)
    assert (right.reply, right.option, right.text) == (Reply.OPTION, 1, "the box g1")
    wrong = ScriptedOperator(Truth(), rng=np.random.default_rng(0), answer_error=1.0)
    counts = np.bincount([wrong.answer(question, 20.0).option or 0 for _ in range(600)], minlength=4)
    assert counts[1] == 0
    assert counts[[0, 2, 3]].min() > 150
