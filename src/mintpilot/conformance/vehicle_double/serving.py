"""The double as a process: one UDP socket, one loop."""

from __future__ import annotations

import multiprocessing
import os
import select
import signal
import socket
import struct
import time
from contextlib import suppress
from dataclasses import dataclass, field
from multiprocessing.connection import Connection
from types import TracebackType
from typing import Any, Self

from mintpilot.conformance.vehicle_double.autopilot import DoubleAutopilot
from mintpilot.conformance.vehicle_double.body import Ned
from mintpilot.conformance.vehicle_double.camera import DoubleCamera
from mintpilot.conformance.vehicle_double.faults import Fault, TimedFault, Wire
from mintpilot.conformance.vehicle_double.hearing import Hearer
from mintpilot.conformance.vehicle_double.parameters import Flavour
from mintpilot.conformance.vehicle_double.place import Place
from mintpilot.conformance.vehicle_double.speaking import Speaker
from mintpilot.core.errors import MissingPartError
from mintpilot.simulation.scene import FlightRules, Scene

STEP_S = 0.01
READY_S = 60.0
CLOSING_S = 3.0
SO_TIMESTAMPNS = 35
"""Linux: the kernel tells when each packet arrived."""
STAMP = struct.Struct("@ll")
ANCILLARY = socket.CMSG_SPACE(STAMP.size)
SET_POINT = bytes([84, 0, 0])
"""Id of SET_POSITION_TARGET_LOCAL_NED, where a MAVLink 2 packet has it."""
GIMBAL = 154
"""Component id of its gimbal, which sends heartbeats of its own: they say nothing of the autopilot."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class DoubleSetup:
    """What a double is started with."""

    flavour: Flavour
    port: int
    """Where it sends to, on this machine."""
    faults: tuple[TimedFault, ...] = ()
    scene: Scene | None = None
    """The world that it flies in; it stands below the scene's start. None: nothing is there."""
    rules: FlightRules | None = None
    endurance_s: float = 1200.0
    seed: int = 0
    camera_port: int | None = None
    """Where pictures of the scene are had, as the frame source ``sim://127.0.0.1:PORT``; 0: any; None: no camera."""


@dataclass(frozen=True, slots=True, kw_only=True)
class DoubleState:
    """How the double is, for tests and benches."""

    time_s: float
    ned_m: Ned
    velocity: Ned
    mode: str
    armed: bool
    airborne: bool
    gripper: str
    set_points_s: tuple[float, ...]
    """When set-points arrived at its socket."""
    parameters: dict[str, float]
    fence_corners: int
    mission_commands: tuple[int, ...]
    """Of the mission that was uploaded."""
    verdict: str
    """What it flew into or out of; empty: nothing."""
    camera_port: int | None = None
    rates_hz: dict[int, float] = field(default_factory=dict)
    """Message id → how often it is sent."""


