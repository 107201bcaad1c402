from __future__ import annotations

import itertools
import math
from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mintpilot.assembly.registry import load, names
from mintpilot.core.errors import UnknownNameError
from mintpilot.reasoning.metrics import (
    FrechetMetric,
    expected_regret_s,
    path_deviation_m,
    q_value_gap,
    resample,
)

paths = st.integers(0, 2**32 - 1).map(
    lambda seed: np.cumsum(np.random.default_rng(seed).normal(size=(2 + seed % 9, 3)), axis=0)
)


def frechet(a: np.ndarray, b: np.ndarray) -> float:
    """The textbook recursion of Eiter and Mannila."""
    one, other = a.tolist(), b.tolist()

    @cache
    def reach(i: int, j: int) -> float:
        d = math.dist(one[i], other[j])
        earlier = [(i - 1, j), (i, j - 1), (i - 1, j - 1)]
        before = [reach(*e) for e in earlier if min(e) >= 0]
        return max(d, min(before)) if before else d

    for i, j in itertools.product(range(len(a)), range(len(b))):
        reach(i, j)
    return reach(len(a) - 1, len(b) - 1)


@pytest.mark.long
@settings(max_examples=10, deadline=None)
@given(paths, paths)
def test_frechet_is_the_textbook_one(a: np.ndarray, b: np.ndarray) -> None:
    assert FrechetMetric().divergence(a, b) == pytest.approx(frechet(resample(a), resample(b)))


@pytest.mark.long
@pytest.mark.parametrize("name", names("metric"))
@settings(max_examples=15, deadline=None)
@given(a=paths, b=paths)
def test_distances_are_symmetric_and_nothing_between_equals(name: str, a: np.ndarray, b: np.ndarray) -> None:
    metric = load("metric", name)()
    assert metric.divergence(a, b) == pytest.approx(metric.divergence(b, a))
    assert metric.divergence(a, b) >= 0
    assert metric.divergence(a, a) == 0


@pytest.mark.parametrize("name", names("metric"))
def test_parallel_lines_and_empty_paths(name: str) -> None:
    metric = load("metric", name)()
    a = np.array([[0.0, 0.0, 0.0], [10.0, 0.0, 0.0]])
    expected = 1.5 if name == "path-variance" else 3.0
    assert metric.divergence(a, a + np.array([0.0, 3.0, 0.0])) == pytest.approx(expected)
    # Another number of way-points on the same line changes nothing.
    assert metric.divergence(a, np.linspace(a[0], a[1], 7)) == pytest.approx(0)
    empty = np.zeros((0, 3))
    assert metric.divergence(empty, empty) == 0
    assert math.isinf(metric.divergence(a, empty))


def test_a_loop_is_far_for_frechet_but_near_for_hausdorff() -> None:
    there = np.array([[0.0, 0, 0], [10.0, 0, 0]])
    back_and_forth = np.array([[0.0, 0, 0], [10.0, 0, 0], [0.0, 0, 0], [10.0, 0, 0]])
    assert load("metric", "hausdorff")().divergence(there, back_and_forth) < 0.2
    assert load("metric", "frechet")().divergence(there, back_and_forth) > 4


def test_resampling_is_even() -> None:
    points = resample(np.array([[0.0, 0, 0], [1.0, 0, 0], [1.0, 9.0, 0]]), 11)
    assert np.linalg.norm(np.diff(points, axis=0), axis=1) == pytest.approx(np.ones(10), abs=0.5)
    assert len(resample(np.array([[1.0, 2.0, 3.0]]))) == 128


def test_path_deviation_weighs_by_probability() -> None:
    a = np.array([[0.0, 0, 0], [10.0, 0, 0]])
    b = a + np.array([0.0, 4.0, 0.0])
    assert path_deviation_m((a, b), (1.0, 0.0)) == 0
    assert path_deviation_m((a, b), (0.5, 0.5)) == pytest.approx(2.0)


def test_losses_of_the_wrong_hypothesis() -> None:
    assert q_value_gap(np.array([1.0, 5.0, 2.0]), np.array([0.0, 1.0, 9.0])) == 3.0
    assert q_value_gap(np.array([1.0, 5.0]), np.array([0.0, 1.0])) == 0.0
    assert expected_regret_s(np.array([[0.0, 8.0], [2.0, 0.0]]), np.array([0.5, 0.5])) == 1.0


def test_metrics_are_found_by_name() -> None:
    with pytest.raises(UnknownNameError, match="frechet"):
        load("metric", "frchet")
