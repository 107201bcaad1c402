"""Lumps of a body's size that nothing names: how likely one is somebody, or has somebody in it, by size and softness.

Somebody who is curled up, covered, tucked in or crawling has no shape that one could tell; a bed with somebody in it is
one body to depth. What this says makes a question, never a person.
"""

from __future__ import annotations

import math

import numpy as np

from mintpilot.core.geometry import Floats
from mintpilot.core.observation import Segment
from mintpilot.perception.lump_weights import BIAS, WEIGHTS
from mintpilot.perception.people import person_probability, solidity, within
from mintpilot.perception.solid_shapes import solid_shape

GRAIN_M = 0.06
"""Edge of the cells in which it is counted how much of its outline is filled."""
BED_M, BED_SOFT_M = ((1.3, 2.2), (0.55, 1.15), (0.35, 0.85)), 0.15
"""Length, breadth and height of a bed or sofa; and how far outside of these it may be one the less."""
ROWS = 5
"""Heights at which the breadth of a lump is measured."""
FEATURES = (
    "height", "height²", "length", "length²", "breadth", "breadth²", "length x height", "flat", "boxlike", "round",
    "turned", "solid", "uneven top", "level top", "middle height", "foot", "cut", "pixels", "on floor", "hanging",
    "taper", "gaps",
    "bed", "bed with uneven top", "like a person",
)  # fmt: skip


MOST = 0.49
"""So likely at most is a lump somebody: it is asked."""
CLAIMED = 0.5
"""What has a person's own shape with at least this probability is a person, whatever the lump says."""
SIZE_M = (0.25, 2.4)
"""Length, or height, of what may have somebody in it."""
FLATTEST = (0.82, 0.9)
"""Share in one face, or in faces at right angles: up to the first a lump, from the second on a box."""
LEAST_PIXELS = 120
"""Fewer show no lump."""


def somebody_probability(segment: Segment) -> float:
    """Probability, 0 to 1, that a segment is somebody or has somebody in it: by a person's shape, or as a lump."""
    alike = person_probability(segment)
    size = max(segment.box_m.size_m)
    if alike >= CLAIMED or not SIZE_M[0] <= size <= SIZE_M[1] or len(segment.points_m) < LEAST_PIXELS:
        return alike
    shape = solid_shape(segment)
    soft = (FLATTEST[1] - max(shape.flat, shape.boxlike)) / (FLATTEST[1] - FLATTEST[0])
    if soft <= 0:
        return alike
    odds = float(lump_features(segment, alike) @ np.array([weight for _, weight in WEIGHTS])) + BIAS
    return min(1.0, soft) * min(MOST, 1 / (1 + math.exp(-min(30.0, max(-30.0, odds)))))


def lump_features(segment: Segment, alike: float) -> Floats:
    """What is measured of a segment (len(FEATURES),).

    Args:
        segment: what is looked at.
        alike: how much it has a person's own shape, 0 to 1.
    """
    points, base = segment.points_m, segment.stands_on_m
    ground = points[:, :2] - points[:, :2].mean(axis=0)
    axes = np.linalg.eigh(ground.T @ ground)[1]
    ends = np.percentile(ground @ axes, (3, 97), axis=0)
    breadth, length = (float(e) for e in ends[1] - ends[0])
    up = points[:, 2] - base
    height = float(np.percentile(up, 99))
    shape = solid_shape(segment)
    known = np.linalg.norm(segment.normals, axis=1) > 0.5
    turned = 1.0 - float(np.linalg.norm(segment.normals[known].mean(axis=0))) if known.any() else 0.0
    top = up > 0.6 * height
    facing_up = known & (segment.normals[:, 2] > 0.5)
    uneven = float(np.std(up[facing_up])) if facing_up.sum() > 10 else 0.0
    level = float((known & (segment.normals[:, 2] > 0.94))[top].mean()) if top.any() else 0.0
    rows = np.clip((up / max(height, 1e-6) * ROWS).astype(int), 0, ROWS - 1)
    counts = np.bincount(rows, minlength=ROWS) / len(up)
    along = ground @ axes[:, 1]
    high = along[rows >= ROWS - 2]
    taper = float(np.ptp(high)) / max(length, 0.05) if len(high) > 5 and (rows < 2).sum() > 5 else 0.0
    cells = np.unique(np.floor(points / GRAIN_M).astype(int), axis=0)
    filled = len(cells) * GRAIN_M**2 / max(0.05, length * height + length * breadth)
    bed = math.prod(within(v, *span, BED_SOFT_M) for v, span in zip((length, breadth, height), BED_M, strict=True))
    return np.array([
        height, height**2, length, length**2, breadth, breadth**2, length * height, shape.flat, shape.boxlike,
        shape.round, turned, solidity(segment.mask), min(uneven, 0.5), level, float(np.median(up)) / max(height, 1e-6),
        float(counts[0]), segment.cut, math.log10(len(up)), segment.on_floor,
        min(0.5, max(0.0, segment.box_m.lo_m[2] - base)), min(taper, 1.5), min(filled, 3.0),
        bed, bed * min(uneven / 0.1, 2.0), alike,
    ])  # fmt: skip
