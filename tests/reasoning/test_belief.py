from __future__ import annotations

import itertools
import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mintpilot.core.errors import LimitError, MissionError
from mintpilot.core.gap import CorrelationGroup, GapKind, KnowledgeGap
from mintpilot.core.query import NO_PART, YES_PART, Combine, Literal, Query, Saying, SayingKind
from mintpilot.reasoning.belief import condition, extend, prior_belief

SAYING = Saying(kind=SayingKind.VALUE)


def gap(name: str, prior: tuple[float, ...] = (0.5, 0.5)) -> KnowledgeGap:
    values = ("passable", "blocked") if len(prior) == 2 else tuple(f"v{i}" for i in range(len(prior)))
    return KnowledgeGap(
        id=name,
        kind=GapKind.OBSTACLE,
        subject=name,
        description=name,
        values=values,
        prior=prior,
        position_m=(0.0, 0.0, 0.0),
    )


def cut(*names: str, combine: Combine = Combine.ALL) -> Query:
    literals = tuple(Literal(gap=n, values=frozenset({"passable"}), saying=SAYING) for n in names)
    return Query(literals=literals, combine=combine)


def brute(priors: list[float], answers: list[tuple[Query, bool]], error: float) -> dict[str, float]:
    """P(passable) of each gap by listing all joint hypotheses."""
    names = [f"g{i}" for i in range(len(priors))]
    total, mass = 0.0, dict.fromkeys(names, 0.0)
    for values in itertools.product(("passable", "blocked"), repeat=len(priors)):
        truth = dict(zip(names, values, strict=True))
        p = math.prod(q if v == "passable" else 1 - q for q, v in zip(priors, values, strict=True))
        for query, yes in answers:
            p *= (1 - error) if query.holds(truth) == yes else error
        total += p
        for name in names:
            mass[name] += p * (truth[name] == "passable")
    return {name: m / total for name, m in mass.items()}


@pytest.mark.long
@settings(max_examples=60, deadline=None)
@given(
    st.lists(st.floats(0.05, 0.95), min_size=3, max_size=5),
    st.lists(
        st.tuples(st.sets(st.integers(0, 2), min_size=1), st.sampled_from(list(Combine)), st.booleans()), max_size=4
    ),
    st.sampled_from([0.1, 0.3]),
)
def test_the_posterior_is_bayes(priors: list[float], told: list[tuple[set[int], Combine, bool]], error: float) -> None:
    belief = prior_belief([gap(f"g{i}", (p, 1 - p)) for i, p in enumerate(priors)])
    answers = []
    for which, combine, yes in told:
        query = cut(*(f"g{i}" for i in sorted(which)), combine=combine)
        update = condition(belief, query, YES_PART if yes else NO_PART, error)
        if not update.contradiction:
            answers.append((query, yes))
        belief = update.belief
    for name, p in brute(priors, answers, error).items():
        assert belief.probability_of(name, "passable") == pytest.approx(p)


def test_thirty_gaps_are_thirty_small_factors() -> None:
    belief = prior_belief([gap(f"g{i:02}") for i in range(30)])
    assert len(belief.factors) == 30
    joined = condition(belief, cut("g00", "g07", "g19", combine=Combine.ANY), YES_PART, 0.0).belief
    assert sorted(f.probability.size for f in joined.factors) == [2] * 27 + [8]
    # Once it is known which one it was, the gaps come apart again.
    settled = condition(joined, cut("g00", "g07", combine=Combine.ANY), NO_PART, 0.0).belief
    assert len(settled.factors) == 30
    assert settled.probability_of("g19", "passable") == 1


def test_with_no_error_an_answer_prunes_and_unsure_tells_nothing() -> None:
    belief = prior_belief([gap("a"), gap("b")])
    assert condition(belief, cut("a"), NO_PART, 0.0).belief.probability_of("a", "passable") == 0
    assert condition(belief, cut("a"), None, 0.0).belief is belief


def test_a_contradiction_is_a_value_and_leaves_the_belief() -> None:
    belief = condition(prior_belief([gap("a"), gap("b")]), cut("a"), YES_PART, 0.0).belief
    update = condition(belief, cut("a", "b", combine=Combine.ANY), NO_PART, 0.0)
    assert update.contradiction
    assert update.expected == 0
    assert update.belief is belief


