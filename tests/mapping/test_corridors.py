"""The middle of a gap that smoke hides."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from mintpilot.mapping.corridors import off_corridor

RES_M, HULL_M = 0.2, 0.4


def hall(gap: tuple[int, int], hidden: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A wall along y at x = 20 with a gap, and a cloud over it; ``hidden`` voxels of each end are in the cloud."""
    shape = (3, 40, 40)
    cloud, solid = np.zeros(shape, bool), np.zeros(shape, bool)
    lo, hi = gap[0] - hidden, gap[1] + hidden
    cloud[:, max(lo, 0) : hi, 14:27] = True
    solid[:, : gap[0], 20] = solid[:, gap[1] :, 20] = True
    return cloud, solid & ~cloud, ~solid & ~cloud


def test_the_way_keeps_away_from_the_ends_of_a_wall() -> None:
    cloud, solid, free = hall((14, 26), 5)
    near = off_corridor(cloud, solid, free, resolution_m=RES_M, hull_m=HULL_M)
    assert (near <= cloud).all()
    # Five voxels of wall are hidden at either end of 22 unseen ones: only the middle is counted on.
    assert near[1, 9:14, 20].all()
    assert near[1, 26:31, 20].all()
    assert not near[1, 18:22, 20].any()


def test_a_pocket_that_is_cut_off_does_not_matter() -> None:
    cloud, solid, free = hall((14, 26), 5)
    solid[:, 11:14, 25:30] = True
    solid[:, 12, 26:29] = False  # a pocket between crates at the cloud's edge
    free &= ~solid
    free[:, 12, 27:29] = True
    near = off_corridor(cloud, solid, free, resolution_m=RES_M, hull_m=0.05)
    assert near[1, 27:31, 20].all()


def test_a_dead_end_keeps_room_to_go_into() -> None:
    cloud, solid, free = (np.zeros((5, 40, 40), bool) for _ in range(3))
    solid[:, :10, 12:28] = solid[:, 30:, 12:28] = solid[:, :, 28] = True  # a corridor with an end, full of smoke
    cloud[:, 10:30, 14:28] = True
    free |= ~(cloud | solid)
    near = off_corridor(cloud, solid, free, resolution_m=RES_M, hull_m=HULL_M)
    assert near[2, 10:12, 20].all()
    assert not near[2, 13:27, 20].any()


def test_flames_are_not_kept_away_from_like_walls() -> None:
    cloud, solid, free = hall((14, 26), 5)
    flames = np.zeros_like(solid)
    flames[:, 8:18, 26:28] = True  # at the cloud's edge, behind one side of the gap
    cloud &= ~flames
    free &= ~flames
    shy = off_corridor(cloud, solid | flames, free, resolution_m=RES_M, hull_m=HULL_M)
    bold = off_corridor(cloud, solid | flames, free, ends=flames, resolution_m=RES_M, hull_m=HULL_M)
    assert shy[1, 18, 22:25].any()
    assert not bold[1, 18:22, 20:26].any()


def test_a_side_way_does_not_pull_the_lane_out_of_the_middle() -> None:
    cloud, solid, free = hall((14, 26), 5)
    rack = np.zeros_like(solid)
    rack[:, 24:27, :14] = True  # its end leaves a narrow way in beside the hidden wall
    free &= ~rack
    near = off_corridor(cloud, solid | rack, free, resolution_m=RES_M, hull_m=HULL_M)
    assert near[1, 9:14, 20].all()
    assert not near[1, 19:22, 20].any()
    assert not near[1, 28:30, 14].any()  # north of the rack one still gets in


def test_a_narrow_gap_stays_open() -> None:
    cloud, solid, free = hall((16, 24), 1)
    near = off_corridor(cloud, solid, free, resolution_m=RES_M, hull_m=HULL_M)
    assert not near[1, 18:22, 20].any()
    assert near.any()


def test_what_stands_apart_does_not_count() -> None:
    cloud, solid, free = (np.zeros((3, 30, 30), bool) for _ in range(3))
    cloud[:, 10:20, 10:20] = True
    solid[:, 15, 24] = solid[0, 15, 20] = True  # a post somewhere else, a brick at the edge
    free |= ~(cloud | solid)
    assert not off_corridor(cloud, solid, free, resolution_m=RES_M, hull_m=HULL_M).any()
    assert not off_corridor(cloud, np.zeros_like(solid), free, resolution_m=RES_M, hull_m=HULL_M).any()


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_only_unseen_voxels_of_the_cloud_are_doubted(seed: int) -> None:
    rng = np.random.default_rng(seed)
    cloud, shape = np.zeros((2, 24, 24), bool), (2, 24, 24)
    a, b = np.sort(rng.integers(0, 24, (2, 2)), axis=0)
    cloud[:, a[0] : b[0] + 1, a[1] : b[1] + 1] = True
    solid = rng.random(shape) < rng.uniform(0, 0.05)
    free = (rng.random(shape) < 0.9) & ~solid
    near = off_corridor(cloud, solid, free, resolution_m=RES_M, hull_m=HULL_M)
    assert not (near & (free | ~cloud)).any()
