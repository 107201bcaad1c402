"""Connected patches of surface and what is measured of each."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from mintpilot.core.geometry import Floats, Ints
from mintpilot.perception.surfaces import LEVEL_COSINE, NOISE_SHARE, UPRIGHT_COSINE, Surfaces
from mintpilot.perception.view import View, as_floats

LEAST_FACE = 0.08
"""A face of a patch has at least this share of its pixels."""
HOLLOW_TURN = -0.3
"""Change of the horizontal part of the normal along a patch that curves inwards, less than this."""
SAMPLE = 3000
"""About so many points of a patch give its extent and its plane."""
_AZIMUTHS = 36


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Patch:
    """One connected patch, all lengths in metres."""

    number: int
    """Its mark in the picture of marks."""
    pixels: int
    area_m2: float
    level: float
    """Share of its pixels that face up."""
    upright: float
    """Share of its pixels that face sideways."""
    normal: Floats
    """Of its best plane (3,), towards the camera."""
    offset_m: float
    """Position of that plane along the normal."""
    flatness_m: float
    """Standard deviation of most of its points from that plane."""
    lo_m: Floats
    hi_m: Floats
    """Corners of its extent, the outermost hundredth left out."""
    sigma_m: float
    """Noise of its depth."""
    top_m: float | None
    """Height of its level face; None where it has none."""
    side: Floats | None
    """Horizontal normal (2,) of its largest upright face; None where it has none."""
    side_m: float
    """Position of that face along its normal."""
    hollow: bool
    """Whether it curves inwards, as the inside of a bowl does."""
    distance_m: float
    """From the camera, median."""


def measured(view: View, surfaces: Surfaces, marks: Ints, count: int) -> list[Patch]:
    """Measures the patches 1 to ``count`` of a picture of marks."""
    order = np.argsort(marks, axis=None, kind="stable")
    ends = np.cumsum(np.bincount(marks.ravel(), minlength=count + 1))
    points, normals = surfaces.points_m.reshape(-1, 3), surfaces.normals.reshape(-1, 3)
    depth = surfaces.depth_m.reshape(-1)
    eye = np.asarray(view.frame.world_from_camera[:3, 3], float)
    focal2 = view.frame.camera.fx * view.frame.camera.fy
    found = []
    for number in range(1, count + 1):
        whole = order[ends[number - 1] : ends[number]]
        pixels = whole[:: max(1, len(whole) // (2 * SAMPLE))]
        own, facing = as_floats(points[pixels]), as_floats(normals[pixels])
        found.append(_measured(number, len(whole), own, facing, depth[pixels].astype(float), eye, focal2))
    return found


def _measured(number: int, size: int, own: Floats, facing: Floats, depth: Floats, eye: Floats, focal2: float) -> Patch:
    towards = eye - own
    slant = np.abs(np.einsum("ij,ij->i", towards, facing)) / np.maximum(np.linalg.norm(towards, axis=1), 1e-6)
    known = np.linalg.norm(facing, axis=1) > 0.5
    up = np.where(known, facing[:, 2], 0.5)
    normal, offset, flat = plane_of(own)
    sign = 1.0 if normal @ (eye - own.mean(axis=0)) >= 0 else -1.0
    spread = own[:: max(1, len(own) // SAMPLE)]
    level, upright = up > LEVEL_COSINE, np.abs(up) < UPRIGHT_COSINE
    lo_m, hi_m = np.percentile(spread, (1, 99), axis=0)
    side, side_m = _side(own[upright], facing[upright], len(own))
    return Patch(
        number=number,
        pixels=size,
        area_m2=float((depth**2 / focal2 / np.maximum(slant, 0.15)).mean()) * size,
        level=float(level.mean()),
        upright=float(upright.mean()),
        normal=sign * normal,
        offset_m=sign * offset,
        flatness_m=flat,
        lo_m=lo_m,
        hi_m=hi_m,
        sigma_m=float(NOISE_SHARE * np.median(depth) ** 2),
        top_m=float(np.median(own[level, 2])) if level.mean() > LEAST_FACE else None,
        side=side,
        side_m=side_m,
        hollow=_is_hollow(own, facing),
        distance_m=float(np.median(np.linalg.norm(towards, axis=1))),
    )


def _is_hollow(points: Floats, facing: Floats) -> bool:
    """Whether the surface faces inwards at the ends of its longest horizontal direction."""
    level = points[:, :2] - points[:, :2].mean(axis=0)
    axis = np.linalg.eigh(level.T @ level)[1][:, 1]
    along = level @ axis
    near, far = np.percentile(along, (20, 80))
    low, high = along <= near, along >= far
    turned = facing[high, :2].mean(axis=0) - facing[low, :2].mean(axis=0)
    return bool(turned @ axis < HOLLOW_TURN)


def plane_of(points: Floats) -> tuple[Floats, float, float]:
    """Normal, position along it and standard deviation of the plane through most of some points (n, 3)."""
    sample = points[:: max(1, len(points) // SAMPLE)]
    near = np.ones(len(sample), bool)
    for _ in range(3):  # least squares, then twice more without the strays
        middle = sample[near].mean(axis=0)
        centred = sample[near] - middle
        normal: Floats = np.linalg.eigh(centred.T @ centred)[1][:, 0]
        off = np.abs((sample - middle) @ normal)
        near = off <= max(float(np.percentile(off, 85)), 1e-4)
    return normal, float(normal @ middle), float(np.sqrt(np.mean(off[near] ** 2)))


def _side(points: Floats, facing: Floats, pixels: int) -> tuple[Floats | None, float]:
    """The direction that most of the upright pixels face, and how far out they are."""
    if len(points) < LEAST_FACE * pixels or len(points) < 8:
        return None, 0.0
    azimuth = np.arctan2(facing[:, 1], facing[:, 0])
    bins = np.floor((azimuth + np.pi) / (2 * np.pi) * _AZIMUTHS).astype(int) % _AZIMUTHS
    counts = np.bincount(bins, minlength=_AZIMUTHS)
    best = int(np.argmax(counts + np.roll(counts, 1) + np.roll(counts, -1)))
    near = np.isin(bins, [(best + d) % _AZIMUTHS for d in (-1, 0, 1)])
    mean = facing[near, :2].mean(axis=0)
    side = mean / max(float(np.linalg.norm(mean)), 1e-9)
    return side, float(np.median(points[near, :2] @ side))


def pixels_of(marks: Ints, count: int) -> Iterator[Ints]:
    """Flat indices of the pixels of each mark from 1 to ``count``."""
    order = np.argsort(marks, axis=None, kind="stable")
    ends = np.cumsum(np.bincount(marks.ravel(), minlength=count + 1))
    for number in range(1, count + 1):
        yield order[ends[number - 1] : ends[number]].astype(np.int64)
