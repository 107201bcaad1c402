"""How the surface lies at every pixel, and where one body ends and another begins: depth alone, no colour.

Bodies that people make are convex or nearly so: two surfaces that meet in a hollow edge belong to two things, two that
meet in a ridge to one, and a jump of depth parts what is near from what is far.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mintpilot.core.compiled import compiled
from mintpilot.core.geometry import Bools
from mintpilot.perception.view import Singles, View

Bytes = NDArray[np.int8]

SMOOTH = 3
"""Half a window over which depth is smoothed at a width of 640, pixels."""
REACH = 5
"""How far apart, to either side of a pixel, surfaces are compared at a width of 640, pixels."""
LEAST_REACH = 3
"""… and at least, in small pictures."""
STEEPEST = 5.0
"""Slope of a surface against the line of sight up to which neighbouring depths are one surface."""
NOISE_SHARE = 0.0014
"""Standard deviation of structured light's depth per square metre of distance, metres; sensors of other kinds are no
worse close by."""
JUMP_SIGMAS = 4.0
LEVEL_COSINE = math.cos(math.radians(20.0))
"""A surface whose normal has at least this height is level."""
UPRIGHT_COSINE = math.sin(math.radians(20.0))
"""A surface whose normal has at most this height is upright."""
HOLLOW_RAD = math.radians(24.0)
"""Surfaces that meet in a hollow edge sharper than this belong to two things."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Surfaces:
    """Each (h, w) unless said otherwise."""

    depth_m: Singles
    """Smoothed within each surface; 0 where there is none."""
    points_m: Singles
    """World points (h, w, 3) of the smoothed depth."""
    normals: Singles
    """Unit vectors (h, w, 3) in the world, towards the camera; 0 where they cannot be told."""
    edges: Bools
    """Hollow edges and jumps of depth."""
    jump_m: Singles
    """Difference of depth to a neighbour above which it lies on another surface."""


def surfaces_of(view: View) -> Surfaces:
    """Measures the surfaces in a view."""
    lens = view.frame.camera
    scale = max(0.5, lens.width / 640)
    reach, half = max(LEAST_REACH, round(REACH * scale)), max(1, round(SMOOTH * scale))
    depth = np.ascontiguousarray(view.depth_m, np.float32)
    sigma = np.maximum(view.sigma_m, NOISE_SHARE * depth * depth)
    jump = (STEEPEST * depth / np.float32(lens.fx) + JUMP_SIGMAS * sigma).astype(np.float32)
    smooth = _smoothed(depth, jump, half)
    pose = view.frame.world_from_camera
    points = _back_projected(smooth, lens.fx, lens.fy, lens.cx, lens.cy)
    reaches = _reaches(smooth, jump, reach)
    normals = _normals(points, smooth, reaches)
    edges = _edges(points, normals, depth, smooth, jump, reaches, math.cos(HOLLOW_RAD))
    rotation = pose[:3, :3].astype(np.float32)
    return Surfaces(
        depth_m=smooth,
        points_m=(points @ rotation.T + pose[:3, 3].astype(np.float32)).astype(np.float32),
        normals=(normals @ rotation.T).astype(np.float32),
        edges=edges,
        jump_m=jump,
    )


@compiled(error_model="numpy")
def _smoothed(depth: Singles, jump: Singles, half: int) -> Singles:
    """Mean of the depth over the square around each pixel, of what lies on the same surface.

    What lies on it differs by no more than the jump times the distance in pixels.
    """
    height, width = depth.shape
    smooth = np.zeros((height, width), np.float32)
    for v in range(height):
        for u in range(width):
            z = depth[v, u]
            if z <= 0:
                continue
            total, count = 0.0, 0
            for y in range(max(0, v - half), min(height, v + half + 1)):
                for x in range(max(0, u - half), min(width, u + half + 1)):
                    other = depth[y, x]
                    # A window that is not the same to both sides would tilt the mean: take points with their mirror.
                    my, mx = 2 * v - y, 2 * u - x
                    if other <= 0 or not (0 <= my < height and 0 <= mx < width):
                        continue
                    mirror = depth[my, mx]
                    if mirror <= 0 or abs(other + mirror - 2 * z) > jump[v, u]:
                        continue
                    total += other
                    count += 1
            smooth[v, u] = total / count if count > 0 else z
    return smooth


