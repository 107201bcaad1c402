"""An exact renderer of boxes, so that what the map should say is known by construction."""

from __future__ import annotations

import math

import numpy as np

from mintpilot.core.geometry import Box, Vec3
from mintpilot.core.observation import CameraModel, Frame

CAMERA = CameraModel(width=160, height=120, fx=110.0, fy=110.0, cx=80.0, cy=60.0)


def pose(eye: Vec3, yaw_rad: float, pitch_down_rad: float = 0.0) -> np.ndarray:
    """World from camera (4, 4), optical frame, looking along yaw and that much below the horizon."""
    forward = np.array(
        [
            math.cos(yaw_rad) * math.cos(pitch_down_rad),
            math.sin(yaw_rad) * math.cos(pitch_down_rad),
            -math.sin(pitch_down_rad),
        ]
    )
    right = np.array([math.sin(yaw_rad), -math.cos(yaw_rad), 0.0])
    matrix = np.eye(4)
    matrix[:3, 0], matrix[:3, 1], matrix[:3, 2], matrix[:3, 3] = right, np.cross(forward, right), forward, eye
    return matrix


def see(room: Box, solids: list[Box], world_from_camera: np.ndarray, camera: CameraModel = CAMERA) -> Frame:
    """What a perfect depth camera inside a hollow room with solid boxes sees."""
    u, v = np.meshgrid(np.arange(camera.width) + 0.5, np.arange(camera.height) + 0.5)
    rays = np.stack([(u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, np.ones_like(u)], -1)
    rays = rays @ world_from_camera[:3, :3].T
    rays = np.where(np.abs(rays) < 1e-12, 1e-12, rays)
    eye = world_from_camera[:3, 3]
    depth = np.max(np.stack([(np.asarray(room.lo_m) - eye) / rays, (np.asarray(room.hi_m) - eye) / rays]), 0).min(-1)
    for solid in solids:
        ends = np.stack([(np.asarray(solid.lo_m) - eye) / rays, (np.asarray(solid.hi_m) - eye) / rays])
        near, far = ends.min(0).max(-1), ends.max(0).min(-1)
        depth = np.where((near < far) & (near > 0), np.minimum(depth, near), depth)
    return Frame(
        time_s=0.0,
        rgb=np.full((camera.height, camera.width, 3), 120, np.uint8),
        depth_m=depth.astype(np.float32),
        camera=camera,
        world_from_camera=world_from_camera,
    )
