"""One frame with everything that is measured pixel by pixel."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import uniform_filter

from mintpilot.core.geometry import Bools, Floats
from mintpilot.core.observation import Frame
from mintpilot.perception.settings import PerceptionSettings

Singles = NDArray[np.float32]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class View:
    """Pixel-wise measurements of one frame, each (h, w) unless said otherwise."""

    frame: Frame
    points_m: Singles
    """World points (h, w, 3); meaningless where not ``valid``."""
    depth_m: Singles
    """Depth with 0 where there is none."""
    valid: Bools
    """Where the sensor got a return."""
    sigma_m: Singles
    """Expected standard deviation of the depth."""
    hue: Singles
    """Degrees, 0 red, 120 green, 240 blue."""
    saturation: Singles
    """0 to 1."""
    value: Singles
    """Brightest channel, 0 to 255."""


def look_at(frame: Frame, settings: PerceptionSettings) -> View:
    """Back-projects a frame and measures its colours."""
    depth = np.nan_to_num(frame.depth_m, nan=0.0, posinf=0.0, neginf=0.0).astype(np.float32)
    valid: Bools = (depth > 0.05) & (depth < settings.furthest_m)
    depth = np.where(valid, depth, np.float32(0))
    lens = frame.camera
    x = ((np.arange(lens.width, dtype=np.float32) + 0.5 - lens.cx) / lens.fx)[None, :] * depth
    y = ((np.arange(lens.height, dtype=np.float32) + 0.5 - lens.cy) / lens.fy)[:, None] * depth
    pose = frame.world_from_camera.astype(np.float32)
    points = np.stack([x, y, depth], axis=-1) @ pose[:3, :3].T + pose[:3, 3]
    hue, saturation, value = hue_saturation_value(frame.rgb)
    return View(
        frame=frame,
        points_m=points.astype(np.float32),
        depth_m=depth,
        valid=valid,
        sigma_m=(settings.noise_m + settings.noise_per_m * depth * depth).astype(np.float32),
        hue=hue,
        saturation=saturation,
        value=value,
    )


def hue_saturation_value(rgb: NDArray[np.uint8]) -> tuple[Singles, Singles, Singles]:
    """Hue in degrees, saturation from 0 to 1, value from 0 to 255, of colours (…, 3)."""
    red, green, blue = (rgb[..., i].astype(np.float32) for i in range(3))
    top, bottom = np.maximum(np.maximum(red, green), blue), np.minimum(np.minimum(red, green), blue)
    span = np.maximum(top - bottom, 1e-6)
    hue = np.where(
        top == red,
        ((green - blue) / span) % 6,
        np.where(top == green, (blue - red) / span + 2, (red - green) / span + 4),
    )
    return (
        (60 * hue).astype(np.float32),
        ((top - bottom) / np.maximum(top, 1)).astype(np.float32),
        top.astype(np.float32),
    )


def mean_around(values: Singles, where: Bools, width: int) -> Singles:
    """Mean of the values over the flagged pixels of a square window; 0 where none is flagged."""
    weight = uniform_filter(where.astype(np.float32), width, mode="constant")
    total = uniform_filter(np.where(where, values, np.float32(0)), width, mode="constant")
    mean: Singles = (total / np.maximum(weight, 1e-6)).astype(np.float32)
    return mean


def as_floats(points: Singles) -> Floats:
    """World points (n, 3) in double precision."""
    return np.asarray(points, np.float64).reshape(-1, 3)
