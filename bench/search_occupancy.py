"""A map that others made: a depot in ROS map_server form, its keep-out mask read as regions of unknown passability."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from PIL import Image
from scipy import ndimage

from bench.search_worlds import Cell3
from mintpilot.core.geometry import GridFrame, Ints
from mintpilot.core.observation import RegionKind
from mintpilot.core.plan import VehicleLimits
from mintpilot.core.semantic_map import Cell, Region, SemanticMap
from mintpilot.planning.flyable import flyable_cells, region_reach
from mintpilot.planning.joint_search import JointSearch

DATA = Path(__file__).resolve().parents[2] / "shared" / "data" / "occupancy"
LIMITS = VehicleLimits(radius_m=0.2, margin_m=0.05)
SMALLEST = 60
"""Patches of the mask with fewer cells of 5 cm are specks of the drawing."""


def depot_map() -> tuple[SemanticMap, tuple[Ints, ...]]:
    """The depot with its regions, and each region as the vehicle's centre would touch it."""
    grey = np.array(Image.open(DATA / "depot.pgm"))[::-1]
    mask = np.array(Image.open(DATA / "depot_keepout.pgm"))[::-1] == 0
    cells = np.select([grey > 250, grey < 100], [int(Cell.FREE), int(Cell.OCCUPIED)], int(Cell.UNKNOWN))[None]
    parts, count = ndimage.label(mask & (grey > 250), np.ones((3, 3)))
    frame = GridFrame(origin_m=(0.0, 0.0, 0.0), resolution_m=0.05, shape=(1, *grey.shape))
    patches = [np.flatnonzero(parts == i + 1).astype(np.int64) for i in range(count)]
    regions = tuple(
        Region(id=f"keep-out-{i}", kind=RegionKind.AREA, cells=cells_of)
        for i, cells_of in enumerate(p for p in patches if p.size >= SMALLEST)
    )
    world = SemanticMap(frame=frame, cells=cells.astype(np.uint8), regions=regions)
    return world, tuple(region_reach(world, region, LIMITS) for region in regions)


def depot(quick: bool = False) -> tuple[str, JointSearch, tuple[Cell3, Cell3]] | None:
    """Name, search and far ends; None where the data is not beside the project."""
    if not DATA.is_dir():
        return None
    world, regions = depot_map()
    free = flyable_cells(world, LIMITS)
    outside = free.copy()
    for cells in regions:
        outside.ravel()[cells] = False
    parts, _ = ndimage.label(free)
    ends = np.argwhere(outside & (parts == np.bincount(parts[outside]).argmax()))
    order = np.argsort(ends @ np.array([0, 1, 1]), kind="stable")
    first, last = (tuple(int(i) for i in ends[order[i]]) for i in (0, -1))
    used = regions[:6] if quick else regions
    name = f"ROS depot {world.frame.shape[2]} x {world.frame.shape[1]}"
    return name, JointSearch(free, used), ((0, *first[1:]), (0, *last[1:]))
