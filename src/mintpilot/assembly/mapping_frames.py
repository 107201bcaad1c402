"""Pictures into one map, without a flight."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from mintpilot.core.geometry import Floats, GridFrame
from mintpilot.core.observation import Frame
from mintpilot.core.plan import VehicleLimits
from mintpilot.core.ports import Perception
from mintpilot.core.semantic_map import SemanticMap
from mintpilot.mapping.builder import MapBuilder
from mintpilot.mapping.settings import MappingSettings

REACH_M = 8.0
"""Depth beyond this places no surface."""
ROUND_M = 0.5
"""The lattice reaches so far around what was seen and where it was seen from."""
CELLS = 4_000_000
"""The lattice is made coarser until it has no more cells."""
FINEST_M = 0.05
START_M = 0.45
"""So much space around the camera is known free: the camera was there."""


def mapped(frames: list[Frame], perception: Perception, floor_m: float) -> SemanticMap:
    """The map of all frames.

    Args:
        frames: one or more, in the world frame.
        perception: makes objects of them.
        floor_m: height of the floor, metres.
    """
    lattice = lattice_of(frames)
    settings = MappingSettings()
    few = len(frames) < 4
    builder = MapBuilder(
        lattice,
        limits=VehicleLimits(),
        volume=lattice.box,
        settings=replace(
            settings,
            max_range_m=REACH_M,
            sure_score=0.5 if few else settings.sure_score,
            viewpoint_height_m=settings.viewpoint_height_m + floor_m,
        ),
    )
    for index, frame in enumerate(frames):
        builder.integrate(frame, perception.detect(frame, index))
    builder.mark_flown(np.array([f.world_from_camera[:3, 3] for f in frames]), START_M)
    return builder.snapshot()


def lattice_of(frames: list[Frame]) -> GridFrame:
    """A lattice around all that is seen within reach, and around where it was seen from."""
    corners = [np.stack([f.world_from_camera[:3, 3] for f in frames])]
    for frame in frames:
        points = _sampled(frame)
        if len(points):
            corners.append(np.percentile(points, (0.5, 99.5), axis=0))
    places = np.concatenate(corners)
    lo, hi = places.min(axis=0) - ROUND_M, places.max(axis=0) + ROUND_M
    resolution = FINEST_M
    while np.prod(np.ceil((hi - lo) / resolution)) > CELLS:
        resolution *= 1.25
    shape = np.ceil((hi - lo) / resolution).astype(int)
    return GridFrame(
        origin_m=(float(lo[0]), float(lo[1]), float(lo[2])),
        resolution_m=float(resolution),
        shape=(int(shape[2]), int(shape[1]), int(shape[0])),
    )


def _sampled(frame: Frame) -> Floats:
    step, lens = max(1, frame.camera.width // 80), frame.camera
    v, u = np.mgrid[0 : lens.height : step, 0 : lens.width : step]
    z = np.nan_to_num(frame.depth_m[v, u]).astype(float)
    kept = (z > 0) & (z < REACH_M)
    u, v, z = u[kept] + 0.5, v[kept] + 0.5, z[kept]
    points = np.stack([(u - lens.cx) / lens.fx * z, (v - lens.cy) / lens.fy * z, z], axis=1)
    moved: Floats = points @ frame.world_from_camera[:3, :3].T + frame.world_from_camera[:3, 3]
    return moved
