"""The simulator as a source of pictures: full turns at free places of a scenario, rendered with the sensor's faults."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from scipy.ndimage import minimum_filter

from mintpilot.core.geometry import Bools, Floats, Vec3
from mintpilot.core.observation import RawFrame
from mintpilot.core.ports import FrameSource, SourceOptions
from mintpilot.core.semantic_map import Cell
from mintpilot.simulation.engine import load_mujoco
from mintpilot.simulation.render import SceneRenderer
from mintpilot.simulation.scenarios import make_scenario
from mintpilot.simulation.scene import Scene
from mintpilot.simulation.scene_map import map_of_scene
from mintpilot.simulation.world import build_world

APART_M = (3.4, 3.1)
"""Between the places that are looked around from, along x and y."""
HEIGHT_M = 1.6
TURNS = 8
"""Pictures of one full turn."""
TILT_RAD = 0.26
"""How far the camera looks down."""
FIELD_OF_VIEW_DEG = 58.0
FRAME_S = 0.5
_RESOLUTION_M, _CLEAR_CELLS = 0.2, 5


class SimulatedPictures(FrameSource):
    """Pictures of a built-in scenario, with true poses.

    Args:
        where: name of the generator; see `mintpilot.simulation.scenarios`.
        options: ``seed`` draws the world and the sensor's noise, ``longest`` bounds the number of frames.
        size: width and height, pixels.

    Raises:
        UnknownNameError: there is no such scenario.
    """

    def __init__(self, where: str, options: SourceOptions, *, size: tuple[int, int] = (320, 240)) -> None:
        self._scene: Scene = make_scenario(where, options.seed).scene
        self._seed, self._size, self._longest = options.seed, size, options.longest

    @property
    def z_is_up(self) -> bool:
        """True."""
        return True

    def remarks(self) -> tuple[str, ...]:
        """Nothing."""
        return ()

    def frames(self) -> Iterator[RawFrame]:
        """The pictures, place after place. Raises `MissingPartError` when MuJoCo is not installed."""
        mujoco = load_mujoco()
        spec = build_world(self._scene)
        spec.worldbody.add_camera(name="rgbd", pos=[1, 1, 1], fovy=FIELD_OF_VIEW_DEG)
        model = spec.compile()
        data = mujoco.MjData(model)
        camera, taken = model.camera("rgbd").id, 0
        with SceneRenderer(model, self._scene, seed=self._seed, width=self._size[0], height=self._size[1]) as renderer:
            for eye in places_to_look_from(self._scene):
                for turn in range(TURNS):
                    if taken >= self._longest:
                        return
                    pose = looking(eye, 2 * math.pi * turn / TURNS, TILT_RAD)
                    quaternion = np.zeros(4)
                    mujoco.mju_mat2Quat(quaternion, (pose[:3, :3] * (1.0, -1.0, -1.0)).reshape(-1))
                    model.cam_pos[camera], model.cam_quat[camera] = eye, quaternion
                    mujoco.mj_forward(model, data)
                    taken += 1
                    frame = renderer.capture(data, taken * FRAME_S)
                    yield RawFrame(
                        time_s=frame.time_s,
                        rgb=frame.rgb,
                        depth_m=np.nan_to_num(frame.depth_m),
                        camera=frame.camera,
                        source_from_camera=pose,
                    )


def places_to_look_from(scene: Scene) -> Iterator[Vec3]:
    """Free places all over a scene, outside its clouds, some metres apart."""
    truth = map_of_scene(scene, _RESOLUTION_M)
    free: Bools = truth.cells == Cell.FREE
    for region in truth.regions:
        free.reshape(-1)[region.cells] = False
    roomy = minimum_filter(free, _CLEAR_CELLS)
    lo, hi = scene.volume.lo_m, scene.volume.hi_m
    for x in np.arange(lo[0] + 1.5, hi[0] - 0.5, APART_M[0]):
        for y in np.arange(lo[1] + 1.5, hi[1] - 0.5, APART_M[1]):
            eye = (float(x), float(y), lo[2] + HEIGHT_M)
            cell = truth.frame.cells_of(eye)
            if truth.frame.contains(cell)[0] and roomy[tuple(cell[0])]:
                yield eye


def looking(eye_m: Vec3, yaw_rad: float, down_rad: float) -> Floats:
    """Pose (4, 4) of an optical frame that looks that way, with its horizon level."""
    level = math.cos(down_rad)
    ahead = np.array([math.cos(yaw_rad) * level, math.sin(yaw_rad) * level, -math.sin(down_rad)])
    right = np.array([math.sin(yaw_rad), -math.cos(yaw_rad), 0.0])
    pose = np.eye(4)
    pose[:3, 0], pose[:3, 1], pose[:3, 2], pose[:3, 3] = right, np.cross(ahead, right), ahead, eye_m
    return pose
