"""Objects that a mission file lists, as matter on its map."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from mintpilot.core.geometry import Box, GridFrame
from mintpilot.core.semantic_map import Cell, MapObject, SemanticMap
from mintpilot.mapping.outline import cells_in_box

THIN_M = 1e-3
"""Thickness that an object without extent along one axis is given, metres: a plate is solid too."""


def with_solid_objects(map: SemanticMap, clearance_m: float) -> SemanticMap:
    """The map with every cell occupied of which a solid object fills a part.

    Args:
        map: the map with its objects; those that are not solid or have no size mark nothing.
        clearance_m: distance kept from matter, metres. On a flat map an object counts as soon as it comes nearer than
            this to the height that is flown at; the drone passes above or below any other.
    """
    boxes = [solid_box(thing) for thing in map.objects]
    marked = [cells_in_box(map.frame, box) for box in boxes if box and _reaches(box, map.frame, clearance_m)]
    if not any(cells.size for cells in marked):
        return map
    filled = np.array(map.cells)
    filled.ravel()[np.concatenate(marked)] = Cell.OCCUPIED
    return replace(map, cells=filled)


def solid_box(thing: MapObject) -> Box | None:
    """What an object fills; None where it is not solid or has no size."""
    if not thing.solid or not any(thing.box_m.size_m):
        return None
    spare = np.where(np.array(thing.box_m.size_m) > 0, 0.0, THIN_M / 2)
    low, high = thing.box_m.lo_m - spare, thing.box_m.hi_m + spare
    return Box(
        lo_m=(float(low[0]), float(low[1]), float(low[2])), hi_m=(float(high[0]), float(high[1]), float(high[2]))
    )


def _reaches(box: Box, frame: GridFrame, clearance_m: float) -> bool:
    flown_m = frame.origin_m[2] + frame.resolution_m / 2
    return not frame.is_flat or box.lo_m[2] - clearance_m < flown_m < box.hi_m[2] + clearance_m
