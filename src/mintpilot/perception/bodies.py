"""From surfaces to bodies: floor, tables, walls, and everything that stands on or before them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum

import numpy as np
from scipy.ndimage import label

from mintpilot.core.compiled import compiled
from mintpilot.core.geometry import Bools, Ints
from mintpilot.perception.grouping import enclosing, groups_of, settled
from mintpilot.perception.holding import flush
from mintpilot.perception.patches import Patch, measured
from mintpilot.perception.surfaces import NOISE_SHARE, Surfaces, surfaces_of
from mintpilot.perception.view import Singles, View, as_floats

LEAST_SHARE = 0.0004
"""Patches of less than this share of the picture are noise."""
LEAST_PIXELS = 24
SURFACE_M2, SURFACE_LEVEL = 0.2, 0.85
"""A level surface of this area, with so much of it level, is what things stand on."""
BOARD_LEVEL, BOARD_M = 0.5, 0.12
"""Of a board so thin less needs to be level: its front edge is seen too."""
WALL_M2, WALL_UPRIGHT, WALL_TALL_M = 0.5, 0.85, 0.9
"""An upright flat surface of this area is a wall; one of half the area where it is also half of this high and wide."""
FLOOR_M = 0.08
"""Level surfaces that begin no higher than this above the floor are floor …"""
TILT = 0.03
"""… or, far away, than this share of the distance: up is not known better."""
ON_PLANE_M, ON_PLANE_SIGMAS = 0.006, 3.0
"""What lies this near to a surface is part of it."""
FLAT_M = 0.012
"""Standard deviation of a flat body's smoothed points from its plane, close by, metres."""
DETACHED = 0.2
"""Pieces of less than this share of a surface may be the inside of something."""
LARGEST_M = 2.6
"""What is longer is no thing."""


