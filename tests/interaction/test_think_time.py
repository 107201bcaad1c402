from __future__ import annotations

import numpy as np
import pytest

from mintpilot.core.errors import InputError
from mintpilot.core.think_time import ThinkTime, think_time


@pytest.mark.parametrize(("words", "least", "most"), [("5", 5, 5), (3.5, 3.5, 3.5), ("2..8", 2, 8), (" 0 ", 0, 0)])
def test_seconds_and_bounds_are_read(words, least, most):
    read = think_time(words)
    assert (read.least_s, read.most_s, read.mean_s) == (least, most, (least + most) / 2)
    assert think_time(str(read)) == read


@pytest.mark.parametrize("words", ["", "soon", "8..2", "-1", "inf", "nan", "1..2..3", ".."])
def test_what_is_no_time_is_refused_by_its_words(words):
    with pytest.raises(InputError, match="think"):
        think_time(words)


def test_a_fixed_time_draws_nothing():
    rng = np.random.default_rng(0)
    assert ThinkTime(5, 5).draw(rng) == 5
    assert rng.random() == np.random.default_rng(0).random()
