from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from rooms_to_see import CAMERA, pose, see

from mintpilot.core.errors import MapError
from mintpilot.core.geometry import Box, GridFrame
from mintpilot.core.observation import Attribute, Detection, Frame
from mintpilot.core.plan import VehicleLimits
from mintpilot.core.semantic_map import Cell, Knowledge, SemanticMap
from mintpilot.mapping.builder import MapBuilder
from mintpilot.uncertainty.doubts import is_doubtful_person

ROOM = Box(lo_m=(0, 0, 0), hi_m=(8, 6, 3))
LATTICE = GridFrame(origin_m=(0.0, 0.0, 0.0), resolution_m=0.2, shape=(15, 30, 40))
BLOCK = Box(lo_m=(3.6, 2.0, 0.0), hi_m=(4.6, 3.0, 1.4))
POST = Box(lo_m=(6.05, 4.05, 0.0), hi_m=(6.13, 4.13, 3.0))


def builder() -> MapBuilder:
    return MapBuilder(LATTICE, limits=VehicleLimits(), volume=ROOM)


def looked_around(solids: list[Box], noise: float = 0.0) -> MapBuilder:
    rng = np.random.default_rng(0)
    made = builder()
    for x, y, turn in itertools.product((1.0, 7.0), (1.0, 5.0), np.arange(0, 2 * math.pi, 0.8)):
        frame = see(ROOM, solids, pose((x, y, 1.5), float(turn), 0.2))
        if noise:
            depth = frame.depth_m * (1 + noise * rng.standard_normal(frame.depth_m.shape)).astype(np.float32)
            frame = with_depth(frame, depth)
        made.integrate(frame, ())
    return made


def with_depth(frame: Frame, depth_m: np.ndarray) -> Frame:
    return Frame(
        time_s=0.0,
        rgb=frame.rgb,
        depth_m=depth_m.astype(np.float32),
        camera=frame.camera,
        world_from_camera=frame.world_from_camera,
    )


def state_at(map: SemanticMap, *points: tuple[float, float, float]) -> list[int]:
    z, y, x = map.frame.cells_of(points).T
    return [int(v) for v in map.cells[z, y, x]]


def cloud_in(frame: Frame, cloud: Box, index: int) -> tuple[Frame, Detection | None]:
    """The frame with every ray that meets the cloud ending just inside of it, and what perception would say."""
    lens, world = frame.camera, frame.world_from_camera
    u, v = np.meshgrid(np.arange(lens.width) + 0.5, np.arange(lens.height) + 0.5)
    rays = np.stack([(u - lens.cx) / lens.fx, (v - lens.cy) / lens.fy, np.ones_like(u)], -1) @ world[:3, :3].T
    rays = np.where(np.abs(rays) < 1e-12, 1e-12, rays)
    eye = world[:3, 3]
    ends = np.stack([(np.asarray(cloud.lo_m) - eye) / rays, (np.asarray(cloud.hi_m) - eye) / rays])
    near, far = ends.min(0).max(-1), ends.max(0).min(-1)
    met = (near > 0) & (near < far) & (near < frame.depth_m)
    if met.sum() < 50:
        return frame, None
    depth = np.where(met, near + 0.02, frame.depth_m)
    points = eye + rays[met] * depth[met][:, None]
    box = Box(lo_m=tuple(points.min(0).tolist()), hi_m=tuple(points.max(0).tolist()))
    pixels = (0, 0, lens.width, lens.height)
    smoke = Detection(label="smoke", score=0.9, box_m=box, points_m=points, pixels=pixels, frame_index=index)
    return with_depth(frame, depth), smoke


def test_an_empty_builder_knows_nothing() -> None:
    assert (builder().snapshot().cells == Cell.UNKNOWN).all()


@pytest.mark.long
def test_free_space_is_free_and_solids_are_not() -> None:
    # With noise, a surface seen at a grazing angle may lose a voxel of its skin.
    for noise, lost in ((0.0, 0.0), (0.005, 0.01)):
        made = looked_around([BLOCK, POST], noise).snapshot()
        centres = LATTICE.centres_of(np.argwhere(np.ones(LATTICE.shape)))
        free = (made.cells == Cell.FREE).ravel()
        for solid in (BLOCK, POST):
            touched = np.all((centres + 0.099 > solid.lo_m) & (centres - 0.099 < solid.hi_m), axis=1)
            assert (free & touched).sum() <= lost * touched.sum(), f"noise {noise}"
        near = [np.all((centres + 0.15 > s.lo_m) & (centres - 0.15 < s.hi_m), axis=1) for s in (BLOCK, POST)]
        clear = ~np.any(near, axis=0)
        inner = clear & np.all((centres > 0.45) & (centres < np.asarray(ROOM.hi_m) - 0.45), axis=1)
        assert (free & inner).sum() / inner.sum() > 0.97


