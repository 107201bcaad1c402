"""Masks grow and shrink as scipy's do."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy import ndimage

from mintpilot.perception.morphology import closed, dilated, eroded, opened

OURS_AND_SCIPYS = [
    (dilated, ndimage.binary_dilation),
    (eroded, ndimage.binary_erosion),
    (closed, ndimage.binary_closing),
    (opened, ndimage.binary_opening),
]


@pytest.mark.long
@pytest.mark.parametrize(("ours", "theirs"), OURS_AND_SCIPYS)
@given(arrays(bool, st.tuples(st.integers(1, 12), st.integers(1, 12))), st.integers(1, 4))
def test_masks_change_as_in_scipy(ours, theirs, mask, steps):
    before = mask.copy()
    assert np.array_equal(ours(mask, steps), theirs(mask, iterations=steps))
    assert np.array_equal(mask, before)


@pytest.mark.parametrize("change", [dilated, eroded, closed, opened])
def test_no_step_changes_nothing(change):
    mask = np.eye(5, dtype=bool)
    assert np.array_equal(change(mask, 0), mask)
