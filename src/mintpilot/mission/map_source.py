"""Where the map comes from: what turns the present view into a newer one."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Protocol

from mintpilot.core.events import FrameSeen, Timed
from mintpilot.core.geometry import Floats
from mintpilot.core.ports import Camera, Perception, Recorder
from mintpilot.core.semantic_map import SemanticMap

if TYPE_CHECKING:
    from mintpilot.mapping.builder import MapBuilder


class MapSource(Protocol):
    """Keeps the map up to date. Called by the loop: before the survey, at the camera's rate in flight, at stops."""

    def look(self) -> None:
        """Takes in the present view. Raises `DeviceError` when the camera is gone."""
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
        builder: gathers what was seen; whoever has one that has seen the same world may put it here.
    """

    def __init__(self, *, camera: Camera, perception: Perception, builder: MapBuilder, recorder: Recorder) -> None:
        self._camera = camera
        self._perception = perception
        self.builder = builder
        self._recorder = recorder
        self._count = 0

    def look(self) -> None:
        """See `MapSource.look`."""
        frame = self._camera.capture()
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
