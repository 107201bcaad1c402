from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mintpilot.benchmark.intervals import student, wilson


def test_wilson_agrees_with_the_published_example() -> None:
    # Newcombe 1998, table I: 81 of 263.
    assert wilson(81, 263) == pytest.approx((0.2553, 0.3662), abs=1e-4)
    assert wilson(20, 20) == pytest.approx((0.8389, 1.0), abs=1e-4)
    assert wilson(0, 0) == (0.0, 1.0)


@settings(deadline=None, max_examples=60)
@given(st.integers(1, 500).flatmap(lambda n: st.tuples(st.integers(0, n), st.just(n))))
def test_wilson_holds_the_share_and_stays_in_range(case: tuple[int, int]) -> None:
    k, n = case
    lo, hi = wilson(k, n)
    assert 0 <= lo <= k / n <= hi <= 1
    assert wilson(n - k, n) == pytest.approx((1 - hi, 1 - lo), abs=1e-12)


def test_student_of_a_textbook_sample() -> None:
    interval = student([1.0, 2.0, 3.0, 4.0, 5.0])
    assert interval == pytest.approx((1.0368, 4.9632), abs=1e-4)
    assert student([3.0]) is None
    assert student([2.0, 2.0, 2.0]) == (2.0, 2.0)
