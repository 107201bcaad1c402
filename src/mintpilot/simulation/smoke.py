"""Smoke and flames, marched as volumes over a picture and its metric depth (Beer-Lambert).

Along each ray the cloud absorbs what is behind it and scatters some light of its own; light from a fire tints it.
An active depth sensor gets its return from inside the cloud, where the optical depth passes
`smoke_kernels.SENSOR_TAU`, as in real smoke. The look of a cloud does not depend on whether it is toxic.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from mintpilot.core.geometry import Box, Floats, Vec3
from mintpilot.simulation.scene import Scene
from mintpilot.simulation.smoke_kernels import march_flame, march_smoke

_NOISE_CELLS = 64
_Grid = NDArray[np.float32]


@dataclass(frozen=True, slots=True, kw_only=True)
class Volume:
    """One cloud or one fire, ready for marching."""

    box: Box
    flame: bool
    glow_m: Vec3
    """Where the light that tints it comes from."""
    glow: float
    """Strength of that light, 0 for none."""
    offset: float
    """Shift into the noise, so that no two volumes look alike."""


def volumes_of(scene: Scene) -> tuple[Volume, ...]:
    """The clouds and flames of a scene; each cloud is tinted by the nearest fire."""
    fires = [s for s in scene.solids if s.kind == "fire"]
    volumes = []
    for index, smoke in enumerate(scene.smokes):
        centre = np.asarray(smoke.extent_m.centre_m)
        near = min(fires, key=lambda f: float(np.linalg.norm(f.extent_m.centre_m - centre)), default=None)
        glow_m = near.extent_m.centre_m if near else smoke.extent_m.centre_m
        offset = 7.3 * index + 1.7 * (scene.seed % 97)
        volumes.append(Volume(box=smoke.extent_m, flame=False, glow_m=glow_m, glow=1.0 if near else 0.0, offset=offset))
    for index, fire in enumerate(fires):
        offset = 3.1 * index + 0.9 * (scene.seed % 89)
        volumes.append(Volume(box=fire.extent_m, flame=True, glow_m=fire.extent_m.centre_m, glow=0.0, offset=offset))
    return tuple(volumes)


@cache
def _noise() -> _Grid:
    """Periodic cloud density (64, 64, 64), mean about 0.6, never below 0."""
    n = _NOISE_CELLS
    k = np.fft.fftfreq(n) * n
    radius = np.sqrt(k[:, None, None] ** 2 + k[None, :, None] ** 2 + k[None, None, :] ** 2)
    radius[0, 0, 0] = 1.0
    field = np.fft.fftn(np.random.default_rng(0).standard_normal((n, n, n))) * radius**-1.7
    field[0, 0, 0] = 0.0
    value = np.real(np.fft.ifftn(field))
    density: _Grid = np.clip(0.6 + 0.4 * value / value.std(), 0.0, 2.0).astype(np.float32)
    return density


@cache
def _jitter() -> _Grid:
    """Where in a step each ray of a 32 x 32 tile samples: hides the steps."""
    return np.random.default_rng(1).random((32, 32)).astype(np.float32)


def march(
    rgb: NDArray[np.uint8],
    depth_m: NDArray[np.float32],
    sensed_m: NDArray[np.float32],
    volume: Volume,
    *,
    world_from_camera: Floats,
    focal_px: float,
    time_s: float,
) -> None:
    """Draws one volume over a picture, in place.

    Args:
        rgb: colours (height, width, 3).
        depth_m: true distance of the surface behind, along the optical axis (height, width).
        sensed_m: what the depth sensor would return so far (height, width); lowered where the cloud returns earlier.
        volume: what to draw.
        world_from_camera: pose of the optical frame (4, 4).
        focal_px: focal length, pixels; the principal point is the middle of the picture.
        time_s: drives the drift of smoke and the flicker of flames.
    """
    kernel = march_flame if volume.flame else march_smoke
    pose = np.ascontiguousarray(world_from_camera, dtype=np.float64)
    kernel(
        rgb,
        depth_m,
        sensed_m,
        pose,
        focal_px,
        np.asarray(volume.box.lo_m, float),
        np.asarray(volume.box.hi_m, float),
        np.asarray(volume.glow_m, float),
        volume.glow,
        volume.offset,
        time_s,
        _noise(),
        _jitter(),
    )
