"""A planning problem laid on the grid: where it may be flown, and under which answers."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import ndimage

from mintpilot.core.errors import InfeasibleError, MissionError
from mintpilot.core.gap import GapKind, KnowledgeGap
from mintpilot.core.geometry import Bools, Floats, GridFrame, Ints, Vec3
from mintpilot.core.plan import PlanningProblem
from mintpilot.core.semantic_map import Cell, Knowledge
from mintpilot.planning.flyable import flyable_cells, region_reach

SNAP_M = 0.5
"""A start that is not flyable is moved to the nearest flyable cell, at most this far, straight through free cells."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Terrain:
    """The grid of one planning problem."""

    frame: GridFrame
    free: Bools
    """Flyable with every gap's region passable (nz, ny, nx)."""
    gaps: tuple[KnowledgeGap, ...]
    """Obstacle gaps with an open region, sorted by id. Bit r of a mask stands for the r-th."""
    regions: tuple[Ints, ...]
    """Inflated region of each, flat cells."""
    open_cells: Bools
    """Cells in any of the regions."""
    matter: Bools
    """Cells that are not free to look through: occupied or unknown."""
    start: Ints
    """Cell (3,) where all paths begin."""
    reachable: Bools
    """Cells that can be reached from there if every region is passable."""


def terrain_of(problem: PlanningProblem) -> Terrain:
    """Lays out the problem.

    Raises:
        InfeasibleError: the start is not in flyable space, nor is any place near it.
        MissionError: an obstacle gap speaks of a region that the map does not have.
    """
    world, limits = problem.map, problem.limits
    free = flyable_cells(world, limits)
    open_regions = {r.id: r for r in world.regions if r.passable is Knowledge.OPEN}
    gaps = []
    for gap in sorted(problem.gaps, key=lambda g: g.id):
        if gap.kind is not GapKind.OBSTACLE:
            continue
        if gap.subject not in {r.id for r in world.regions}:
            known = ", ".join(sorted(r.id for r in world.regions)) or "(none)"
            raise MissionError(f"gap '{gap.id}' is about region '{gap.subject}', which the map lacks; it has {known}")
        if gap.subject in open_regions:
            gaps.append(gap)
    settled = {g.subject for g in gaps}
    for region in world.regions:
        if region.passable is not Knowledge.YES and region.id not in settled:
            free.ravel()[region_reach(world, region, limits)] = False
    regions = tuple(region_reach(world, open_regions[g.subject], limits) for g in gaps)
    open_cells = np.zeros(free.shape, bool)
    for cells in regions:
        open_cells.ravel()[cells] = True
    matter = np.asarray(world.cells != Cell.FREE)
    start = start_cell(world.frame, free, matter, problem.start_m)
    # Moves that cut no corner join exactly what steps through faces join.
    parts, _ = ndimage.label(free)
    return Terrain(
        frame=world.frame,
        free=free,
        gaps=tuple(gaps),
        regions=regions,
        open_cells=open_cells,
        matter=matter,
        start=start,
        reachable=parts == parts[tuple(start)],
    )


def start_cell(frame: GridFrame, free: Bools, matter: Bools, start_m: Vec3) -> Ints:
    """The cell (3,) where paths from that position begin: its own, or the nearest flyable one.

    Raises:
        InfeasibleError: there is none within `SNAP_M`, straight through free cells.
    """
    own: Ints = _cells_of(frame, np.array([start_m]))[0]
    if frame.contains(own)[0] and free[tuple(own)]:
        return own
    reach = int(np.ceil(SNAP_M / frame.resolution_m)) + 1
    cells = cells_around(frame, own, reach)
    cells = cells[free[tuple(cells.T)]]
    away = distances_m(frame, cells, start_m)
    order = np.lexsort((np.ravel_multi_index(tuple(cells.T), frame.shape), np.round(away, 9)))
    for i in order:
        if away[i] > SNAP_M:
            break
        ray = rays(frame, cells[i : i + 1], start_m)[0]
        ray = ray[np.any(ray != own, axis=1)]
        if frame.contains(ray).all() and not matter[tuple(ray.T)].any():
            return np.asarray(cells[i], np.int64)
    raise InfeasibleError(
        f"start ({start_m[0]:.2f}, {start_m[1]:.2f}, {start_m[2]:.2f}) is not in flyable space, and no flyable cell is "
        f"within {SNAP_M} m straight through free space; start from elsewhere, or reduce the vehicle's radius or margin"
    )


def cells_around(frame: GridFrame, centre: Ints, reach: int) -> Ints:
    """All cells (n, 3) of the grid at most so many cells from that one along each axis, in ascending order."""
    spans = [
        np.arange(max(0, c - reach), min(n, c + reach + 1)) for c, n in zip(centre.tolist(), frame.shape, strict=True)
    ]
    cells: Ints = np.stack(np.meshgrid(*spans, indexing="ij"), axis=-1).reshape(-1, 3).astype(np.int64)
    return cells


def distances_m(frame: GridFrame, cells: Ints, position_m: Vec3) -> Floats:
    """Distance (n,) from cells' centres to a position, metres; in a 2D map, heights do not count."""
    apart = frame.centres_of(cells) - np.asarray(position_m)
    if frame.is_flat:
        apart[:, 2] = 0.0
    distance: Floats = np.linalg.norm(apart, axis=1)
    return distance


def rays(frame: GridFrame, cells: Ints, position_m: Vec3) -> Ints:
    """Cells (n, m, 3) along the straight lines from cells' centres to a position, four to a cell's edge."""
    centres = frame.centres_of(cells)
    target = np.asarray(position_m, float)
    longest = float(np.linalg.norm(centres - target, axis=1).max(initial=0.0))
    steps = np.linspace(0.0, 1.0, max(2, int(np.ceil(4 * longest / frame.resolution_m)) + 1))
    points = centres[:, None, :] + (target - centres)[:, None, :] * steps[None, :, None]
    found: Ints = _cells_of(frame, points.reshape(-1, 3)).reshape(len(cells), len(steps), 3)
    return found


def _cells_of(frame: GridFrame, points_m: Floats) -> Ints:
    cells = frame.cells_of(points_m)
    if frame.is_flat:
        cells[:, 0] = 0
    return cells
