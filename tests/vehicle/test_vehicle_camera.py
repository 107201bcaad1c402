"""The camera of a real vehicle: pictures of a frame source, where they say they are or where the vehicle is."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mintpilot.assembly.vehicle_camera import MOUNT_M, VehicleCamera, world_from_body
from mintpilot.core.errors import DeviceError
from mintpilot.core.observation import CameraModel, RawFrame
from mintpilot.core.trajectory import VehicleState

HERE = VehicleState(time_s=7.0, position_m=(2.0, 3.0, 1.5), velocity_mps=(0.0, 0.0, 0.0), yaw_rad=math.pi / 2)
LENS = CameraModel(width=4, height=3, fx=4.0, fy=4.0, cx=2.0, cy=1.5)


class Source:
    """One picture with that pose."""

    z_is_up = True

    def __init__(self, pose: np.ndarray | None) -> None:
        self._pose = pose

    def frames(self) -> Iterator[RawFrame]:
        yield RawFrame(
            time_s=99.0, rgb=np.zeros((3, 4, 3), np.uint8), depth_m=np.ones((3, 4), np.float32), camera=LENS,
            source_from_camera=self._pose,
        )  # fmt: skip

    def remarks(self) -> tuple[str, ...]:
        return ()


def test_a_picture_without_a_pose_is_where_the_vehicle_is_and_looks_where_its_nose_points():
    frame = VehicleCamera(Source(None), lambda: HERE).capture()
    assert frame.time_s == 7.0
    assert frame.world_from_camera[:3, 3] == pytest.approx((2.0, 3.0 + MOUNT_M, 1.5))
    right, down, ahead = frame.world_from_camera[:3, :3].T
    assert ahead == pytest.approx((0.0, 1.0, 0.0), abs=1e-9)
    assert right == pytest.approx((1.0, 0.0, 0.0), abs=1e-9)
    assert down == pytest.approx((0.0, 0.0, -1.0), abs=1e-9)


def test_a_picture_with_a_pose_is_where_it_says():
    pose = np.eye(4)
    pose[:3, 3] = (9.0, 8.0, 7.0)
    assert VehicleCamera(Source(pose), lambda: HERE).capture().world_from_camera == pytest.approx(pose)


def test_a_nose_that_is_up_looks_up_and_a_roll_to_the_right_brings_the_right_side_down():
    up = VehicleCamera(Source(None), lambda: HERE, lambda: (0.0, 0.3)).capture()
    assert up.world_from_camera[2, 2] == pytest.approx(math.sin(0.3))
    rolled = VehicleCamera(Source(None), lambda: HERE, lambda: (0.3, 0.0)).capture()
    assert rolled.world_from_camera[2, 0] == pytest.approx(-math.sin(0.3))


@given(roll=st.floats(-1, 1), pitch=st.floats(-1, 1), yaw=st.floats(-4, 4))
def test_a_pose_is_a_rigid_motion(roll: float, pitch: float, yaw: float):
    state = VehicleState(time_s=0.0, position_m=(0.0, 0.0, 1.0), velocity_mps=(0.0, 0.0, 0.0), yaw_rad=yaw)
    turn = world_from_body(state, roll, pitch)[:3, :3]
    assert turn @ turn.T == pytest.approx(np.eye(3), abs=1e-9)
    assert np.linalg.det(turn) == pytest.approx(1.0)


def test_a_camera_that_ends_or_errs_is_gone():
    camera = VehicleCamera(Source(None), lambda: HERE)
    camera.capture()
    with pytest.raises(DeviceError, match="no more pictures after 1"):
        camera.capture()
    scaled = np.diag([2.0, 2.0, 2.0, 1.0])
    with pytest.raises(DeviceError, match="cannot be used"):
        VehicleCamera(Source(scaled), lambda: HERE).capture()
