"""Every drawn world keeps its promises, over many seeds."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy import ndimage
from scipy.sparse import coo_array
from scipy.sparse.csgraph import dijkstra

from mintpilot.core.errors import MissionError, UnknownNameError
from mintpilot.core.geometry import Box, Vec3
from mintpilot.core.semantic_map import Cell, SemanticMap
from mintpilot.simulation.scenarios import SCENARIOS, Scenario, make_scenario
from mintpilot.simulation.scenarios.fire_warehouse import STAY_S
from mintpilot.simulation.scenarios.floor import gap_m
from mintpilot.simulation.scenarios.medicine_boxes import EDGES_M, SPACING_M
from mintpilot.simulation.scene import Shape, Solid
from mintpilot.simulation.scene_map import map_of_scene

SEEDS = range(50)
CLEARANCE_M = 0.4
"""Radius 0.3 m plus margin 0.1 m."""


def flyable(world: SemanticMap, *, without: NDArray[np.int64] | None = None) -> NDArray[np.bool_]:
    """Cells whose centre keeps the clearance from every cell that is not free: a plain second opinion."""
    blocked = world.cells != Cell.FREE
    if without is not None:
        blocked = blocked.copy()
        blocked.reshape(-1)[without] = True
    padded = np.pad(blocked, ((0, 0), (1, 1), (1, 1)), constant_values=True)
    distance = ndimage.distance_transform_edt(~padded)[:, 1:-1, 1:-1] * world.frame.resolution_m
    return np.asarray(distance - world.frame.resolution_m / 2 > CLEARANCE_M)


def places_reached(scenario: Scenario, *, through_smoke: bool) -> tuple[bool, bool]:
    """Whether the person, and every room's viewpoint, can be reached from the start."""
    scene = scenario.scene
    world = map_of_scene(scene, 0.2)
    smoke = np.concatenate([r.cells for r in world.regions]) if world.regions and not through_smoke else None
    labels, _ = ndimage.label(flyable(world, without=smoke), structure=np.ones((3, 3, 3)))
    start = labels[tuple(world.frame.cells_of(scene.start_m)[0])]
    assert start > 0
    reached = world.frame.centres_of(np.argwhere(labels == start))

    def near(place: tuple[float, float, float], reach_m: float) -> bool:
        return bool((np.linalg.norm(reached - place, axis=1) <= reach_m).any())

    return (
        all(near(p.position_m, 1.5) for p in scene.persons),
        all(near(r.viewpoint_m, 0.5) for r in scene.rooms),
    )


@pytest.mark.parametrize("name", sorted(SCENARIOS))
def test_same_seed_same_world(name: str) -> None:
    first, again, other = make_scenario(name, 7), make_scenario(name, 7), make_scenario(name, 8)
    assert first == again
    assert first.scene != other.scene


@pytest.mark.long
@pytest.mark.parametrize("seed", SEEDS)
def test_the_omniscient_flight_exists_and_so_does_one_round_the_smoke(seed: int) -> None:
    scenario = make_scenario("fire-warehouse", seed)
    assert places_reached(scenario, through_smoke=True) == (True, True)
    assert places_reached(scenario, through_smoke=False) == (True, True)


def overlap(a: Box, b: Box) -> bool:
    return all(a.lo_m[i] < b.hi_m[i] - 1e-6 and b.lo_m[i] < a.hi_m[i] - 1e-6 for i in range(3))


@pytest.mark.parametrize("seed", SEEDS)
def test_nothing_overlaps_in_the_warehouse(seed: int) -> None:
    scene = make_scenario("fire-warehouse", seed).scene
    boxes = [s.extent_m for s in scene.solids] + [r.extent_m for r in scene.rooms]
    for a, b in itertools.combinations(boxes, 2):
        assert not overlap(a, b)
    here = Box(lo_m=scene.start_m, hi_m=scene.start_m)
    assert all(gap_m(here, b) > 0.5 for b in boxes)
    for person in scene.persons:
        lying = Box(lo_m=person.position_m, hi_m=person.position_m)
        assert all(gap_m(lying, b) > 1.0 for b in boxes)
    for box in (*boxes, *(s.extent_m for s in scene.smokes)):
        assert scene.volume.contains([box.lo_m, box.hi_m]).all()
    for cloud in scene.smokes:
        assert (cloud.extent_m.lo_m[2], cloud.extent_m.hi_m[2]) == (0.0, scene.volume.hi_m[2])
        for place in (scene.start_m, *(r.viewpoint_m for r in scene.rooms), *(p.position_m for p in scene.persons)):
            assert gap_m(cloud.extent_m, Box(lo_m=place, hi_m=place)) > 0.6


@pytest.mark.parametrize("seed", SEEDS)
def test_occupants_are_in_their_rooms_behind_the_door(seed: int) -> None:
    for room in make_scenario("fire-warehouse", seed, prior_occupied=1.0).scene.rooms:
        assert room.occupant is not None
        x, y, z = room.occupant.position_m
        assert room.extent_m.contains([(x - 1.0, y, z), (x + 1.0, y, z)]).all()
        assert room.extent_m.contains(room.door_m.centre_m).all()
        assert math.dist(room.viewpoint_m[:2], room.door_m.centre_m[:2]) == pytest.approx(1.2, abs=0.1)


