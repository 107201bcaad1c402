"""Flames that nobody sees: where smoke glows and no flames that were seen explain it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from mintpilot.core.geometry import Box, GridFrame
from mintpilot.core.observation import Detection
from mintpilot.mapping.smoke import Cloud, cells_in

EXPLAINED_M = 2.0
"""Distance from flames that were seen within which light is theirs, metres."""
WIDEST_M = 2.5
"""Distance between lit fronts up to which they belong to the same flames, metres."""
LEAST_M3 = 0.05
"""Amount of smoke in the light of flames below which it is a reflection."""


class Glow:
    """Smoke that flames light up, voxel by voxel."""

    def __init__(self, frame: GridFrame) -> None:
        self._frame = frame
        self._lit: NDArray[np.int32] = np.zeros(frame.shape, np.int32)

    def add(self, detections: tuple[Detection, ...]) -> None:
        """Counts the lit smoke of one frame."""
        lit = np.zeros(self._frame.shape, bool)
        for detection in detections:
            if detection.label == "glow" and detection.points_m is not None:
                cells = self._frame.cells_of(detection.points_m)
                z, y, x = cells[self._frame.contains(cells)].T
                lit[z, y, x] = True
        self._lit += lit

    def boxes(self, clouds: list[Cloud], flames: list[Box], smoke: NDArray[np.int32]) -> list[Box]:
        """What lies between the lit fronts of each cloud: somewhere in there are flames.

        Args:
            clouds: where to look.
            flames: those that were seen.
            smoke: (nz, ny, nx) number of frames that showed smoke in a voxel, lit or not.
        """
        lit = (self._lit >= 2) & (2 * self._lit >= smoke)
        for box in flames:
            (x0, y0, z0), (x1, y1, z1) = box.lo_m, box.hi_m
            lo = (x0 - EXPLAINED_M, y0 - EXPLAINED_M, z0 - EXPLAINED_M)
            hi = (x1 + EXPLAINED_M, y1 + EXPLAINED_M, z1 + EXPLAINED_M)
            lit &= ~cells_in(self._frame, Box(lo_m=lo, hi_m=hi))
        if not lit.any():
            return []
        boxes, edge = [], self._frame.resolution_m
        reach = 2 * max(1, round(WIDEST_M / edge / 2)) + 1
        for cloud in clouds:
            mask = lit & cells_in(self._frame, cloud.box_m)
            labels, _ = ndimage.label(ndimage.maximum_filter(mask.astype(np.uint8), size=reach))
            for number in np.unique(labels[mask]):
                cells = np.argwhere(mask & (labels == number))[:, ::-1]
                if len(cells) * edge**3 >= LEAST_M3:
                    boxes.append(_around(cells.min(axis=0), cells.max(axis=0) + 1, self._frame))
        return boxes


def _around(lo: NDArray[np.int64], hi: NDArray[np.int64], frame: GridFrame) -> Box:
    (x0, y0, z0), (x1, y1, z1) = ((np.asarray(frame.origin_m) + frame.resolution_m * c).tolist() for c in (lo, hi))
    return Box(lo_m=(x0, y0, z0), hi_m=(x1, y1, z1))