class DoubleLoop:
    """One double over one socket.

    Raises:
        MissingPartError: pymavlink is not installed.
    """

    def __init__(self, setup: DoubleSetup) -> None:
        self._m = _dialect()
        self._setup = setup
        self.autopilot = DoubleAutopilot(setup.flavour, endurance_s=setup.endurance_s)
        self._speaker = Speaker(self.autopilot, self._m)
        self._hearer = Hearer(self.autopilot, self._speaker, self._m, self._send)
        self._mav = self._m.MAVLink(None, srcSystem=1, srcComponent=1)
        self._mav.robust_parsing = True
        self._gimbal, self._gimbal_s = self._m.MAVLink(None, srcSystem=1, srcComponent=GIMBAL), 0.0
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.setblocking(False)
        with suppress(OSError):
            self._socket.setsockopt(socket.SOL_SOCKET, SO_TIMESTAMPNS, 1)
        self._set_points_s: list[float] = []
        self._out, self._in = Wire(setup.seed), Wire(setup.seed + 1)
        self._begun_s = time.monotonic()
        self._place = Place(setup.scene, setup.rules) if setup.scene is not None else None
        self._waiting = list(setup.faults)
        self._camera: DoubleCamera | None = None
        if setup.camera_port is not None and setup.scene is not None:
            self._camera = DoubleCamera(setup.scene, setup.rules, setup.camera_port)
            self._begun_s = time.monotonic()

    @property
    def camera_port(self) -> int | None:
        """Port of pictures; None: it has no camera."""
        return None if self._camera is None else self._camera.port

    def turn(self) -> None:
        """One step: hear, move, speak."""
        select.select([self._socket], [], [], STEP_S / 2)
        now_s = time.monotonic() - self._begun_s
        for fault in [f for f in self._waiting if f.at_s <= now_s]:
            self._waiting.remove(fault)
            self.autopilot.switch_on(fault.fault)
        self._receive(now_s)
        self.autopilot.step(now_s)
        if self._place is not None:
            self._place.move(now_s, self.autopilot.body)
        if self._camera is not None:
            self._camera.move(now_s, self.autopilot.reported_ned(), self.autopilot.body.heading_rad)
        self._hearer.due(now_s)
        for message in self._speaker.due(now_s):
            self._send(message)
        if now_s >= self._gimbal_s:
            self._gimbal_s = now_s + 1.0
            m = self._m
            beat = m.MAVLink_heartbeat_message(m.MAV_TYPE_GIMBAL, m.MAV_AUTOPILOT_INVALID, 0, 0, m.MAV_STATE_ACTIVE, 3)
            self._send(beat, self._gimbal)
        for packet in self._out.due(now_s):
            with suppress(OSError):
                self._socket.sendto(packet, ("127.0.0.1", self._setup.port))

    def state(self) -> DoubleState:
        """How it is now."""
        a = self.autopilot
        return DoubleState(
            time_s=time.monotonic() - self._begun_s,
            ned_m=a.body.ned_m,
            velocity=a.body.velocity,
            mode=a.mode.value,
            armed=a.armed,
            airborne=a.airborne,
            gripper=a.gripper,
            set_points_s=tuple(self._set_points_s),
            parameters=dict(a.parameters.values),
            fence_corners=self._hearer.fence_corners,
            mission_commands=self._hearer.mission_commands,
            verdict=self._place.verdict if self._place is not None else "",
            camera_port=self.camera_port,
            rates_hz=dict(self._speaker.rates_hz),
        )

    def close(self) -> None:
        """Ends it."""
        self._socket.close()
        if self._camera is not None:
            self._camera.close()

    def _receive(self, now_s: float) -> None:
        while True:
            try:
                packet, told, _, _ = self._socket.recvmsg(2048, ANCILLARY)
            except OSError:  # nothing more, or nobody listens yet
                break
            if packet[7:10] == SET_POINT and Fault.SILENCE not in self.autopilot.faults:
                self._set_points_s.append(now_s - _waited_s(told))
            self._in.put(packet, now_s, self.autopilot.faults)
        for packet in self._in.due(now_s):
            if Fault.SILENCE in self.autopilot.faults:
                continue
            for message in self._mav.parse_buffer(packet) or []:
                if message.get_type() != "BAD_DATA":
                    self._hearer.hear(message, now_s)

    def _send(self, message: Any, who: Any | None = None) -> None:
        mav = who or self._mav
        packet = message.pack(mav)
        mav.seq = (mav.seq + 1) % 256
        if Fault.SILENCE not in self.autopilot.faults:
            self._out.put(packet, time.monotonic() - self._begun_s, self.autopilot.faults)


class VehicleDouble:
    """A double in a process of its own; a context that ends it.

    Args:
        setup: what it is started with.
    """

    def __init__(self, setup: DoubleSetup) -> None:
        context = multiprocessing.get_context("spawn")
        self._pipe, theirs = context.Pipe()
        self._process = context.Process(target=_serve, args=(theirs, setup), name="vehicle-double")
        self._process.start()
        theirs.close()
        if not self._pipe.poll(READY_S):
            raise TimeoutError("the vehicle double did not start")
        self._pipe.recv()

    def state(self) -> DoubleState:
        """How it is now."""
        self._pipe.send(None)
        found: DoubleState = self._pipe.recv()
        return found

    def switch_on(self, fault: Fault) -> None:
        """A fault begins now."""
        self._pipe.send(fault)

    def close(self) -> None:
        """Ends the process."""
        self._pipe.close()
        self._process.join(CLOSING_S)
        self._process.kill()
        self._process.join()
        self._process.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()


def free_port() -> int:
    """A UDP port of this machine that nobody uses at the moment."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


def _serve(pipe: Connection, setup: DoubleSetup) -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    with suppress(OSError):  # an autopilot has a processor of its own
        os.nice(-10)
    loop = DoubleLoop(setup)
    pipe.send(None)
    try:
        while True:
            loop.turn()
            while pipe.poll():
                wanted: Fault | None = pipe.recv()
                if wanted is None:
                    pipe.send(loop.state())
                else:
                    loop.autopilot.switch_on(wanted)
    except (EOFError, OSError):
        return
    finally:
        loop.close()


def _waited_s(told: list[tuple[int, int, bytes]]) -> float:
    """How long ago a packet arrived at the socket, as the kernel tells: this process may have been late to read it."""
    for level, kind, data in told:
        if level == socket.SOL_SOCKET and kind == SO_TIMESTAMPNS and len(data) == STAMP.size:
            seconds, nanoseconds = STAMP.unpack(data)
            return max(time.time() - float(seconds) - 1e-9 * float(nanoseconds), 0.0)
    return 0.0


def _dialect() -> Any:
    try:
        from pymavlink.dialects.v20 import ardupilotmega
    except ImportError:
        raise MissingPartError("the vehicle double needs pymavlink: pip install 'mintpilot[vehicle]'") from None
    return ardupilotmega
