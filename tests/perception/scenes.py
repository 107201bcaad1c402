"""Worlds to look at: an exact renderer without any simulator, and scenes for the real one."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from mintpilot.core.observation import CameraModel, Frame

CAMERA = CameraModel(width=320, height=240, fx=216.0, fy=216.0, cx=160.0, cy=120.0)
Colour = tuple[float, float, float]


@dataclass(frozen=True, slots=True, kw_only=True)
class Block:
    """A painted box."""

    lo_m: tuple[float, float, float]
    hi_m: tuple[float, float, float]
    colour: Colour


def pose(eye: tuple[float, float, float], yaw_rad: float, pitch_down_rad: float) -> np.ndarray:
    """World from camera (4, 4), optical frame."""
    level = math.cos(pitch_down_rad)
    forward = np.array([math.cos(yaw_rad) * level, math.sin(yaw_rad) * level, -math.sin(pitch_down_rad)])
    right = np.array([math.sin(yaw_rad), -math.cos(yaw_rad), 0.0])
    matrix = np.eye(4)
    matrix[:3, 0], matrix[:3, 1], matrix[:3, 2], matrix[:3, 3] = right, np.cross(forward, right), forward, eye
    return matrix


def picture(
    blocks: list[Block],
    *,
    eye: tuple[float, float, float] = (0.0, 0.0, 1.6),
    pitch_rad: float = 0.35,
    light: Colour = (1.0, 1.0, 1.0),
    seed: int = 0,
) -> Frame:
    """A hall 10 m wide, grey, with painted blocks, lit from above and in front, with sensor noise."""
    world = pose(eye, 0.0, pitch_rad)
    lens = CAMERA
    u, v = np.meshgrid(np.arange(lens.width) + 0.5, np.arange(lens.height) + 0.5)
    rays = np.stack([(u - lens.cx) / lens.fx, (v - lens.cy) / lens.fy, np.ones_like(u)], -1) @ world[:3, :3].T
    rays = np.where(np.abs(rays) < 1e-9, 1e-9, rays)
    start = world[:3, 3]
    ends = np.stack([(np.array([-5.0, -5.0, 0.0]) - start) / rays, (np.array([9.0, 5.0, 4.0]) - start) / rays])
    leave = ends.max(0)
    depth, face = leave.min(-1), leave.argmin(-1)
    rng = np.random.default_rng(seed)
    shade = np.array([0.75, 0.65, 1.0])
    rgb = np.full((*depth.shape, 3), 125.0) * shade[face][..., None]
    for block in blocks:
        ends = np.stack([(np.asarray(block.lo_m) - start) / rays, (np.asarray(block.hi_m) - start) / rays])
        near, far = ends.min(0), ends.max(0).min(-1)
        first, side = near.max(-1), near.argmax(-1)
        met = (first > 0) & (first < far) & (first < depth)
        depth = np.where(met, first, depth)
        painted = 255 * np.asarray(block.colour) * shade[side][..., None]
        rgb = np.where(met[..., None], painted, rgb)
    rgb = np.clip(rgb * np.asarray(light) + rng.normal(0, 2.0, rgb.shape), 0, 255).astype(np.uint8)
    noisy = depth + rng.normal(0, 1, depth.shape) * (0.003 + 0.0008 * depth**2)
    return Frame(time_s=0.0, rgb=rgb, depth_m=noisy.astype(np.float32), camera=lens, world_from_camera=world)
