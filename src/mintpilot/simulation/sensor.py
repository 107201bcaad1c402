"""The depth sensor's faults: noise that grows with the square of the distance, holes, a limited range."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mintpilot.core.compiled import compiled

_Grid = NDArray[np.float32]


@dataclass(frozen=True, slots=True, kw_only=True)
class SensorSettings:
    """How bad the depth sensor is; the defaults are those of a stereo camera of 2020s make."""

    noise_m: float = 0.003
    """Standard deviation close by, metres."""
    noise_per_m: float = 0.0008
    """Added standard deviation per square metre of distance: 5 cm at 8 m."""
    range_m: float = 12.0
    """Nothing comes back from farther away, metres."""
    near_m: float = 0.25
    """Nothing comes back from nearer, metres."""
    steepest: float = 7.0
    """Slope of a surface against the picture plane, 7 being 82 degrees, beyond which returns get lost."""
    steep_loss: float = 0.85
    """Share of the returns lost there, and at the edges of things."""
    random_loss: float = 0.004
    """Share of returns lost anywhere."""


def corrupt(depth_m: _Grid, *, focal_px: float, settings: SensorSettings, rng: np.random.Generator) -> _Grid:
    """What the sensor returns instead of the true depth.

    Args:
        depth_m: true distance along the optical axis (height, width), metres.
        focal_px: focal length, pixels.
        settings: the sensor.
        rng: decides noise and losses.

    Returns:
        Depth (height, width), metres; NaN where nothing comes back.
    """
    normal = rng.standard_normal(depth_m.shape, dtype=np.float32)
    chance = rng.random(depth_m.shape, dtype=np.float32)
    s = settings
    faulty: _Grid = _corrupt(
        depth_m,
        normal,
        chance,
        focal_px,
        s.noise_m,
        s.noise_per_m,
        s.range_m,
        s.near_m,
        s.steepest,
        s.steep_loss,
        s.random_loss,
    )
    return faulty


@compiled()
def _corrupt(
    depth: _Grid,
    normal: _Grid,
    chance: _Grid,
    focal: float,
    noise: float,
    growth: float,
    reach: float,
    near: float,
    steepest: float,
    steep_loss: float,
    random_loss: float,
) -> _Grid:
    height, width = depth.shape
    out = np.empty((height, width), np.float32)
    for v in range(height):
        for u in range(width):
            z = depth[v, u]
            left, right = depth[v, max(u - 1, 0)], depth[v, min(u + 1, width - 1)]
            up, down = depth[max(v - 1, 0), u], depth[min(v + 1, height - 1), u]
            step = max(max(abs(left - z), abs(right - z)), max(abs(up - z), abs(down - z)))
            loss = steep_loss if step * focal > steepest * z else random_loss
            if not (near <= z <= reach) or chance[v, u] < loss:
                out[v, u] = np.nan
            else:
                out[v, u] = z + normal[v, u] * (noise + growth * z * z)
    return out
