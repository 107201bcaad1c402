"""Frames from the drawn world: true distances within the sensor's faults, the right pose, smoke and fire."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from mintpilot.core.errors import UnknownNameError
from mintpilot.core.geometry import Box, Vec3
from mintpilot.core.observation import Frame
from mintpilot.simulation.render import SceneRenderer
from mintpilot.simulation.scene import ClosedRoom, Person, Scene, Smoke, Solid
from mintpilot.simulation.sensor import SensorSettings
from mintpilot.simulation.world import build_world

pytestmark = pytest.mark.sim
HALL = Box(lo_m=(0.0, 0.0, 0.0), hi_m=(16.0, 8.0, 4.0))
WALL_X_M = 6.0
EYE_M: Vec3 = (1.0, 4.0, 1.5)
EAST = [0.0, -1.0, 0.0, 0.0, 0.0, 1.0]


def hall(*solids: Solid, smokes: tuple[Smoke, ...] = (), rooms: tuple[ClosedRoom, ...] = ()) -> Scene:
    return Scene(name="hall", volume=HALL, start_m=EYE_M, solids=solids, smokes=smokes, rooms=rooms, seed=1)


WALL = Solid(id="wall", kind="wall", extent_m=Box(lo_m=(WALL_X_M, 0.0, 0.0), hi_m=(WALL_X_M + 0.2, 8.0, 4.0)))


class View:
    """A world with a camera that looks east."""

    def __init__(self, scene: Scene, *, eye_m: Vec3 = EYE_M, seed: int = 0, **settings: Any) -> None:
        mujoco = pytest.importorskip("mujoco")
        spec = build_world(scene)
        spec.worldbody.add_camera(name="rgbd", pos=list(eye_m), fovy=58, xyaxes=EAST)
        model = spec.compile()
        self.data = mujoco.MjData(model)
        mujoco.mj_forward(model, self.data)
        self.renderer = SceneRenderer(model, scene, seed=seed, **settings)

    def frame(self, time_s: float = 0.0) -> Frame:
        with self.renderer:
            return self.renderer.capture(self.data, time_s)


@pytest.fixture(scope="module")
def wall_frame() -> Frame:
    return View(hall(WALL)).frame()


def centre(depth_m: np.ndarray) -> np.ndarray:
    return np.asarray(depth_m[100:140, 140:180])


def test_the_depth_of_a_wall_is_its_distance_within_noise(wall_frame: Frame) -> None:
    depth = centre(wall_frame.depth_m)
    seen = depth[np.isfinite(depth)]
    assert seen.size > 0.97 * depth.size
    assert seen.mean() == pytest.approx(WALL_X_M - EYE_M[0], abs=0.01)
    assert 0.5 * 0.023 < seen.std() < 2 * 0.023


def test_a_perfect_sensor_gives_the_exact_distance_everywhere_on_the_wall() -> None:
    perfect = SensorSettings(noise_m=0.0, noise_per_m=0.0, random_loss=0.0)
    depth = centre(View(hall(WALL), sensor=perfect).frame().depth_m)
    assert np.abs(depth - (WALL_X_M - EYE_M[0])).max() < 0.005


def test_points_back_projected_with_the_frames_pose_lie_on_the_wall(wall_frame: Frame) -> None:
    lens, depth = wall_frame.camera, wall_frame.depth_m
    v, u = np.nonzero(np.isfinite(depth))
    z = depth[v, u].astype(float)
    rays = np.stack([(u + 0.5 - lens.cx) / lens.fx * z, (v + 0.5 - lens.cy) / lens.fy * z, z, np.ones_like(z)])
    x, y, height, _ = wall_frame.world_from_camera @ rays
    assert np.percentile(x[height < 3.8], 99) < WALL_X_M + 0.12
    on_wall = np.abs(x - WALL_X_M) < 0.1
    assert on_wall.mean() > 0.5
    # The picture's left is north of an eye that looks east, its top is up.
    assert np.corrcoef(u[on_wall], y[on_wall])[0, 1] < -0.99
    assert np.corrcoef(v[on_wall], height[on_wall])[0, 1] < -0.99
    assert height.min() > -0.15
    turn = wall_frame.world_from_camera[:3, :3]
    assert np.allclose(turn @ turn.T, np.eye(3), atol=1e-9)
    assert np.linalg.det(turn) == pytest.approx(1.0)


@pytest.mark.long
def test_nothing_returns_from_beyond_the_range_and_noise_grows_with_distance() -> None:
    far = View(hall()).frame().depth_m
    assert np.isnan(centre(far)).all()
    assert np.nanmax(far) < 12.6
    near_wall = Solid(id="near", kind="wall", extent_m=Box(lo_m=(3.0, 0.0, 0.0), hi_m=(3.2, 8.0, 4.0)))
    near, middle = (centre(View(hall(w)).frame().depth_m) for w in (near_wall, WALL))
    assert np.nanstd(middle) > 2 * np.nanstd(near)


@pytest.mark.long
def test_the_same_seed_gives_the_same_frames_and_another_other_noise() -> None:
    first, again, other = (View(hall(WALL), seed=s).frame() for s in (0, 0, 1))
    assert np.array_equal(first.depth_m, again.depth_m, equal_nan=True)
    assert np.array_equal(first.rgb, again.rgb)
    assert not np.array_equal(first.depth_m, other.depth_m, equal_nan=True)


def cloud(long_m: float) -> Smoke:
    return Smoke(id="smoke", extent_m=Box(lo_m=(3.0, 2.0, 0.0), hi_m=(3.0 + long_m, 6.0, 4.0)), toxic=True)


@pytest.mark.long
def test_smoke_hides_more_and_returns_nearer_the_thicker_it_is() -> None:
    bricks = Solid(id="bricks", kind="partition", extent_m=WALL.extent_m)
    contrast, depth = [], []
    for smokes in ((), (cloud(0.5),), (cloud(1.0),), (cloud(2.5),)):
        frame = View(hall(bricks, smokes=smokes)).frame()
        contrast.append(centre(frame.rgb.astype(float).mean(axis=2)).std())
        depth.append(float(np.nanmean(centre(frame.depth_m))))
    assert contrast[0] > contrast[1] > contrast[2] > contrast[3]
    assert contrast[3] < 0.3 * contrast[0]
    assert depth[0] >= depth[1] > depth[2] > depth[3] - 0.2
    assert 2.0 < depth[3] < 3.3


@pytest.mark.long
def test_smoke_looks_the_same_whether_toxic_or_not() -> None:
    toxic = cloud(2.0)
    safe = Smoke(id="smoke", extent_m=toxic.extent_m, toxic=False)
    a, b = (View(hall(WALL, smokes=(s,))).frame() for s in (toxic, safe))
    assert np.array_equal(a.rgb, b.rgb)
    assert np.array_equal(a.depth_m, b.depth_m, equal_nan=True)


@pytest.mark.long
def test_fire_is_bright_orange_and_returns_from_its_flames() -> None:
    fire = Solid(id="fire", kind="fire", extent_m=Box(lo_m=(3.4, 3.4, 0.0), hi_m=(4.6, 4.6, 1.5)))
    frame = View(hall(WALL, fire), eye_m=(1.0, 4.0, 0.8)).frame(2.0)
    red, green, blue = (frame.rgb[..., i].astype(int) for i in range(3))
    flames = (red > 200) & (red > green + 20) & (green > blue + 40)
    assert 500 < flames.sum() < 20000
    assert 2.4 < np.nanmedian(frame.depth_m[flames]) < 3.6


@pytest.mark.long
def test_a_pane_mirrors_from_afar_and_shows_the_room_from_near() -> None:
    room = ClosedRoom(
        id="room",
        extent_m=Box(lo_m=(5.0, 2.5, 0.0), hi_m=(8.0, 5.5, 2.6)),
        door_m=Box(lo_m=(5.02, 3.55, 0.0), hi_m=(5.1, 4.45, 2.05)),
        viewpoint_m=(3.8, 4.0, 1.4),
        occupant=Person(id="inside", position_m=(6.9, 4.0, 0.0), yaw_rad=np.pi / 2),
    )
    far = View(hall(rooms=(room,)), eye_m=(1.5, 4.0, 1.4)).frame()
    near = View(hall(rooms=(room,)), eye_m=room.viewpoint_m).frame()
    assert np.nanmedian(far.depth_m[116:124, 156:164]) == pytest.approx(5.06 - 1.5, abs=0.1)
    assert np.nanmedian(near.depth_m[116:124, 156:164]) == pytest.approx(8.0 - 0.12 - 3.8, abs=0.1)


def test_pictures_for_people_and_unknown_cameras() -> None:
    view = View(hall(WALL))
    with view.renderer as renderer:
        picture = renderer.picture(view.data, "overview", 200, 120)
        plan = renderer.picture(view.data, "plan", 200, 120)
        assert picture.shape == plan.shape == (120, 200, 3)
        assert picture.std() > 5.0
        assert plan.std() > 5.0
        with pytest.raises(UnknownNameError, match="overview"):
            renderer.picture(view.data, "overvew")
    view.renderer.close()
