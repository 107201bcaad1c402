"""The camera of a real vehicle: the next picture of a frame source is the present view."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Final

import numpy as np

from mintpilot.assembly.sources import open_source
from mintpilot.core.errors import DeviceError, MapError
from mintpilot.core.geometry import Floats
from mintpilot.core.observation import Frame
from mintpilot.core.ports import Camera, FrameSource, SourceOptions
from mintpilot.core.trajectory import VehicleState
from mintpilot.frames.checks import checked_pose

ENDLESS: Final = 10**9
MOUNT_M: Final = 0.1
"""So far ahead of the vehicle's middle a camera without poses sits, metres; it looks ahead."""
BODY_FROM_CAMERA: Final = ((0.0, 0.0, 1.0, MOUNT_M), (-1.0, 0.0, 0.0, 0.0), (0.0, -1.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))
"""The camera's optical frame (x right, y down, z ahead) in the body's (x ahead, y left, z up)."""


class VehicleCamera(Camera):
    """Takes the next picture of a frame source whenever the mission wants one.

    A picture that comes with a pose is where it says, in the map's frame; one without is where the vehicle is now.

    Args:
        source: gives pictures one by one, as they are taken.
        state: where the vehicle is.
        tilt: its roll and pitch, radians, as autopilots count them: to the right and nose up.
    """

    def __init__(
        self,
        source: FrameSource,
        state: Callable[[], VehicleState],
        tilt: Callable[[], tuple[float, float]] = lambda: (0.0, 0.0),
    ) -> None:
        self._frames, self._state, self._tilt = iter(source.frames()), state, tilt
        self._count = 0

    def capture(self) -> Frame:
        """See `Camera.capture`. Raises `DeviceError` when pictures end, or one cannot be used."""
        try:
            raw = next(self._frames)
            self._count += 1
            state = self._state()
            here = world_from_body(state, *self._tilt()) @ np.asarray(BODY_FROM_CAMERA)
            posed = raw.source_from_camera
            return Frame(
                time_s=state.time_s,
                rgb=raw.rgb,
                depth_m=raw.depth_m,
                camera=raw.camera,
                world_from_camera=here if posed is None else checked_pose(posed, self._count),
            )
        except StopIteration:
            raise DeviceError(f"the camera gives no more pictures after {self._count}") from None
        except MapError as error:
            raise DeviceError(f"the camera's picture cannot be used: {error}") from None


def live_camera(
    where: str, state: Callable[[], VehicleState], tilt: Callable[[], tuple[float, float]] | None
) -> VehicleCamera:
    """The camera of that name; see `open_source` for names and errors."""
    source = open_source(where, SourceOptions(longest=ENDLESS, live=True))
    return VehicleCamera(source, state) if tilt is None else VehicleCamera(source, state, tilt)


def world_from_body(state: VehicleState, roll_rad: float, pitch_rad: float) -> Floats:
    """Pose (4, 4) of a body that points ahead, left and up, on the map."""
    cr, sr, cp, sp = math.cos(roll_rad), math.sin(roll_rad), math.cos(-pitch_rad), math.sin(-pitch_rad)
    cy, sy = math.cos(state.yaw_rad), math.sin(state.yaw_rad)
    yaw = np.array([[cy, -sy, 0.0], [sy, cy, 0.0], [0.0, 0.0, 1.0]])
    pitch = np.array([[cp, 0.0, sp], [0.0, 1.0, 0.0], [-sp, 0.0, cp]])
    roll = np.array([[1.0, 0.0, 0.0], [0.0, cr, -sr], [0.0, sr, cr]])
    pose: Floats = np.eye(4)
    pose[:3, :3] = yaw @ pitch @ roll
    pose[:3, 3] = state.position_m
    return pose
