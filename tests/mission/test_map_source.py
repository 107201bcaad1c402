"""Pictures become a map; one that stands still while the drone moves does not."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mintpilot.core.errors import DeviceError
from mintpilot.core.observation import CameraModel, Frame
from mintpilot.mission.map_source import STILL_M, STILL_RAD, CameraMapSource
from mintpilot.recording.recorders import NullRecorder

LENS = CameraModel(width=8, height=6, fx=8.0, fy=8.0, cx=4.0, cy=3.0)


class Pictures:
    """A camera that shows what it is told, from where it is told."""

    def __init__(self) -> None:
        self.seed, self.x_m, self.yaw_rad = 0, 0.0, 0.0

    def capture(self) -> Frame:
        rng = np.random.default_rng(self.seed)
        c, s = math.cos(self.yaw_rad), math.sin(self.yaw_rad)
        pose = np.array([[c, -s, 0, self.x_m], [s, c, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1.0]])
        depth = rng.uniform(1, 3, (6, 8)).astype(np.float32)
        depth[0, 0] = np.nan
        rgb = rng.integers(0, 255, (6, 8, 3), np.uint8)
        return Frame(time_s=0.0, rgb=rgb, depth_m=depth, camera=LENS, world_from_camera=pose)


class Builder:
    """Counts what it takes in."""

    taken = 0

    def integrate(self, frame: Frame, detections: object) -> None:
        self.taken += 1


class Blind:
    """Perceives nothing."""

    def detect(self, frame: Frame, index: int) -> tuple[()]:
        return ()


@pytest.fixture
def source() -> CameraMapSource:
    return CameraMapSource(camera=Pictures(), perception=Blind(), builder=Builder(), recorder=NullRecorder())  # type: ignore[arg-type]


@pytest.mark.parametrize(("x_m", "yaw_rad"), [(1.5 * STILL_M, 0.0), (0.0, 1.5 * STILL_RAD)])
def test_a_picture_that_stands_still_while_the_camera_moves_is_not_taken_in(source, x_m, yaw_rad) -> None:
    source.look()
    source.camera.x_m, source.camera.yaw_rad = x_m / 2, yaw_rad / 2
    source.look()  # hovering, and noise
    source.camera.x_m, source.camera.yaw_rad = x_m, yaw_rad
    with pytest.raises(DeviceError, match="stands still"):
        source.look()
    assert source.builder.taken == 2
    source.camera.seed = 1  # it shows something new: all is well again
    source.look()
    assert source.builder.taken == 3


def test_a_camera_that_is_still_may_show_the_same(source) -> None:
    for _ in range(3):
        source.look()
    assert source.builder.taken == 3
