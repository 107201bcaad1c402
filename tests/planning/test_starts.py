"""Where paths begin, how a drone that is too near to something leaves it, and what is said where nothing fits."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.oracles.clearance import densely, distances

from mintpilot.core.errors import InfeasibleError
from mintpilot.core.gap import Assumptions, GapKind, KnowledgeGap
from mintpilot.core.geometry import GridFrame
from mintpilot.core.observation import RegionKind
from mintpilot.core.plan import PlanningProblem, Site, Stop, VehicleLimits
from mintpilot.core.semantic_map import Cell, Region, SemanticMap
from mintpilot.core.task import Action
from mintpilot.planning.checks import check_path
from mintpilot.planning.flyable import known_flyable
from mintpilot.planning.task_planner import GridPlanner
from mintpilot.planning.terrain import can_start, start_cell

LIMITS = VehicleLimits(radius_m=0.3, margin_m=0.1)


def room(cell_m: float, wide: int, **changes: object) -> SemanticMap:
    cells = np.full((1, wide, wide), Cell.FREE, np.uint8)
    frame = GridFrame(origin_m=(0.0, 0.0, 0.0), resolution_m=cell_m, shape=cells.shape)
    return replace(SemanticMap(frame=frame, cells=cells), **changes)


def to(x: float, y: float, reach_m: float = 0.75) -> tuple[Stop, ...]:
    site = Site(position_m=(x, y, 0.5), reach_m=reach_m)
    return (Stop(id="go:1", action=Action.GO, sites=(site,)),)


@settings(deadline=None, max_examples=60)
@given(cell_m=st.sampled_from([0.1, 0.35, 0.5, 1.0, 2.0]), seed=st.integers(0, 10**6))
def test_the_way_to_the_first_cell_is_never_nearer_than_the_clearance_or_the_start(cell_m: float, seed: int) -> None:
    rng = np.random.default_rng(seed)
    map = room(cell_m, 14)
    cells = rng.choice([Cell.FREE] * 9 + [Cell.OCCUPIED], size=map.cells.shape).astype(np.uint8)
    map = replace(map, cells=cells)
    start = tuple(float(v) for v in rng.uniform([0, 0, 0.05], [14 * cell_m, 14 * cell_m, 0.06]))
    try:
        cell = start_cell(map, LIMITS, known_flyable(map, LIMITS), start)
    except InfeasibleError:
        return
    hop = np.stack([np.asarray(start), map.frame.centres_of(cell)[0]])
    gaps = distances(densely(hop, cell_m / 100), cells != Cell.FREE, map.frame.origin_m, cell_m, 0.5)
    assert gaps.min() >= min(gaps[0], LIMITS.clearance_m) - 1e-6
    assert not check_path(hop, map, LIMITS)


def test_leaving_never_leads_nearer_than_the_start() -> None:
    map = room(0.1, 40)
    away = np.array([[1.0, 0.2, 0.05], [1.0, 0.6, 0.05], [3.0, 0.6, 0.05]])
    assert not check_path(away, map, LIMITS)
    nearer = np.array([[1.0, 0.2, 0.05], [1.3, 0.19, 0.05]])
    assert "comes nearer than 0.40 m to the map's border" in str(check_path(nearer, map, LIMITS))
    assert check_path(away[::-1], map, LIMITS), "only the beginning is excepted"


def region_around(map: SemanticMap, low: int, high: int) -> Region:
    block = np.zeros(map.frame.shape, bool)
    block[0, :, low:high] = True
    return Region(id="cloud", kind=RegionKind.SMOKE, cells=np.flatnonzero(block))


def test_a_start_beside_an_open_region_begins_outside_its_reach() -> None:
    """The start keeps the clearance, the centre of its own cell does not."""
    map = room(0.5, 20)
    map = replace(map, regions=(region_around(map, 8, 12),))
    gap = KnowledgeGap(
        id="obstacle:cloud",
        kind=GapKind.OBSTACLE,
        subject="cloud",
        description="the cloud",
        values=("passable", "blocked"),
        prior=(0.5, 0.5),
        position_m=(5.0, 5.0, 0.5),
    )
    problem = PlanningProblem(map=map, start_m=(3.55, 5.1, 0.2), stops=to(1.25, 5.25), gaps=(gap,), limits=LIMITS)
    plan = GridPlanner().open(problem).cautious(Assumptions())
    assert plan is not None
    assert not plan.enters
    assert not check_path(plan.path_m, map, LIMITS)


def test_can_start_tells_a_place_with_no_way_out() -> None:
    map = room(0.5, 20)
    map = replace(map, regions=(region_around(map, 4, 16),))
    assert can_start(map, LIMITS, (1.0, 5.0, 0.2))
    assert not can_start(map, LIMITS, (5.0, 5.0, 0.2))


def test_where_cells_are_too_coarse_for_the_body_the_message_says_so() -> None:
    cells = np.full((1, 20, 20), Cell.FREE, np.uint8)
    cells[0, :, 10] = Cell.OCCUPIED
    cells[0, 9:11, 10] = Cell.FREE  # a passage of 1 m, in cells of 0.5 m
    map = room(0.5, 20, cells=cells)
    problem = PlanningProblem(map=map, start_m=(2.25, 2.25, 0.2), stops=to(8.25, 8.25), gaps=(), limits=LIMITS)
    with pytest.raises(InfeasibleError, match=r"0\.80 m wide.*cells of 0\.5 m.*3 of them \(1\.50 m\).*finer map"):
        GridPlanner().open(problem)
    cells = cells.copy()
    cells[0, :, 10] = Cell.OCCUPIED
    with pytest.raises(InfeasibleError, match="is connected to the start; map its surroundings"):
        GridPlanner().open(replace(problem, map=room(0.5, 20, cells=cells)))
    cells = cells.copy()
    cells[0, 8:11, 10] = Cell.FREE
    assert GridPlanner().open(replace(problem, map=room(0.5, 20, cells=cells)))


def test_a_flight_that_begins_too_near_keeps_its_clearance_from_half_a_metre_on() -> None:
    """The border of the grid counts as something: along it, less than the clearance away, no flight leads on."""
    map = room(0.1, 40)
    near = [[1.0, 0.2, 0.05], [1.4, 0.2, 0.05]]
    assert not check_path(np.array(near), map, LIMITS)
    assert check_path(np.array([*near, [1.9, 0.2, 0.05]]), map, LIMITS)
