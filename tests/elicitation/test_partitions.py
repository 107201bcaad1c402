"""Queries with two, three and four parts: what they are, what their answers tell, and the two-part case as it was."""

from __future__ import annotations

import itertools
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from elicitation.gaps import boxes, smoke
from mintpilot.core.errors import MissionError
from mintpilot.core.gap import KnowledgeGap
from mintpilot.core.mission import AskingSettings
from mintpilot.core.ports import QuerySituation
from mintpilot.core.query import (
    CHOICE_EFFORT,
    NO_PART,
    YES_PART,
    Answer,
    Combine,
    Evidence,
    Literal,
    Option,
    Query,
    Reply,
    Saying,
    SayingKind,
    answer_for,
    choice,
)
from mintpilot.elicitation.choose import decisions, reply_probabilities
from mintpilot.elicitation.objectives import Ec2, InformationGain, Optimal, ValueOfInformation
from mintpilot.elicitation.partitions import partition_keys
from mintpilot.elicitation.phrasing_cost import phrasing_cost
from mintpilot.elicitation.sentences import MAX_WORDS
from mintpilot.elicitation.wording import word_question
from mintpilot.reasoning.belief import condition, prior_belief

EXACT = AskingSettings(delta_c_s=0.0, alpha=0.0)
SEEDS = st.integers(0, 2**32 - 1)
ERRORS = st.sampled_from([0.0, 0.1, 0.4])
some = settings(max_examples=40, deadline=None)


def literal(gap: KnowledgeGap, *values: str) -> Literal:
    return Literal(gap=gap.id, values=frozenset(values), saying=Saying(kind=SayingKind.VALUE, value=values[0]))


def option(gap: KnowledgeGap, *values: str) -> Option:
    return Option(label=f"the {values[0]}", literals=(literal(gap, *values),))


def situation(seed: int, error: float = 0.0, n: int = 8, queries: int = 6, most: int = 4) -> QuerySituation:
    rng = np.random.default_rng(seed)
    count = rng.integers(2, most + 1, queries)
    class_of = np.concatenate([np.arange(3), rng.integers(3, size=n - 3)])
    return QuerySituation(
        probability=rng.dirichlet(np.ones(n)),
        class_of=class_of,
        regret_s=np.where(class_of[None, :] == np.arange(3)[:, None], 0.0, rng.uniform(1, 9, (3, n))),
        parts=np.array([rng.integers(0, c, n) for c in count], np.int8),
        part_count=count.astype(np.int64),
        effort=np.ones(queries),
        settings=replace(EXACT, answer_error=error),
    )


def channel(parts: np.ndarray, count: int, error: float) -> np.ndarray:
    """P(answer | hypothesis), (count, n)."""
    right = parts[None, :] == np.arange(count)[:, None]
    return np.where(right, 1 - error, error / (count - 1))


def bits(p: np.ndarray) -> float:
    p = p[p > 0]
    return float(-(p * np.log2(p)).sum())


@some
@given(SEEDS, ERRORS)
def test_every_objective_is_what_its_definition_says(seed: int, error: float) -> None:
    s = situation(seed, error)
    gains, saved, shares = (o().scores(s) for o in (InformationGain, ValueOfInformation, Ec2))
    for i, (parts, count, replies) in enumerate(zip(s.parts, s.part_count, reply_probabilities(s), strict=True)):
        joint = channel(parts, count, error) * s.probability
        assert replies == pytest.approx(joint.sum(axis=1))
        assert sum(replies) == pytest.approx(1)
        by_class = np.array([[row[s.class_of == c].sum() for c in range(3)] for row in joint])
        mutual = bits(by_class.sum(axis=0)) + bits(by_class.sum(axis=1)) - bits(by_class.ravel())
        assert gains[i] == pytest.approx(max(mutual, 0), abs=1e-9)
        assert 0 <= gains[i] <= np.log2(count)
        after = sum((s.regret_s @ row).min() for row in joint)
        assert saved[i] == pytest.approx(max((s.regret_s @ s.probability).min() - after, 0), abs=1e-8)
        assert 0 <= shares[i] <= 1
        if error == 0:
            pairs = [(a, b) for a, b in itertools.combinations(range(8), 2) if s.class_of[a] != s.class_of[b]]
            weight = {(a, b): s.probability[a] * s.probability[b] for a, b in pairs}
            kept = sum(
                p * sum(w for (a, b), w in weight.items() if parts[a] == parts[b] == part)
                for part, p in enumerate(replies)
            )
            assert shares[i] == pytest.approx(1 - kept / sum(weight.values()), abs=1e-9)


