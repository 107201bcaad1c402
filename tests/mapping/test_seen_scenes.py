"""What is mapped from rendered pictures, held against the truth of the scene."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
import pytest
from rooms_to_see import pose
from scipy.ndimage import minimum_filter

from mintpilot.core.geometry import Box
from mintpilot.core.observation import Frame
from mintpilot.core.plan import VehicleLimits
from mintpilot.core.semantic_map import Cell, SemanticMap
from mintpilot.mapping.builder import MapBuilder
from mintpilot.mapping.smoke import cells_in
from mintpilot.perception.geometric import GeometricPerception
from mintpilot.simulation.scenarios.fire_warehouse import fire_warehouse
from mintpilot.simulation.scenarios.medicine_boxes import medicine_boxes
from mintpilot.simulation.scene import Scene
from mintpilot.simulation.scene_map import SHAPE_WORDS, map_of_scene, size_word

pytestmark = pytest.mark.sim


def views(scene: Scene, truth: SemanticMap, seed: int) -> Iterator[Frame]:
    """Full turns at free places some metres apart."""
    mujoco = pytest.importorskip("mujoco", reason="needs MuJoCo")
    from mintpilot.simulation.render import SceneRenderer
    from mintpilot.simulation.world import build_world

    spec = build_world(scene)
    spec.worldbody.add_camera(name="rgbd", pos=[1, 1, 1], fovy=58.0)
    model = spec.compile()
    data = mujoco.MjData(model)
    camera, time_s = model.camera("rgbd").id, 0.0
    rng = np.random.default_rng(seed)
    free = truth.cells == Cell.FREE
    for region in truth.regions:
        free.reshape(-1)[region.cells] = False
    free = minimum_filter(free, 5)
    with SceneRenderer(model, scene, seed=seed) as renderer:
        for x in np.arange(1.5, scene.volume.hi_m[0] - 0.5, 3.4):
            for y in np.arange(1.5, scene.volume.hi_m[1] - 0.5, 3.1):
                eye = (float(x), float(y), float(rng.uniform(1.2, 2.6)))
                if not free[tuple(truth.frame.cells_of(eye)[0])]:
                    continue
                for turn in np.linspace(0, 2 * math.pi, 9, endpoint=False):
                    world = pose(eye, float(turn), 0.26)
                    quaternion = np.zeros(4)
                    mujoco.mju_mat2Quat(quaternion, (world[:3, :3] * (1.0, -1.0, -1.0)).reshape(-1))
                    model.cam_pos[camera], model.cam_quat[camera] = eye, quaternion
                    mujoco.mj_forward(model, data)
                    time_s += 0.5
                    yield renderer.capture(data, time_s)


def mapped(scene: Scene, seed: int) -> tuple[SemanticMap, SemanticMap]:
    truth = map_of_scene(scene, 0.2)
    builder = MapBuilder(truth.frame, limits=VehicleLimits(), volume=scene.volume)
    perception = GeometricPerception()
    for index, frame in enumerate(views(scene, truth, seed)):
        builder.integrate(frame, perception.detect(frame, index))
    return builder.snapshot(), truth


@pytest.mark.long
@pytest.mark.parametrize("seed", [1, pytest.param(2, marks=pytest.mark.slow)])
def test_boxes_are_found_with_their_looks(seed: int) -> None:
    scene = medicine_boxes(seed).scene
    found, truth = mapped(scene, seed)
    boxes = [o for o in found.objects if o.label == "box"]
    assert len(boxes) == len(scene.solids)
    for solid in scene.solids:
        near = min(boxes, key=lambda o: math.dist(o.position_m, solid.extent_m.centre_m))
        assert math.dist(near.position_m, solid.extent_m.centre_m) < 0.25
        looks = {a.name: a.value for a in near.attributes}
        wanted = {"colour": solid.colour, "size": size_word(solid.extent_m), "shape": SHAPE_WORDS[solid.shape]}
        assert looks == wanted
    (person,) = [o for o in found.objects if o.label == "person"]
    assert math.dist(person.position_m[:2], scene.persons[0].position_m[:2]) < 0.7
    free, solid_cells = found.cells == Cell.FREE, truth.cells == Cell.OCCUPIED
    solid_cells[0] = False
    # The truth calls a voxel solid as soon as a corner of it is touched.
    assert (free & solid_cells).sum() / free.sum() < 0.003


@pytest.mark.slow
@pytest.mark.parametrize("seed", [1, 3])
def test_no_flyable_space_is_left_inside_smoke(seed: int) -> None:
    scene = fire_warehouse(seed).scene
    found, truth = mapped(scene, seed)
    (region,), (room,) = found.regions, found.rooms
    covered = np.zeros(found.frame.size, bool)
    covered[region.cells] = True
    covered = covered.reshape(found.cells.shape)
    extent: Box = scene.smokes[0].extent_m
    smoky = cells_in(found.frame, extent) & (truth.cells != Cell.OCCUPIED)
    smoky[0] = False
    assert (smoky & ~covered & (found.cells == Cell.FREE)).sum() / smoky.sum() < 0.005
    assert (smoky & covered).sum() / smoky.sum() > 0.96  # what is missing is unknown, not free
    centres = found.frame.centres_of(np.argwhere(covered))
    beyond = np.maximum(np.asarray(extent.lo_m) - centres, centres - np.asarray(extent.hi_m))[:, :2].max()
    assert beyond < 0.75
    assert math.dist(room.viewpoint_m, scene.rooms[0].viewpoint_m) < 0.5
    assert "door" in room.description
    assert "smoke" in region.description
    assert [o.label for o in found.objects].count("person") == 1
    walls = np.zeros(found.cells.shape, bool)
    for solid in scene.solids:
        # What is inside the hull of a rack or a heap of rubble may well be open, and is seen to be.
        if solid.kind in ("partition", "crate", "box", "barrel", "pillar"):
            walls |= cells_in(found.frame, solid.extent_m)
    walls[0] = False
    assert (walls & (found.cells == Cell.FREE) & ~covered).sum() / walls.sum() < 0.01
