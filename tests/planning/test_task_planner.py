"""Where tasks start, stop and fail: the defined cases around the plans."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from mintpilot.core.errors import InfeasibleError, MissionError
from mintpilot.core.gap import ABSENT, BLOCKED, PASSABLE, PRESENT, Assumptions, GapKind, KnowledgeGap
from mintpilot.core.geometry import GridFrame
from mintpilot.core.observation import RegionKind
from mintpilot.core.plan import PlanningProblem, Shortage, Site, Stop, VehicleLimits
from mintpilot.core.semantic_map import Cell, Knowledge, Region, SemanticMap
from mintpilot.core.task import Action
from mintpilot.planning.task_planner import GridPlanner
from mintpilot.planning.warm import warm_up

FREE, WALL = int(Cell.FREE), int(Cell.OCCUPIED)
LIMITS = VehicleLimits(radius_m=0.2, margin_m=0.0, cruise_mps=2.0)


def world(cells: np.ndarray, regions: tuple[Region, ...] = ()) -> SemanticMap:
    frame = GridFrame(origin_m=(0.0, 0.0, 0.0), resolution_m=0.5, shape=cells.shape)
    return SemanticMap(frame=frame, cells=cells.astype(np.uint8), regions=regions)


def area(name: str, cells: list[tuple[int, int, int]], shape: tuple, passable: Knowledge = Knowledge.OPEN) -> Region:
    flat = np.array(sorted(int(np.ravel_multi_index(c, shape)) for c in cells), np.int64)
    return Region(id=name, kind=RegionKind.AREA, cells=flat, passable=passable)


def gap(name: str, kind: GapKind, subject: str, values: tuple[str, ...]) -> KnowledgeGap:
    share = tuple([1 / len(values)] * len(values))
    return KnowledgeGap(
        id=name, kind=kind, subject=subject, description=name, values=values, prior=share, position_m=(0, 0, 0)
    )


def go(x: float, y: float, z: float = 0.25, reach_m: float = 0.3, **other: object) -> Stop:
    return Stop(id="go", action=Action.GO, sites=(Site(position_m=(x, y, z), reach_m=reach_m),), **other)


def problem(cells: np.ndarray, *stops: Stop, regions: tuple = (), gaps: tuple = (), **other: object) -> PlanningProblem:
    parts = {"start_m": (0.25, 0.25, 0.25), "limits": LIMITS, **other}
    return PlanningProblem(map=world(cells, regions), stops=stops, gaps=gaps, **parts)


def test_cost_is_length_over_speed_and_the_stay() -> None:
    space = GridPlanner().open(problem(np.full((1, 3, 9), FREE), go(4.25, 0.25, dwell_s=3.0)))
    plan = space.optimistic(Assumptions())
    assert plan is not None
    assert plan.length_m == pytest.approx(4.0)
    assert plan.cost_s == pytest.approx(4.0 / 2.0 + 3.0)
    assert space.searches == 1
    assert space.notes == ()


def test_nothing_to_do_is_an_empty_plan() -> None:
    plan = GridPlanner().open(problem(np.full((1, 3, 3), FREE))).cautious(Assumptions())
    assert plan is not None
    assert plan.cost_s == 0
    assert plan.path_m.shape == (0, 3)


def test_the_way_begins_at_the_true_start() -> None:
    start = (0.4, 0.1, 0.25)
    plan = GridPlanner().open(problem(np.full((1, 3, 9), FREE), go(4.25, 0.25), start_m=start)).cautious(Assumptions())
    assert plan is not None
    assert plan.path_m[0].tolist() == list(start)
    assert plan.length_m == pytest.approx(4.0 + np.hypot(0.15, 0.15))


def test_a_start_too_near_a_wall_is_moved() -> None:
    cells = np.full((1, 9, 9), FREE)
    cells[0, :, 0] = WALL
    wide = replace(LIMITS, radius_m=0.4)
    near = problem(cells, go(3.25, 2.25), start_m=(0.75, 2.25, 0.25), limits=wide)
    plan = GridPlanner().open(near).cautious(Assumptions())
    assert plan is not None
    assert plan.path_m[1].tolist() == [1.25, 2.25, 0.25]


def test_a_start_in_matter_is_infeasible() -> None:
    cells = np.full((1, 9, 9), FREE)
    cells[0, :4, :4] = WALL
    with pytest.raises(InfeasibleError, match=r"start .* is not in flyable space"):
        GridPlanner().open(problem(cells, go(3.25, 3.25)))


def test_a_start_is_not_moved_through_matter() -> None:
    cells = np.full((1, 3, 9), FREE)
    cells[0, :, :2] = WALL
    cells[0, 1, 0] = FREE
    wide = replace(LIMITS, radius_m=0.3)
    with pytest.raises(InfeasibleError, match="start"):
        GridPlanner().open(problem(cells, go(3.25, 0.75), start_m=(0.25, 0.75, 0.25), limits=wide))


def test_an_unreachable_stop_is_named() -> None:
    cells = np.full((1, 5, 9), FREE)
    cells[0, :, 4] = WALL
    with pytest.raises(InfeasibleError, match=r"stop 'go' .* under no hypothesis"):
        GridPlanner().open(problem(cells, go(4.25, 0.25)))


def test_an_unreachable_room_is_left_undone_and_not_asked_about() -> None:
    cells = np.full((1, 5, 9), FREE)
    cells[0, :, 4] = WALL
    site = Site(position_m=(4.25, 0.25, 0.25), reach_m=0.1, value=PRESENT)
    look = Stop(id="look", action=Action.LOOK, sites=(site,), gap="presence:room", optional=True)
    presence = gap("presence:room", GapKind.PRESENCE, "room", (PRESENT, ABSENT))
    space = GridPlanner().open(problem(cells, go(0.25, 2.25), look, gaps=(presence,)))
    plan = space.optimistic(Assumptions())
    assert plan is not None
    assert plan.relies_on == plan.skips == frozenset()
    assert [(one.stop.id, one.resource) for one in plan.leaves_undone] == [("look", Shortage.WAY)]
    assert plan.stakes == (("presence:room", PRESENT, look.price_s),)
    for other in (space.cautious(Assumptions()), space.optimistic(Assumptions.exactly({"presence:room": PRESENT}))):
        assert other is not None
        assert other.signature == plan.signature


def test_a_stop_without_a_gap_to_choose_its_site_is_refused() -> None:
    sites = tuple(Site(position_m=(x, 0.25, 0.25), value=str(x)) for x in (1.25, 2.25))
    stop = Stop(id="pick", action=Action.PICK, sites=sites, gap="target:box")
    with pytest.raises(MissionError, match="2 sites"):
        GridPlanner().open(problem(np.full((1, 3, 9), FREE), stop))


def test_a_gap_about_an_unknown_region_is_refused() -> None:
    stray = gap("obstacle:x", GapKind.OBSTACLE, "x", (PASSABLE, BLOCKED))
    with pytest.raises(MissionError, match="region 'x', which the map lacks"):
        GridPlanner().open(problem(np.full((1, 3, 9), FREE), go(4.25, 0.25), gaps=(stray,)))


def barrier(passable: Knowledge) -> tuple[np.ndarray, Region]:
    cells = np.full((1, 5, 9), FREE)
    return cells, area("smoke", [(0, y, 4) for y in range(5)], cells.shape, passable)


def test_a_region_known_passable_is_flown_through() -> None:
    cells, region = barrier(Knowledge.YES)
    space = GridPlanner().open(problem(cells, go(4.25, 0.25), regions=(region,)))
    plan = space.cautious(Assumptions())
    assert plan is not None
    assert plan.enters == frozenset()


@pytest.mark.parametrize("passable", [Knowledge.NO, Knowledge.OPEN])
def test_blocked_regions_and_open_ones_without_a_gap_are_obstacles(passable: Knowledge) -> None:
    cells, region = barrier(passable)
    with pytest.raises(InfeasibleError, match="go"):
        GridPlanner().open(problem(cells, go(4.25, 0.25), regions=(region,)))


def test_an_open_region_is_entered_only_by_the_optimist() -> None:
    cells, region = barrier(Knowledge.OPEN)
    smoke = gap("obstacle:smoke", GapKind.OBSTACLE, "smoke", (PASSABLE, BLOCKED))
    space = GridPlanner().open(problem(cells, go(4.25, 0.25), regions=(region,), gaps=(smoke,)))
    plan = space.optimistic(Assumptions())
    assert plan is not None
    assert plan.relies_on == plan.enters == {"obstacle:smoke"}
    assert space.cautious(Assumptions()) is None
    known = space.cautious(Assumptions.exactly({"obstacle:smoke": PASSABLE}))
    assert known is not None
    assert known.signature == plan.signature
    assert known.relies_on == frozenset()
    assert known.enters == {"obstacle:smoke"}


def test_the_body_keeps_its_distance_from_a_region() -> None:
    cells = np.full((1, 9, 9), FREE)
    region = area("smoke", [(0, y, 4) for y in range(5)], cells.shape)
    smoke = gap("obstacle:smoke", GapKind.OBSTACLE, "smoke", (PASSABLE, BLOCKED))
    wide = replace(LIMITS, radius_m=0.6)
    start = (0.75, 0.75, 0.25)
    given = problem(cells, go(3.75, 0.75), regions=(region,), gaps=(smoke,), limits=wide, start_m=start)
    plan = GridPlanner().open(given).cautious(Assumptions())
    assert plan is not None
    smoke_m = given.map.frame.centres_of(np.stack(np.unravel_index(region.cells, cells.shape), axis=1))
    apart = np.maximum(np.abs(plan.path_m[:, None, :2] - smoke_m[None, :, :2]) - 0.25, 0.0)
    assert np.linalg.norm(apart, axis=2).min() >= 0.6 - 1e-9


def test_plans_beyond_the_endurance_do_not_exist() -> None:
    cells = np.full((1, 3, 9), FREE)
    for endurance, exists in ((4.0, True), (3.9, False)):
        given = problem(cells, go(4.25, 0.25), limits=replace(LIMITS, endurance_s=endurance))
        space = GridPlanner().open(given)
        assert (space.optimistic(Assumptions()) is not None) == exists
        assert (space.cautious(Assumptions()) is not None) == exists


def test_candidates_at_one_place_need_no_answer() -> None:
    sites = tuple(Site(position_m=(4.25, 0.25, 0.25), reach_m=0.3, value=v) for v in ("a", "b"))
    box = gap("target:box", GapKind.TARGET, "the box", ("a", "b"))
    stop = Stop(id="pick", action=Action.PICK, sites=sites, gap="target:box")
    space = GridPlanner().open(problem(np.full((1, 3, 9), FREE), stop, gaps=(box,)))
    plan = space.optimistic(Assumptions())
    assert plan is not None
    assert plan.relies_on == frozenset()
    assert space.cautious(Assumptions()) is not None


def test_one_answer_binds_every_stop_of_its_gap() -> None:
    places = {"a": 1.25, "b": 4.25}
    box = gap("target:box", GapKind.TARGET, "the box", ("a", "b"))
    stops = [
        Stop(
            id=name,
            action=Action.PICK,
            gap="target:box",
            sites=tuple(Site(position_m=(x, y, 0.25), reach_m=0.1, value=v) for v, x in places.items()),
        )
        for name, y in (("pick", 0.25), ("deliver", 2.25))
    ]
    space = GridPlanner().open(problem(np.full((1, 5, 9), FREE), *stops, gaps=(box,)))
    plan = space.optimistic(Assumptions())
    assert plan is not None
    assert {leg.site.value for leg in plan.legs} == {"a"}
    assert plan.binds == (("target:box", "a"),)


def approached(cells: np.ndarray, site: Site, **other: object) -> list[float]:
    stop = Stop(id="go", action=Action.PICK, sites=(site,))
    plan = GridPlanner().open(problem(cells, stop, **other)).optimistic(Assumptions())
    assert plan is not None
    return [float(v) for v in plan.path_m[-1]]


def test_a_thing_is_approached_where_it_is_in_sight() -> None:
    cells = np.full((1, 9, 9), FREE)
    cells[0, 4, 4] = WALL
    assert approached(cells, Site(position_m=(2.25, 2.25, 0.25), reach_m=1.0)) == [2.25, 1.75, 0.25]
    cells[0, 3, :8] = WALL  # a shelf right before it: the nearest cells are behind
    cells[0, 4, 3] = cells[0, 4, 5] = WALL
    x, y, _ = approached(cells, Site(position_m=(2.25, 2.25, 0.25), reach_m=1.0))
    assert (x, y) == (2.25, 2.75)


def test_an_approach_outside_open_regions_is_preferred() -> None:
    cells = np.full((1, 9, 9), FREE)
    region = area("smoke", [(0, 4, 3), (0, 4, 4)], cells.shape)
    smoke = gap("obstacle:smoke", GapKind.OBSTACLE, "smoke", (PASSABLE, BLOCKED))
    site = Site(position_m=(2.25, 2.25, 0.25), reach_m=1.0)
    assert approached(cells, site, regions=(region,), gaps=(smoke,)) == [2.25, 1.75, 0.25]
    assert approached(cells, replace(site, reach_m=0.1), regions=(region,), gaps=(smoke,)) == [2.25, 2.25, 0.25]


def test_thirty_rooms_in_the_way_stay_bounded_and_say_so() -> None:
    cells = np.full((1, 5, 80), FREE)
    regions = tuple(area(f"r{i:02}", [(0, y, i) for y in range(5)], cells.shape) for i in range(2, 72))
    gaps = tuple(gap(f"obstacle:{r.id}", GapKind.OBSTACLE, r.id, (PASSABLE, BLOCKED)) for r in regions)
    thin = replace(LIMITS, radius_m=0.01)
    with_gaps = problem(cells, go(39.25, 0.25), regions=regions, gaps=gaps, limits=thin)
    space = GridPlanner().open(with_gaps)
    assert space.optimistic(Assumptions()) is None  # 7 of 70 walls of smoke count as blocked
    assert "taken as blocked" in str(space.notes[0])


def test_compiling_ahead_can_be_done_twice() -> None:
    warm_up()
    warm_up()