@some
@given(SEEDS, ERRORS)
def test_two_parts_score_as_they_did_before_there_were_more(seed: int, error: float) -> None:
    """The formulas for yes and no alone, beside queries with more parts that must not disturb them."""
    s = situation(seed, error, n=12, queries=9)
    p, classes = s.probability, s.class_of[:, None] == np.arange(3)
    yes = (s.parts == YES_PART) @ (p[:, None] * classes)
    no = np.maximum(p @ classes - yes, 0)
    as_yes, as_no = (1 - error) * yes + error * no, (1 - error) * no + error * yes

    def plogp(mass: np.ndarray) -> np.ndarray:
        return mass * np.log2(np.where(mass > 0, mass, 1.0))

    gain = plogp(as_yes).sum(1) + plogp(as_no).sum(1) - plogp(as_yes.sum(1)) - plogp(as_no.sum(1))
    gain = np.clip(gain - plogp(p @ classes).sum(), 0, 1)
    loss = s.regret_s * p
    lost_yes = (s.parts == YES_PART) @ loss.T
    lost_no = loss.sum(axis=1) - lost_yes
    after = ((1 - error) * lost_yes + error * lost_no).min(1) + ((1 - error) * lost_no + error * lost_yes).min(1)
    discount = error / (1 - error)
    edges = (1 - ((p @ classes) ** 2).sum()) / 2

    def cut(agree: np.ndarray, disagree: np.ndarray) -> np.ndarray:
        left = agree + discount * disagree
        highest = np.where(agree.sum(1) > 1e-12, 1.0, discount)
        return highest**2 * edges - (left.sum(1) ** 2 - (left**2).sum(1)) / 2

    heard = as_yes.sum(1)
    share = np.clip((heard * cut(yes, no) + (1 - heard) * cut(no, yes)) / edges, 0, 1)
    two = s.part_count == 2
    for objective, expected in (
        (InformationGain, gain),
        (ValueOfInformation, np.maximum(loss.sum(axis=1).min() - after, 0)),
        (Ec2, share),
    ):
        got = objective().scores(s)
        # Objectives call what rounding may have made nothing.
        assert np.abs(got - np.where(got == 0, np.minimum(expected, 1e-9) * 0, expected))[two].max(initial=0) <= 1e-12
        assert expected[two & (got == 0)].max(initial=0) <= 1e-9


@some
@given(SEEDS)
def test_splitting_a_part_never_lowers_the_gain(seed: int) -> None:
    s = situation(seed, n=10, most=3)
    rng = np.random.default_rng(seed)
    finer = s.parts.copy()
    for row, count in zip(finer, s.part_count, strict=True):
        row[(row == rng.integers(count)) & (rng.random(10) < 0.5)] = count
    split = replace(s, parts=finer, part_count=s.part_count + 1)
    for objective in (InformationGain, Ec2, ValueOfInformation):
        assert (objective().scores(split) >= objective().scores(s) - 1e-9).all()


def fewest(s: QuerySituation) -> float:
    """Plain recursion over all ways to ask: the operator's time in units of a yes or no."""

    @cache
    def follow(alive: frozenset[int]) -> float:
        if len({s.class_of[i] for i in alive}) == 1 or any(all(row[i] <= 0 for i in alive) for row in s.regret_s):
            return 0.0
        total, best = sum(s.probability[i] for i in alive), np.inf
        for row, count, effort in zip(s.parts, s.part_count, s.effort, strict=True):
            parts = [p for k in range(count) if (p := frozenset(i for i in alive if row[i] == k))]
            if len(parts) > 1:
                best = min(best, effort + sum(sum(s.probability[i] for i in p) / total * follow(p) for p in parts))
        return 0.0 if np.isinf(best) else best

    return follow(frozenset(range(len(s.probability))))


@settings(max_examples=30, deadline=None)
@given(SEEDS)
def test_optimal_is_optimal_with_choices_and_never_needs_more_than_without(seed: int) -> None:
    drawn = situation(seed, n=7, queries=6)
    s = replace(drawn, effort=np.where(drawn.part_count > 2, CHOICE_EFFORT, 1.0))
    best = max(Optimal().scores(s))
    assert (1 / best if best else 0.0) == pytest.approx(fewest(s))
    two = s.part_count == 2
    without = replace(s, parts=s.parts[two], part_count=s.part_count[two], effort=s.effort[two])
    if two.any() and (alone := max(Optimal().scores(without))) > 0 and settled(without):
        assert 1 / best <= 1 / alone + 1e-9


