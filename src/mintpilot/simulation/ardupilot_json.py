"""The MuJoCo world as physics back-end of ArduPilot's JSON interface, in lock-step over UDP.

ArduPilot sends servo outputs, we step the world once and send back what its sensors would measure: north-east-down,
body axes forward-right-down. The world frame here is east-north-up, the body forward-left-up.
"""

from __future__ import annotations

import json
import selectors
import socket
import struct
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from mintpilot.core.errors import DeviceError
from mintpilot.core.geometry import Floats
from mintpilot.simulation.control import GRAVITY_MPS2
from mintpilot.simulation.engine import load_mujoco
from mintpilot.simulation.picture_server import PictureServer
from mintpilot.simulation.quadrotor import DRONE, Airframe, add_quadrotor
from mintpilot.simulation.scene import FlightRules, Scene
from mintpilot.simulation.world import build_world, place_late_solids

MAGICS: Final = {18458: 16, 29569: 32}
"""First two bytes of a servo packet, and how many channels follow."""
HEAD: Final = struct.Struct("<HHI")
IDLE_US, SPAN_US = 1000.0, 1000.0
"""Servo output of a rotor at rest, and from there to full thrust, microseconds."""
CHANNELS: Final = (0, 3, 1, 2)
"""Channel of each rotor: ArduPilot counts front right, rear left, front left, rear right."""
RATES_HZ: Final = (50, 5000)
"""Steps a second that ArduPilot may ask for."""
NED_FROM_ENU: Final = np.array([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0]])
FRD_FROM_FLU: Final = np.array([1.0, -1.0, -1.0])


@dataclass(frozen=True, slots=True, kw_only=True)
class Servos:
    """One packet of ArduPilot."""

    rate_hz: int
    number: int
    """Counts the packets; a smaller one than before: ArduPilot has started again."""
    pulses_us: tuple[float, ...]


def read_servos(packet: bytes) -> Servos | None:
    """A servo packet; None where it is none."""
    if len(packet) < HEAD.size:
        return None
    magic, rate_hz, number = HEAD.unpack_from(packet)
    channels = MAGICS.get(magic, 0)
    if not channels or len(packet) < HEAD.size + 2 * channels or not RATES_HZ[0] <= rate_hz <= RATES_HZ[1]:
        return None
    pulses = struct.unpack_from(f"<{channels}H", packet, HEAD.size)
    return Servos(rate_hz=rate_hz, number=number, pulses_us=tuple(float(p) for p in pulses))


class ArdupilotWorld:
    """A scene with a quadrotor that stands on the ground below the scene's start.

    Args:
        scene: the world.
        rules: size of the hull.

    Raises:
        MissingPartError: MuJoCo is not installed.
    """

    def __init__(self, scene: Scene, rules: FlightRules) -> None:
        self._mujoco = load_mujoco()
        airframe = Airframe(spin=-1.0)
        ground_m = scene.volume.lo_m[2] + rules.half_height_m + 0.01
        self._home_m = (scene.start_m[0], scene.start_m[1], ground_m)
        spec = build_world(scene)
        add_quadrotor(spec, self._home_m, rules=rules, airframe=airframe)
        self.scene = scene
        self.model: Any = spec.compile()
        self.data: Any = self._mujoco.MjData(self.model)
        self._most_n = airframe.max_thrust_n
        joint = self.model.joint(DRONE)
        self._q, self._v = int(joint.qposadr[0]), int(joint.dofadr[0])
        self._body = int(self.model.body(DRONE).id)
        self.reset()

    @property
    def position_m(self) -> Floats:
        """Where the drone is (3,), world frame, metres."""
        place: Floats = self.data.qpos[self._q : self._q + 3].copy()
        return place

    def reset(self) -> None:
        """Back to the beginning, standing on the ground."""
        self._mujoco.mj_resetData(self.model, self.data)
        self._mujoco.mj_forward(self.model, self.data)

    def step(self, servos: Servos) -> None:
        """One step of that length, with those servo outputs."""
        throttle = np.clip((np.asarray(servos.pulses_us[:4]) - IDLE_US) / SPAN_US, 0.0, 1.0)
        self.model.opt.timestep = 1.0 / servos.rate_hz
        self.data.ctrl[:4] = self._most_n * throttle[list(CHANNELS)] ** 2
        place_late_solids(self.model, self.data, self.scene, float(self.data.time))
        self._mujoco.mj_step(self.model, self.data)

    def measured(self) -> dict[str, Any]:
        """What the sensors measure, as ArduPilot's JSON names it."""
        turned = self.data.xmat[self._body].reshape(3, 3)  # world from body
        linear = self.data.qacc[self._v : self._v + 3] + np.array([0.0, 0.0, GRAVITY_MPS2])
        attitude = np.zeros(4)
        self._mujoco.mju_mat2Quat(attitude, np.ascontiguousarray(NED_FROM_ENU @ (turned * FRD_FROM_FLU)).reshape(-1))
        moved = self.position_m - np.asarray(self._home_m)
        return {
            "timestamp": float(self.data.time),
            "imu": {
                "gyro": _rounded(self.data.qvel[self._v + 3 : self._v + 6] * FRD_FROM_FLU),
                "accel_body": _rounded((turned.T @ linear) * FRD_FROM_FLU),
            },
            "position": _rounded(NED_FROM_ENU @ moved),
            "quaternion": _rounded(attitude),
            "velocity": _rounded(NED_FROM_ENU @ self.data.qvel[self._v : self._v + 3]),
        }


