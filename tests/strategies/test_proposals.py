"""Cuts from outside count for what they tell, and for nothing else."""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

ROOT = Path(__file__).resolve().parents[2]
if str(ROOT) not in sys.path:
    sys.path.insert(0, str(ROOT))

from bench.twenty_questions import OneEach, opening  # noqa: E402

from drivers.play import open_situation, told  # noqa: E402
from mintpilot.core.gap import BLOCKED, Candidate, GapKind, KnowledgeGap  # noqa: E402
from mintpilot.core.mission import AskingSettings  # noqa: E402
from mintpilot.core.observation import Attribute  # noqa: E402
from mintpilot.core.ports import Ask, Situation  # noqa: E402
from mintpilot.core.query import Combine, Literal, Query, Reply, Saying, SayingKind  # noqa: E402
from mintpilot.core.tree import Mint, StopReason  # noqa: E402
from mintpilot.elicitation.choose import query_situation  # noqa: E402
from mintpilot.elicitation.objectives.information_gain import class_gain_bits  # noqa: E402
from mintpilot.reasoning.situation import regret_matrix  # noqa: E402
from mintpilot.strategies.flying import tree_of  # noqa: E402
from mintpilot.strategies.mint import MintStrategy  # noqa: E402
from mintpilot.strategies.proposals import gain_bound_bits  # noqa: E402
from strategies.test_strategies import EXACT, gate  # noqa: E402

NAMES = ("ann", "bea", "cid", "dan", "eve", "fay", "gus", "hal")


class Proposing:
    """Proposes the same cuts each time and counts how often it was asked."""

    name = "clever"

    def __init__(self, *queries: Query) -> None:
        self.queries, self.calls = queries, 0

    def propose(self, mint: Mint) -> tuple[Query, ...]:
        self.calls += 1
        return self.queries


def game(count: int = 8, prior: tuple[float, ...] | None = None, **options: float) -> Situation:
    """Who of them is meant? Nothing tells them apart but their names, so at most two go into one cut of our own."""
    names = NAMES[:count]
    gap = KnowledgeGap(
        id="target",
        kind=GapKind.TARGET,
        subject="person",
        description="the person",
        values=names,
        prior=prior or tuple(1 / count for _ in names),
        position_m=(0.0, 0.0, 0.0),
        candidates=tuple(Candidate(id=n, position_m=(float(i), 0.0, 0.0), description=n) for i, n in enumerate(names)),
    )
    asking = AskingSettings(alpha=0.0, goal_entropy_bits=0.0, **options)
    return replace(opening(gap, asking), space=OneEach(gap))


def one_of(*names: str, combine: Combine = Combine.ANY) -> Query:
    said = (Literal(gap="target", values=frozenset({n}), saying=Saying(kind=SayingKind.VALUE, value=n)) for n in names)
    return Query(literals=tuple(said), combine=combine)


def test_the_best_by_score_wins_whoever_proposed_it() -> None:
    trio, pair = one_of("ann", "bea", "cid"), one_of("ann", "hal")
    own = MintStrategy().decide(game())
    model = Proposing(pair, trio)
    decision = MintStrategy().decide(replace(game(), proposer=model))
    assert isinstance(own, Ask)
    assert isinstance(decision, Ask)
    assert own.scored.gain_bits == pytest.approx(0.8113, abs=1e-4)
    assert (decision.scored.query, decision.scored.proposed_by) == (trio, "clever")
    assert decision.scored.gain_bits == pytest.approx(0.9544, abs=1e-4)
    assert decision.alternatives[0].query.id == own.scored.query.id
    assert decision.alternatives[0].proposed_by == "enumeration"
    assert [s.query for s in decision.proposed] == [trio]  # the pair is one of our own cuts
    assert decision.bound_bits == 1.0


def test_a_worse_proposal_changes_nothing_but_is_told() -> None:
    skewed = game(prior=(0.25, *[0.75 / 7] * 7))
    poor = one_of("fay", "gus", "hal")
    own, decision = (MintStrategy().decide(s) for s in (skewed, replace(skewed, proposer=Proposing(poor))))
    assert isinstance(own, Ask)
    assert isinstance(decision, Ask)
    assert decision.scored == own.scored
    assert own.scored.query != poor
    assert decision.proposed[-1].gain_bits < own.scored.gain_bits


