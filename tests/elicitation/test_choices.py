"""Which choices can be put, and that they are only put where that is wanted (method, section 13)."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from drivers.play import open_situation, play
from mintpilot.core.gap import NONE_OF_THEM, Candidate, GapKind, KnowledgeGap
from mintpilot.core.mission import AskingSettings, QueryKinds
from mintpilot.core.observation import Attribute
from mintpilot.core.query import CHOICE_EFFORT, MAX_PARTS
from mintpilot.elicitation.candidates import candidate_queries
from mintpilot.elicitation.choices import choices_about
from mintpilot.elicitation.objectives import Optimal
from mintpilot.elicitation.sentences import MAX_CHOICE_WORDS, is_sayable, sentence
from mintpilot.strategies.flying import tree_of
from mintpilot.strategies.mint import MintStrategy
from oracles.worlds import hypotheses, random_world

EXACT = AskingSettings(delta_c_s=0.0, alpha=0.0, floor=0.0, goal_entropy_bits=0.0, max_questions=60)
COLOURS = ("red", "blue", "green", "white", "black")


def which(count: int, *, colours: int = 3, doubt: bool = False) -> KnowledgeGap:
    things = tuple(
        Candidate(
            id=f"b{i}",
            position_m=(float(i), 0.0, 0.0),
            attributes=(Attribute(name="colour", value=COLOURS[i % colours]),),
            description=f"the {COLOURS[i % colours]} box number {i}",
        )
        for i in range(count)
    )
    values = (*(c.id for c in things), *((NONE_OF_THEM,) if doubt else ()))
    return KnowledgeGap(
        id="target:1:box", kind=GapKind.TARGET, subject="the box", description="the box", values=values,
        prior=(1 / len(values),) * len(values), position_m=(0.0, 0.0, 0.0), candidates=things,
    )  # fmt: skip


def value(count: int) -> KnowledgeGap:
    return KnowledgeGap(
        id="value:gap", kind=GapKind.VALUE, subject="gap", description="the width of the gap",
        values=tuple(f"{0.3 * i:.1f} m" for i in range(count)), prior=(1 / count,) * count,
        position_m=(0.0, 0.0, 0.0),
    )  # fmt: skip


@settings(max_examples=60, deadline=None)
@given(st.integers(2, 10), st.integers(1, 5), st.booleans(), st.integers(2, 5))
def test_every_choice_divides_all_values_into_three_or_four_named_parts(
    count: int, colours: int, doubt: bool, intervals: int
) -> None:
    gaps = (which(count, colours=colours, doubt=doubt), value(intervals))
    known = {gap.id: gap for gap in gaps}
    for query in choices_about(gaps):
        (gap,) = (known[name] for name in query.gap_ids)
        parts = [query.part_of({gap.id: v}) for v in gap.values]
        assert set(parts) == set(range(query.part_count))
        assert 3 <= query.part_count <= MAX_PARTS
        words = [query.part_words(part) for part in range(query.part_count)]
        assert len(set(words)) == len(words)
        assert query.effort == CHOICE_EFFORT
        if is_sayable(query, known):
            assert len(sentence(query, known).split()) <= MAX_CHOICE_WORDS
        if gap.kind is GapKind.VALUE:
            assert parts == sorted(parts)


@pytest.mark.parametrize(("count", "doubt", "offered"), [(2, False, 0), (2, True, 1), (3, False, 1), (4, False, 1),
                                                         (5, False, 10), (9, False, 0)])  # fmt: skip
def test_things_are_offered_by_name_while_they_are_few(count: int, doubt: bool, offered: int) -> None:
    named = list(choices_about((which(count, colours=1, doubt=doubt),)))
    assert len(named) == offered


def test_a_phrase_that_may_mean_none_of_the_things_is_not_asked_for_by_attribute() -> None:
    labels = {option.label for q in choices_about((which(3, doubt=True),)) for option in q.options}
    assert not labels & set(COLOURS)


def test_of_two_regions_both_one_or_neither() -> None:
    world = random_world(np.random.default_rng(1), regions=2)
    pair = tuple(gap for gap in world.gaps if gap.kind is GapKind.OBSTACLE)
    (query,) = choices_about(pair)
    found = {
        query.part_of(dict(zip((g.id for g in pair), values, strict=True)))
        for values in itertools.product(("passable", "blocked"), repeat=2)
    }
    assert found == {0, 1, 2, 3}
    assert {x.gap for x in query.asserted(0)} == {g.id for g in pair}


def test_choices_are_asked_only_where_that_is_wanted_and_only_where_they_tell_more() -> None:
    world = random_world(np.random.default_rng(3), regions=2, goals=4)
    mint = tree_of(open_situation(world, EXACT))
    plain = candidate_queries(mint)
    every = candidate_queries(mint, kinds=QueryKinds.ANY)
    assert not any(query.is_choice for query in plain)
    assert every[: len(plain)] == plain
    assert len(every) > len(plain)


@pytest.mark.long
@pytest.mark.parametrize("seed", range(1, 7))
def test_optimal_over_mixed_questions_never_takes_longer_than_yes_and_no_alone(seed: int) -> None:
    """The law of section 13, whole games against a brute-force plan space, every answer followed."""
    world = random_world(np.random.default_rng(seed), regions=2, goals=3 + seed % 2)
    taken = {}
    for kinds in QueryKinds:
        settings_ = AskingSettings(**{name: getattr(EXACT, name) for name in EXACT.__slots__} | {"kinds": kinds})
        taken[kinds] = sum(
            p
            * sum(query.effort for query in play(MintStrategy(Optimal()), open_situation(world, settings_), t).queries)
            for t, p in hypotheses(world)
        )
    assert taken[QueryKinds.ANY] <= taken[QueryKinds.YES_NO] + 1e-9
