"""People in any posture, by shape and size: curved everywhere, solid, as large as a body, with a head where upright.

A body falls into convex parts (head, trunk, limbs), so touching curved parts are put together before they are judged.
"""

from __future__ import annotations

import functools
from collections.abc import Iterator, Sequence

import numpy as np
from scipy.spatial import ConvexHull, KDTree, QhullError

from mintpilot.core.geometry import Bools, Box, Floats
from mintpilot.core.observation import Segment
from mintpilot.perception.solid_shapes import KEPT, solid_shape

LEAST_PIXELS = 200
SOLID = (0.5, 0.7)
"""Share of its outline in the picture that a body fills: below the first nobody, from the second on surely possible."""
FLATTEST = (0.6, 0.85)
"""Share in one face, or in two or three at right angles: up to the first a body, from the second on none."""
TURNED = 0.1
"""Least spread of the directions in which a body's surface is turned."""
TOUCH_M = 0.1
"""Parts of one body are no further apart; clothes and noise leave gaps."""
LYING_LENGTH_M, LYING_WIDTH_M, LYING_HEIGHT_M = (1.1, 2.1), (0.22, 1.1), (0.12, 0.6)
UPRIGHT_M, ACROSS_M = (0.6, 2.1), (0.18, 1.15)
"""Somebody standing, sitting or crouching: height, and extent on the ground."""
HEIGHT_SOFT_M = 0.08
"""Heights outside of these ranges count less, and from so much on nothing."""
HEAD_M, HEAD_WIDTH_M = 0.2, (0.1, 0.34)
"""Height of a head above the shoulders, and its width."""
SHOULDERS = 1.15
"""Shoulders are wider than the head by at least this factor."""
HEADLESS = 0.35
"""Probability of what has a body's size and curves, but no head in view."""
REACHES_M = 0.5
"""Somebody upright is seen down to this height above what they are on, unless the picture ends before."""


def with_people(segments: Sequence[Segment], least: float = 0.3) -> list[Segment]:
    """The segments with the parts of each likely body put together to one.

    Args:
        segments: all segments of one picture.
        least: probability from which parts are put together.
    """
    taken: set[int] = set()
    bodies = []
    for members in _clusters(segments):
        whole = joined([segments[i] for i in members])
        chance = person_probability(whole)
        if chance >= least and chance >= max(person_probability(segments[i]) for i in members):
            taken.update(members)
            bodies.append(whole)
    return [s for i, s in enumerate(segments) if i not in taken] + bodies


@functools.lru_cache(maxsize=KEPT)
def person_probability(segment: Segment) -> float:
    """Probability, 0 to 1, that a segment is somebody."""
    height = segment.box_m.hi_m[2] - segment.stands_on_m
    if not any(within(height, *sizes, HEIGHT_SOFT_M) for sizes in (LYING_HEIGHT_M, UPRIGHT_M)):
        return 0.0
    if int(segment.mask.sum()) < LEAST_PIXELS or _spread(segment.normals) < TURNED:
        return 0.0
    shape = solid_shape(segment)
    faces = max(shape.flat, shape.boxlike)
    curved = float(np.clip((FLATTEST[1] - faces) / (FLATTEST[1] - FLATTEST[0]), 0.0, 1.0))
    alike = curved and max(_lying(segment), _upright(segment))
    if not alike:
        return 0.0
    solid = float(np.clip((solidity(segment.mask) - SOLID[0]) / (SOLID[1] - SOLID[0]), 0.0, 1.0))
    return min(0.9, curved * solid * alike)


def joined(parts: Sequence[Segment]) -> Segment:
    """Several segments as one."""
    if len(parts) == 1:
        return parts[0]
    lowest = min(parts, key=lambda s: s.box_m.lo_m[2])
    lo = np.min([s.box_m.lo_m for s in parts], axis=0)
    hi = np.max([s.box_m.hi_m for s in parts], axis=0)
    mask = np.logical_or.reduce([s.mask for s in parts])
    return Segment(
        mask=mask,
        points_m=np.concatenate([s.points_m for s in parts]),
        normals=np.concatenate([s.normals for s in parts]),
        box_m=Box(lo_m=(float(lo[0]), float(lo[1]), float(lo[2])), hi_m=(float(hi[0]), float(hi[1]), float(hi[2]))),
        stands_on_m=lowest.stands_on_m,
        on_floor=lowest.on_floor,
        cut=any(s.cut for s in parts),
    )