@pytest.mark.parametrize(("prior", "part"), [((1.0, 0.0), NO_PART), ((0.0, 1.0), YES_PART)])
def test_answers_against_priors_of_one_and_zero_are_contradictions(prior: tuple[float, ...], part: int) -> None:
    update = condition(prior_belief([gap("a", prior)]), cut("a"), part, 0.0)
    assert update.contradiction
    assert update.belief.marginal("a").tolist() == list(prior)


def test_an_answer_that_error_explains_is_taken_in() -> None:
    belief = prior_belief([gap("a", (0.99, 0.01))])
    assert not condition(belief, cut("a"), NO_PART, 0.1).contradiction
    assert condition(belief, cut("a"), NO_PART, 0.01).contradiction


def test_correlated_gaps_are_one_factor() -> None:
    group = CorrelationGroup(gaps=("b", "a"), joint=((("passable", "passable"), 0.3), (("blocked", "blocked"), 0.7)))
    belief = prior_belief([gap("a"), gap("b"), gap("c")], [group])
    assert belief.probability_of("a", "passable") == pytest.approx(0.3)
    after = condition(belief, cut("a"), YES_PART, 0.0).belief
    assert after.probability_of("b", "passable") == 1
    assert after.probability_of("c", "passable") == 0.5
    # A group of which one gap is open counts by its marginal.
    assert prior_belief([gap("b")], [group]).probability_of("b", "passable") == pytest.approx(0.3)


def test_bad_groups_are_refused() -> None:
    with pytest.raises(MissionError, match="no value 'maybe'"):
        prior_belief([gap("a"), gap("b")], [CorrelationGroup(gaps=("a", "b"), joint=((("maybe", "passable"), 1.0),))])
    with pytest.raises(MissionError, match="sum to 1"):
        prior_belief([gap("a"), gap("b")], [CorrelationGroup(gaps=("a", "b"), joint=((("passable",) * 2, 0.5),))])
    one = CorrelationGroup(gaps=("a", "b"), joint=((("passable", "passable"), 1.0),))
    with pytest.raises(MissionError, match="may be in one"):
        prior_belief([gap("a"), gap("b")], [one, replace(one)])
    with pytest.raises(LimitError, match="make it smaller"):
        prior_belief([gap("a"), gap("b")], [one], max_joint=3)


def test_answers_that_couple_too_much_are_refused() -> None:
    belief = prior_belief([gap(f"g{i}") for i in range(6)])
    with pytest.raises(LimitError, match="fewer gaps at once"):
        condition(belief, cut(*(f"g{i}" for i in range(5))), NO_PART, 0.0, max_joint=16)


def test_extend_keeps_what_is_known_adds_and_drops() -> None:
    belief = prior_belief([gap("a"), gap("b"), gap("c")])
    belief = condition(belief, cut("a", "b", combine=Combine.ANY), YES_PART, 0.0).belief
    after = extend(belief, [gap("b"), gap("c", (0.9, 0.1)), gap("d", (0.2, 0.8))])
    assert [g.id for g in after.gaps] == ["b", "c", "d"]
    assert after.probability_of("b", "passable") == pytest.approx(2 / 3)
    assert after.probability_of("c", "passable") == 0.5
    assert after.probability_of("d", "passable") == pytest.approx(0.2)


def test_extend_follows_a_gap_whose_values_changed() -> None:
    old = prior_belief([gap("t", (0.2, 0.3, 0.5))])
    fewer = replace(gap("t", (0.2, 0.3, 0.5)), values=("v2", "v0"), prior=(0.5, 0.5))
    assert extend(old, [fewer]).marginal("t").tolist() == pytest.approx([5 / 7, 2 / 7])
    more = gap("t", (0.1, 0.2, 0.3, 0.4))
    assert extend(old, [more]).marginal("t").tolist() == pytest.approx([0.1, 0.2, 0.3, 0.4])


def test_the_order_of_gaps_does_not_matter() -> None:
    gaps = [gap(n, (p, 1 - p)) for n, p in (("a", 0.1), ("b", 0.2), ("c", 0.3))]
    one, other = prior_belief(gaps), prior_belief(gaps[::-1])
    assert [f.gaps for f in one.factors] == [f.gaps for f in other.factors]
    assert all(np.array_equal(f.probability, g.probability) for f, g in zip(one.factors, other.factors, strict=True))