@compiled(error_model="numpy")
def _back_projected(depth: Singles, fx: float, fy: float, cx: float, cy: float) -> Singles:
    height, width = depth.shape
    points = np.zeros((height, width, 3), np.float32)
    for v in range(height):
        for u in range(width):
            z = depth[v, u]
            points[v, u, 0] = (u + 0.5 - cx) / fx * z
            points[v, u, 1] = (v + 0.5 - cy) / fy * z
            points[v, u, 2] = z
    return points


@compiled(error_model="numpy")
def _reaches(depth: Singles, jump: Singles, reach: int) -> Bytes:
    """How many steps one can go from each pixel (h, w, 8) without a jump of depth, up to ``reach``.

    Ways: right, left, down, up, and the diagonals down right, up left, down left, up right.
    """
    height, width = depth.shape
    steps = np.zeros((height, width, 8), np.int8)
    for way in range(8):
        dv = (0, 0, 1, -1, 1, -1, 1, -1)[way]
        du = (1, -1, 0, 0, 1, -1, -1, 1)[way]
        for i in range(height):
            v = height - 1 - i if dv > 0 else i
            for j in range(width):
                u = width - 1 - j if du > 0 else j
                y, x = v + dv, u + du
                if not (0 <= y < height and 0 <= x < width) or depth[y, x] <= 0:
                    continue
                if abs(depth[y, x] - depth[v, u]) <= jump[y, x]:
                    steps[v, u, way] = min(reach, steps[y, x, way] + 1)
    return steps


@compiled(error_model="numpy")
def _normals(points: Singles, depth: Singles, reaches: Bytes) -> Singles:
    height, width = depth.shape
    normals = np.zeros((height, width, 3), np.float32)
    for v in range(height):
        for u in range(width):
            if depth[v, u] <= 0:
                continue
            right, left, down, up = reaches[v, u, 0], reaches[v, u, 1], reaches[v, u, 2], reaches[v, u, 3]
            if right + left < 2 or down + up < 2:
                continue
            ax = points[v, u + right, 0] - points[v, u - left, 0]
            ay = points[v, u + right, 1] - points[v, u - left, 1]
            az = points[v, u + right, 2] - points[v, u - left, 2]
            bx = points[v + down, u, 0] - points[v - up, u, 0]
            by = points[v + down, u, 1] - points[v - up, u, 1]
            bz = points[v + down, u, 2] - points[v - up, u, 2]
            nx, ny, nz = ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx
            length = math.sqrt(nx * nx + ny * ny + nz * nz)
            if length < 1e-12:
                continue
            if nx * points[v, u, 0] + ny * points[v, u, 1] + nz * points[v, u, 2] > 0:
                length = -length
            normals[v, u, 0], normals[v, u, 1], normals[v, u, 2] = nx / length, ny / length, nz / length
    return normals


@compiled(error_model="numpy")
def _edges(
    points: Singles,
    normals: Singles,
    raw: Singles,
    depth: Singles,
    jump: Singles,
    reaches: Bytes,
    cosine: float,
) -> Bools:
    """Pixels between surfaces that meet in a hollow edge, and those on the far side of a jump of depth."""
    height, width = depth.shape
    edges = np.zeros((height, width), np.bool_)
    for v in range(height):
        for u in range(width):
            if depth[v, u] <= 0:
                edges[v, u] = True
                continue
            for way in range(4):
                dv = 0 if way == 0 else 1
                du = (1, 0, 1, -1)[way]
                for sign in (-1, 1):
                    y, x = v + sign * dv, u + sign * du
                    inside = 0 <= y < height and 0 <= x < width
                    if inside and raw[y, x] > 0 and raw[v, u] - raw[y, x] > jump[v, u]:
                        edges[v, u] = True
                ahead, behind = reaches[v, u, 2 * way], reaches[v, u, 2 * way + 1]
                if ahead < 1 or behind < 1 or ahead + behind < 3:
                    continue
                y, x = v + ahead * dv, u + ahead * du
                q, p = v - behind * dv, u - behind * du
                dot, apart = 0.0, 0.0
                for i in range(3):
                    dot += normals[y, x, i] * normals[q, p, i]
                    apart += (normals[y, x, i] - normals[q, p, i]) * (points[y, x, i] - points[q, p, i])
                if dot < cosine and apart < 0:
                    edges[v, u] = True
                    break
    return edges
