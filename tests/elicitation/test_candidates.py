from __future__ import annotations

import numpy as np
import pytest

from mintpilot.core.gap import GapKind
from mintpilot.core.mission import AskingSettings
from mintpilot.core.query import Combine, SayingKind
from mintpilot.elicitation.candidates import candidate_queries, gap_literals
from mintpilot.elicitation.phrasing_cost import phrasing_cost
from mintpilot.reasoning.belief import prior_belief
from mintpilot.reasoning.metrics import FrechetMetric
from mintpilot.reasoning.tree import build_tree
from oracles.worlds import BruteForce, random_world

from .gaps import ALL, START, boxes

EXACT = AskingSettings(delta_c_s=0.0, goal_entropy_bits=0.0)


def values_of(name: str, value: str = "") -> list[frozenset[str]]:
    return [
        x.values
        for x in gap_literals(boxes(), START)
        if x.saying.name == name and (not value or x.saying.value == value)
    ]


def test_attributes_pick_the_candidates_that_have_them() -> None:
    assert values_of("colour", "red") == [frozenset({"box-1", "box-3"})]
    assert values_of("size", "small") == [frozenset({"box-3", "box-4"})]


def test_relations_are_geometry() -> None:
    # From the origin, looking along x: box-1 is far left, then box-3, box-4 and box-2 on the right.
    assert values_of("left of", "box-2") == [frozenset({"box-1", "box-3", "box-4"})]
    assert values_of("right of", "box-1") == [frozenset({"box-2", "box-3", "box-4"})]
    assert values_of("larger than", "box-3") == [frozenset({"box-1", "box-2"})]
    assert values_of("farthest") == [frozenset({"box-4"})]
    # Two boxes are equally near: nobody could say which is the nearest.
    assert values_of("nearest") == []


def test_without_a_place_of_the_drone_there_are_no_sides() -> None:
    kinds = {x.saying.name for x in gap_literals(boxes()) if x.saying.kind is SayingKind.RELATION}
    assert kinds == {"larger than"}


def test_literals_are_never_negated() -> None:
    for gap in ALL:
        for literal in gap_literals(gap, START):
            assert literal.values
            assert literal.values < set(gap.values)
            if gap.kind is GapKind.OBSTACLE:
                assert literal.values == {"passable"}
            if gap.kind is GapKind.PRESENCE:
                assert literal.values == {"present"}


@pytest.mark.parametrize("seed", range(8))
def test_cuts_divide_and_no_two_divide_alike(seed: int) -> None:
    world = random_world(np.random.default_rng(seed), regions=4, goals=3, rooms=1)
    mint = build_tree(BruteForce(world), prior_belief(world.gaps), EXACT, FrechetMetric())
    queries = candidate_queries(mint, start_m=START)
    support = mint.support
    seen = set()
    for query in queries:
        row = query.part_table(mint.belief).ravel()[support]
        assert row.any()
        assert not row.all()
        seen.add((row ^ row[0]).tobytes())
    assert len(seen) == len(queries)
    assert list(queries) == sorted(queries, key=phrasing_cost)


def test_a_refused_cut_is_not_asked_in_other_words() -> None:
    world = random_world(np.random.default_rng(1), regions=3, goals=2)
    mint = build_tree(BruteForce(world), prior_belief(world.gaps), EXACT, FrechetMetric())
    queries = candidate_queries(mint)
    target = next(q for q in queries if q.gap_ids == ("target",))
    left = candidate_queries(mint, refused={target.id})
    row = target.part_table(mint.belief)
    assert len(left) == len(queries) - 1
    for query in left:
        other = query.part_table(mint.belief)
        assert not np.array_equal(other, row)
        assert not np.array_equal(other, 1 - row)


def test_compound_cuts_are_offered() -> None:
    for seed in range(20):
        world = random_world(np.random.default_rng(seed), regions=4)
        mint = build_tree(BruteForce(world), prior_belief(world.gaps), EXACT, FrechetMetric())
        if len(mint.belief.gaps) >= 3:
            queries = candidate_queries(mint)
            assert {len(q.literals) for q in queries} == {1, 2, 3}
            assert {q.combine for q in queries if len(q.literals) > 1} == {Combine.ANY, Combine.ALL}
            return
    raise AssertionError("no world with three gaps that interact")
