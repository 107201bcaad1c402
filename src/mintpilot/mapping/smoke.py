"""Clouds: smoke points of many frames into regions that cover the whole of each cloud, the unseen inside too."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from mintpilot.core.geometry import Bools, Box, Floats, GridFrame, Ints
from mintpilot.core.observation import Detection
from mintpilot.mapping.settings import MappingSettings

STRAY = 0.12
"""Share of the voxels of a cloud's thick slices that a slice must have to belong to it."""


FREE_BETWEEN = 0.25
"""Share of known free space between two near clouds up to which they are one."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SmokeEvidence:
    """What is known of the voxels besides smoke; each array is (nz, ny, nx)."""

    solid: NDArray[np.int32]
    """In how many frames a ray from near ended there."""
    free: Bools
    """Known free."""
    blazing: Bools
    """Where flames are: their fringe is as soft as smoke, but no cloud."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Cloud:
    """One cloud as far as it is known."""

    box_m: Box
    """Conservative extent."""
    best_view: tuple[int, int, int, int, int] | None


class Clouds:
    """Smoke seen so far, voxel by voxel."""

    def __init__(self, frame: GridFrame) -> None:
        self._frame = frame
        self.seen: NDArray[np.int32] = np.zeros(frame.shape, np.int32)
        """(nz, ny, nx) number of frames that showed smoke in a voxel."""
        self.against: NDArray[np.int32] = np.zeros(frame.shape, np.int32)
        """(nz, ny, nx) number of frames that looked through a voxel."""
        self._views: list[tuple[Floats, tuple[int, int, int, int, int], float]] = []

    def add(self, detections: tuple[Detection, ...]) -> NDArray[np.uint8]:
        """Counts the smoke of one frame; returns where it is, (nz, ny, nx) uint8, one voxel wider than the points."""
        mask = np.zeros(self._frame.shape, np.uint8)
        for detection in detections:
            if detection.label != "smoke" or detection.points_m is None or not len(detection.points_m):
                continue
            cells = self._frame.cells_of(detection.points_m)
            z, y, x = cells[self._frame.contains(cells)].T
            mask[z, y, x] = 1
            left, top, right, bottom = detection.pixels
            view = (detection.frame_index, left, top, right, bottom)
            area = float(max(0, right - left) * max(0, bottom - top))
            self._views.append((np.median(detection.points_m, axis=0), view, area))
        if not mask.any():
            return mask
        self.seen += mask
        return np.asarray(ndimage.maximum_filter(mask, size=3), np.uint8)

    def contradict(self, clear: Bools) -> None:
        """Counts the voxels (nz, ny, nx) that one frame looked through."""
        self.against += clear

    def front_of(self, clouds: list[Cloud], solid: NDArray[np.int32]) -> Bools:
        """Voxels (nz, ny, nx) in clouds that are no more than a front taken for something solid now and then.

        Args:
            clouds: where.
            solid: (nz, ny, nx) number of frames in which a ray from near ended in a voxel. What stands inside a
                cloud was seen so often from near without smoke around it that it stays.
        """
        front = np.zeros(self._frame.shape, bool)
        for cloud in clouds:
            front |= cells_in(self._frame, cloud.box_m)
        near_smoke = ndimage.maximum_filter(self.seen, size=3)
        front &= (solid < 2) | (near_smoke >= 0.4 * solid)
        return front

    def clouds(self, evidence: SmokeEvidence, volume: Box, settings: MappingSettings) -> list[Cloud]:
        """The clouds known so far, from west to east.

        Each is the upright box around its visible front, with a margin for the thin edge that the sensor looks
        through, drawn to the floor and to the roof where it comes near them. A box, because the inside of a cloud
        is never seen: whatever lies between two fronts belongs to it. A solid return from far away does not speak
        against smoke, since a cloud looks solid from there.

        Args:
            evidence: what is known of the voxels besides smoke.
            volume: the hall.
            settings: thresholds and the margin.
        """
        mask = (
            (self.seen >= 2)
            & ~evidence.blazing
            & (self.seen >= settings.smoke_share * (self.seen + self.against + evidence.solid))
        )
        if not mask.any():
            return []
        reach = 2 * max(1, round(settings.smoke_gap_m / self._frame.resolution_m / 2)) + 1
        labels, count = ndimage.label(ndimage.maximum_filter(mask.astype(np.uint8), size=reach))
        clouds = []
        for number in range(1, count + 1):
            cells = np.argwhere(mask & (labels == number))
            if (box := self._extent(cells, volume, settings)) is not None:
                clouds.append(Cloud(box_m=box, best_view=self._best_view(box)))
        return sorted(_merged(clouds, self._frame, evidence.free, settings), key=lambda c: c.box_m.lo_m)

    def _extent(self, cells: Ints, volume: Box, settings: MappingSettings) -> Box | None:
        if len(cells) * self._frame.resolution_m**3 < settings.least_smoke_m3:
            return None
        spans = [_thick_span(cells[:, axis]) for axis in (2, 1, 0)]
        origin, edge = np.asarray(self._frame.origin_m), self._frame.resolution_m
        lo = origin + edge * np.array([first for first, _ in spans])
        hi = origin + edge * np.array([last + 1 for _, last in spans])
        if hi[2] - lo[2] < settings.least_smoke_height_m:
            return None
        lo, hi = lo - settings.smoke_margin_m, hi + settings.smoke_margin_m
        near = 0.8  # nobody can fly in a gap thinner than this, and fronts near floor and roof are seen worst
        lo[2] = volume.lo_m[2] if lo[2] < volume.lo_m[2] + near else lo[2]
        hi[2] = volume.hi_m[2] if hi[2] > volume.hi_m[2] - near else hi[2]
        lo = np.clip(lo, volume.lo_m, volume.hi_m)
        hi = np.clip(hi, volume.lo_m, volume.hi_m)
        return Box(lo_m=(float(lo[0]), float(lo[1]), float(lo[2])), hi_m=(float(hi[0]), float(hi[1]), float(hi[2])))

    def _best_view(self, box: Box) -> tuple[int, int, int, int, int] | None:
        inside = [(area, view) for point, view, area in self._views if bool(box.contains(point)[0])]
        return max(inside)[1] if inside else None


