from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from mintpilot.assembly.registry import load
from mintpilot.core.errors import LimitError, UnknownNameError
from mintpilot.core.mission import AskingSettings
from mintpilot.core.ports import QuerySituation
from mintpilot.elicitation.objectives import Ec2, InformationGain, Optimal, Random
from mintpilot.elicitation.objectives.optimal import huffman
from mintpilot.elicitation.objectives.value_of_information import ValueOfInformation

EXACT = AskingSettings(delta_c_s=0.0, alpha=0.0)


def situation(seed: int, error: float = 0.0, n: int = 8, classes: int = 3, cuts: int = 6) -> QuerySituation:
    rng = np.random.default_rng(seed)
    class_of = np.concatenate([np.arange(classes), rng.integers(classes, size=n - classes)])
    return QuerySituation(
        probability=rng.dirichlet(np.ones(n)),
        class_of=class_of,
        regret_s=np.where(class_of[None, :] == np.arange(classes)[:, None], 0.0, rng.uniform(1, 9, (classes, n))),
        parts=(rng.random((cuts, n)) >= 0.5).astype(np.int8),
        part_count=np.full(cuts, 2),
        effort=np.ones(cuts),
        settings=replace(EXACT, answer_error=error),
    )


def brute_entropy(p: list[float]) -> float:
    return -sum(x * np.log2(x) for x in p if x > 0)


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 2**32 - 1), st.sampled_from([0.0, 0.1, 0.4]))
def test_information_gain_is_mutual_information(seed: int, error: float) -> None:
    s = situation(seed, error)
    for cut, gain in zip(s.parts == 0, InformationGain().scores(s), strict=True):
        joint = np.zeros((2, 3))
        for p, c, y in zip(s.probability, s.class_of, cut, strict=True):
            joint[int(y), c] += p * (1 - error)
            joint[1 - int(y), c] += p * error
        classes, answers = joint.sum(axis=0), joint.sum(axis=1)
        expected = brute_entropy(classes) + brute_entropy(answers) - brute_entropy(joint.ravel())
        assert gain == pytest.approx(max(expected, 0), abs=1e-9)
        assert 0 <= gain <= 1


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_ec2_counts_the_edges_that_are_cut(seed: int) -> None:
    s = situation(seed)
    n = len(s.probability)
    pairs = [(i, j) for i in range(n) for j in range(i) if s.class_of[i] != s.class_of[j]]
    weight = {(i, j): s.probability[i] * s.probability[j] for i, j in pairs}
    for cut, score in zip(s.parts == 0, Ec2().scores(s), strict=True):
        yes = s.probability[cut].sum()
        expected = 0.0
        for answer, p in ((True, yes), (False, 1 - yes)):
            gone = sum(w for (i, j), w in weight.items() if cut[i] != answer or cut[j] != answer)
            expected += p * gone
        assert score == pytest.approx(expected / sum(weight.values()), abs=1e-9)


@pytest.mark.parametrize("error", [0.0, 0.1, 0.3])
def test_a_cut_that_tells_nothing_is_worth_nothing(error: float) -> None:
    s = situation(1, error)
    s = replace(
        s, parts=np.vstack([np.ones(8, np.int8), np.zeros(8, np.int8)]), part_count=np.array([2, 2]), effort=np.ones(2)
    )
    for objective in (InformationGain(), Ec2(), ValueOfInformation(), Random()):
        assert (objective.scores(s) <= 1e-9).all()


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 2**32 - 1), st.sampled_from([0.0, 0.2]))
def test_value_of_information_is_the_fall_of_expected_regret(seed: int, error: float) -> None:
    s = situation(seed, error)
    now = (s.regret_s @ s.probability).min()
    for cut, value in zip(s.parts == 0, ValueOfInformation().scores(s), strict=True):
        heard = np.where(cut, 1 - error, error)
        after = sum((s.regret_s @ (s.probability * w)).min() for w in (heard, 1 - heard))
        assert value == pytest.approx(max(now - after, 0), abs=1e-8)


def test_the_price_of_a_question_is_taken_off() -> None:
    s = situation(5)
    dear = replace(s, settings=replace(s.settings, question_price_s=2.0))
    assert ValueOfInformation().scores(dear) == pytest.approx(ValueOfInformation().scores(s) - 2.0)


def fewest(s: QuerySituation, alive: frozenset[int]) -> float:
    """Plain recursion over all ways to ask."""
    if len({s.class_of[i] for i in alive}) == 1 or any(all(row[i] <= 0 for i in alive) for row in s.regret_s):
        return 0.0
    total, best = sum(s.probability[i] for i in alive), np.inf
    for cut in s.parts == 0:
        parts = [frozenset(i for i in alive if cut[i]), frozenset(i for i in alive if not cut[i])]
        if all(parts):
            best = min(best, 1 + sum(sum(s.probability[i] for i in p) / total * fewest(s, p) for p in parts))
    return 0.0 if np.isinf(best) else best


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_optimal_is_optimal(seed: int) -> None:
    s = situation(seed, n=6, cuts=5)
    best = max(Optimal().scores(s))
    expected = fewest(s, frozenset(range(6)))
    assert (1 / best if best else 0.0) == pytest.approx(expected)


