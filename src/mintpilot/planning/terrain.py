"""A planning problem laid on the grid: where it may be flown, and under which answers."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass

import numpy as np
from scipy import ndimage

from mintpilot.core.errors import InfeasibleError, MissionError
from mintpilot.core.gap import GapKind, KnowledgeGap
from mintpilot.core.geometry import Bools, Floats, GridFrame, Ints, Vec3
from mintpilot.core.message import message
from mintpilot.core.plan import PlanningProblem, VehicleLimits
from mintpilot.core.semantic_map import Cell, Knowledge, SemanticMap
from mintpilot.planning.checks import first_breach
from mintpilot.planning.clearance import surroundings
from mintpilot.planning.flyable import flyable_cells, known_flyable, region_reach

SNAP_M = 0.5
"""Distance, metres, at most, from a start that is not flyable to the flyable cell where paths begin; a cell's diagonal
where that is more."""


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
    start = _start_of(problem, free, open_cells, settled)
    # Moves that cut no corner join exactly what steps through faces join.
    parts, _ = ndimage.label(free)
    return Terrain(
        frame=world.frame,
        free=free,
        gaps=tuple(gaps),
        regions=regions,
        open_cells=open_cells,
        matter=np.asarray(world.cells != Cell.FREE),
        start=start,
        reachable=parts == parts[tuple(start)],
    )


def start_cell(
    map: SemanticMap, limits: VehicleLimits, free: Bools, start_m: Vec3, *, passable: Collection[str] = ()
) -> Ints:
    """The cell (3,) where paths from that position begin: its own, else the nearest one that can be flown to.

    Args:
        map: what is known.
        limits: the vehicle.
        free: flyable cells (nz, ny, nx) to choose from.
        start_m: where the vehicle is, metres.
        passable: ids of regions that are taken as passable besides those known to be.

    Raises:
        InfeasibleError: there is none within `SNAP_M` (or a cell's diagonal) that a straight way which
            `mintpilot.planning.checks.check_path` allows leads to.
    """
    frame = map.frame
    own: Ints = _cells_of(frame, np.array([start_m]))[0]
    reach_m = max(SNAP_M, frame.resolution_m * (2 if frame.is_flat else 3) ** 0.5)
    cells = cells_around(frame, own, int(np.ceil(reach_m / frame.resolution_m)) + 1)
    cells = cells[free[tuple(cells.T)]]
    away = distances_m(frame, cells, start_m)
    cells, away = cells[away <= reach_m], away[away <= reach_m]
    if len(cells):
        centres = frame.centres_of(cells)
        here = np.asarray(start_m, float)
        order = np.lexsort(
            (np.ravel_multi_index(tuple(cells.T), frame.shape), np.round(away, 9), np.any(cells != own, axis=1))
        )
        for tried in (order[:1], order[1:]):  # most often the first will do, and little has to be looked at around it
            near = surroundings(map, np.vstack([here, centres[tried]]), limits.clearance_m, passable=passable)
            for i in tried:
                if first_breach(np.stack([here, centres[i]]), near)[1] < 0:
                    return np.asarray(cells[i], np.int64)
    raise InfeasibleError(
        message(
            "start ({x:.2f}, {y:.2f}, {z:.2f}) is not in flyable space, and no flyable cell is within {reach_m:.2g} m "
            "straight through free space; start from elsewhere, or reduce the vehicle's radius or margin",
            x=start_m[0],
            y=start_m[1],
            z=start_m[2],
            reach_m=reach_m,
        )
    )


def can_start(map: SemanticMap, limits: VehicleLimits, position_m: Vec3) -> bool:
    """Whether a plan that relies on no answer could start from there."""
    try:
        start_cell(map, limits, known_flyable(map, limits), position_m)
    except InfeasibleError:
        return False
    return True


def _start_of(problem: PlanningProblem, free: Bools, open_cells: Bools, settled: Collection[str]) -> Ints:
    """Where paths begin: outside all regions if the start allows it, else as if the open ones were passable."""
    world, limits, start_m = problem.map, problem.limits, problem.start_m
    try:
        return start_cell(world, limits, free & ~open_cells, start_m)
    except InfeasibleError:
        return start_cell(world, limits, free, start_m, passable=settled)


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
