"""Compiled ray casting: what one depth picture says of the voxels (method, section 1: the semantic map)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mintpilot.core.compiled import compiled
from mintpilot.core.geometry import Floats

Grid32 = NDArray[np.float32]


@compiled(nogil=True)
def cast_rays(
    depth: Grid32,
    stride: int,
    lens: tuple[float, float, float, float],
    pose: Floats,
    origin: Floats,
    resolution: float,
    log_odds: Grid32,
    stamp: NDArray[np.int32],
    solid: NDArray[np.int32],
    tick: int,
    smoke: NDArray[np.uint8],
    limits: tuple[float, float, float],
    weights: tuple[float, float, float, float],
) -> None:
    """Updates ``log_odds``, ``stamp`` and ``solid`` in place from one depth picture.

    Every voxel changes at most once a frame, and a hit beats any number of misses: thin things such as rack posts
    would otherwise be worn away by the rays that pass beside them inside the same voxel. Voxels flagged in ``smoke``
    are neither hit nor cleared: the sensor cannot tell what is in them.

    Args:
        depth: (h, w) metres along the optical axis; not finite or too small: no return, teaches nothing.
        stride: take every n-th pixel along both axes.
        lens: (fx, fy, cx, cy) pixels.
        pose: (4, 4) world from camera.
        origin: (3,) corner of the lattice (x, y, z).
        resolution: edge of a voxel, metres.
        log_odds: (nz, ny, nx) float32.
        stamp: (nz, ny, nx) int32, frame in which a voxel was changed last: ``2 tick`` missed, ``2 tick + 1`` hit.
        solid: (nz, ny, nx) int32, number of frames in which a ray from near ended in a voxel.
        tick: number of this frame, ascending from 1.
        smoke: (nz, ny, nx) uint8, 1 where this frame shows smoke.
        limits: (min range, range up to which a return is surely told from smoke, max range) metres.
        weights: (hit from near, hit from further away, miss, clamp) log-odds.
    """
    fx, fy, cx, cy = lens
    nearest, near, furthest = limits
    hit, far_hit, miss, clamp = weights
    height, width = depth.shape
    nz, ny, nx = log_odds.shape
    half = stride // 2
    for v in range(half, height, stride):
        for u in range(half, width, stride):
            d = depth[v, u]
            if not (d > nearest and d <= furthest):
                continue
            a = (u + 0.5 - cx) / fx
            b = (v + 0.5 - cy) / fy
            x = pose[0, 3] + d * (pose[0, 0] * a + pose[0, 1] * b + pose[0, 2])
            y = pose[1, 3] + d * (pose[1, 0] * a + pose[1, 1] * b + pose[1, 2])
            z = pose[2, 3] + d * (pose[2, 0] * a + pose[2, 1] * b + pose[2, 2])
            i = int(np.floor((x - origin[0]) / resolution))
            j = int(np.floor((y - origin[1]) / resolution))
            k = int(np.floor((z - origin[2]) / resolution))
            if i < 0 or j < 0 or k < 0 or i >= nx or j >= ny or k >= nz or smoke[k, j, i]:
                continue
            if stamp[k, j, i] != 2 * tick + 1:
                stamp[k, j, i] = 2 * tick + 1
                log_odds[k, j, i] = min(clamp, log_odds[k, j, i] + (hit if d <= near else far_hit))
                if d <= near:
                    solid[k, j, i] += 1
    for v in range(half, height, stride):
        for u in range(half, width, stride):
            d = depth[v, u]
            if not (d > nearest and d < np.inf):
                continue
            d = min(d, furthest)
            a = (u + 0.5 - cx) / fx
            b = (v + 0.5 - cy) / fy
            # Metres along x, y, z per metre of depth: the ray is parametrised by depth from 0 to d.
            dx = pose[0, 0] * a + pose[0, 1] * b + pose[0, 2]
            dy = pose[1, 0] * a + pose[1, 1] * b + pose[1, 2]
            dz = pose[2, 0] * a + pose[2, 1] * b + pose[2, 2]
            _clear(
                (pose[0, 3] - origin[0]) / resolution,
                (pose[1, 3] - origin[1]) / resolution,
                (pose[2, 3] - origin[2]) / resolution,
                dx / resolution,
                dy / resolution,
                dz / resolution,
                d,
                log_odds,
                stamp,
                tick,
                smoke,
                miss,
                clamp,
            )


@compiled(nogil=True)
def _clear(
    x: float,
    y: float,
    z: float,
    dx: float,
    dy: float,
    dz: float,
    end: float,
    log_odds: Grid32,
    stamp: NDArray[np.int32],
    tick: int,
    smoke: NDArray[np.uint8],
    miss: float,
    clamp: float,
) -> None:
    """Walks one ray in voxel units (Amanatides and Woo) up to, not into, the voxel in which it ends."""
    nz, ny, nx = log_odds.shape
    # Cut the ray to the lattice first, so that a camera outside of it works and no step is wasted.
    t, t_end = 0.0, end
    for axis in range(3):
        p = x if axis == 0 else (y if axis == 1 else z)
        q = dx if axis == 0 else (dy if axis == 1 else dz)
        n = nx if axis == 0 else (ny if axis == 1 else nz)
        if abs(q) < 1e-12:
            if p < 0 or p >= n:
                return
            continue
        t0, t1 = (0.0 - p) / q, (n - p) / q
        t, t_end = max(t, min(t0, t1)), min(t_end, max(t0, t1))
    if t >= t_end:
        return
    eps = 1e-9
    i = min(max(int(np.floor(x + dx * (t + eps))), 0), nx - 1)
    j = min(max(int(np.floor(y + dy * (t + eps))), 0), ny - 1)
    k = min(max(int(np.floor(z + dz * (t + eps))), 0), nz - 1)
    si, sj, sk = (1 if dx > 0 else -1), (1 if dy > 0 else -1), (1 if dz > 0 else -1)
    wide = 1e30
    step_x = abs(1.0 / dx) if abs(dx) > 1e-12 else wide
    step_y = abs(1.0 / dy) if abs(dy) > 1e-12 else wide
    step_z = abs(1.0 / dz) if abs(dz) > 1e-12 else wide
    next_x = (i + (1 if si > 0 else 0) - x) / dx if step_x < wide else wide
    next_y = (j + (1 if sj > 0 else 0) - y) / dy if step_y < wide else wide
    next_z = (k + (1 if sk > 0 else 0) - z) / dz if step_z < wide else wide
    while True:
        leave = min(next_x, next_y, next_z)
        if leave >= end:
            return
        if stamp[k, j, i] < 2 * tick and not smoke[k, j, i]:
            stamp[k, j, i] = 2 * tick
            log_odds[k, j, i] = max(-clamp, log_odds[k, j, i] - miss)
        if next_x <= next_y and next_x <= next_z:
            i += si
            next_x += step_x
            if i < 0 or i >= nx:
                return
        elif next_y <= next_z:
            j += sj
            next_y += step_y
            if j < 0 or j >= ny:
                return
        else:
            k += sk
            next_z += step_z
            if k < 0 or k >= nz:
                return
