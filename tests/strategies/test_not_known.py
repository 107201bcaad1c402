"""Somebody who does not know is not pestered: one question for a region or room, two attributes for a target."""

from __future__ import annotations

from collections import Counter

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from drivers.play import open_situation, told
from mintpilot.core.gap import Candidate, GapKind, KnowledgeGap
from mintpilot.core.mission import AskingSettings
from mintpilot.core.observation import Attribute
from mintpilot.core.ports import Ask
from mintpilot.core.query import Answer, Combine, Literal, Query, Reply, Saying, SayingKind, is_refused, topics
from mintpilot.elicitation.candidates import candidate_queries
from mintpilot.mission.belief_state import BeliefState, update
from mintpilot.reasoning.belief import prior_belief
from mintpilot.strategies.flying import tree_of
from mintpilot.strategies.mint import MintStrategy
from oracles.worlds import random_world

EAGER = AskingSettings(delta_c_s=0.0, alpha=0.0, floor=0.0, goal_entropy_bits=0.0, max_questions=60)


@settings(max_examples=25, deadline=None)
@given(
    seed=st.integers(0, 10_000),
    regions=st.integers(1, 5),
    known=st.lists(st.sampled_from([Reply.UNSURE, Reply.UNSURE, Reply.YES, Reply.NO]), max_size=3),
)
def test_of_each_region_that_is_not_known_one_question_is_asked(seed: int, regions: int, known: list[Reply]) -> None:
    world = random_world(np.random.default_rng(seed), regions=regions)
    situation = open_situation(world, EAGER)
    answers = iter(known)
    unsure: Counter[str] = Counter()
    for _ in range(60):
        decision = MintStrategy().decide(situation)
        if not isinstance(decision, Ask):
            break
        query = decision.scored.query
        assert not any(unsure[gap] for gap in query.gap_ids), "asked about what was not known"
        reply = next(answers, Reply.UNSURE)
        if reply is Reply.UNSURE:
            unsure.update(query.gap_ids)
        situation = told(situation, query, reply)
    assert not isinstance(decision, Ask)
    assert max(unsure.values(), default=0) <= 1


def boxes() -> KnowledgeGap:
    things = tuple(
        Candidate(
            id=f"box-{n}",
            position_m=(float(n), 0.0, 0.0),
            attributes=(
                Attribute(name="colour", value=colour),
                Attribute(name="size", value=size),
                Attribute(name="shape", value=shape),
            ),
        )
        for n, (colour, size, shape) in enumerate(
            [
                ("red", "small", "round"),
                ("blue", "large", "flat"),
                ("green", "small", "flat"),
                ("red", "large", "round"),
            ]
        )
    )
    return KnowledgeGap(
        id="target:1:box",
        kind=GapKind.TARGET,
        subject="the box",
        description="the box",
        values=tuple(c.id for c in things),
        prior=(0.25,) * 4,
        position_m=(0.0, 0.0, 0.0),
        candidates=things,
    )


def attribute(name: str, value: str) -> Query:
    gap = boxes()
    values = frozenset(c.id for c in gap.candidates for a in c.attributes if (a.name, a.value) == (name, value))
    saying = Saying(kind=SayingKind.ATTRIBUTE, name=name, value=value)
    return Query(literals=(Literal(gap=gap.id, values=values, saying=saying),))


def test_of_a_target_the_attribute_is_withdrawn_and_after_two_the_gap() -> None:
    state = BeliefState(
        map=random_world(np.random.default_rng(0), regions=1).problem().map, belief=prior_belief((boxes(),))
    )
    state = update(state, attribute("colour", "red"), unsure(), EAGER).state
    assert is_refused(attribute("colour", "blue"), state.withdrawn)
    assert not is_refused(attribute("size", "small"), state.withdrawn)
    state = update(state, attribute("size", "small"), unsure(), EAGER).state
    assert is_refused(attribute("shape", "round"), state.withdrawn)
    assert state.belief.gaps == (boxes(),), "the belief is left as it was"


def unsure() -> Answer:
    return Answer(reply=Reply.UNSURE, latency_s=1.0)


@pytest.mark.parametrize("combine", list(Combine))
def test_a_combination_withdraws_all_that_it_turns_on(combine: Combine) -> None:
    one, other = (
        Literal(
            gap=f"obstacle:{name}",
            values=frozenset({"passable"}),
            saying=Saying(kind=SayingKind.VALUE, value="passable"),
        )
        for name in ("a", "b")
    )
    both = Query(literals=(one, other), combine=combine)
    assert topics(both) == {"obstacle:a", "obstacle:b"}
    assert is_refused(Query(literals=(one,)), topics(both))
    assert is_refused(both, frozenset({"obstacle:b"}))
    assert not is_refused(Query(literals=(one,)), frozenset({"obstacle:b"}))


def test_queries_that_turn_on_what_is_not_known_are_no_candidates() -> None:
    world = random_world(np.random.default_rng(3), regions=4)
    mint = tree_of(open_situation(world, EAGER))
    free = candidate_queries(mint)
    names = {gap for query in free for gap in query.gap_ids}
    refused = sorted(names)[0]
    left = candidate_queries(mint, refused={refused})
    assert all(refused not in query.gap_ids for query in left)
    assert {query for query in free if refused not in query.gap_ids} <= set(left)
