"""Somebody who does not know is not pestered; a missing yes is asked for; the tolerance is spent once."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from drivers.play import open_situation, told
from mintpilot.core.gap import CorrelationGroup, GapKind
from mintpilot.core.mission import AskingSettings
from mintpilot.core.ports import Ask, Fly, Situation, Strategy
from mintpilot.core.predicate import Combine, Literal, Saying, SayingKind
from mintpilot.core.query import Query, Reply
from mintpilot.core.topics import turns_on, with_unknown
from mintpilot.core.tree import StopReason
from mintpilot.mission.belief_state import confirmed_by
from mintpilot.reasoning.belief import prior_belief
from mintpilot.strategies.exhaustive import ExhaustiveStrategy
from mintpilot.strategies.mint import MintStrategy
from mintpilot.strategies.random_query import RandomQueryStrategy
from oracles.worlds import BruteForce, World, hypotheses, random_world

EXACT = AskingSettings(delta_c_s=0.5, goal_entropy_bits=0.0, alpha=0.0, floor=0.0, max_questions=100)
worlds = st.builds(
    lambda seed, regions, goals, rooms: random_world(
        np.random.default_rng(seed), regions=regions, goals=goals, rooms=rooms, uneven=True
    ),
    st.integers(0, 2**32 - 1),
    st.integers(0, 4),
    st.integers(1, 4),
    st.integers(0, 2),
)


def questions_to_somebody_who_never_knows(strategy: Strategy, situation: Situation) -> Counter[str]:
    """How many questions speak of each gap."""
    found: Counter[str] = Counter()
    for _ in range(100):
        decision = strategy.decide(situation)
        if not isinstance(decision, Ask):
            return found
        query = decision.scored.query
        found.update(query.gap_ids)
        situation = told(situation, query, Reply.UNSURE)
    raise AssertionError("still asking")


@settings(max_examples=25, deadline=None)
@given(worlds, st.sampled_from([0.0, 0.1]), st.sampled_from([MintStrategy, RandomQueryStrategy, ExhaustiveStrategy]))
def test_who_never_knows_is_asked_once_of_a_region_or_room_and_twice_of_a_target(
    world: World, error: float, strategy: type[Strategy]
) -> None:
    situation = open_situation(world, replace(EXACT, answer_error=error))
    targets = {gap.id for gap in world.gaps if gap.kind is GapKind.TARGET}
    for gap, count in questions_to_somebody_who_never_knows(strategy(), situation).items():
        assert count <= (2 if gap in targets else 1), gap


def region(*names: str, combine: Combine = Combine.ALL) -> Query:
    saying = Saying(kind=SayingKind.VALUE, value="passable")
    literals = tuple(Literal(gap=n, values=frozenset({"passable"}), saying=saying) for n in names)
    return Query(literals=literals, combine=combine)


def attribute(name: str, value: str) -> Query:
    saying = Saying(kind=SayingKind.ATTRIBUTE, name=name, value=value)
    return Query(literals=(Literal(gap="target", values=frozenset({value}), saying=saying),))


def test_a_region_that_is_not_known_is_not_asked_about_in_another_combination() -> None:
    unknown = with_unknown(frozenset(), region("a", "b", combine=Combine.ANY))
    assert turns_on(region("b", "c"), unknown)
    assert turns_on(region("a"), unknown)
    assert not turns_on(region("c"), unknown)


def test_of_a_target_the_attribute_is_withdrawn_and_after_two_the_target() -> None:
    unknown = with_unknown(frozenset(), attribute("colour", "red"))
    assert turns_on(attribute("colour", "blue"), unknown)
    assert not turns_on(attribute("size", "small"), unknown)
    unknown = with_unknown(unknown, attribute("size", "small"))
    assert turns_on(attribute("shape", "round"), unknown)


def test_an_any_of_yes_confirms_none_of_its_regions_and_an_all_of_yes_all() -> None:
    gaps = corridor(("a", "b")).gaps
    assert confirmed_by(region("a", "b", combine=Combine.ANY), 0, gaps) == frozenset()
    assert confirmed_by(region("a", "b"), 0, gaps) == {"a", "b"}
    assert confirmed_by(region("a", "b"), 1, gaps) == frozenset()


def corridor(names: tuple[str, ...], *, prior: float = 1.0) -> World:
    """One way to the goal, through all these clouds."""
    free = np.zeros((1, 2 * len(names) + 2), bool)
    free[0] = True
    regions = {name: frozenset({(0, 2 * i + 1)}) for i, name in enumerate(names)}
    priors = dict.fromkeys(names, (prior, 1 - prior))
    return World(free=free, regions=regions, start=(0, 0), goals={"g": (0, free.shape[1] - 1)}, priors=priors)


def test_regions_that_are_certain_are_confirmed_by_one_question() -> None:
    situation = open_situation(corridor(("a", "b", "c")), EXACT)
    ask = MintStrategy().decide(situation)
    assert isinstance(ask, Ask)
    assert ask.scored.query.gap_ids == ("a", "b", "c")
    assert ask.scored.reply_probabilities == (1.0, 0.0)
    fly = MintStrategy().decide(told(situation, ask.scored.query, Reply.YES))
    assert isinstance(fly, Fly)
    assert fly.plan is not None
    assert fly.plan.enters == {"a", "b", "c"}


def test_a_gate_that_is_certain_without_a_yes_is_asked_about_not_given_up() -> None:
    """Two ways behind a certain cloud; one of them is open, and which one makes no difference worth a question."""
    free = np.zeros((3, 6), bool)
    free[1, :3] = free[:, 2] = free[:, 4] = free[1, 4:] = True
    free[0, 2:5] = free[2, 2:5] = True
    world = World(
        free=free,
        regions={"gate": frozenset({(1, 1)}), "north": frozenset({(0, 3)}), "south": frozenset({(2, 3)})},
        start=(1, 0),
        goals={"g": (1, 5)},
        priors={"gate": (1.0, 0.0)},
    )
    joint = ((("passable", "blocked"), 0.5), (("blocked", "passable"), 0.5))
    situation = open_situation(world, EXACT, groups=(CorrelationGroup(gaps=("north", "south"), joint=joint),))
    for truth in ("north", "south"):
        here, asked = situation, set()
        for _ in range(5):
            decision = MintStrategy().decide(here)
            if not isinstance(decision, Ask):
                break
            query = decision.scored.query
            asked |= set(query.gap_ids)
            values = {name: "passable" if name in ("gate", truth) else "blocked" for name in world.regions}
            here = told(here, query, Reply.YES if query.holds(values) else Reply.NO)
        assert isinstance(decision, Fly)
        assert "gate" in asked
        assert decision.plan is not None
        assert decision.plan.enters == {"gate", truth}


@settings(max_examples=40, deadline=None)
@given(worlds, st.floats(0, 4), st.integers(0, 10**6))
def test_a_plan_that_is_good_for_all_loses_no_more_than_delta_c(world: World, delta_c_s: float, seed: int) -> None:
    asking = replace(EXACT, delta_c_s=delta_c_s)
    space = BruteForce(world)
    situation = open_situation(world, asking, space=space)
    rng = np.random.default_rng(seed)
    all_truths = [h for h, p in hypotheses(world) if p > 0]
    truth = all_truths[int(rng.integers(len(all_truths)))]
    for _ in range(100):
        decision = MintStrategy().decide(situation)
        if not isinstance(decision, Ask):
            break
        query = decision.scored.query
        reply = Reply.UNSURE if rng.random() < 0.3 else Reply.YES if query.holds(truth) else Reply.NO
        situation = told(situation, query, reply)
    assert isinstance(decision, Fly)
    certificate = decision.certificate
    assert 0.0 <= certificate.outside <= 1.0
    if certificate.reason is StopReason.GOOD_FOR_ALL:
        assert certificate.bound_s <= delta_c_s + 1e-9
        assert certificate.outside <= 1e-9
        # Against every joint hypothesis that the answers leave, planned for by itself.
        for left, p in hypotheses(world):
            if p > 0 and all(one.query.part_of(left) == one.part for one in situation.asked):
                assert decision.plan is not None
                assert decision.plan.cost_s <= space.cost_under(left) + delta_c_s + 1e-9
