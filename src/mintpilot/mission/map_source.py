"""Where the map comes from: what turns the present view into a newer one."""

from __future__ import annotations

import math
import time
from typing import TYPE_CHECKING, Protocol

import numpy as np
from numpy.typing import NDArray

from mintpilot.core.errors import DeviceError
from mintpilot.core.events import FrameSeen, Timed
from mintpilot.core.geometry import Floats
from mintpilot.core.observation import Frame
from mintpilot.core.ports import Camera, Perception, Recorder
from mintpilot.core.semantic_map import SemanticMap

if TYPE_CHECKING:
    from mintpilot.mapping.builder import MapBuilder


STILL_M, STILL_RAD = 0.1, 0.1
"""A picture that stays the same to the last bit while the camera is moved or turned by this much stands still."""


class MapSource(Protocol):
    """Keeps the map up to date. Called by the loop: before the survey, at the camera's rate in flight, at stops."""

    def look(self) -> None:
        """Takes in the present view. Raises `DeviceError` when the camera is gone, or its picture stands still."""
        ...

    def draw(self, previous: SemanticMap | None) -> SemanticMap:
        """The map of all that was taken in; knowledge and names are carried over from ``previous``."""
        ...

    def flown(self, points_m: Floats, radius_m: float) -> None:
        """The vehicle has been at these points (n, 3), metres, without touching anything: they are free."""
        ...


class CameraMapSource(MapSource):
    """Picture → detections → voxels.

    Attributes:
        camera: takes the pictures; whoever tries faults out may put another one here.
        builder: gathers what was seen; whoever has one that has seen the same world may put it here.
    """

    def __init__(self, *, camera: Camera, perception: Perception, builder: MapBuilder, recorder: Recorder) -> None:
        self.camera = camera
        self._perception = perception
        self.builder = builder
        self._recorder = recorder
        self._count = 0
        self._since: Frame | None = None

    def look(self) -> None:
        """See `MapSource.look`."""
        frame = self.camera.capture()
        self._check(frame)
        begun = time.perf_counter()
        detections = self._perception.detect(frame, self._count)
        seen = time.perf_counter()
        self.builder.integrate(frame, detections)
        self._recorder.record(FrameSeen(index=self._count, frame=frame, detections=detections))
        self._recorder.record(Timed(stage="perception", seconds=seen - begun))
        self._recorder.record(Timed(stage="mapping", seconds=time.perf_counter() - seen))
        self._count += 1

    def draw(self, previous: SemanticMap | None) -> SemanticMap:
        """See `MapSource.draw`."""
        begun = time.perf_counter()
        newer = self.builder.snapshot(previous)
        self._recorder.record(Timed(stage="mapping", seconds=time.perf_counter() - begun))
        return newer

    def flown(self, points_m: Floats, radius_m: float) -> None:
        """See `MapSource.flown`."""
        self.builder.mark_flown(points_m, radius_m)

    def _check(self, frame: Frame) -> None:
        """Refuses a picture that stands still: drawn from where the camera is now, it would show walls as free."""
        since = self._since
        if since is None or not (_same(frame.depth_m, since.depth_m) and _same(frame.rgb, since.rgb)):
            self._since = frame
            return
        moved = np.linalg.inv(since.world_from_camera) @ frame.world_from_camera
        turned = math.acos(min(1.0, max(-1.0, (float(np.trace(moved[:3, :3])) - 1) / 2)))
        if float(np.linalg.norm(moved[:3, 3])) > STILL_M or turned > STILL_RAD:
            raise DeviceError("the camera's picture stands still while the drone moves: see to the camera")


def _same(one: NDArray[np.generic], other: NDArray[np.generic]) -> bool:
    """Whether two arrays hold the same bytes."""
    return one.shape == other.shape and one.tobytes() == other.tobytes()


class GivenMap(MapSource):
    """A map that was given and does not change."""

    def __init__(self, given: SemanticMap) -> None:
        self._given = given

    def look(self) -> None:
        """There is nothing to see."""

    def draw(self, previous: SemanticMap | None) -> SemanticMap:
        """See `MapSource.draw`."""
        return self._given if previous is None else previous

    def flown(self, points_m: Floats, radius_m: float) -> None:
        """A given map learns nothing from it."""
