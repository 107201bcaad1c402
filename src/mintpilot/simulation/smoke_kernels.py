"""The compiled loops that march rays through smoke and flames; `smoke` says what they mean."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mintpilot.core.compiled import compiled
from mintpilot.core.geometry import Floats

SMOKE_EXTINCTION_PER_M = 2.4
"""At the mean density; 2 m of cloud let about 3 % of the light through."""
FLAME_EXTINCTION_PER_M = 8.0
SENSOR_TAU = 1.0
"""Optical depth from which the depth sensor gets its return."""
EDGE_M = 0.3
"""A cloud thins out over this distance from its sides; it reaches floor and roof."""
STEP_M = 0.12
"""Length of a step along a ray, metres, while the ray has no more than `MOST_STEPS` of them."""
MOST_STEPS = 28
_Grid = NDArray[np.float32]


@compiled(fastmath=True)
def _density(noise: _Grid, x: float, y: float, z: float) -> float:
    """Trilinear sample of the periodic noise; x, y, z in its cells."""
    n = noise.shape[0]
    fx, fy, fz = np.floor(x), np.floor(y), np.floor(z)
    ax, ay, az = x - fx, y - fy, z - fz
    i0, j0, k0 = int(fx) % n, int(fy) % n, int(fz) % n
    i1, j1, k1 = (i0 + 1) % n, (j0 + 1) % n, (k0 + 1) % n
    c00 = noise[i0, j0, k0] * (1 - ax) + noise[i1, j0, k0] * ax
    c10 = noise[i0, j1, k0] * (1 - ax) + noise[i1, j1, k0] * ax
    c01 = noise[i0, j0, k1] * (1 - ax) + noise[i1, j0, k1] * ax
    c11 = noise[i0, j1, k1] * (1 - ax) + noise[i1, j1, k1] * ax
    value: float = (c00 * (1 - ay) + c10 * ay) * (1 - az) + (c01 * (1 - ay) + c11 * ay) * az
    return value


@compiled(fastmath=True)
def _nearby(noise: _Grid, x: float, y: float, z: float) -> float:
    """Sample of the periodic noise without interpolation: for detail that jitter blurs anyway."""
    n = noise.shape[0]
    value: float = noise[int(np.floor(x)) % n, int(np.floor(y)) % n, int(np.floor(z)) % n]
    return value


@compiled(fastmath=True)
def _span(pose: Floats, d: Floats, lo: Floats, hi: Floats, far: float) -> tuple[float, float]:
    """Part of a ray inside a box, in units of depth along the axis; empty when the second is not above the first."""
    near = 0.02
    for a in range(3):
        if abs(d[a]) < 1e-9:
            if pose[a, 3] < lo[a] or pose[a, 3] > hi[a]:
                return 1.0, 0.0
            continue
        ta, tb = (lo[a] - pose[a, 3]) / d[a], (hi[a] - pose[a, 3]) / d[a]
        if ta > tb:
            ta, tb = tb, ta
        near, far = max(near, ta), min(far, tb)
    return near, far


@compiled(fastmath=True)
def march_smoke(
    rgb: NDArray[np.uint8],
    depth: _Grid,
    sensed: _Grid,
    pose: Floats,
    focal: float,
    lo: Floats,
    hi: Floats,
    glow_m: Floats,
    glow: float,
    offset: float,
    time: float,
    noise: _Grid,
    jitter: _Grid,
) -> None:
    """Draws smoke over the picture and lowers what the depth sensor returns, both in place."""
    height, width = depth.shape
    d = np.empty(3)
    for v in range(height):
        for u in range(width):
            cx, cy = (u + 0.5 - width / 2) / focal, (v + 0.5 - height / 2) / focal
            for a in range(3):
                d[a] = pose[a, 0] * cx + pose[a, 1] * cy + pose[a, 2]
            near, far = _span(pose, d, lo, hi, depth[v, u])
            if far <= near:
                continue
            metres = (far - near) * np.sqrt(d[0] ** 2 + d[1] ** 2 + d[2] ** 2)
            steps = min(MOST_STEPS, 3 + int(metres / STEP_M))
            step, metres = (far - near) / steps, metres / steps
            clear, tau, hit = 1.0, 0.0, -1.0
            r, g, b = 0.0, 0.0, 0.0
            for s in range(steps):
                t = near + (s + jitter[v & 31, u & 31]) * step
                x, y, z = pose[0, 3] + d[0] * t, pose[1, 3] + d[1] * t, pose[2, 3] + d[2] * t
                inside = min(min(x - lo[0], hi[0] - x), min(y - lo[1], hi[1] - y))
                if inside <= 0.0:
                    continue
                low, high = (z - lo[2]) / (hi[2] - lo[2]), 0.0
                wide = _density(noise, x * 2.6 + offset, y * 2.6 + 0.1 * time, (z - 0.2 * time) * 2.6)
                edge = (inside + 0.25 * (wide - 0.75)) / EDGE_M
                if edge <= 0.0:
                    continue
                fine = _nearby(noise, (x + 0.12 * time) * 9 + offset, (y + 0.05 * time) * 9, (z - 0.35 * time) * 9)
                thick = SMOKE_EXTINCTION_PER_M * (0.35 + 0.5 * fine + 0.6 * wide) * min(1.0, edge) * (0.75 + 0.4 * low)
                opaque = 1.0 - np.exp(-thick * metres)
                if glow > 0.0:
                    away = (x - glow_m[0]) ** 2 + (y - glow_m[1]) ** 2 + (z - glow_m[2]) ** 2
                    high = glow / (1.0 + 1.1 * away)
                shade = (0.72 + 0.28 * low) * (0.8 + 0.25 * wide)
                r += clear * opaque * (112.0 * shade + 330.0 * high)
                g += clear * opaque * (110.0 * shade + 150.0 * high)
                b += clear * opaque * (107.0 * shade + 40.0 * high)
                clear *= 1.0 - opaque
                tau += thick * metres
                if hit < 0.0 and tau > SENSOR_TAU:
                    hit = t
                if clear < 0.02:
                    break
            rgb[v, u, 0] = np.uint8(min(255.0, rgb[v, u, 0] * clear + r))
            rgb[v, u, 1] = np.uint8(min(255.0, rgb[v, u, 1] * clear + g))
            rgb[v, u, 2] = np.uint8(min(255.0, rgb[v, u, 2] * clear + b))
            if hit > 0.0 and (hit < sensed[v, u] or np.isnan(sensed[v, u])):
                sensed[v, u] = hit


@compiled(fastmath=True)
def march_flame(
    rgb: NDArray[np.uint8],
    depth: _Grid,
    sensed: _Grid,
    pose: Floats,
    focal: float,
    lo: Floats,
    hi: Floats,
    glow_m: Floats,
    glow: float,  # noqa: ARG001  (both kernels are called alike)
    offset: float,
    time: float,
    noise: _Grid,
    jitter: _Grid,
) -> None:
    """Draws flames over the picture and lowers what the depth sensor returns, both in place."""
    height, width = depth.shape
    d = np.empty(3)
    rise = hi[2] - lo[2]
    for v in range(height):
        for u in range(width):
            cx, cy = (u + 0.5 - width / 2) / focal, (v + 0.5 - height / 2) / focal
            for a in range(3):
                d[a] = pose[a, 0] * cx + pose[a, 1] * cy + pose[a, 2]
            near, far = _span(pose, d, lo, hi, depth[v, u])
            if far <= near:
                continue
            metres = (far - near) * np.sqrt(d[0] ** 2 + d[1] ** 2 + d[2] ** 2)
            steps = min(MOST_STEPS, 3 + int(metres / STEP_M))
            step, metres = (far - near) / steps, metres / steps
            clear, tau, hit = 1.0, 0.0, -1.0
            r, g, b = 0.0, 0.0, 0.0
            for s in range(steps):
                t = near + (s + jitter[v & 31, u & 31]) * step
                x, y, z = pose[0, 3] + d[0] * t, pose[1, 3] + d[1] * t, pose[2, 3] + d[2] * t
                h = (z - lo[2]) / rise
                sway = (_density(noise, offset + 3 * x, y * 3, z * 2.5 - 3.0 * time) - 0.6) * 0.35 * h
                ex = 2 * (x + sway - glow_m[0]) / (hi[0] - lo[0])
                ey = 2 * (y - sway - glow_m[1]) / (hi[1] - lo[1])
                body = 1.0 - (ex * ex + ey * ey)
                if body <= 0.0:
                    continue
                # How high the tongue at this place reaches; it changes slowly with height, so tongues stand upright.
                tongue = _density(noise, (x + sway) * 13 + offset, (y - sway) * 13, z * 1.5 - 2.2 * time)
                fine = _density(noise, x * 16 + offset, y * 16, z * 7 - 9.0 * time)
                heat = 1.5 * (body**0.5 * (0.16 + 0.95 * tongue / (0.5 + tongue)) - h) + 0.35 * (fine - 0.6)
                heat = min(heat, 4.0 * (1.0 - h))
                if heat <= 0.0:
                    continue
                thick = FLAME_EXTINCTION_PER_M * min(1.0, 2.2 * heat)
                opaque = 1.0 - np.exp(-thick * metres)
                r += clear * opaque * min(255.0, 190.0 + 330.0 * heat)
                g += clear * opaque * min(240.0, 40.0 + 270.0 * heat)
                b += clear * opaque * min(170.0, max(8.0, 230.0 * (heat - 0.65)))
                clear *= 1.0 - opaque
                tau += thick * metres
                if hit < 0.0 and tau > SENSOR_TAU:
                    hit = t
                if clear < 0.02:
                    break
            rgb[v, u, 0] = np.uint8(min(255.0, rgb[v, u, 0] * clear + r))
            rgb[v, u, 1] = np.uint8(min(255.0, rgb[v, u, 1] * clear + g))
            rgb[v, u, 2] = np.uint8(min(255.0, rgb[v, u, 2] * clear + b))
            if hit > 0.0 and (hit < sensed[v, u] or np.isnan(sensed[v, u])):
                sensed[v, u] = hit