def test_one_ray_clears_what_it_passes_and_fills_where_it_ends() -> None:
    made = builder()
    eye = (1.1, 3.1, 1.5)
    frame = see(ROOM, [], pose(eye, 0.0))
    depth = np.full_like(frame.depth_m, np.nan)
    depth[60, 80] = 4.0
    for _ in range(3):
        made.integrate(with_depth(frame, depth), ())
    row = made.snapshot().cells[7, 15]
    assert row[5:25].tolist() == [Cell.FREE] * 20
    assert row[25] == Cell.OCCUPIED
    assert (row[26:] == Cell.UNKNOWN).all()
    assert (made.snapshot().cells != Cell.UNKNOWN).sum() <= 23


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf, 0.0, -1.0])
def test_missing_depth_teaches_nothing(value: float) -> None:
    made = builder()
    frame = see(ROOM, [], pose((1.0, 3.0, 1.5), 0.0))
    made.integrate(with_depth(frame, np.full_like(frame.depth_m, value)), ())
    assert (made.snapshot().cells == Cell.UNKNOWN).all()


@given(
    eye=st.tuples(st.floats(-3, 11), st.floats(-3, 9), st.floats(-1, 4)),
    yaw=st.floats(-7, 7),
    pitch=st.floats(-1.5, 1.5),
    seed=st.integers(0, 99),
)
@settings(deadline=None, max_examples=25)
def test_any_depth_from_anywhere_changes_only_what_rays_can_reach(
    eye: tuple[float, float, float], yaw: float, pitch: float, seed: int
) -> None:
    depth = np.random.default_rng(seed).uniform(0.2, 2.0, (CAMERA.height, CAMERA.width))
    world = pose(eye, yaw, pitch)
    made = builder()
    frame = Frame(
        time_s=0.0,
        rgb=np.zeros((*depth.shape, 3), np.uint8),
        depth_m=depth.astype(np.float32),
        camera=CAMERA,
        world_from_camera=world,
    )
    made.integrate(frame, ())
    changed = np.argwhere(made.snapshot().cells != Cell.UNKNOWN)
    if len(changed):
        ahead = (LATTICE.centres_of(changed) - np.asarray(eye)) @ world[:3, 2]
        assert ahead.max() <= 2.0 + 0.2
        assert ahead.min() >= -0.2


def test_where_the_vehicle_was_is_free() -> None:
    made = builder()
    made.mark_flown([(2.0, 2.0, 1.0), (2.5, 2.0, 1.0)], 0.4)
    map = made.snapshot()
    assert state_at(map, (2.0, 2.0, 1.0), (2.5, 2.3, 1.0), (2.0, 2.0, 1.7)) == [Cell.FREE, Cell.FREE, Cell.UNKNOWN]


def test_a_cloud_becomes_one_region_that_covers_all_of_it() -> None:
    cloud = Box(lo_m=(3.0, 2.0, 0.0), hi_m=(5.0, 4.0, 3.0))
    made = builder()
    views = itertools.product((1.0, 7.0), (1.0, 5.0), np.arange(0, 2 * math.pi, 0.8))
    for index, (x, y, turn) in enumerate(views):
        frame, smoke = cloud_in(see(ROOM, [POST], pose((x, y, 1.5), float(turn), 0.1)), cloud, index)
        made.integrate(frame, (smoke,) if smoke else ())
    map = made.snapshot()
    (region,) = map.regions
    covered = np.zeros(map.frame.size, bool)
    covered[region.cells] = True
    centres = LATTICE.centres_of(np.argwhere(np.ones(LATTICE.shape)))
    inside = cloud.contains(centres) & (centres[:, 2] > 0.2)
    assert not (inside & (map.cells.ravel() == Cell.FREE) & ~covered).any()
    assert covered[inside].mean() > 0.99
    beyond = np.max(np.maximum(np.asarray(cloud.lo_m) - centres[covered], centres[covered] - cloud.hi_m)[:, :2])
    assert beyond < 0.75
    assert set(map.cells.ravel()[region.cells].tolist()) == {Cell.FREE}
    assert region.passable is Knowledge.OPEN
    assert "smoke" in region.description

    told = map.with_region(region.id, Knowledge.YES)
    assert [(r.id, r.passable) for r in made.snapshot(told).regions] == [(region.id, Knowledge.YES)]


