"""Where to hover for a site: one flyable cell, chosen the same way every time."""

from __future__ import annotations

import numpy as np

from mintpilot.core.geometry import Bools, Ints
from mintpilot.core.plan import Site
from mintpilot.planning.terrain import Terrain, cells_around, distances_m, rays

AT_ONCE = 32
"""For so many cells at a time it is looked whether they see the site: most often one of the first ones does."""


def approach_cell(terrain: Terrain, site: Site) -> Ints | None:
    """The cell (3,) from which a site is served; None where nothing within reach can be flown to.

    Among the cells within ``reach_m`` that can be reached if every gap turns out well: those that see the site first,
    then those outside open regions, then the nearest one, then the lowest index. Where cells are so large that there is
    none, those up to an edge further away count, too: beside or above a thing that fills one of them.
    """
    frame = terrain.frame
    position = np.array([site.position_m])
    middle = frame.cells_of(position)[0]
    if frame.is_flat:
        middle[0] = 0
    cells = cells_around(frame, middle, int(np.ceil(site.reach_m / frame.resolution_m)) + 2)
    cells = cells[terrain.reachable[tuple(cells.T)]]
    away = distances_m(frame, cells, site.position_m)
    within = away <= site.reach_m + 1e-9
    if not within.any():
        within = away <= site.reach_m + frame.resolution_m + 1e-9
    cells, away = cells[within], away[within]
    if not len(cells):
        return None
    order = np.lexsort(
        (
            np.ravel_multi_index(tuple(cells.T), frame.shape),
            np.round(away, 9),
            terrain.open_cells[tuple(cells.T)],
        )
    )
    cells = cells[order]
    for first in range(0, len(cells), AT_ONCE):
        seeing = sees(terrain, cells[first : first + AT_ONCE], site)
        if seeing.any():
            return np.asarray(cells[first + int(np.argmax(seeing))], np.int64)
    return np.asarray(cells[0], np.int64)


def sees(terrain: Terrain, cells: Ints, site: Site) -> Bools:
    """Which cells (n, 3) have the site in sight: once the line of sight meets matter, it stays in it to the end.

    That matter is the thing itself: its position is inside it. In a 2D map heights do not count.
    """
    frame = terrain.frame
    along = rays(frame, cells, site.position_m)
    inside = frame.contains(along.reshape(-1, 3)).reshape(along.shape[:2])
    bounded = np.clip(along, 0, np.array(frame.shape) - 1)
    matter = terrain.matter[tuple(np.moveaxis(bounded, -1, 0))] | ~inside
    seen: Bools = ~(matter[:, :-1] & ~matter[:, 1:]).any(axis=1)
    return seen