def way_length_m(world: SemanticMap, start: Vec3, goal: Vec3, *, closed: bool) -> float:
    """Length of the shortest way through free cells of a coarse map, clouds closed or not."""
    free = world.cells == Cell.FREE
    if closed:
        free = free.copy()
        free.reshape(-1)[np.concatenate([r.cells for r in world.regions])] = False
    index = np.arange(free.size).reshape(free.shape)
    rows, columns, lengths = [], [], []
    for step in itertools.product((0, 1), (-1, 0, 1), (-1, 0, 1)):
        if step <= (0, 0, 0):
            continue
        here = tuple(slice(max(0, -k), n - max(0, k)) for k, n in zip(step, free.shape, strict=True))
        there = tuple(slice(max(0, k), n - max(0, -k)) for k, n in zip(step, free.shape, strict=True))
        both = free[here] & free[there]
        rows.append(index[here][both])
        columns.append(index[there][both])
        lengths.append(np.full(both.sum(), math.hypot(*step) * world.frame.resolution_m))
    pairs = (np.concatenate(rows), np.concatenate(columns))
    graph = coo_array((np.concatenate(lengths), pairs), shape=(free.size, free.size)).tocsr()
    source, target = (int(np.ravel_multi_index(tuple(c), free.shape)) for c in world.frame.cells_of([start, goal]))
    return float(dijkstra(graph, directed=False, indices=source)[target])


@pytest.mark.long
@pytest.mark.parametrize(("on_way", "kind"), [(1.0, "on-way"), (0.0, "off-way")])
def test_smoke_on_the_way_lengthens_it_and_smoke_off_the_way_does_not(on_way: float, kind: str) -> None:
    longer = []
    for seed in range(12):
        scenario = make_scenario("fire-warehouse", seed, on_way=on_way, other_way=0.0)
        if scenario.notes["smoke_places"] != kind:
            continue
        world = map_of_scene(scenario.scene, 0.4)
        x, y, _ = scenario.scene.persons[0].position_m
        ends = (scenario.scene.start_m, (x, y, 1.0))
        longer.append(way_length_m(world, *ends, closed=True) - way_length_m(world, *ends, closed=False))
    assert len(longer) >= 9
    if on_way:
        # Two ways of nearly equal length may change places between straight lines and the coarse map.
        assert sum(more > 0.1 for more in longer) >= 0.75 * len(longer)
        assert max(longer) > 4.0
    else:
        assert max(longer) < 0.1


@pytest.mark.long
def test_truths_follow_the_priors_and_move_nothing() -> None:
    safe = make_scenario("fire-warehouse", 3, prior_toxic=0.0, prior_occupied=0.0)
    bad = make_scenario("fire-warehouse", 3, prior_toxic=1.0, prior_occupied=1.0)
    assert [s.toxic for s in safe.scene.smokes] == [False]
    assert [s.toxic for s in bad.scene.smokes] == [True]
    assert safe.scene.rooms[0].occupant is None
    assert bad.scene.rooms[0].occupant is not None
    assert safe.scene.solids == bad.scene.solids
    assert safe.rules == bad.rules
    toxic = [make_scenario("fire-warehouse", s).scene.smokes[0].toxic for s in range(100)]
    assert 35 <= sum(toxic) <= 65


def test_the_battery_is_drawn_between_its_bounds() -> None:
    for seed in SEEDS:
        scenario = make_scenario("fire-warehouse", seed)
        shortest = scenario.notes["shortest_s"]
        assert isinstance(shortest, float)
        planned = scenario.mission.limits.endurance_s
        assert shortest > 15.0 / 1.5 + STAY_S - 1.0
        assert 1.2 * shortest <= planned <= 2.2 * shortest
        assert scenario.rules.endurance_s == pytest.approx(planned / 0.75)


def test_several_clouds_and_rooms_keep_apart() -> None:
    for seed in range(10):
        scene = make_scenario("fire-warehouse", seed, smokes=3, rooms=3).scene
        assert len(scene.rooms) == 3
        assert len(scene.smokes) >= 2
        for a, b in itertools.combinations(scene.smokes, 2):
            assert gap_m(a.extent_m, b.extent_m) > 1.0


def look(solid: Solid) -> tuple[str, float, Shape]:
    return (solid.colour, round(max(solid.extent_m.size_m), 3), solid.shape)


@pytest.mark.long
@pytest.mark.parametrize("seed", SEEDS)
def test_boxes_stand_free_and_differ_in_combination_only(seed: int) -> None:
    scenario = make_scenario("medicine-boxes", seed)
    boxes = scenario.scene.solids
    assert 3 <= len(boxes) <= 8
    for a, b in itertools.combinations(boxes, 2):
        assert gap_m(a.extent_m, b.extent_m) > SPACING_M
    looks = [look(b) for b in boxes]
    assert len(set(looks)) == len(looks)
    assert all(len(set(values)) < len(looks) for values in zip(*looks, strict=True))
    assert {edge for _, edge, _ in looks} <= set(EDGES_M.values())
    holding = [b.id for b in boxes if any((a.name, a.value) == ("contents", "medicine") for a in b.attributes)]
    assert tuple(holding) == scenario.scene.goal_objects
    assert places_reached(scenario, through_smoke=True) == (True, True)


def test_a_wrong_name_or_value_says_what_is_right() -> None:
    with pytest.raises(UnknownNameError, match="fire-warehouse"):
        make_scenario("fire-warehose", 0)
    with pytest.raises(UnknownNameError, match="prior_toxic"):
        make_scenario("fire-warehouse", 0, prior_toxik=0.5)
    with pytest.raises(MissionError, match="probability"):
        make_scenario("fire-warehouse", 0, prior_toxic=1.5)
    with pytest.raises(MissionError, match="seed = -1"):
        make_scenario("medicine-boxes", -1)
    with pytest.raises(MissionError, match="from 2 to 12"):
        make_scenario("medicine-boxes", 0, fewest=9)
    with pytest.raises(MissionError, match="must be a number"):
        make_scenario("medicine-boxes", 0, most="many")  # type: ignore[arg-type]