def box_at(x: float, index: int, colour: str = "red", score: float = 0.7) -> Detection:
    return Detection(
        label="box",
        score=score,
        box_m=Box(lo_m=(x, 2.0, 0.0), hi_m=(x + 0.5, 2.5, 0.5)),
        attributes=(Attribute(name="colour", value=colour),),
        pixels=(10, 10, 40, 40),
        frame_index=index,
    )


def test_objects_are_fused_named_and_keep_their_names() -> None:
    made = builder()
    frame = see(ROOM, [], pose((1.0, 3.0, 1.5), 0.0))
    for index, colour in enumerate(("red", "red", "orange")):
        made.integrate(frame, (box_at(2.0 + 0.02 * index, index, colour), box_at(5.0, index, "blue")))
    first = made.snapshot()
    assert sorted(o.id for o in first.objects) == ["box-1", "box-2"]
    colours = {next(iter(o.values("colour"))): o for o in first.objects}
    assert set(colours) == {"red", "blue"}
    assert colours["red"].sightings == 3
    assert colours["red"].position_m == pytest.approx((2.27, 2.25, 0.25), abs=0.02)
    made.integrate(frame, (box_at(6.5, 7), box_at(2.05, 7)))
    made.integrate(frame, (box_at(6.5, 8),))
    later = made.snapshot(first)
    assert {o.id: o.values("colour") for o in later.objects}[colours["blue"].id] == {"blue"}
    assert len(later.objects) == 3


def test_a_glimpse_is_no_object() -> None:
    made = builder()
    made.integrate(see(ROOM, [], pose((1.0, 3.0, 1.5), 0.0)), (box_at(2.0, 0, score=0.5),))
    assert made.snapshot().objects == ()


def test_nobody_flies_through_flames() -> None:
    made = looked_around([])
    flames = Box(lo_m=(4, 3, 0.2), hi_m=(4.6, 3.6, 1.0))
    frame = see(ROOM, [], pose((1.0, 3.0, 1.5), 0.0))
    for index in (98, 99):
        made.integrate(frame, (Detection(label="fire", score=0.9, box_m=flames, frame_index=index),))
    assert state_at(made.snapshot(), (4.3, 3.3, 0.5), (4.8, 3.3, 0.5), (5.6, 3.3, 0.9)) == [2, 2, 1]


def test_flames_count_from_the_first_glimpse_and_nobody_flies_over_them() -> None:
    made = looked_around([])
    flames = Box(lo_m=(4, 3, 0.2), hi_m=(4.6, 3.6, 1.0))
    made.integrate(
        see(ROOM, [], pose((1.0, 3.0, 1.5), 0.0)), (Detection(label="fire", score=0.9, box_m=flames, frame_index=98),)
    )
    assert state_at(made.snapshot(), (4.3, 3.3, 0.5), (4.3, 3.3, 2.7), (5.6, 3.3, 2.1)) == [2, 2, 1]


def test_smoke_that_glows_hides_flames_between_its_lit_fronts() -> None:
    cloud = Box(lo_m=(3.0, 2.0, 0.0), hi_m=(5.0, 4.0, 3.0))
    made = builder()
    for index, (x, turn) in enumerate(itertools.product((0.5, 7.5), np.arange(0, 2 * math.pi, 0.5))):
        frame, smoke = cloud_in(see(ROOM, [], pose((x, 3.0, 1.5), float(turn), 0.1)), cloud, index)
        found = []
        if smoke is not None and smoke.points_m is not None:
            low = smoke.points_m[(smoke.points_m[:, 2] < 1.0) & (np.abs(smoke.points_m[:, 1] - 3.0) < 0.3)]
            found = [smoke]
            if len(low):
                box = Box(lo_m=tuple(low.min(0).tolist()), hi_m=tuple(low.max(0).tolist()))
                found.append(Detection(label="glow", score=0.9, box_m=box, points_m=low, frame_index=index))
        made.integrate(frame, tuple(found))
    map = made.snapshot()
    assert [o.label for o in map.objects] == []
    (region,) = map.regions
    passable = made.snapshot(map.with_region(region.id, Knowledge.YES))
    inside = state_at(passable, (3.1, 3.0, 0.5), (4.0, 3.0, 0.5), (4.0, 3.0, 2.0), (4.9, 3.0, 0.5))
    assert inside == [Cell.OCCUPIED] * 4
    assert state_at(passable, (4.0, 2.1, 0.7), (4.0, 3.9, 0.7)) == [Cell.FREE, Cell.FREE]


