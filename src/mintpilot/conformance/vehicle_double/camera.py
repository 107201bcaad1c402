"""The double's camera: MuJoCo draws its scene at the pose that the double reports, in a process of its own."""

from __future__ import annotations

import math
import multiprocessing
import select
import signal
from multiprocessing.connection import Connection
from typing import Any

from mintpilot.conformance.vehicle_double.body import Ned
from mintpilot.core.errors import DeviceError
from mintpilot.core.geometry import Vec3
from mintpilot.simulation.scene import FlightRules, Scene

READY_S = 60.0
_FIELDS = 5
"""Shared with the process: time, seconds; x, y, z on the map, metres; yaw, radians."""


class DoubleCamera:
    """Pictures at ``sim://127.0.0.1:PORT``. Drawing takes longer than the double may stand still: hence the process.

    Args:
        scene: what is drawn.
        rules: size of the drone's hull.
        port: TCP; 0: any free one.

    Attributes:
        port: where pictures are had.

    Raises:
        DeviceError: the port cannot be used, or nothing can be drawn.
    """

    def __init__(self, scene: Scene, rules: FlightRules | None, port: int) -> None:
        context = multiprocessing.get_context("spawn")
        self._pose: Any = context.Array("d", [0.0] * _FIELDS)
        self._pad: Vec3 = (scene.start_m[0], scene.start_m[1], scene.volume.lo_m[2])
        self._pipe, theirs = context.Pipe()  # as long as it is open, the process draws
        arguments = (theirs, self._pose, scene, rules or FlightRules(), port)
        self._process = context.Process(target=_draw, args=arguments, name="vehicle-double-camera", daemon=True)
        self.move(0.0, (0.0, 0.0, 0.0), 0.0)
        self._process.start()
        theirs.close()
        said: int | str = self._pipe.recv() if self._pipe.poll(READY_S) else "it did not start"
        if isinstance(said, str):
            self.close()
            raise DeviceError(f"no camera at port {port}: {said}; choose another port")
        self.port = said

    def move(self, time_s: float, ned_m: Ned, heading_rad: float) -> None:
        """The double reports that it is there. North is y, east is x; it started below the scene's start."""
        north, east, down = ned_m
        x, y, z = self._pad
        with self._pose.get_lock():
            self._pose[:] = [time_s, x + east, y + north, z - down, math.pi / 2 - heading_rad]

    def close(self) -> None:
        """Ends the process."""
        self._process.kill()
        self._process.join()


def _draw(pipe: Connection, pose: Any, scene: Scene, rules: FlightRules, port: int) -> None:
    from mintpilot.simulation.engine import load_mujoco
    from mintpilot.simulation.picture_server import PictureServer
    from mintpilot.simulation.quadrotor import DRONE, add_quadrotor
    from mintpilot.simulation.world import build_world, place_late_solids

    signal.signal(signal.SIGINT, signal.SIG_IGN)
    mujoco, spec = load_mujoco(), build_world(scene)
    add_quadrotor(spec, scene.start_m, rules=rules)
    model = spec.compile()
    data = mujoco.MjData(model)
    try:
        server = PictureServer(model, scene, "127.0.0.1", port)
    except OSError as error:
        pipe.send(error.strerror or str(error))
        return
    mujoco.mj_forward(model, data)
    server.draw(data)
    pipe.send(server.port)
    first = int(model.joint(DRONE).qposadr[0])
    while True:
        select.select([server.listener.fileno(), pipe.fileno()], [], [])
        if pipe.poll():  # the double has gone
            return
        with pose.get_lock():
            time_s, x, y, z, yaw = pose[:]
        data.time = time_s
        data.qpos[first : first + 7] = (x, y, max(z, rules.half_height_m), math.cos(yaw / 2), 0, 0, math.sin(yaw / 2))
        place_late_solids(model, data, scene, time_s)
        mujoco.mj_forward(model, data)
        server.serve_one(data)