def solidity(mask: Bools) -> float:
    """Share of a patch's convex outline in the picture that it fills."""
    pixels, rows = int(mask.sum()), np.flatnonzero(mask.any(axis=1))
    if pixels < 10:
        return 0.0
    first, last = mask.argmax(axis=1), mask.shape[1] - 1 - mask[:, ::-1].argmax(axis=1)
    # Of each row of pixels only the outermost can be corners.
    corners = np.stack([np.concatenate([first[rows], last[rows]]), np.concatenate([rows, rows])], axis=1)
    try:
        area = float(ConvexHull(np.concatenate([corners, corners + 1])).volume)
    except QhullError:
        return 0.0
    return min(1.0, pixels / max(area, 1.0))


def _clusters(segments: Sequence[Segment]) -> Iterator[list[int]]:
    """Sets of indices of curved segments that touch each other, and are together no larger than somebody."""
    curved = [i for i, s in enumerate(segments) if _may_be_limb(s)]
    trees = {i: KDTree(segments[i].points_m[:: max(1, len(segments[i].points_m) // 300)]) for i in curved}
    left = set(curved)
    while left:
        cluster, edge = [], [min(left)]
        left.discard(edge[0])
        while edge:
            i = edge.pop()
            cluster.append(i)
            near = {j for j in left if segments[i].box_m.apart_m(segments[j].box_m) < TOUCH_M}
            near = {j for j in near if trees[i].count_neighbors(trees[j], TOUCH_M) > 0}
            left -= near
            edge += sorted(near)
        yield sorted(cluster)


def _may_be_limb(segment: Segment) -> bool:
    shape = solid_shape(segment)
    return shape.flat < FLATTEST[1] and (shape.boxlike < FLATTEST[1] or int(segment.mask.sum()) < LEAST_PIXELS)


def _spread(normals: Floats) -> float:
    known = normals[np.linalg.norm(normals, axis=1) > 0.5]
    return 1.0 - float(np.linalg.norm(known.mean(axis=0))) if len(known) else 0.0


def _axes(points: Floats) -> tuple[float, float]:
    """Length and width of points (n, 2) on the ground."""
    level = points - points.mean(axis=0)
    axes = np.linalg.eigh(level.T @ level)[1]
    along, across = (np.percentile(level @ axes[:, i], (2, 98)) for i in (1, 0))
    return float(along[1] - along[0]), float(across[1] - across[0])


def within(value: float, low: float, high: float, soft: float) -> float:
    """1 inside of a range, falling to 0 over ``soft`` outside of it."""
    return float(np.clip(min((value - low) / soft + 1, (high - value) / soft + 1), 0.0, 1.0))


def _lying(segment: Segment) -> float:
    height = segment.box_m.hi_m[2] - segment.stands_on_m
    low = segment.box_m.lo_m[2] - segment.stands_on_m
    if low >= 0.15 or not within(height, *LYING_HEIGHT_M, HEIGHT_SOFT_M):
        return 0.0
    length, width = _axes(segment.points_m[:, :2])
    size = within(length, *LYING_LENGTH_M, 0.25) * within(width, *LYING_WIDTH_M, 0.1)
    return 0.75 * size * within(height, *LYING_HEIGHT_M, HEIGHT_SOFT_M) * float(length > 1.6 * height)


def _upright(segment: Segment) -> float:
    points, base = segment.points_m, segment.stands_on_m
    height = segment.box_m.hi_m[2] - base
    length, _ = _axes(points[:, :2])
    size = within(height, *UPRIGHT_M, 0.05) * within(length, *ACROSS_M, 0.1)
    if size <= 0 or (segment.box_m.lo_m[2] - base > REACHES_M and not segment.cut):
        return 0.0
    top = float(np.percentile(points[:, 2], 99.5))
    head = points[points[:, 2] > top - HEAD_M]
    below = points[(points[:, 2] <= top - HEAD_M - 0.04) & (points[:, 2] > top - HEAD_M - 0.34)]
    if len(head) < 8 or len(below) < 8:
        return HEADLESS * size
    wide, shoulders = _axes(head[:, :2])[0], _axes(below[:, :2])[0]
    if not HEAD_WIDTH_M[0] <= wide <= HEAD_WIDTH_M[1] or shoulders < SHOULDERS * wide:
        return HEADLESS * size
    return size * (0.8 if height > 1.4 else 0.6)