def test_nobody_is_asked_for_cuts_where_none_can_be_better() -> None:
    model = Proposing()
    for situation in (game(2), game(3), game(4), open_situation(gate(), EXACT)):
        assert isinstance(MintStrategy().decide(replace(situation, proposer=model)), Ask)
    assert model.calls == 0


def test_nor_when_the_budget_is_spent() -> None:
    model = Proposing(one_of("ann", "bea", "cid"))
    fly = MintStrategy().decide(replace(game(max_questions=0), proposer=model))
    assert (fly.certificate.reason, model.calls) == (StopReason.BUDGET, 0)


def _swapped(query: Query, **changes: object) -> Query:
    return Query(literals=tuple(replace(x, **changes) for x in query.literals), combine=query.combine)


TRIO = one_of("ann", "bea", "cid")


@pytest.mark.parametrize(
    "unsound",
    [
        _swapped(TRIO, gap="another"),
        _swapped(TRIO, values=frozenset({"dan", "eve", "fay"})),
        _swapped(TRIO, saying=Saying(kind=SayingKind.ATTRIBUTE, name="eyes", value="blue")),
        one_of("ann", "bea", "cid", combine=Combine.ALL),
        one_of(*NAMES),
        one_of("nobody", "ann"),
    ],
)
def test_unsound_proposals_are_dropped(unsound: Query) -> None:
    plain, decision = (MintStrategy().decide(s) for s in (game(), replace(game(), proposer=Proposing(unsound))))
    assert isinstance(decision, Ask)
    assert decision.proposed == ()
    assert decision.scored == plain.scored


@pytest.mark.parametrize("reply", [Reply.UNSURE, Reply.YES])
def test_what_was_asked_or_withdrawn_is_not_asked_again(reply: Reply) -> None:
    noisy = game(answer_error=0.1) if reply is Reply.YES else game()
    situation = replace(noisy, proposer=Proposing(TRIO))
    first = MintStrategy().decide(situation)
    assert isinstance(first, Ask)
    second = MintStrategy().decide(told(situation, first.scored.query, reply))
    assert first.scored.query == TRIO
    assert all(s.query != TRIO for s in second.proposed)


def test_a_negated_cut_about_a_region_is_never_asked() -> None:
    """Its words would say the opposite of what it means."""
    said = Saying(kind=SayingKind.VALUE, value=BLOCKED)
    turned = Query(literals=(Literal(gap="smoke", values=frozenset({BLOCKED}), saying=said),))
    world = gate(goals=5)
    situation = replace(open_situation(world, EXACT), proposer=Proposing(turned, TRIO))
    while isinstance(decision := MintStrategy().decide(situation), Ask):
        assert decision.proposed == ()
        situation = told(situation, decision.scored.query, Reply.NO)


@settings(deadline=None, max_examples=60)
@given(
    st.lists(st.floats(0.01, 1.0), min_size=2, max_size=6),
    st.sampled_from([0.0, 0.05, 0.3]),
    st.lists(st.sets(st.integers(0, 5), min_size=1), min_size=1, max_size=5),
)
def test_no_cut_passes_the_bound(weights: list[float], error: float, sides: list[set[int]]) -> None:
    total = sum(weights)
    situation = game(len(weights), tuple(w / total for w in weights), answer_error=error)
    mint = tree_of(situation)
    if not mint.belief.gaps:
        return
    regret = regret_matrix(mint, situation.settings)
    bound = gain_bound_bits(situation, mint, regret)
    values = mint.belief.gaps[0].values
    cuts: list[Query] = []
    for side in sides:
        held = frozenset(values[i] for i in side if i < len(values))
        said = Saying(kind=SayingKind.VALUE)
        cuts += [Query(literals=(Literal(gap="target", values=held, saying=said),))] if held else []
    gains = class_gain_bits(query_situation(cuts, mint, regret, situation.settings))
    assert 0 <= bound <= 1
    assert np.all(gains <= bound + 1e-9)


def test_a_cut_of_our_own_that_halves_needs_no_other() -> None:
    situation = game()
    hats = tuple(
        replace(c, attributes=(Attribute(name="hat", value="red" if i < 4 else "blue"),))
        for i, c in enumerate(situation.problem.gaps[0].candidates)
    )
    gap, model = replace(situation.problem.gaps[0], candidates=hats), Proposing(TRIO)
    decision = MintStrategy().decide(replace(opening(gap, situation.settings), space=OneEach(gap), proposer=model))
    assert isinstance(decision, Ask)
    assert (decision.scored.gain_bits, model.calls) == (1.0, 0)
