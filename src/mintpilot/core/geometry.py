"""Where things are. World frame: metres, right-handed, x east, y north, z up (ENU)."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mintpilot.core.errors import MapError

Floats: TypeAlias = NDArray[np.float64]
Ints: TypeAlias = NDArray[np.int64]
SmallInts: TypeAlias = NDArray[np.int8]
Bools: TypeAlias = NDArray[np.bool_]
Vec3: TypeAlias = tuple[float, float, float]


def frozen(array: NDArray[np.generic]) -> None:
    """Makes an array read-only: nouns that hold arrays are values."""
    array.setflags(write=False)


@dataclass(frozen=True, slots=True, kw_only=True)
class Box:
    """An axis-aligned box in the world frame."""

    lo_m: Vec3
    """Lowest corner (x, y, z), metres."""
    hi_m: Vec3
    """Highest corner (x, y, z), metres; no coordinate below that of ``lo_m``."""

    def __post_init__(self) -> None:
        if any(not low <= high for low, high in zip(self.lo_m, self.hi_m, strict=True)):
            raise MapError(f"box from {self.lo_m} to {self.hi_m}: each upper corner must be at or above the lower one")

    @property
    def centre_m(self) -> Vec3:
        """Centre (x, y, z), metres."""
        x, y, z = ((a + b) / 2 for a, b in zip(self.lo_m, self.hi_m, strict=True))
        return (x, y, z)

    @property
    def size_m(self) -> Vec3:
        """Edge lengths (x, y, z), metres."""
        x, y, z = (b - a for a, b in zip(self.lo_m, self.hi_m, strict=True))
        return (x, y, z)

    def apart_m(self, other: Box) -> float:
        """Shortest distance to another box, metres; 0 where they touch or overlap."""
        sides = zip(self.lo_m, self.hi_m, other.lo_m, other.hi_m, strict=True)
        return math.hypot(*(max(0.0, lo - top, bottom - hi) for lo, hi, bottom, top in sides))

    def around(self, other: Box) -> Box:
        """The smallest box that holds both."""
        (x0, y0, z0), (x1, y1, z1) = map(min, self.lo_m, other.lo_m), map(max, self.hi_m, other.hi_m)
        return Box(lo_m=(x0, y0, z0), hi_m=(x1, y1, z1))

    def contains(self, points_m: ArrayLike) -> Bools:
        """Which of the points (n, 3), or the one point (3,), are inside or on the surface."""
        points = np.atleast_2d(np.asarray(points_m, float))
        inside: Bools = np.all((points >= self.lo_m) & (points <= self.hi_m), axis=1)
        return inside


_FARTHEST = 2.0**53


@dataclass(frozen=True, slots=True, kw_only=True)
class GridFrame:
    """The lattice of a voxel map. Arrays over it are indexed ``[z, y, x]``; a 2D map has ``nz == 1``."""

    origin_m: Vec3
    """World position (x, y, z) of the outer corner of cell ``[0, 0, 0]``, metres."""
    resolution_m: float
    """Edge of a cell, metres."""
    shape: tuple[int, int, int]
    """Number of cells (nz, ny, nx)."""

    def __post_init__(self) -> None:
        if not self.resolution_m > 0:
            raise MapError(f"resolution {self.resolution_m} m: a cell's edge must be above 0")
        if min(self.shape) < 1:
            raise MapError(f"grid of shape {self.shape} is empty: give at least one cell along each axis")

    @property
    def is_flat(self) -> bool:
        """True for a 2D map: planning is 8-connected in its one layer."""
        return self.shape[0] == 1

    @property
    def size(self) -> int:
        """Number of cells."""
        return self.shape[0] * self.shape[1] * self.shape[2]

    @property
    def box(self) -> Box:
        """The volume that the grid covers."""
        nz, ny, nx = self.shape
        x, y, z = self.origin_m
        r = self.resolution_m
        return Box(lo_m=self.origin_m, hi_m=(x + nx * r, y + ny * r, z + nz * r))

    def cells_of(self, points_m: ArrayLike) -> Ints:
        """Cells (n, 3) ``[z, y, x]`` of world points (n, 3) ``[x, y, z]``; they may lie outside the grid."""
        points = np.atleast_2d(np.asarray(points_m, float))
        cells = np.floor((points - self.origin_m) / self.resolution_m)
        # Places so far off that their cell is no whole number any more are outside all the same.
        return np.clip(cells, -_FARTHEST, _FARTHEST).astype(np.int64)[:, ::-1]

    def centres_of(self, cells: ArrayLike) -> Floats:
        """World centres (n, 3) ``[x, y, z]``, metres, of cells (n, 3) ``[z, y, x]``."""
        indices = np.atleast_2d(np.asarray(cells, float))
        centres: Floats = np.asarray(self.origin_m) + (indices[:, ::-1] + 0.5) * self.resolution_m
        return centres

    def contains(self, cells: ArrayLike) -> Bools:
        """Which of the cells (n, 3) ``[z, y, x]`` lie in the grid."""
        indices = np.atleast_2d(np.asarray(cells))
        inside: Bools = np.all((indices >= 0) & (indices < self.shape), axis=1)
        return inside