def test_the_foot_of_flames_is_nobody_but_somebody_beside_them_is() -> None:
    made = builder()
    frame = see(ROOM, [], pose((1.0, 3.0, 1.5), 0.0))
    lying = {
        "in the flames": Box(lo_m=(3.9, 2.9, 0.0), hi_m=(4.9, 3.5, 0.4)),
        "beside": Box(lo_m=(4.7, 4.0, 0.0), hi_m=(5.7, 4.6, 0.3)),
    }
    for index in range(2):
        people = [Detection(label="person", score=0.9, box_m=box, frame_index=index) for box in lying.values()]
        made.integrate(frame, people)
    before = made.snapshot()
    assert len([o for o in before.objects if o.label == "person"]) == 2
    flames = Box(lo_m=(4, 3, 0.2), hi_m=(4.6, 3.6, 1.0))
    for index in (2, 3):
        made.integrate(frame, (Detection(label="fire", score=0.9, box_m=flames, frame_index=index),))
    people_left = [o.box_m for o in made.snapshot(before).objects if o.label == "person"]
    assert people_left == [lying["beside"]]


def test_flames_in_smoke_stay_solid() -> None:
    cloud = Box(lo_m=(3.0, 2.0, 0.0), hi_m=(5.0, 4.0, 3.0))
    flames = Box(lo_m=(2.8, 2.8, 0.2), hi_m=(3.2, 3.2, 1.0))
    made = builder()
    for index in range(4):
        frame, smoke = cloud_in(see(ROOM, [], pose((0.5, 3.0, 1.5), 0.0, 0.1)), cloud, index)
        assert smoke is not None
        made.integrate(frame, (smoke, Detection(label="fire", score=0.9, box_m=flames, frame_index=index)))
    assert state_at(made.snapshot(), (3.0, 3.0, 0.5), (3.4, 3.0, 0.5)) == [Cell.OCCUPIED, Cell.OCCUPIED]


def test_a_door_becomes_a_room_to_look_into() -> None:
    made = looked_around([])
    frame = see(ROOM, [], pose((3.0, 3.0, 1.5), 0.0))
    for index in range(50, 54):
        leaf = Detection(
            label="door",
            score=0.92,
            box_m=Box(lo_m=(7.9, 2.5, 0.0), hi_m=(8.0, 3.5, 2.0)),
            attributes=(Attribute(name="colour", value="brown"),),
            frame_index=index,
        )
        made.integrate(frame, (leaf,))
    map = made.snapshot()
    (room,) = map.rooms
    assert room.viewpoint_m[:2] == pytest.approx((6.75, 3.0), abs=0.5)
    assert state_at(map, room.viewpoint_m) == [Cell.FREE]
    assert room.description == "the closed room with the brown door on the east side"
    told = map.with_room(room.id, occupied=Knowledge.NO, searched=True)
    (again,) = made.snapshot(told).rooms
    assert (again.id, again.occupied, again.searched) == (room.id, Knowledge.NO, True)


def test_a_map_on_another_lattice_is_refused() -> None:
    other = GridFrame(origin_m=(0.0, 0.0, 0.0), resolution_m=0.1, shape=(2, 2, 2))
    stranger = SemanticMap(frame=other, cells=np.zeros(other.shape, np.uint8))
    with pytest.raises(MapError, match="same lattice"):
        builder().snapshot(stranger)


def test_somebody_glimpsed_once_stays_in_doubt_until_seen_again():
    made = builder()
    box = Box(lo_m=(3.0, 2.0, 0.0), hi_m=(4.7, 2.5, 0.3))
    for index, frame in enumerate(see(ROOM, [], pose((1.0, 2.0, 1.5), turn, 0.2)) for turn in (0.0, 0.3)):
        made.integrate(frame, [Detection(label="person", score=0.9, box_m=box, frame_index=index)])
        (person,) = made.snapshot().objects
        assert is_doubtful_person(person) == (index == 0)
    assert not person.names
