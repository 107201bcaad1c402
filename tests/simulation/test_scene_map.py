"""The perfect map holds what can be seen, and nothing that cannot."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mintpilot.core.errors import LimitError
from mintpilot.core.geometry import Box, Vec3
from mintpilot.core.observation import Attribute
from mintpilot.core.semantic_map import Cell, Knowledge
from mintpilot.simulation.scenarios import make_scenario
from mintpilot.simulation.scene import Person, Scene, Shape, Smoke, Solid
from mintpilot.simulation.scene_map import map_of_scene

HALL = Box(lo_m=(0.0, 0.0, 0.0), hi_m=(6.0, 5.0, 3.0))


def scene(*solids: Solid, smokes: tuple[Smoke, ...] = ()) -> Scene:
    return Scene(name="small", volume=HALL, start_m=(0.5, 0.5, 1.0), solids=solids, smokes=smokes)


def box(lo: Vec3, hi: Vec3) -> Box:
    return Box(lo_m=lo, hi_m=hi)


corner = st.tuples(st.floats(0.2, 4.0), st.floats(0.2, 3.0), st.floats(0.0, 1.5))
edges = st.tuples(st.floats(0.1, 1.6), st.floats(0.1, 1.6), st.floats(0.1, 1.4))


@settings(deadline=None, max_examples=30)
@given(low=corner, size=edges, shape=st.sampled_from(list(Shape)), seed=st.integers(0, 99))
def test_every_point_of_a_solid_is_in_an_occupied_cell(low: Vec3, size: Vec3, shape: Shape, seed: int) -> None:
    extent = Box(lo_m=low, hi_m=tuple(a + b for a, b in zip(low, size, strict=True)))  # type: ignore[arg-type]
    world = map_of_scene(scene(Solid(id="it", kind="crate", extent_m=extent, shape=shape)), 0.2)
    points = np.random.default_rng(seed).uniform(extent.lo_m, extent.hi_m, (400, 3))
    away = points - np.asarray(extent.centre_m)
    if shape is Shape.CYLINDER:
        points = points[np.hypot(away[:, 0], away[:, 1]) < min(size[:2]) / 2 - 1e-3]
    elif shape is Shape.SPHERE:
        points = points[np.linalg.norm(away, axis=1) < min(size) / 2 - 1e-3]
    z, y, x = world.frame.cells_of(points).T
    assert (world.cells[z, y, x] == Cell.OCCUPIED).all()


def test_cells_that_a_solid_only_touches_from_outside_stay_free() -> None:
    world = map_of_scene(scene(Solid(id="it", kind="crate", extent_m=box((1.0, 1.0, 0.2), (2.0, 2.0, 1.0)))), 0.2)
    assert (world.cells[1:] == Cell.OCCUPIED).sum() == 5 * 5 * 4
    assert (world.cells[0] == Cell.OCCUPIED).all()


def test_hidden_properties_are_not_on_the_map() -> None:
    safe = make_scenario("fire-warehouse", 5, prior_toxic=0.0, prior_occupied=0.0).scene
    bad = make_scenario("fire-warehouse", 5, prior_toxic=1.0, prior_occupied=1.0).scene
    bad = replace(
        bad,
        smokes=tuple(replace(s, prior_safe=1.0) for s in bad.smokes),
        rooms=tuple(replace(r, prior_occupied=0.0) for r in bad.rooms),
    )
    a, b = map_of_scene(safe, 0.2), map_of_scene(bad, 0.2)
    assert (a.cells == b.cells).all()
    assert a.objects == b.objects
    assert a.rooms == b.rooms
    assert all(
        (p.cells == q.cells).all() and p.passable is q.passable for p, q in zip(a.regions, b.regions, strict=True)
    )
    assert all(r.passable is Knowledge.OPEN for r in b.regions)
    assert all(r.occupied is Knowledge.OPEN and not r.searched for r in b.rooms)


def test_a_room_is_matter_outside_and_unknown_inside() -> None:
    drawn = make_scenario("fire-warehouse", 5).scene
    world = map_of_scene(drawn, 0.2)
    room = drawn.rooms[0]
    x, y, _ = room.extent_m.centre_m
    inside = tuple(world.frame.cells_of((x, y, 1.0))[0])
    assert world.cells[inside] == Cell.UNKNOWN
    assert world.cells[tuple(world.frame.cells_of(room.door_m.centre_m)[0])] == Cell.OCCUPIED
    assert world.cells[tuple(world.frame.cells_of(room.viewpoint_m)[0])] == Cell.FREE


def test_a_cloud_is_a_region_of_its_free_cells_and_changes_none() -> None:
    crate = Solid(id="crate", kind="crate", extent_m=box((2.0, 2.0, 0.0), (3.0, 3.0, 1.0)))
    cloud = Smoke(id="cloud", extent_m=box((1.0, 1.0, 0.0), (4.0, 4.0, 3.0)), toxic=True, prior_safe=0.3)
    clear, smoky = map_of_scene(scene(crate), 0.2), map_of_scene(scene(crate, smokes=(cloud,)), 0.2)
    assert (clear.cells == smoky.cells).all()
    (region,) = smoky.regions
    assert (smoky.cells.reshape(-1)[region.cells] == Cell.FREE).all()
    assert len(region.cells) == 15 * 15 * 14 - 5 * 5 * 4
    assert region.prior_passable == 0.3
    assert (np.diff(region.cells) > 0).all()


def test_boxes_get_words_for_what_can_be_seen_only() -> None:
    solid = Solid(
        id="box-1",
        kind="box",
        extent_m=box((1.0, 1.0, 0.0), (1.8, 1.8, 0.8)),
        shape=Shape.CYLINDER,
        colour="red",
        attributes=(Attribute(name="contents", value="medicine"),),
    )
    wall = Solid(id="wall", kind="partition", extent_m=box((3.0, 0.0, 0.0), (3.2, 5.0, 3.0)))
    person = Person(id="somebody", position_m=(5.0, 2.0, 0.0))
    world = map_of_scene(replace(scene(solid, wall), persons=(person,)), 0.2)
    assert [o.label for o in world.objects] == ["box", "person"]
    said = {(a.name, a.value) for a in world.objects[0].attributes}
    assert said == {("colour", "red"), ("size", "large"), ("shape", "cylindrical")}


def test_what_comes_later_is_not_there_yet() -> None:
    late = Solid(id="late", kind="rubble", extent_m=box((2.0, 2.0, 0.0), (3.0, 3.0, 1.0)), appears_s=10.0)
    before, after = map_of_scene(scene(late), 0.2, time_s=9.0), map_of_scene(scene(late), 0.2, time_s=10.0)
    assert before.objects == ()
    assert [o.id for o in after.objects] == ["late"]
    assert (after.cells == Cell.OCCUPIED).sum() > (before.cells == Cell.OCCUPIED).sum()


def test_a_hall_of_too_many_voxels_is_refused() -> None:
    vast = Scene(name="vast", volume=Box(lo_m=(0, 0, 0), hi_m=(8000, 8000, 300)), start_m=(1.0, 1.0, 1.0))
    with pytest.raises(LimitError, match="make the volume smaller"):
        map_of_scene(vast, 0.2)