class ArdupilotServer:
    """Answers ArduPilot's servo packets, and pictures on request. One thread owns the world and the drawing.

    Args:
        world: is stepped.
        host: address to listen at.
        port: of servo packets; 0: any free one.
        camera_port: of pictures, TCP; 0: any free one; None: no camera.

    Raises:
        DeviceError: a port cannot be used.
    """

    def __init__(
        self, world: ArdupilotWorld, *, host: str = "127.0.0.1", port: int = 9002, camera_port: int | None = None
    ) -> None:
        self._world = world
        self._last: int | None = None
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        try:
            self._socket.bind((host, port))
            self.port = int(self._socket.getsockname()[1])
            self._pictures = None if camera_port is None else PictureServer(world.model, world.scene, host, camera_port)
        except OSError as error:
            self._socket.close()
            raise DeviceError(
                f"cannot listen at {host}, port {port} or {camera_port}: {error.strerror}; choose another port"
            ) from error
        self._socket.setblocking(False)
        self._selector = selectors.DefaultSelector()
        self._selector.register(self._socket, selectors.EVENT_READ)
        if self._pictures is not None:
            self._selector.register(self._pictures.listener, selectors.EVENT_READ)

    @property
    def camera_port(self) -> int | None:
        """Port of pictures; None: no camera."""
        return None if self._pictures is None else self._pictures.port

    def serve(self, *, until: Callable[[], bool], wait_s: float = 0.2) -> int:
        """Serves until told to stop; the number of steps made.

        Args:
            until: asked after every packet, and every ``wait_s`` seconds without one.
            wait_s: longest time that nothing is done, seconds.
        """
        steps = 0
        try:
            while not until():
                for key, _ in self._selector.select(wait_s):
                    if key.fileobj is self._socket:
                        steps += self._answer()
                    elif self._pictures is not None:
                        self._pictures.serve_one(self._world.data)
        finally:
            if self._pictures is not None:
                self._pictures.stop_drawing()
        return steps

    def close(self) -> None:
        """Frees the ports. Safe to call again."""
        self._selector.close()
        self._socket.close()
        if self._pictures is not None:
            self._pictures.close()

    def _answer(self) -> int:
        packet, sender = self._socket.recvfrom(2048)
        servos = read_servos(packet)
        if servos is None:
            return 0
        if self._last is not None and servos.number < self._last:
            self._world.reset()
        is_new = servos.number != self._last
        if is_new:
            self._world.step(servos)
        self._last = servos.number
        text = json.dumps(self._world.measured(), separators=(",", ":"))  # ArduPilot reads no spaces
        self._socket.sendto(f"\n{text}\n".encode(), sender)
        return int(is_new)


def _rounded(values: Floats) -> list[float]:
    return [round(float(value), 7) for value in values]
