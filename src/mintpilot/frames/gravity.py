"""Up and the floor, from depth alone: the level surfaces of what people build."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from mintpilot.core.geometry import Floats
from mintpilot.core.observation import RawFrame

CELL = 8
"""Edge of the patches whose planes are fitted, pixels at a width of 640."""
FLAT_SHARE = 0.006
"""A patch is flat when its points deviate from its plane by less than this share of their distance squared, metres."""
LIKE_RAD = math.radians(8.0)
"""Normals no further apart than this are one direction."""
STEEPEST_RAD = math.radians(75.0)
"""A camera looks up or down by no more than this, and is not turned about its axis by more."""
LEAST_SHARE = 0.03
"""A level surface has at least this share of all flat patches."""
SPREAD_M = 0.1
"""A layer is spread by at least this much, standard deviation, in both directions, to tell what is level."""
FLOOR_M = 0.06
"""Patches no further apart in height than this are one surface."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Patches:
    """Small flat pieces of surface, in the world of the poses, or in the camera's frame where there are none."""

    points_m: Floats
    """Their middles (n, 3)."""
    normals: Floats
    """Unit vectors (n, 3) towards the camera."""
    ups: Floats
    """The upward direction of the picture each was seen in (n, 3), unit vectors."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Level:
    """What was found out about gravity."""

    up: Floats
    """Unit vector (3,)."""
    share: float
    """Share of all flat patches that face up."""
    floor: float | None
    """Position of the lowest level surface along ``up``, metres; None where none is below the camera."""
    spread_rad: float
    """Mean angle between the normals of the level patches and ``up``."""


def patches_of(frames: Sequence[RawFrame]) -> Patches:
    """The flat patches of some frames."""
    found = [_patches(frame) for frame in frames]
    return Patches(
        points_m=np.concatenate([p.points_m for p in found]) if found else np.zeros((0, 3)),
        normals=np.concatenate([p.normals for p in found]) if found else np.zeros((0, 3)),
        ups=np.concatenate([p.ups for p in found]) if found else np.zeros((0, 3)),
    )


def level_of(patches: Patches) -> Level | None:
    """Up by the flat patches: the direction that most of them face among those that the cameras allow.

    Patches that face sideways, as walls do, count for a direction too, at a fifth. None where too few face any way.
    """
    normals = patches.normals
    if len(normals) < 20:
        return None
    allowed = np.einsum("ij,ij->i", normals, patches.ups) > math.cos(STEEPEST_RAD)
    candidates = normals[allowed]
    if not len(candidates):
        return None
    candidates = candidates[:: max(1, len(candidates) // 400)]
    cosines = candidates @ normals.T
    facing = (cosines > math.cos(LIKE_RAD)) & allowed
    sideways = np.abs(cosines) < math.sin(LIKE_RAD)
    best = int(np.argmax(facing.sum(axis=1) + 0.2 * sideways.sum(axis=1)))
    up = candidates[best]
    for _ in range(3):
        near = (normals @ up > math.cos(LIKE_RAD)) & allowed
        up = normals[near].mean(axis=0)
        up = up / np.linalg.norm(up)
    near = (normals @ up > math.cos(LIKE_RAD)) & allowed
    share = float(near.mean())
    if share < LEAST_SHARE:
        return None
    up = _levelled(patches.points_m[(normals @ up > math.cos(2 * LIKE_RAD)) & allowed], up)
    near = normals @ up > math.cos(2 * LIKE_RAD)
    off = float(np.arccos(np.clip(normals[near] @ up, -1, 1)).mean())
    return Level(up=up, share=share, floor=floor_along(patches, up), spread_rad=off)


def floor_along(patches: Patches, up: Floats) -> float | None:
    """Position along ``up`` of the lowest level surface that is large enough; None where there is none."""
    near = patches.normals @ up > math.cos(2 * LIKE_RAD)
    heights = np.sort(patches.points_m[near] @ up)
    least = max(5, int(LEAST_SHARE * len(patches.normals)))
    if len(heights) < least:
        return None
    # How many patches lie from each one up to FLOOR_M above it.
    counts = np.searchsorted(heights, heights + FLOOR_M, side="right") - np.arange(len(heights))
    first = int(np.argmax(counts >= least))
    if counts[first] < least:
        return None
    # From the first of the noise below it uphill to the fullest layer.
    begin, fuller = -1, first
    while fuller != begin:
        begin = fuller
        above = np.searchsorted(heights, heights[begin] + FLOOR_M, side="right")
        fuller = begin + int(np.argmax(counts[begin:above]))
    return float(np.median(heights[begin : begin + counts[begin]]))


def _levelled(points: Floats, up: Floats) -> Floats:
    """Up once more, by the plane through the middles of the fullest layer: those err less than single normals."""
    for band in (3 * FLOOR_M, 2 * FLOOR_M, FLOOR_M):
        along = points @ up
        order = np.sort(along)
        counts = np.searchsorted(order, order + band, side="right") - np.arange(len(order))
        low = order[int(np.argmax(counts))]
        layer = points[(along >= low) & (along <= low + band)]
        centred = layer - layer.mean(axis=0)
        spreads, axes = np.linalg.eigh(centred.T @ centred / len(layer))
        if len(layer) < 20 or spreads[1] < SPREAD_M**2:
            return up
        normal = axes[:, 0] * np.sign(axes[:, 0] @ up)
        if float(normal @ up) < math.cos(2 * LIKE_RAD):
            return up
        up = normal
    return up


def _patches(frame: RawFrame) -> Patches:
    lens = frame.camera
    edge = max(4, round(CELL * lens.width / 640))
    rows, columns = lens.height // edge, lens.width // edge
    z = frame.depth_m[: rows * edge, : columns * edge].astype(float)
    u = (np.arange(columns * edge) + 0.5 - lens.cx) / lens.fx
    v = (np.arange(rows * edge) + 0.5 - lens.cy) / lens.fy
    points = np.stack([u[None, :] * z, v[:, None] * z, z], axis=-1)
    cells = points.reshape(rows, edge, columns, edge, 3).transpose(0, 2, 1, 3, 4).reshape(-1, edge * edge, 3)
    full = (cells[..., 2] > 0).mean(axis=1) > 0.95
    cells = cells[full]
    if not len(cells):
        return Patches(points_m=np.zeros((0, 3)), normals=np.zeros((0, 3)), ups=np.zeros((0, 3)))
    weights = (cells[..., 2] > 0).astype(float)[..., None]
    middles = (cells * weights).sum(axis=1) / weights.sum(axis=1)
    centred = (cells - middles[:, None]) * weights
    values, vectors = np.linalg.eigh(np.einsum("nij,nik->njk", centred, centred))
    deviation = np.sqrt(np.maximum(values[:, 0], 0) / weights.sum(axis=(1, 2)))
    flat = deviation < FLAT_SHARE * np.maximum(middles[:, 2], middles[:, 2] ** 2)
    normals, middles = vectors[flat, :, 0], middles[flat]
    normals = normals * -np.sign(np.einsum("ij,ij->i", normals, middles))[:, None]
    pose = frame.source_from_camera if frame.source_from_camera is not None else np.eye(4)
    return Patches(
        points_m=middles @ pose[:3, :3].T + pose[:3, 3],
        normals=normals @ pose[:3, :3].T,
        ups=np.repeat(-pose[:3, 1][None], len(middles), axis=0),
    )
