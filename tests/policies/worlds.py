"""Random halls with regions of unknown passability, as problems and as plain arrays for an oracle."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mintpilot.core.errors import InfeasibleError
from mintpilot.core.gap import BLOCKED, PASSABLE, GapKind, KnowledgeGap, obstacle_id
from mintpilot.core.geometry import GridFrame
from mintpilot.core.observation import RegionKind
from mintpilot.core.plan import PlanningProblem, Site, Stop, VehicleLimits
from mintpilot.core.semantic_map import Cell, Region, SemanticMap
from mintpilot.core.task import Action
from mintpilot.planning.task_planner import GridPlanner


@dataclass
class Hall:
    free: np.ndarray
    """(ny, nx)"""
    regions: list[set[tuple[int, int]]]
    start: tuple[int, int]
    goal: tuple[int, int]

    @property
    def problem(self) -> PlanningProblem:
        shape = (1, *self.free.shape)
        made, gaps = [], []
        for i, cells in enumerate(self.regions):
            inside = np.zeros(shape, bool)
            for y, x in cells:
                inside[0, y, x] = True
            made.append(Region(id=f"r{i}", kind=RegionKind.SMOKE, cells=np.flatnonzero(inside).astype(np.int64)))
            gaps.append(
                KnowledgeGap(
                    id=obstacle_id(f"r{i}"),
                    kind=GapKind.OBSTACLE,
                    subject=f"r{i}",
                    description=f"the smoke {i}",
                    values=(PASSABLE, BLOCKED),
                    prior=(0.5, 0.5),
                    position_m=(0.0, 0.0, 0.0),
                )
            )
        site = Site(position_m=(self.goal[1] + 0.5, self.goal[0] + 0.5, 0.5), reach_m=0.1)
        return PlanningProblem(
            map=SemanticMap(
                frame=GridFrame(origin_m=(0.0, 0.0, 0.0), resolution_m=1.0, shape=shape),
                cells=np.where(self.free[None], Cell.FREE, Cell.OCCUPIED).astype(np.uint8),
                regions=tuple(made),
            ),
            start_m=(self.start[1] + 0.5, self.start[0] + 0.5, 0.5),
            stops=(Stop(id="go", action=Action.GO, sites=(site,), dwell_s=0.0),),
            gaps=tuple(gaps),
            limits=VehicleLimits(radius_m=0.01, margin_m=0.0, cruise_mps=1.0),
        )


def hall(seed: int, *, shape: tuple[int, int] = (24, 40), regions: int = 3) -> Hall:
    """Drawn again until it can be flown."""
    rng = np.random.default_rng([77, seed, regions])
    height, width = shape
    while True:
        free = rng.random(shape) >= 0.15
        start, goal = (int(rng.integers(height)), 0), (int(rng.integers(height)), width - 1)
        free[start] = free[goal] = True
        made = []
        for _ in range(regions):
            tall, wide = int(rng.integers(height // 6, height // 2 + 3)), int(rng.integers(2, 4))
            y, x = int(rng.integers(height - tall + 1)), int(rng.integers(2, width - 2 - wide))
            made.append({(a, b) for a in range(y, y + tall) for b in range(x, x + wide)})
        found = Hall(free=free, regions=made, start=start, goal=goal)
        try:
            GridPlanner().open(found.problem)
        except InfeasibleError:
            continue
        return found
