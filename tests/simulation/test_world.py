"""Scenes as MuJoCo worlds: what is felt lies inside the extents, and what is felt is there."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from mintpilot.core.errors import UnknownNameError
from mintpilot.core.geometry import Box
from mintpilot.simulation.materials import COLOURS
from mintpilot.simulation.scenarios import make_scenario
from mintpilot.simulation.scene import Scene, Shape, Solid
from mintpilot.simulation.textures import NAMES, texture
from mintpilot.simulation.world import build_world, place_late_solids

HALL = Box(lo_m=(0.0, 0.0, 0.0), hi_m=(8.0, 6.0, 4.0))


def compiled(scene: Scene) -> tuple[Any, Any, Any]:
    mujoco = pytest.importorskip("mujoco")
    model = build_world(scene).compile()
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    return mujoco, model, data


def corners(model: Any, data: Any, index: int) -> np.ndarray:
    """Corners (8, 3) of the geom's own bounding box, in the world."""
    signs = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    centre, half = model.geom_aabb[index][:3], model.geom_aabb[index][3:]
    return np.asarray(data.geom_xpos[index] + (centre + signs * half) @ data.geom_xmat[index].reshape(3, 3).T)


@pytest.mark.sim
@pytest.mark.parametrize(("name", "seed"), [("fire-warehouse", 0), ("fire-warehouse", 1), ("medicine-boxes", 0)])
def test_all_that_is_felt_of_a_solid_or_room_lies_in_its_extent(name: str, seed: int) -> None:
    scene = make_scenario(name, seed).scene
    _, model, data = compiled(scene)
    extents = {f"solid:{s.id}": s.extent_m for s in scene.solids} | {f"room:{r.id}": r.extent_m for r in scene.rooms}
    felt = set()
    for index in range(model.ngeom):
        owner = model.geom(index).name.rpartition(":")[0]
        if owner not in extents or model.geom_contype[index] == 0:
            continue
        felt.add(owner)
        box, points = extents[owner], corners(model, data, index)
        assert (points >= np.asarray(box.lo_m) - 1e-6).all(), model.geom(index).name
        assert (points <= np.asarray(box.hi_m) + 1e-6).all(), model.geom(index).name
    assert felt == set(extents)


@pytest.mark.sim
def test_no_bay_of_a_rack_is_high_enough_for_a_drone_with_its_margin() -> None:
    scene = make_scenario("fire-warehouse", 0).scene
    mujoco, model, data = compiled(scene)
    up, hit = np.array([0.0, 0.0, 1.0]), np.array([-1], np.int32)
    for rack in [s for s in scene.solids if s.kind == "rack"]:
        lo, hi = np.asarray(rack.extent_m.lo_m), np.asarray(rack.extent_m.hi_m)
        for share in np.linspace(0.15, 0.85, 12):
            for height in np.arange(0.25, 2.1, 0.15):
                place = np.array([*(lo + share * (hi - lo))[:2], height])
                above, below = (mujoco.mj_ray(model, data, place, sign * up, None, 1, -1, hit) for sign in (1, -1))
                assert 0 <= above + below < 2 * (0.27 + 0.1)


@pytest.mark.sim
def test_the_door_of_a_room_is_shut() -> None:
    scene = make_scenario("fire-warehouse", 0).scene
    mujoco, model, data = compiled(scene)
    room = scene.rooms[0]
    outwards = 1.0 if room.viewpoint_m[1] > room.door_m.centre_m[1] else -1.0
    eye = np.asarray(room.viewpoint_m)
    hit = np.array([-1], np.int32)
    distance = mujoco.mj_ray(model, data, eye, np.array([0.0, -outwards, 0.0]), None, 1, -1, hit)
    assert model.geom(int(hit[0])).name == f"pane:{room.id}"
    assert distance == pytest.approx(1.25, abs=0.1)


@pytest.mark.sim
def test_every_shape_and_colour_compiles_with_its_size() -> None:
    solids = tuple(
        Solid(
            id=f"{shape}-{colour}",
            kind="box",
            shape=shape,
            colour=colour,
            extent_m=Box(lo_m=(0.5 + 0.8 * i, 1.0 + j, 0.0), hi_m=(0.9 + 0.8 * i, 1.4 + j, 0.4)),
        )
        for i, colour in enumerate(COLOURS)
        for j, shape in enumerate(Shape)
    )
    _, model, _ = compiled(Scene(name="all", volume=HALL, start_m=(1, 1, 1), solids=solids))
    for solid in solids:
        geom = model.geom(f"solid:{solid.id}:0")
        assert geom.size[0] == pytest.approx(0.2)
        assert tuple(model.mat_rgba[geom.matid[0]][:3]) == pytest.approx(COLOURS[solid.colour])


@pytest.mark.sim
def test_a_late_solid_comes_when_its_time_has_come() -> None:
    late = Solid(id="late", kind="crate", extent_m=Box(lo_m=(3, 2, 0), hi_m=(4, 3, 1)), appears_s=5.0)
    scene = Scene(name="late", volume=HALL, start_m=(1, 1, 1), solids=(late,))
    mujoco, model, data = compiled(scene)
    eye, east, hit = np.array([1.0, 2.5, 0.5]), np.array([1.0, 0.0, 0.0]), np.array([-1], np.int32)
    seen = []
    for time_s in (0.0, 4.9, 5.0):
        place_late_solids(model, data, scene, time_s)
        mujoco.mj_forward(model, data)
        seen.append(float(mujoco.mj_ray(model, data, eye, east, None, 1, -1, hit)))
    assert seen == pytest.approx([7.0, 7.0, 2.0])


@pytest.mark.parametrize("name", NAMES)
def test_textures_tile_and_are_made_once(name: str) -> None:
    image = texture(name)
    assert image.shape == (256, 256, 3)
    assert image.std() > 2.0
    assert texture(name) is image
    assert not image.flags.writeable


def test_an_unknown_texture_is_named() -> None:
    with pytest.raises(UnknownNameError, match="brick"):
        texture("brik")
