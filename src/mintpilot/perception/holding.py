"""What holds what: parts that hang in the air belong to what they touch, folds of a curtain to each other."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from mintpilot.core.geometry import Floats, Ints
from mintpilot.perception.patches import Patch
from mintpilot.perception.surfaces import Surfaces

BELOW = 5
"""How far below the lower rim of a patch one looks, pixels."""
FREE_M = 0.1
"""What is that much farther away is behind, with free air between."""
FREE_SHARE, RESTING_SHARE = 0.5, 0.25
"""A patch hangs when this share of its lower rim is over free air, and no more than that rests on something."""
TOUCH_M, TOUCH_PIXELS = 0.03, 6
"""Two patches touch when so many pixels are so near to each other."""
NEAR_SURFACE_M = 0.1
"""A thing stands on a surface whose outline reaches this near to its middle."""
TALL_M, FOLD_M, ENDS_M = 0.8, 0.07, 0.06
"""Upright strips of that height, so near to each other and with ends so much alike, are folds of one thing."""


def hanging(surfaces: Surfaces, marks: Ints, patch: Patch) -> bool:
    """Whether a patch is seen to have nothing below it."""
    mask = marks == patch.number
    columns = np.flatnonzero(mask.any(axis=0))
    lowest = mask.shape[0] - 1 - np.argmax(mask[::-1, columns], axis=0)
    below = lowest + BELOW
    inside = below < mask.shape[0]
    if inside.sum() < 0.5 * len(columns):
        return False
    rows, columns, lowest = below[inside], columns[inside], lowest[inside]
    depth, own = surfaces.depth_m[rows, columns], surfaces.depth_m[lowest, columns]
    free = float((depth - own > FREE_M).mean())
    resting = float((np.abs(depth - own) < FREE_M / 2).mean())
    return free > FREE_SHARE and resting < RESTING_SHARE


def touching(surfaces: Surfaces, marks: Ints) -> set[tuple[int, int]]:
    """Pairs of numbers, the smaller first, of patches that touch each other in space."""
    counts: dict[tuple[int, int], int] = {}
    for dv, du in ((0, 2), (2, 0), (2, 2), (2, -2)):
        a, b = _shifted(marks, dv, du)
        p, q = _shifted(surfaces.points_m, dv, du)
        differ = (a != b) & (a > 0) & (b > 0)
        near = np.linalg.norm(p[differ] - q[differ], axis=-1) < TOUCH_M
        for x, y in zip(a[differ][near].tolist(), b[differ][near].tolist(), strict=True):
            key = (min(x, y), max(x, y))
            counts[key] = counts.get(key, 0) + 1
    return {pair for pair, count in counts.items() if count >= TOUCH_PIXELS}


def folds(a: Patch, b: Patch) -> bool:
    """Whether two tall strips are folds of one curtain, or slats of one blind."""
    if min(a.upright, b.upright) < 0.6 or min(a.hi_m[2] - a.lo_m[2], b.hi_m[2] - b.lo_m[2]) < TALL_M:
        return False
    gap = np.maximum(0.0, np.maximum(a.lo_m - b.hi_m, b.lo_m - a.hi_m))
    return float(np.linalg.norm(gap)) < FOLD_M and abs(float(a.lo_m[2] - b.lo_m[2])) < ENDS_M


def flush(points_m: Floats, wall: Patch) -> bool:
    """Whether nearly all points (n, 3) of a patch lie in a wall, or no further before it than a skirting board."""
    off = points_m @ wall.normal - wall.offset_m
    tolerance = 0.02 + 3 * wall.sigma_m
    return bool(((off > -tolerance) & (off < FLUSH_M + tolerance)).mean() > 0.85)


FLUSH_M = 0.04
"""Skirting boards, frames and switches stand out of a wall by no more."""


def held_together(
    surfaces: Surfaces, marks: Ints, patches: Sequence[Patch], is_thing: Sequence[bool]
) -> list[tuple[int, int]]:
    """Pairs of indices of patches that are parts of one body: what hangs, with what it touches; folds."""
    index = {p.number: i for i, p in enumerate(patches)}
    things = [i for i, thing in enumerate(is_thing) if thing]
    hang = {i for i in things if hanging(surfaces, marks, patches[i])}
    pairs = []
    for x, y in sorted(touching(surfaces, marks)):
        i, j = index[x], index[y]
        if is_thing[i] and is_thing[j] and (i in hang or j in hang):
            pairs.append((i, j))
    pairs += [(i, j) for i in things for j in things if i < j and folds(patches[i], patches[j])]
    return pairs


def height_below(lo_m: Floats, hi_m: Floats, supports: Sequence[Patch], floor_m: float) -> tuple[float, int]:
    """Height of the highest surface under an extent, and its index among the supports; -1 for the floor."""
    x, y = (lo_m[:2] + hi_m[:2]) / 2
    best, index = floor_m, -1
    for i, patch in enumerate(supports):
        near = (patch.lo_m[:2] - NEAR_SURFACE_M <= (x, y)) & ((x, y) <= patch.hi_m[:2] + NEAR_SURFACE_M)
        if not near.all() or patch.normal[2] < 0.5:
            continue
        height = (patch.offset_m - patch.normal[0] * x - patch.normal[1] * y) / patch.normal[2]
        if best < height <= lo_m[2] + NEAR_SURFACE_M / 2:
            best, index = float(height), i
    return best, index


def overlap_m3(a: tuple[Floats, Floats], b: tuple[Floats, Floats]) -> float:
    """Volume that two extents (lowest and highest corner) share."""
    edges = np.minimum(a[1], b[1]) - np.maximum(a[0], b[0])
    return float(np.prod(np.maximum(edges, 0.0)))


def _shifted(values: np.ndarray, dv: int, du: int) -> tuple[np.ndarray, np.ndarray]:
    """Each value beside the one ``dv`` rows down and ``du`` columns to the right of it."""
    height, width = values.shape[:2]
    left, right = max(0, -du), width - max(0, du)
    return values[: height - dv, left:right], values[dv:, left + du : right + du]
