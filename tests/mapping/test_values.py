"""What is believed of an ordered value, cut into regions (method, section 13)."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mintpilot.core.errors import MissionError
from mintpilot.core.geometry import GridFrame
from mintpilot.core.observation import RegionKind
from mintpilot.core.plan import VehicleLimits
from mintpilot.core.semantic_map import Knowledge, Region
from mintpilot.core.threshold import ValueKind
from mintpilot.mapping.values import MAX_CUTS, Value, cut_by

CUBE = GridFrame(origin_m=(0.0, 0.0, 0.0), resolution_m=0.25, shape=(20, 3, 3))
FLAT = GridFrame(origin_m=(0.0, 0.0, 1.0), resolution_m=0.25, shape=(1, 3, 3))
BODY = VehicleLimits(radius_m=0.3, margin_m=0.1)


def region(frame: GridFrame) -> Region:
    return Region(
        id="gate", kind=RegionKind.AREA, cells=np.arange(int(np.prod(frame.shape)), dtype=np.int64),
        description="the gate",
    )  # fmt: skip


@settings(max_examples=60, deadline=None)
@given(st.floats(0, 2), st.floats(0.1, 3), st.floats(0, 4), st.floats(0.01, 2), st.lists(st.floats(0, 6), min_size=2))
def test_the_chance_falls_with_the_threshold_and_stays_one(
    least: float, wide: float, mean: float, sigma: float, thresholds: list[float]
) -> None:
    value = Value(
        id="v", kind=ValueKind.CEILING, least_m=least, most_m=least + wide, mean_m=mean, sigma_m=sigma
    )  # fmt: skip
    chances = [value.at_least(t) for t in sorted(thresholds)]
    assert all(0 <= p <= 1 for p in chances)
    assert chances == sorted(chances, reverse=True)
    assert (value.at_least(least), value.at_least(least + wide + 0.01)) == (1.0, 0.0)


@settings(max_examples=60, deadline=None)
@given(st.floats(0, 3), st.floats(0.1, 4), st.floats(0, 5), st.floats(0.05, 2))
def test_the_layers_of_a_cloud_hang_together_and_keep_their_chances(
    least: float, wide: float, mean: float, sigma: float
) -> None:
    value = Value(id="v", kind=ValueKind.CEILING, least_m=least, most_m=least + wide, mean_m=mean, sigma_m=sigma)
    parts, group = cut_by(region(CUBE), value, CUBE, BODY)
    open_ = [p for p in parts if p.passable is Knowledge.OPEN]
    assert len(open_) <= MAX_CUTS
    everything = np.concatenate([p.cells for p in parts]) if parts else np.zeros(0, np.int64)
    assert len(np.unique(everything)) == len(everything)
    # What is in no part lies wholly below the least value: it is known to be clear.
    layer_top = (np.unravel_index(np.setdiff1d(region(CUBE).cells, everything), CUBE.shape)[0] + 1) * 0.25
    assert (layer_top <= least + 1e-6).all()
    if group is not None:
        assert sum(p for _, p in group.joint) == pytest.approx(1)
        for i, part in enumerate(open_):
            chance = sum(p for values, p in group.joint if values[i] == "passable")
            assert chance == pytest.approx(part.prior_passable)
            assert chance == pytest.approx(value.at_least(part.threshold.at_least_m))


def test_a_passage_must_be_as_wide_as_the_body_with_its_clearance() -> None:
    value = Value(
        id="v", kind=ValueKind.CLEARANCE, least_m=0.5, most_m=1.5, points=((0.7, 0.25), (0.8, 0.5), (1.2, 0.25))
    )
    (part,), group = cut_by(region(FLAT), value, FLAT, BODY)
    assert group is None
    assert part.threshold.words == "0.8 m"
    assert part.prior_passable == pytest.approx(0.75)
    (too_wide,), _ = cut_by(region(FLAT), value, FLAT, VehicleLimits(radius_m=0.9))
    assert too_wide.passable is Knowledge.NO


@pytest.mark.parametrize("limits", [(1.0, 1.0), (2.0, 1.0), (-1.0, 1.0), (0.0, float("inf"))])
def test_a_range_that_does_not_rise_is_refused(limits: tuple[float, float]) -> None:
    with pytest.raises(MissionError, match="must rise"):
        Value(id="v", kind=ValueKind.CEILING, least_m=limits[0], most_m=limits[1], mean_m=1.0, sigma_m=0.1)
