"""What shape a segment has: a box, an upright cylinder, a flat panel, or none of these."""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass

import numpy as np

from mintpilot.core.geometry import Floats
from mintpilot.core.observation import Segment

FACE_RAD = math.radians(20.0)
"""Normals no further apart than this belong to one face."""
FACE_SHARE = 0.12
"""A second face has at least this share of the surface."""
SQUARE = math.sin(math.radians(14.0))
"""Faces of a box are at right angles within this."""
LEAST_ROUND = 0.35
"""This share of all of a cylinder's surface that is seen is its sides."""
_SAMPLE = 700
KEPT = 64
"""Segments whose shapes are kept: they are asked for again when parts are joined, and when names are given."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SolidShape:
    """How a segment's surface is turned."""

    flat: float
    """Share of the surface in its one largest face."""
    boxlike: float
    """Share of the surface in two or three faces at right angles; 0 where fewer are seen."""
    round: float
    """Share of the upright surface that lies on one upright cylinder; 0 where it hardly turns."""
    radius_m: float
    """Radius of that cylinder, metres; 0 for none."""
    centre_m: tuple[float, float]
    """Its axis on the ground."""
    faces: int
    """How many faces of a box are seen."""


@functools.lru_cache(maxsize=KEPT)
def solid_shape(segment: Segment) -> SolidShape:
    """Measures one segment."""
    known = np.linalg.norm(segment.normals, axis=1) > 0.5
    step = max(1, int(known.sum()) // _SAMPLE)
    normals, points = segment.normals[known][::step], segment.points_m[known][::step]
    if len(normals) < 12:
        return SolidShape(flat=0.0, boxlike=0.0, round=0.0, radius_m=0.0, centre_m=(0.0, 0.0), faces=0)
    shares = _faces(normals)
    radius, centre, fit = _cylinder(points, normals)
    return SolidShape(
        flat=shares[0],
        boxlike=sum(shares) if len(shares) > 1 else 0.0,
        round=fit,
        radius_m=radius,
        centre_m=centre,
        faces=len(shares),
    )


def _faces(normals: Floats) -> list[float]:
    """Shares of the surface in up to three faces at right angles, the largest first."""
    left = np.ones(len(normals), bool)
    axes: list[Floats] = []
    shares = []
    for _ in range(3):
        rest = normals[left]
        if len(rest) < max(4, FACE_SHARE * len(normals)):
            break
        candidates = rest[:: max(1, len(rest) // 150)]
        if axes:
            square = (np.abs(candidates @ np.array(axes).T) < SQUARE).all(axis=1)
            candidates = candidates[square]
            if not len(candidates):
                break
        near = candidates @ rest.T > math.cos(FACE_RAD)
        best = int(np.argmax(near.sum(axis=1)))
        axis = rest[near[best]].mean(axis=0)
        axis = axis / max(float(np.linalg.norm(axis)), 1e-9)
        share = float((rest @ axis > math.cos(FACE_RAD)).sum()) / len(normals)
        if axes and share < FACE_SHARE:
            break
        axes.append(axis)
        shares.append(share)
        left &= normals @ axis <= math.cos(1.6 * FACE_RAD)
    return shares


def _cylinder(points: Floats, normals: Floats) -> tuple[float, tuple[float, float], float]:
    """Radius, axis on the ground, and share of the upright surface on the best upright cylinder."""
    upright = np.abs(normals[:, 2]) < 0.4
    p, n = points[upright][:, :2], normals[upright][:, :2]
    if len(p) < 12:
        return 0.0, (0.0, 0.0), 0.0
    azimuth = np.arctan2(n[:, 1], n[:, 0])
    turned = 1 - float(np.hypot(np.cos(azimuth).mean(), np.sin(azimuth).mean()))
    if turned < 0.06 or float(np.abs(np.exp(4j * azimuth).mean())) > 0.75:
        return 0.0, (0.0, 0.0), 0.0
    matrix = np.column_stack([2 * p, np.ones(len(p))])
    solution = np.linalg.lstsq(matrix, (p**2).sum(axis=1), rcond=None)[0]
    centre, square = solution[:2], float(solution[2] + solution[:2] @ solution[:2])
    if square <= 0:
        return 0.0, (0.0, 0.0), 0.0
    radius = math.sqrt(square)
    off = np.abs(np.linalg.norm(p - centre, axis=1) - radius)
    on = off < 0.006 + 0.05 * radius
    span = float(np.ptp(p, axis=0).max())
    if radius > span:  # nearly flat: any circle fits
        return 0.0, (0.0, 0.0), 0.0
    if float(on.sum()) < LEAST_ROUND * len(normals):
        return 0.0, (0.0, 0.0), 0.0
    return radius, (float(centre[0]), float(centre[1])), float(on.mean())
