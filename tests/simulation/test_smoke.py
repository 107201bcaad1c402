"""The laws of marching a volume, without any drawing library."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mintpilot.core.geometry import Box
from mintpilot.simulation.scenarios import make_scenario
from mintpilot.simulation.sensor import SensorSettings, corrupt
from mintpilot.simulation.smoke import Volume, march, volumes_of

SIZE = (24, 32)
FOCAL_PX = 22.0
LOOK_EAST = np.array([[0.0, 0.0, 1.0, 0.0], [-1.0, 0.0, 0.0, 0.0], [0.0, -1.0, 0.0, 1.5], [0.0, 0.0, 0.0, 1.0]])


def marched(near_m: float, long_m: float, wall_m: float, *, flame: bool = False) -> tuple[np.ndarray, np.ndarray]:
    """Picture and sensed depth of a cloud from ``near_m`` on before a grey wall."""
    rgb = np.full((*SIZE, 3), 200, np.uint8)
    depth = np.full(SIZE, wall_m, np.float32)
    sensed = depth.copy()
    box = Box(lo_m=(near_m, -6.0, 0.0), hi_m=(near_m + long_m, 6.0, 4.0))
    volume = Volume(box=box, flame=flame, glow_m=box.centre_m, glow=0.0, offset=0.0)
    march(rgb, depth, sensed, volume, world_from_camera=LOOK_EAST, focal_px=FOCAL_PX, time_s=0.0)
    return rgb, sensed


@settings(deadline=None, max_examples=25)
@given(near_m=st.floats(1.0, 4.0), long_m=st.floats(0.8, 4.0), wall_m=st.floats(0.5, 9.0))
def test_a_cloud_never_returns_from_before_its_front_or_behind_the_wall(
    near_m: float, long_m: float, wall_m: float
) -> None:
    rgb, sensed = marched(near_m, long_m, wall_m)
    assert (sensed <= np.float32(wall_m) + 1e-5).all()
    assert (sensed >= min(near_m, wall_m) - 1e-3).all()
    if wall_m <= near_m - 0.001:
        assert (rgb == 200).all()
        assert (sensed == np.float32(wall_m)).all()


def test_what_shines_through_falls_exponentially_with_thickness() -> None:
    thin, middle, thick = (np.abs(marched(2.0, d, 9.0)[0].astype(float) - 200).mean() for d in (1.0, 2.0, 4.0))
    assert 1.0 < thin < middle <= thick + 3.0
    # Where nearly nothing shines through, more smoke changes little.
    assert thick - middle < middle - thin


def test_the_depth_sensor_sees_through_thin_smoke_and_not_through_thick() -> None:
    assert (marched(2.0, 0.35, 6.0)[1] > 5.9).mean() > 0.9
    assert (marched(2.0, 3.0, 6.0)[1][8:-6] < 4.0).mean() > 0.99


def test_a_nan_of_the_sensor_is_replaced_by_the_cloud_in_front() -> None:
    depth = np.full(SIZE, 30.0, np.float32)
    sensed = np.full(SIZE, np.nan, np.float32)
    box = Box(lo_m=(2.0, -6.0, 0.0), hi_m=(5.0, 6.0, 4.0))
    volume = Volume(box=box, flame=False, glow_m=box.centre_m, glow=0.0, offset=0.0)
    rgb = np.zeros((*SIZE, 3), np.uint8)
    march(rgb, depth, sensed, volume, world_from_camera=LOOK_EAST, focal_px=FOCAL_PX, time_s=0.0)
    assert np.isfinite(sensed).mean() > 0.9


def test_volumes_tint_smoke_by_the_nearest_fire_and_flicker_with_time() -> None:
    scene = next(s for s in (make_scenario("fire-warehouse", n).scene for n in range(20)) if len(s.solids) > 20)
    smoke, fire = volumes_of(scene)
    assert (smoke.flame, fire.flame) == (False, True)
    assert smoke.glow > 0
    assert smoke.glow_m == fire.box.centre_m
    pictures = []
    for time_s in (0.0, 0.5):
        rgb, depth = np.zeros((*SIZE, 3), np.uint8), np.full(SIZE, 20.0, np.float32)
        eye = LOOK_EAST.copy()
        eye[:3, 3] = np.asarray(fire.box.centre_m) - (3.0, 0.0, 0.0)
        march(rgb, depth, depth.copy(), fire, world_from_camera=eye, focal_px=FOCAL_PX, time_s=time_s)
        pictures.append(rgb)
    assert pictures[0].max() > 150
    assert (pictures[0] != pictures[1]).any()


@pytest.mark.parametrize("distance_m", [2.0, 6.0])
def test_noise_is_as_large_as_stated(distance_m: float) -> None:
    settings_ = SensorSettings(random_loss=0.0)
    flat = np.full((120, 160), distance_m, np.float32)
    faulty = corrupt(flat, focal_px=200.0, settings=settings_, rng=np.random.default_rng(0))
    stated = settings_.noise_m + settings_.noise_per_m * distance_m**2
    assert np.isfinite(faulty).all()
    assert faulty.std() == pytest.approx(stated, rel=0.05)
    assert faulty.mean() == pytest.approx(distance_m, abs=0.002)


def test_returns_are_lost_at_edges_out_of_range_and_where_nothing_was() -> None:
    step = np.full((40, 60), 2.0, np.float32)
    step[:, 30:] = 4.0
    step[:, 50:] = np.nan
    step[:5] = 20.0
    lossy = SensorSettings(steep_loss=1.0, random_loss=0.0)
    faulty = corrupt(step, focal_px=200.0, settings=lossy, rng=np.random.default_rng(0))
    assert np.isnan(faulty[10:, 29:31]).all()
    assert np.isfinite(faulty[10:, 5:28]).all()
    assert np.isnan(faulty[:5]).all()
    assert np.isnan(faulty[:, 50:]).all()