def settled(s: QuerySituation) -> bool:
    """Whether these queries alone can tell all plan classes apart: else asking ends early without them."""
    columns = [tuple(column) for column in s.parts.T]
    return all(
        a != b or s.class_of[i] == s.class_of[j] for (i, a), (j, b) in itertools.combinations(enumerate(columns), 2)
    )


@some
@given(SEEDS)
def test_keys_are_equal_exactly_where_partitions_are(seed: int) -> None:
    rng = np.random.default_rng(seed)
    parts = rng.integers(0, int(rng.integers(1, 5)), (12, 4)).astype(np.int8)
    keys = partition_keys(parts)
    same = [[[a == b for b in row] for a in row] for row in parts.tolist()]
    for i, j in itertools.combinations(range(12), 2):
        assert (keys[i].tobytes() == keys[j].tobytes()) == (same[i] == same[j])
    assert [bool(key.any()) for key in keys] == [len(set(row)) > 1 for row in parts.tolist()]


@some
@given(SEEDS, ERRORS)
def test_the_posterior_of_a_choice_is_bayes_and_sums_to_one(seed: int, error: float) -> None:
    rng = np.random.default_rng(seed)
    box, cloud = boxes(), smoke("a", "the smoke")
    p, q = rng.dirichlet(np.ones(4)), rng.dirichlet(np.ones(2))
    gaps = (replace(box, prior=tuple(p)), replace(cloud, prior=tuple(q)))
    pair = (literal(box, "box-1", "box-2"), literal(cloud, "passable"))
    query = choice([Option(label="the left way", literals=pair), option(box, "box-3")], gaps)
    assert query.part_count == 3
    belief = prior_belief(gaps)
    part = int(rng.integers(3))
    after = condition(belief, query, part, error)
    mass = np.zeros((4, 2))
    for (i, b), (j, c) in itertools.product(enumerate(box.values), enumerate(cloud.values)):
        named = 0 if b in ("box-1", "box-2") and c == "passable" else 1 if b == "box-3" else 2
        mass[i, j] = p[i] * q[j] * (1 - error if named == part else error / 2)
    if not after.contradiction:
        assert after.expected == pytest.approx(mass.sum())
        assert after.belief.marginal(box.id) == pytest.approx(mass.sum(axis=1) / mass.sum())
        assert after.belief.marginal(cloud.id) == pytest.approx(mass.sum(axis=0) / mass.sum())
    assert sum(f.probability.sum() for f in after.belief.factors) == pytest.approx(len(after.belief.factors))
    assert condition(belief, query, None, error).belief is belief


def test_the_parts_of_a_choice_cover_and_exclude() -> None:
    box, cloud = boxes(), smoke("a", "the smoke")
    whole = choice([option(box, "box-1", "box-2"), option(box, "box-3", "box-4")], (box,))
    assert (whole.part_count, whole.none_of_these) == (2, False)
    some_of = choice([option(box, "box-1"), option(box, "box-2"), option(box, "box-3")], (box, cloud))
    assert (some_of.part_count, some_of.none_of_these, some_of.gap_ids) == (4, True, (box.id,))
    joint = prior_belief((box,)).factors[0]
    table = some_of.part_table(joint)
    assert [some_of.part_of({box.id: value}) for value in box.values] == table.tolist() == [0, 1, 2, 3]
    assert [some_of.part_words(part) for part in range(4)] == ["the box-1", "the box-2", "the box-3", "none of these"]
    assert some_of.id != whole.id
    assert some_of.id == choice([*some_of.options], (box,)).id
    relabelled = tuple(replace(x, label="other") for x in some_of.options)
    assert choice(relabelled, (box,)).id == some_of.id
    assert phrasing_cost(some_of) > phrasing_cost(whole) > phrasing_cost(Query(literals=whole.options[0].literals))