class BodyKind(StrEnum):
    """What a body is to the place."""

    FLOOR = "floor"
    SURFACE = "surface"
    """A table top, shelf or bed: level, large, above the floor."""
    WALL = "wall"
    THING = "thing"


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Body:
    """One body in a picture."""

    kind: BodyKind
    mask: Bools
    """Its pixels (h, w)."""
    patch: Patch
    """What was measured of its largest part."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Scene:
    """All bodies of one view."""

    surfaces: Surfaces
    bodies: tuple[Body, ...]

    @property
    def things(self) -> tuple[Body, ...]:
        """Those that are neither floor, surface nor wall."""
        return tuple(b for b in self.bodies if b.kind is BodyKind.THING)


def bodies_of(view: View, floor_m: float) -> Scene:
    """Parts a view into bodies."""
    surfaces = surfaces_of(view)
    labels, count = label(~surfaces.edges & view.valid)
    least = max(LEAST_PIXELS, LEAST_SHARE * labels.size)
    sizes = np.bincount(labels.ravel(), minlength=count + 1)
    sizes[0] = 0
    numbers = np.flatnonzero(sizes >= least)
    numbered = np.zeros(count + 1, np.int64)
    numbered[numbers] = np.arange(1, len(numbers) + 1)
    marks = np.ascontiguousarray(numbered[labels], np.int64)
    patches = measured(view, surfaces, marks, len(numbers))
    kinds = [_kind(p, floor_m) for p in patches]
    _take_coplanar(view, surfaces, marks, patches, kinds)
    _take_flush(surfaces, marks, patches, kinds)
    marks = _grown(marks, np.where(view.valid, view.depth_m, 0).astype(np.float32), surfaces.jump_m, 40)
    is_thing = [k is BodyKind.THING for k in kinds]
    is_support = [k in (BodyKind.FLOOR, BodyKind.SURFACE) for k in kinds]
    groups = groups_of(surfaces, marks, patches, is_thing, is_support)
    groups = settled(groups, patches, is_thing, [p for p, s in zip(patches, is_support, strict=True) if s])
    _returned(marks, patches, kinds, groups)
    return Scene(surfaces=surfaces, bodies=_as_bodies(view, marks, patches, kinds, groups))


def _kind(patch: Patch, floor_m: float) -> BodyKind:
    size = patch.hi_m - patch.lo_m
    flat = patch.flatness_m < FLAT_M + 0.6 * patch.sigma_m
    if patch.level > SURFACE_LEVEL and patch.lo_m[2] < floor_m + FLOOR_M + TILT * patch.distance_m:
        return BodyKind.FLOOR
    board = patch.level > BOARD_LEVEL and size[2] < BOARD_M
    if (patch.level > SURFACE_LEVEL or board) and patch.level * patch.area_m2 > SURFACE_M2 and flat:
        return BodyKind.SURFACE
    wide = float(np.hypot(size[0], size[1]))
    tall = patch.area_m2 > WALL_M2 or (min(size[2], wide) > WALL_TALL_M / 2 and patch.area_m2 > WALL_M2 / 2)
    if patch.upright > WALL_UPRIGHT and flat and tall:
        return BodyKind.WALL
    return BodyKind.WALL if float(np.linalg.norm(size)) > LARGEST_M else BodyKind.THING


def _take_coplanar(
    view: View, surfaces: Surfaces, marks: Ints, patches: Sequence[Patch], kinds: list[BodyKind]
) -> None:
    """Gives pixels that lie in a large surface's plane, and hang together with it, to that surface.

    Small patches are taken whole when they lie in the plane: a table is one surface, whatever lies across it.
    """
    large = [i for i, k in enumerate(kinds) if k in (BodyKind.FLOOR, BodyKind.SURFACE)]
    tolerance = ON_PLANE_M + ON_PLANE_SIGMAS * NOISE_SHARE * surfaces.depth_m**2
    for i in sorted(large, key=lambda i: -patches[i].pixels):
        patch = patches[i]
        off = np.abs(surfaces.points_m @ patch.normal.astype(np.float32) - np.float32(patch.offset_m))
        near = (off < tolerance) & view.valid
        for j, other in enumerate(patches):
            if j == i or kinds[j] is BodyKind.WALL or (kinds[j] is not BodyKind.THING and other.pixels > patch.pixels):
                continue
            own = marks == other.number
            if own.any() and float(near[own].mean()) > 0.8:
                marks[own] = patch.number
                kinds[j] = kinds[i]
        loose = near & (marks == 0)
        touching, count = label(loose | (marks == patch.number))
        joined = np.zeros(count + 1, bool)
        joined[np.unique(touching[marks == patch.number])] = True
        joined[0] = False
        marks[joined[touching] & loose] = patch.number


@compiled(error_model="numpy")
def _grown(marks: Ints, depth: Singles, jump: Singles, steps: int) -> Ints:
    """Gives each loose pixel with depth to the neighbouring patch that is nearest in depth, ring after ring."""
    height, width = marks.shape
    grown = marks.copy()
    for _ in range(steps):
        before = grown.copy()
        changed = False
        for v in range(height):
            for u in range(width):
                if before[v, u] != 0 or depth[v, u] <= 0:
                    continue
                best, least = 0, jump[v, u]
                for dv, du in ((-1, 0), (1, 0), (0, -1), (0, 1)):
                    y, x = v + dv, u + du
                    if 0 <= y < height and 0 <= x < width and before[y, x] != 0:
                        off = abs(depth[y, x] - depth[v, u])
                        if off < least:
                            best, least = before[y, x], off
                if best != 0:
                    grown[v, u] = best
                    changed = True
        if not changed:
            break
    return grown


def _take_flush(surfaces: Surfaces, marks: Ints, patches: Sequence[Patch], kinds: list[BodyKind]) -> None:
    """Gives patches that lie in a wall, or right before it, to that wall: what is seen between the legs of a chair."""
    walls = [p for p, k in zip(patches, kinds, strict=True) if k is BodyKind.WALL]
    for j, patch in enumerate(patches):
        if kinds[j] is not BodyKind.THING:
            continue
        own = as_floats(surfaces.points_m[marks == patch.number])
        if any(len(own) and flush(own, wall) for wall in walls):
            kinds[j] = BodyKind.WALL


def _returned(marks: Ints, patches: Sequence[Patch], kinds: Sequence[BodyKind], groups: Sequence[int]) -> None:
    """Gives detached pieces of floors and surfaces to the thing around them: one looks into a bowl, not through it."""
    numbered = np.zeros(len(patches) + 1, np.int64)
    for patch, kind, group in zip(patches, kinds, groups, strict=True):
        numbered[patch.number] = group + 1 if kind is BodyKind.THING else 0
    for patch, kind in zip(patches, kinds, strict=True):
        if kind not in (BodyKind.FLOOR, BodyKind.SURFACE):
            continue
        pieces, count = label(marks == patch.number)
        sizes = np.bincount(pieces.ravel(), minlength=count + 1)
        for piece in range(1, count + 1):
            if sizes[piece] < DETACHED * sizes[1:].sum():
                group = enclosing(pieces == piece, numbered[marks])
                if group:
                    marks[pieces == piece] = patches[group - 1].number


def _as_bodies(
    view: View, marks: Ints, patches: Sequence[Patch], kinds: Sequence[BodyKind], groups: Sequence[int]
) -> tuple[Body, ...]:
    bodies = []
    for group in sorted(set(groups)):
        members = [i for i, g in enumerate(groups) if g == group]
        main = max(members, key=lambda i: patches[i].pixels)
        mask = np.isin(marks, [patches[i].number for i in members]) & view.valid
        if not mask.any():
            continue
        bodies.append(Body(kind=kinds[main], mask=mask, patch=patches[main]))
    return tuple(bodies)
