"""How a mission sees: something that turns the present view into a newer map."""

from __future__ import annotations

import time
from typing import Protocol

from mintpilot.core.events import FrameSeen, Timed
from mintpilot.core.geometry import Floats
from mintpilot.core.ports import Camera, Perception, Recorder
from mintpilot.core.semantic_map import SemanticMap
from mintpilot.mapping.builder import MapBuilder


class Eyes(Protocol):
    """Keeps the map up to date. Called on the ground, at the camera's rate in flight, and at every stop."""

    def look(self, previous: SemanticMap | None) -> SemanticMap:
        """The map after the present view; knowledge and names are carried over from ``previous``."""
        ...

    def flown(self, points_m: Floats, radius_m: float) -> None:
        """The vehicle has been at these points (n, 3) without touching anything: they are free."""
        ...


class CameraEyes:
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

    def glance(self) -> None:
        """Takes in the present view without drawing up a map of it: cheaper than `look`."""
        frame = self._camera.capture()
        begun = time.perf_counter()
        detections = self._perception.detect(frame, self._count)
        seen = time.perf_counter()
        self.builder.integrate(frame, detections)
        self._recorder.record(FrameSeen(index=self._count, frame=frame, detections=detections))
        self._recorder.record(Timed(stage="perception", seconds=seen - begun))
        self._recorder.record(Timed(stage="mapping", seconds=time.perf_counter() - seen))
        self._count += 1

    def look(self, previous: SemanticMap | None) -> SemanticMap:
        """See `Eyes.look`."""
        self.glance()
        return self.redraw(previous)

    def redraw(self, previous: SemanticMap | None) -> SemanticMap:
        """The map of all that was taken in so far."""
        begun = time.perf_counter()
        newer = self.builder.snapshot(previous)
        self._recorder.record(Timed(stage="mapping", seconds=time.perf_counter() - begun))
        return newer

    def flown(self, points_m: Floats, radius_m: float) -> None:
        """See `Eyes.flown`."""
        self.builder.mark_flown(points_m, radius_m)


class FixedEyes:
    """For a map that was given and does not change."""

    def __init__(self, given: SemanticMap) -> None:
        self._given = given

    def look(self, previous: SemanticMap | None) -> SemanticMap:
        """See `Eyes.look`."""
        return self._given if previous is None else previous

    def flown(self, points_m: Floats, radius_m: float) -> None:
        """See `Eyes.flown`; a given map learns nothing from it."""
