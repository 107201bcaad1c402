"""Which patches are parts of one body: handles, the inside of bowls, what an occluder cuts in two."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from scipy.spatial import ConvexHull, QhullError

from mintpilot.core.geometry import Bools, Floats, Ints
from mintpilot.perception.holding import height_below, held_together, overlap_m3
from mintpilot.perception.morphology import dilated
from mintpilot.perception.patches import Patch
from mintpilot.perception.surfaces import Surfaces

TOUCH = 2
"""Patches whose pixels are no further apart than twice this touch in the picture."""
ON_SUPPORT, FOOT_M = 0.12, 0.035
"""A patch of which this share of the rim touches what things stand on, and that ends no higher than this above it,
stands there itself."""
ENCLOSED = 0.7
"""A piece of a surface of which this share of the rim touches one thing is inside of that thing."""
INSIDE_M, ABOVE_M = 0.03, 0.01
"""A part lies within the outline of the whole, grown by this much, and ends no higher than this above it."""
RIM_SHARE, RIM_M = 0.05, 0.02
"""The inside of a vessel shares so much of its rim with the outside, and ends at the same height within this."""
FLOATS_M, SHARED = 0.15, 0.05
"""What is so high above what is below it floats; it belongs to a body that shares so much of its extent."""
GAP_M = 0.45
"""Two parts of one thing behind an occluder are no further apart."""
ALIGNED_RAD, ALIGNED_M = math.radians(14.0), 0.015
"""Faces of one thing to either side of an occluder agree so well in direction and place."""
OCCLUDED = 0.8
"""This share of the way between the two parts is covered by something nearer."""


def groups_of(
    surfaces: Surfaces, marks: Ints, patches: Sequence[Patch], is_thing: Sequence[bool], is_support: Sequence[bool]
) -> list[int]:
    """For each patch the index of the patch that stands for its body.

    Args:
        surfaces: of the view.
        marks: number of the patch of each pixel (h, w), 0 for none.
        patches: all patches.
        is_thing: which may be parts of things.
        is_support: which things stand on.
    """
    groups = list(range(len(patches)))
    rims = [_rim(marks == p.number) if thing else None for p, thing in zip(patches, is_thing, strict=True)]
    supports = [p.number for p, support in zip(patches, is_support, strict=True) if support]
    hulls = [_outline(surfaces, marks == p.number) if t else None for p, t in zip(patches, is_thing, strict=True)]
    order = sorted((i for i, thing in enumerate(is_thing) if thing), key=lambda i: patches[i].pixels)
    for i in order:
        whole = _whole_of(i, order, marks, patches, rims, hulls, supports, surfaces)
        if whole is not None and _root(groups, whole) != i:
            groups[i] = whole
    for i in order:
        for j in order:
            rim = rims[i]
            if i != j and rim is not None and _is_vessel(patches[i], patches[j], marks[rim]):
                groups[_root(groups, i)] = _root(groups, j)
    for i in order:
        for j in order:
            if i < j and _root(groups, i) != _root(groups, j) and _cut_in_two(patches[i], patches[j], marks, surfaces):
                groups[_root(groups, j)] = _root(groups, i)
    for i, j in held_together(surfaces, marks, patches, is_thing):
        if _root(groups, i) != _root(groups, j):
            groups[_root(groups, j)] = _root(groups, i)
    return [_root(groups, i) for i in range(len(groups))]


def settled(
    groups: Sequence[int], patches: Sequence[Patch], is_thing: Sequence[bool], supports: Sequence[Patch]
) -> list[int]:
    """The groups with those that float in the air joined to the body whose extent they share most of.

    The back of a chair is seen above its seat, which hides where the two meet.
    """
    joined = list(groups)
    extents = {}
    for group in sorted({g for g, thing in zip(groups, is_thing, strict=True) if thing}):
        members = [p for p, g in zip(patches, groups, strict=True) if g == group]
        extents[group] = (np.min([p.lo_m for p in members], axis=0), np.max([p.hi_m for p in members], axis=0))
    lowest = min((p.lo_m[2] for p in supports), default=-math.inf)
    for group, (lo, hi) in extents.items():
        below, _ = height_below(lo, hi, supports, float(lowest))
        if lo[2] - below < FLOATS_M:
            continue
        shared = {g: overlap_m3((lo, hi), other) for g, other in extents.items() if g != group and other[0][2] < lo[2]}
        best = max(shared, key=lambda g: shared[g], default=None)
        if best is not None and shared[best] > SHARED * float(np.prod(np.maximum(hi - lo, 0.01))):
            joined = [best if g == group else g for g in joined]
            if joined[best] == group:  # the other one was joined to this one before
                joined = [best if g == group else g for g in joined]
    return joined


def enclosing(piece: Bools, groups: Ints) -> int:
    """Group (1 and above) that encloses a detached piece of a surface, such as the bottom of a bowl; 0 for none.

    Args:
        piece: the pixels (h, w).
        groups: number of the group of each pixel that is part of a thing (h, w), else 0.
    """
    around = groups[_rim(piece)]
    counts = np.bincount(around, minlength=1)
    counts[0] = 0
    return int(np.argmax(counts)) if counts.max() > ENCLOSED * around.size else 0


def _root(groups: list[int], index: int) -> int:
    while groups[index] != index:
        index = groups[index]
    return index


def _rim(mask: Bools) -> Bools:
    """The pixels right outside of a patch."""
    rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
    rim = np.zeros(mask.shape, bool)
    if not rows.size:
        return rim
    grow = 2 * TOUCH
    window = (
        slice(max(0, rows[0] - grow), rows[-1] + grow + 1),
        slice(max(0, columns[0] - grow), columns[-1] + grow + 1),
    )
    rim[window] = dilated(mask[window], grow) & ~dilated(mask[window], TOUCH - 1)
    return rim


def _outline(surfaces: Surfaces, mask: Bools) -> Floats | None:
    """Half-planes (n, 3) of the convex outline of a patch seen from above: a x + b y + c <= 0 inside."""
    points = surfaces.points_m[mask][:, :2].astype(float)
    if len(points) < 8:
        return None
    try:
        hull: Floats = ConvexHull(points[:: max(1, len(points) // 400)]).equations
    except QhullError:
        return None
    return hull


def _whole_of(
    part: int,
    order: Sequence[int],
    marks: Ints,
    patches: Sequence[Patch],
    rims: Sequence[Bools | None],
    hulls: Sequence[Floats | None],
    supports: Sequence[int],
    surfaces: Surfaces,
) -> int | None:
    """The larger thing that a patch is a part of: it touches it, does not stand for itself, and lies within it."""
    rim = rims[part]
    assert rim is not None
    around = marks[rim]
    below = np.isin(around, supports)
    if not around.size or (
        below.mean() > ON_SUPPORT
        and patches[part].lo_m[2] - float(np.median(surfaces.points_m[rim][below, 2])) < FOOT_M
    ):
        return None
    own = surfaces.points_m[marks == patches[part].number][:, :2].astype(float)
    best, most = None, 0.15 * around.size
    for i in order:
        hull = hulls[i]
        touching = float((around == patches[i].number).sum())
        if i == part or hull is None or patches[i].pixels <= patches[part].pixels or touching <= most:
            continue
        if patches[part].hi_m[2] > patches[i].hi_m[2] + ABOVE_M:
            continue
        inside = (own @ hull[:, :2].T + hull[:, 2] <= INSIDE_M).all(axis=1)
        if float(inside.mean()) > 0.85:
            best, most = i, touching
    return best


def _is_vessel(inside: Patch, outside: Patch, around: Ints) -> bool:
    """Whether one patch is the inside of the open vessel of which another one is the near wall."""
    if not inside.hollow or inside.distance_m < outside.distance_m:
        return False
    if abs(float(inside.hi_m[2] - outside.hi_m[2])) > RIM_M + 2 * inside.sigma_m:
        return False
    return bool(around.size) and float((around == outside.number).mean()) > RIM_SHARE


def _cut_in_two(a: Patch, b: Patch, marks: Ints, surfaces: Surfaces) -> bool:
    """Whether two patches are what shows of one thing to either side of something nearer."""
    gap = np.maximum(0.0, np.maximum(a.lo_m - b.hi_m, b.lo_m - a.hi_m))
    if float(np.linalg.norm(gap)) > GAP_M or not _aligned(a, b):
        return False
    return _covered(marks, a.number, b.number, surfaces)


def _aligned(a: Patch, b: Patch) -> bool:
    """Whether two patches have faces in common, and none that disagrees."""
    tolerance = ALIGNED_M + 2 * max(a.sigma_m, b.sigma_m)
    agreeing = 0
    if a.top_m is not None and b.top_m is not None:
        if abs(a.top_m - b.top_m) > tolerance:
            return False
        agreeing += 1
    if a.side is not None and b.side is not None:
        if float(a.side @ b.side) < math.cos(ALIGNED_RAD) or abs(a.side_m - b.side_m) > tolerance:
            return False
        agreeing += 1
    same_height = abs(float(a.hi_m[2] - b.hi_m[2])) < 2 * tolerance
    return agreeing >= 1 and same_height


def _covered(marks: Ints, a: int, b: int, surfaces: Surfaces) -> bool:
    """Whether the straight way in the picture between two patches is covered by what is nearer than both."""
    first, second = np.argwhere(marks == a), np.argwhere(marks == b)
    if not len(first) or not len(second):
        return False
    begin, end = _nearest_pair(first, second)
    steps = int(np.abs(end - begin).max()) + 1
    way = np.round(np.linspace(begin, end, steps + 1)[1:-1]).astype(int)
    if not len(way):
        return False
    depth = surfaces.depth_m
    ends = float(min(depth[tuple(begin)], depth[tuple(end)]))
    on = marks[way[:, 0], way[:, 1]]
    between = (on != a) & (on != b)
    if not between.any():
        return False
    near = depth[way[:, 0], way[:, 1]]
    hidden = (near == 0) | (near < ends - surfaces.jump_m[tuple(begin)])
    return float(hidden[between].mean()) >= OCCLUDED and bool((near[between] > 0).any())


def _nearest_pair(first: Ints, second: Ints) -> tuple[Ints, Ints]:
    """The ends of the way between two sets of pixels (n, 2): near the line that joins their middles."""
    a, b = first.mean(axis=0), second.mean(axis=0)
    ahead = (b - a) / max(float(np.linalg.norm(b - a)), 1e-9)
    aside = np.array([-ahead[1], ahead[0]])

    def end(pixels: Ints, sign: float) -> Ints:
        offset = pixels - (a + b) / 2
        central = np.abs(offset @ aside) <= np.percentile(np.abs(offset @ aside), 30)
        picked: Ints = pixels[central][int(np.argmax(sign * (offset[central] @ ahead)))]
        return picked

    return end(first, 1.0), end(second, -1.0)
