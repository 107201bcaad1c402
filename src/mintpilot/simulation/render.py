"""Pictures of a world: what the drone's RGB-D camera returns, and nice views for people."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mintpilot.core.errors import UnknownNameError
from mintpilot.core.geometry import Floats
from mintpilot.core.observation import CameraModel, Frame
from mintpilot.simulation.engine import drawing_context, drawing_resources, load_mujoco
from mintpilot.simulation.props import CEILING_GROUP
from mintpilot.simulation.scene import Scene
from mintpilot.simulation.sensor import SensorSettings, corrupt
from mintpilot.simulation.smoke import march, volumes_of

CLEAR_PANE_M = 2.2
"""A door's pane mirrors the lit hall; only from nearer than this can one see through it."""


class SceneRenderer:
    """Draws one compiled world. Belongs to the thread that made it; `close` it, or use it in a ``with``.

    Args:
        model: the compiled world (``build_world(scene).compile()``, with or without a drone).
        scene: the scene it was built from: clouds and flames are drawn from it.
        seed: decides the noise of the depth sensor: the same seed and calls give the same frames.
        width: of the drone's pictures, pixels.
        height: of the drone's pictures, pixels.
        sensor: faults of the depth sensor.

    Raises:
        MissingPartError: MuJoCo or a drawing library is not installed.
    """

    def __init__(
        self,
        model: Any,
        scene: Scene,
        *,
        seed: int,
        width: int = 320,
        height: int = 240,
        sensor: SensorSettings | None = None,
    ) -> None:
        self._mujoco = load_mujoco()
        self._model = model
        self._volumes = volumes_of(scene)
        self._rng = np.random.default_rng(seed)
        self._size = (width, height)
        self._sensor = sensor or SensorSettings()
        self._gl: Any = drawing_context(self._mujoco, max(width, 1280), max(height, 960))
        self._context: Any = drawing_resources(self._mujoco, model)
        self._mujoco.mjr_setBuffer(self._mujoco.mjtFramebuffer.mjFB_OFFSCREEN.value, self._context)
        self._context.readDepthMap = self._mujoco.mjtDepthMap.mjDEPTH_ZEROFAR
        self._scene: Any = self._mujoco.MjvScene(model, maxgeom=10000)
        names = (model.geom(i).name for i in range(model.ngeom))
        self._panes = {i for i, name in enumerate(names) if name.startswith("pane:")}

    def capture(self, data: Any, time_s: float, camera: str = "rgbd") -> Frame:
        """What the drone's camera returns now: colours and faulty depth, from one drawing pass.

        Args:
            data: state of the world.
            time_s: stamp of the frame; also drives smoke and flames.
            camera: name of a camera of the model.

        Raises:
            UnknownNameError: the model has no camera of that name.
        """
        width, height = self._size
        rgb, depth = self._draw(data, camera, width, height, shadows=False)
        pose, focal = self._pose(data, camera), self._focal(camera, height)
        sensed = depth.copy()
        self._march(rgb, depth, sensed, pose, focal, time_s)
        returned = corrupt(sensed, focal_px=focal, settings=self._sensor, rng=self._rng)
        lens = CameraModel(width=width, height=height, fx=focal, fy=focal, cx=width / 2, cy=height / 2)
        return Frame(time_s=time_s, rgb=rgb, depth_m=returned, camera=lens, world_from_camera=pose)

    def geoms_seen(self, data: Any, camera: str) -> NDArray[np.int32]:
        """Index of the geom that each pixel of the drone's picture shows (height, width); -1 for none.

        Raises:
            UnknownNameError: the model has no camera of that name.
        """
        flags, mj, (width, height) = self._scene.flags, self._mujoco, self._size
        flags[mj.mjtRndFlag.mjRND_SEGMENT] = flags[mj.mjtRndFlag.mjRND_IDCOLOR] = True
        try:
            rgb, _ = self._draw(data, camera, width, height, shadows=False)
        finally:
            flags[mj.mjtRndFlag.mjRND_SEGMENT] = flags[mj.mjtRndFlag.mjRND_IDCOLOR] = False
        numbers = rgb.astype(np.int32) @ np.array([1, 256, 65536], np.int32)
        geoms = np.full(self._scene.ngeom + 1, -1, np.int32)
        for i in range(self._scene.ngeom):
            if self._scene.geoms[i].objtype == mj.mjtObj.mjOBJ_GEOM:
                geoms[self._scene.geoms[i].segid + 1] = self._scene.geoms[i].objid
        return geoms[np.where(numbers < len(geoms), numbers, 0)]

    def picture(
        self, data: Any, camera: str = "overview", width: int = 960, height: int = 540, *, time_s: float = 0.0
    ) -> NDArray[np.uint8]:
        """A view for people (height, width, 3), with shadows; at most 1280 x 960. ``plan`` leaves out the roof.

        Raises:
            UnknownNameError: the model has no camera of that name.
        """
        rgb, depth = self._draw(data, camera, width, height, shadows=True)
        self._march(rgb, depth, depth.copy(), self._pose(data, camera), self._focal(camera, height), time_s)
        return rgb

    def close(self) -> None:
        """Frees the drawing context. Safe to call twice."""
        if self._gl is not None:
            self._gl.make_current()
            self._context.free()
            self._gl.free()
            self._gl = None

    def __enter__(self) -> SceneRenderer:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _draw(
        self, data: Any, camera: str, width: int, height: int, *, shadows: bool
    ) -> tuple[NDArray[np.uint8], NDArray[np.float32]]:
        """Colours and true depth in metres, both from one pass."""
        mj = self._mujoco
        self._gl.make_current()
        view, option = mj.MjvCamera(), mj.MjvOption()
        view.type, view.fixedcamid = mj.mjtCamera.mjCAMERA_FIXED, self._camera_id(camera)
        option.geomgroup[:] = 1
        option.geomgroup[4:] = 0
        option.geomgroup[CEILING_GROUP] = camera != "plan"
        self._scene.flags[mj.mjtRndFlag.mjRND_SHADOW] = shadows
        mj.mjv_updateScene(self._model, data, option, None, view, mj.mjtCatBit.mjCAT_ALL.value, self._scene)
        self._hide_near_panes(data, camera)
        rgb, raw = np.empty((height, width, 3), np.uint8), np.empty((height, width), np.float32)
        rect = mj.MjrRect(0, 0, width, height)
        mj.mjr_render(rect, self._scene, self._context)
        mj.mjr_readPixels(rgb, raw, rect, self._context)
        extent, clip = self._model.stat.extent, self._model.vis.map
        near, far = clip.znear * extent, clip.zfar * extent
        # Reversed z: 1 at the near plane, 0 at the far one.
        depth = near * far / (near + np.flipud(raw).astype(np.float64) * (far - near))
        return np.ascontiguousarray(np.flipud(rgb)), depth.astype(np.float32)

    def _hide_near_panes(self, data: Any, camera: str) -> None:
        """Panes mirror from afar; those near the camera are made too small to see."""
        eye = data.cam_xpos[self._camera_id(camera)]
        for i in range(self._scene.ngeom):
            geom = self._scene.geoms[i]
            if (
                geom.objtype == self._mujoco.mjtObj.mjOBJ_GEOM
                and geom.objid in self._panes
                and np.linalg.norm(geom.pos - eye) < CLEAR_PANE_M
            ):
                geom.size[:] = 1e-6

    def _camera_id(self, camera: str) -> int:
        names = [self._model.camera(i).name for i in range(self._model.ncam)]
        if camera not in names:
            raise UnknownNameError("camera", camera, names)
        return names.index(camera)

    def _focal(self, camera: str, height: int) -> float:
        return float(height / 2 / math.tan(math.radians(self._model.cam_fovy[self._camera_id(camera)]) / 2))

    def _pose(self, data: Any, camera: str) -> Floats:
        """Pose of the optical frame; MuJoCo's camera looks along -z with y up."""
        index = self._camera_id(camera)
        pose = np.eye(4)
        pose[:3, :3] = data.cam_xmat[index].reshape(3, 3) * (1.0, -1.0, -1.0)
        pose[:3, 3] = data.cam_xpos[index]
        return pose

    def _march(
        self,
        rgb: NDArray[np.uint8],
        depth: NDArray[np.float32],
        sensed: NDArray[np.float32],
        pose: Floats,
        focal: float,
        time_s: float,
    ) -> None:
        """Clouds and flames over the picture, farthest first."""
        eye = pose[:3, 3]
        for volume in sorted(self._volumes, key=lambda v: -float(np.linalg.norm(v.box.centre_m - eye))):
            march(rgb, depth, sensed, volume, world_from_camera=pose, focal_px=focal, time_s=time_s)