def _thick_span(indices: Ints) -> tuple[int, int]:
    """First and last slice of a cloud: those with few voxels, against its thick ones, are stray returns."""
    counts = np.bincount(indices)
    slices = np.flatnonzero(counts >= STRAY * np.percentile(counts[counts > 0], 80))
    return int(slices[0]), int(slices[-1])


def cells_in(frame: GridFrame, box: Box) -> Bools:
    """Which cells (nz, ny, nx) have their centre in the box."""
    inside = np.ones(frame.shape, bool)
    for axis, cell_axis in ((0, 2), (1, 1), (2, 0)):
        n = frame.shape[cell_axis]
        centres = frame.origin_m[axis] + (np.arange(n) + 0.5) * frame.resolution_m
        line = (centres >= box.lo_m[axis]) & (centres <= box.hi_m[axis])
        inside &= line.reshape([-1 if a == cell_axis else 1 for a in range(3)])
    return inside


def _merged(clouds: list[Cloud], frame: GridFrame, free: Bools, settings: MappingSettings) -> list[Cloud]:
    """Clouds that belong together as one: a region is passable or not as a whole.

    Overlapping ones do, and near ones with hardly any known free space between them: two sides of one cloud whose
    inside nobody has seen.
    """
    for i, a in enumerate(clouds):
        for b in clouds[i + 1 :]:
            if _is_one(a.box_m, b.box_m, frame, free, settings):
                rest = [c for c in clouds if c is not a and c is not b]
                joint = Cloud(box_m=a.box_m.around(b.box_m), best_view=a.best_view or b.best_view)
                return _merged([*rest, joint], frame, free, settings)
    return clouds


def _is_one(a: Box, b: Box, frame: GridFrame, free: Bools, settings: MappingSettings) -> bool:
    gap = float(np.max(np.maximum(np.subtract(a.lo_m, b.hi_m), np.subtract(b.lo_m, a.hi_m))))
    if gap < 0:
        return True
    between = cells_in(frame, a.around(b)) & ~cells_in(frame, a) & ~cells_in(frame, b)
    return gap <= settings.widest_inside_m and float(free[between].mean()) <= FREE_BETWEEN