def test_what_is_no_partition_is_refused() -> None:
    box, cloud = boxes(), smoke("a", "the smoke")
    one, other = option(box, "box-1", "box-2"), option(box, "box-2", "box-3")
    with pytest.raises(MissionError, match="may hold at once"):
        choice([one, other], (box,))
    with pytest.raises(MissionError, match="may hold at once"):
        choice([option(box, "box-1"), option(cloud, "passable")], (box, cloud))
    with pytest.raises(MissionError, match="5 parts"):
        choice([*(option(box, v) for v in box.values[:3]), *_more()], (replace(box),))
    with pytest.raises(MissionError, match="1 parts"):
        choice([option(box, *box.values)], (box,))
    with pytest.raises(MissionError, match="either"):
        Query(literals=one.literals, options=(one, option(box, "box-3")))
    with pytest.raises(MissionError, match="either"):
        Query()
    partial = Query(options=(option(box, "box-1"), option(box, "box-2")))
    with pytest.raises(MissionError, match="none of these"):
        partial.part_of({box.id: "box-4"})
    with pytest.raises(MissionError, match="none of these"):
        partial.part_table(prior_belief((box,)).factors[0])
    with pytest.raises(MissionError, match="no yes and no"):
        partial.holds({box.id: "box-1"})
    either = Option(label="one", literals=(literal(box, "box-1"), literal(cloud, "passable")), combine=Combine.ANY)
    with pytest.raises(MissionError, match="may hold at once"):
        choice([either, option(box, "box-3")], (box, cloud))
    within = Option(label="both", literals=(literal(box, "box-1"), literal(cloud, "passable")))
    assert choice([within, option(box, "box-3")], (box, cloud)).part_count == 3


def _more() -> list[Option]:
    return [option(boxes(), "box-4"), option(boxes(), "box-9")]


def test_answers_name_parts() -> None:
    box = boxes()
    pick = choice([option(box, "box-1"), option(box, "box-2")], (box,))
    plain = Query(literals=(literal(box, "box-1"),))
    assert [answer_for(plain, part).reply for part in (YES_PART, NO_PART)] == [Reply.YES, Reply.NO]
    for part in range(3):
        answer = answer_for(pick, part)
        assert (answer.reply, answer.option, answer.part) == (Reply.OPTION, part, part)
    assert [Answer(reply=r, latency_s=0.0).part for r in (Reply.YES, Reply.NO, Reply.UNSURE, Reply.TIMEOUT)] == [
        0,
        1,
        None,
        None,
    ]
    for wrong in ({"reply": Reply.OPTION}, {"reply": Reply.YES, "option": 1}):
        with pytest.raises(MissionError, match="option"):
            Answer(latency_s=0.0, **wrong)
    with pytest.raises(MissionError, match="part 3"):
        Evidence(query=pick, part=3)


def test_only_what_is_said_outright_is_asserted() -> None:
    box, cloud, other = boxes(), smoke("a", "the smoke"), smoke("b", "the other smoke")
    safe, second = literal(cloud, "passable"), literal(other, "passable")
    assert Query(literals=(safe,)).asserted(YES_PART) == (safe,)
    assert Query(literals=(safe,)).asserted(NO_PART) == ()
    assert Query(literals=(safe, second)).asserted(YES_PART) == (safe, second)
    assert Query(literals=(safe, second), combine=Combine.ANY).asserted(YES_PART) == ()
    both = Option(label="both", literals=(safe, second))
    none = Option(label="the first only", literals=(safe, literal(other, "blocked")))
    pick = choice([both, none], (cloud, other, box))
    assert pick.asserted(0) == (safe, second)
    assert pick.asserted(2) == ()


def test_a_choice_is_one_short_question_with_a_consequence_for_each_reply() -> None:
    box = boxes()
    pick = choice([option(box, "box-1"), option(box, "box-2")], (box,))
    for attempt in (1, 2):
        question = word_question(pick, (box,), None, attempt=attempt)
        assert "1 the box-1, 2 the box-2 or 3 none of these" in question.text
        assert question.text.endswith("?")
        assert len(question.text.split()) <= MAX_WORDS
        assert len(question.option_means) == pick.part_count
        assert (question.yes_means, question.no_means) == ("", "")


def test_a_plan_exactly_within_the_tolerance_needs_no_question_despite_rounding() -> None:
    asking = AskingSettings(delta_c_s=2.0)
    regret_s = np.array([[0.0, 2.0 + 1e-12], [5.0, 0.0]])
    merged = decisions(np.array([0, 1]), np.array([0.6, 0.4]), regret_s, asking)
    assert merged[0] == merged[1]
    dearer = decisions(np.array([0, 1]), np.array([0.6, 0.4]), regret_s + np.array([[0, 1e-3], [0, 0]]), asking)
    assert dearer[0] != dearer[1]
