"""Ways through what cannot be seen: the middle of the gap, since walls go on inside a cloud."""

from __future__ import annotations

import numpy as np
from scipy import ndimage

from mintpilot.core.geometry import Bools, Floats

CLEARANCES_M = (2.0, 1.75, 1.5, 1.25, 1.0, 0.75, 0.5, 0.25)
"""Distances to keep from what is solid, besides the vehicle's own, the largest first."""
TOUCHING = 1
"""Only what stands inside a cloud, or no more voxels than this beside it, may go on inside."""
DEAD_END_M = 0.5
"""At most so much where the cloud leads nowhere: whoever wants to go into it must still find room."""
RING_M = 0.6
"""What is connected is judged in a ring of this width around the cloud, besides the vehicle's own size."""
ROOMY_M3 = 1.0
"""Pockets of free space smaller than this need not stay connected."""
TALL_M = 0.6
"""Walls and racks are taller than this; floors, roofs and things that lie about are not."""
_APART = 1e6  # between layers: only what stands beside a cell counts, neither floor nor roof


def hugging(cloud: Bools, solid: Bools, free: Bools, *, resolution_m: float, hull_m: float) -> Bools:
    """Unseen voxels of a cloud that are not to be counted on, because they are next to something solid.

    What is solid at the edge of a cloud often goes on inside, where no sensor sees it. So the way through keeps away
    from it, by as much as can be had while all roomy places that the cloud connects stay connected: to the middle.

    Args:
        cloud: voxels of the cloud (nz, ny, nx).
        solid: voxels known to be occupied.
        free: voxels known to be free.
        resolution_m: edge of a voxel.
        hull_m: radius of the vehicle with its margin.

    Returns:
        Voxels (nz, ny, nx) of the cloud.
    """
    near = np.zeros(cloud.shape, bool)
    found = np.argwhere(cloud)
    if not len(found) or not solid.any():
        return near
    reach = int(np.ceil((RING_M + hull_m) / resolution_m)) + 1
    around = np.array([0, reach, reach])
    lo, hi = np.maximum(found.min(axis=0) - around, 0), found.max(axis=0) + 1 + around
    part = tuple(slice(int(a), int(b)) for a, b in zip(lo, hi, strict=True))
    inside, hard = cloud[part], solid[part]
    tall = hard.sum(axis=0) * resolution_m >= TALL_M
    beside = hard & tall & ndimage.binary_dilation(inside, np.ones((1, 3, 3), bool), iterations=TOUCHING)
    if not beside.any():
        return near
    clear = _away_m(hard, resolution_m) >= hull_m
    away_m = _away_m(beside, resolution_m)
    shore = _roomy(free[part] & ~inside & clear, resolution_m)
    whole = _connected(shore, inside & clear)
    leads_on = whole < _connected(shore, np.zeros_like(inside))
    for clearance_m in [c for c in CLEARANCES_M if leads_on or c <= DEAD_END_M]:
        if _connected(shore, inside & clear & (away_m >= hull_m + clearance_m)) == whole:
            near[part] = inside & (away_m < clearance_m) & ~free[part]
            return near
    return near


def _roomy(shore: Bools, resolution_m: float) -> Bools:
    """The parts of it that are no mere pockets."""
    labels, _ = ndimage.label(shore)
    sizes_m3 = np.bincount(labels.ravel()) * resolution_m**3
    roomy: Bools = shore & (sizes_m3 >= ROOMY_M3)[labels]
    return roomy


def _away_m(solid: Bools, resolution_m: float) -> Floats:
    """Distance of every voxel to what is solid in its layer, metres."""
    away: Floats = ndimage.distance_transform_edt(~solid, sampling=(_APART, resolution_m, resolution_m))
    return away


def _connected(shore: Bools, passage: Bools) -> int:
    """Number of parts that the shore falls into where one may also go through the passage."""
    labels, _ = ndimage.label(shore | passage)
    return int(np.unique(labels[shore]).size)