def detours(seed: int, gaps: int = 4, ways: int = 10, alpha: float = 0.0) -> QuerySituation:
    """Ways with random lengths through random regions, each open with even odds; cuts about one or two regions."""
    rng = np.random.default_rng(seed)
    open_ = np.array(list(itertools.product([True, False], repeat=gaps)))
    needs = np.vstack([rng.random((ways, gaps)) < 0.4, np.zeros((1, gaps), bool)])
    cost = np.append(rng.integers(0, 2 * ways, ways), 2 * ways).astype(float)
    can = ~(needs[:, None, :] & ~open_[None, :, :]).any(axis=2)
    under = np.where(can, cost[:, None], np.inf)
    regret = np.where(can, cost[:, None] - under.min(axis=0), 100.0)
    pairs = list(itertools.combinations(range(gaps), 2))
    both = [open_[:, a] & open_[:, b] for a, b in pairs] + [open_[:, a] | open_[:, b] for a, b in pairs]
    used, class_of = np.unique(under.argmin(axis=0), return_inverse=True)
    return QuerySituation(
        probability=np.full(len(open_), 1 / len(open_)),
        class_of=class_of,
        regret_s=regret[used],
        parts=(~np.array([*open_.T, *both])).astype(np.int8),
        part_count=np.full(gaps + 2 * len(pairs), 2),
        effort=np.ones(gaps + 2 * len(pairs)),
        settings=replace(EXACT, delta_c_s=1.0, alpha=alpha),
    )


def fewest_by_bits(s: QuerySituation) -> float:
    """As `fewest`, for more hypotheses: sets are bit masks, and nothing is worked out twice."""
    n = len(s.probability)

    def bits(row: Sequence[bool]) -> int:
        return sum(1 << i for i in range(n) if row[i])

    plans = [bits(row <= s.settings.delta_c_s) for row in s.regret_s]
    classes = [bits(s.class_of == c) for c in set(s.class_of)]
    cuts = [bits(row) for row in s.parts == 0]
    enough = 1 - s.settings.alpha

    @cache
    def follow(alive: int) -> float:
        size = alive.bit_count()
        if any(alive & ~p == 0 for p in plans) or any((alive & c).bit_count() >= enough * size for c in classes):
            return 0.0
        ways = [
            1 + sum(part.bit_count() / size * follow(part) for part in (alive & cut, alive & ~cut))
            for cut in cuts
            if alive & cut and alive & ~cut
        ]
        return min(ways)

    return follow((1 << n) - 1)


@pytest.mark.long
@settings(max_examples=12, deadline=None)
@given(st.tuples(st.integers(0, 2**32 - 1), st.just(4), st.just(10), st.sampled_from([0.0, 0.05, 0.2])))
@example((25, 4, 10, 0.0))
@example((25, 4, 10, 0.1))
@example((43, 5, 10, 0.0))  # some supports are met again where more questions may still be asked about them
@example((73, 5, 10, 0.0))
def test_optimal_is_optimal_where_plans_overlap_and_masses_are_equal(world: tuple[int, int, int, float]) -> None:
    s = detours(*world)
    best = max(Optimal().scores(s))
    assert (1 / best if best else 0.0) == pytest.approx(fewest_by_bits(s))


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_huffmans_code_is_the_shortest(seed: int) -> None:
    rng = np.random.default_rng(seed)
    weights = rng.dirichlet(np.ones(int(rng.integers(1, 7))))
    queue, length = sorted(weights), 0.0
    while len(queue) > 1:
        a, b, *rest = queue
        length += a + b
        queue = sorted([a + b, *rest])
    assert huffman(rng.permutation(weights)[None, :], 2)[0] == pytest.approx(length)
    # What is beyond a sum of one does not count.
    assert huffman(np.array([[0.5, 0.25, 0.5, 0.25]]), 2)[0] == pytest.approx(1.0)


def test_optimal_refuses_politely() -> None:
    with pytest.raises(LimitError, match="use 'information-gain'"):
        Optimal().scores(situation(0, error=0.1))
    with pytest.raises(LimitError, match="raise the bound"):
        Optimal(max_states=3).scores(situation(0, n=30, classes=9, cuts=30))


def test_an_exclusive_or_does_not_end_the_asking() -> None:
    # The class is the exclusive or of two fair gaps: neither tells anything of it alone.
    s = QuerySituation(
        probability=np.full(4, 0.25),
        class_of=np.array([0, 1, 1, 0]),
        regret_s=np.array([[0.0, 9.0, 9.0, 0.0], [9.0, 0.0, 0.0, 9.0]]),
        parts=np.array([[0, 0, 1, 1], [0, 1, 0, 1]], np.int8),
        part_count=np.array([2, 2]),
        effort=np.ones(2),
        settings=EXACT,
    )
    assert (InformationGain().scores(s) > 0).all()
    assert (Ec2().scores(s) > 0).all()


def test_random_is_seeded() -> None:
    s = situation(3)
    one, other = (Random(seed=7).scores(s) for _ in range(2))
    assert np.array_equal(one, other)


def test_objectives_are_found_by_name() -> None:
    assert isinstance(load("objective", "ec2")(), Ec2)
    with pytest.raises(UnknownNameError, match="information-gain"):
        load("objective", "information-gian")
