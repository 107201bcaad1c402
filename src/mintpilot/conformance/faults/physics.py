"""Physics and pictures: wind, rotors, a position that is wrong, a camera that is gone, frozen or wrong."""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from typing import Final

import numpy as np

from mintpilot.assembly.components import Choices, VehicleChoice
from mintpilot.assembly.talk import Talk
from mintpilot.assembly.worlds import World
from mintpilot.conformance.faults.drawing import Draw
from mintpilot.conformance.faults.faulty_source import FaultySource
from mintpilot.conformance.faults.faulty_vehicle import FaultyVehicle
from mintpilot.conformance.faults.kinds import Fault, FaultKind
from mintpilot.conformance.faults.ledger import Ledger
from mintpilot.conformance.faults.stage import Stage, people
from mintpilot.core.errors import DeviceError
from mintpilot.core.geometry import Vec3
from mintpilot.core.inputs import VehicleInput
from mintpilot.core.motion import Motion
from mintpilot.core.observation import Frame
from mintpilot.core.ports import Camera, Vehicle
from mintpilot.core.trajectory import VehicleState
from mintpilot.mission.components import MissionComponents
from mintpilot.mission.map_source import CameraMapSource
from mintpilot.simulation.mujoco_drone import Disturbance
from mintpilot.simulation.mujoco_vehicle import MujocoSimulator

GUST_S: Final = 0.05
"""The wind changes this often, seconds."""
MOST_WIND_N: Final = 2.0
"""Strongest wind, newtons: about a sixth of the weight. It swings by half of itself."""
WEAKEST: Final = 0.75
"""Least share of its thrust that a weak rotor gives. The frame can fly on with that."""
JUMP_M: Final = 0.12
"""Largest jump of the measured position, metres: what the clearance covers besides noise and gusts."""
SENSED: Final = (FaultKind.CAMERA_GONE, FaultKind.CAMERA_FROZEN, FaultKind.DEPTH_WRONG)
_BODY: Final = (FaultKind.WIND, FaultKind.MOTOR_LOST, FaultKind.MOTOR_WEAK, FaultKind.POSE_JUMPS)
HOLES, SPIKES = 0.6, 0.02
"""Largest shares of a picture that are lost, and that read what is not there."""


@contextmanager
def on_physics(draw: Draw, world: World, ledger: Ledger, talk: Talk) -> Iterator[Stage]:  # noqa: ARG001
    """The MuJoCo simulator with its rendered camera."""

    def beset(made: MissionComponents) -> MissionComponents:
        simulator, source = made.vehicle, made.map_source
        assert isinstance(simulator, MujocoSimulator)
        assert isinstance(source, CameraMapSource)
        source.camera = FaultyCamera(source.camera, draw, ledger)
        outside = replace(draw, faults=tuple(fault for fault in draw.faults if fault.kind not in (*SENSED, *_BODY)))
        flown = FaultyVehicle(
            DisturbedDrone(simulator, draw, ledger), outside, ledger, truth=lambda: simulator.position_m
        )
        return replace(made, vehicle=flown, map_source=FaultySource(source, outside, ledger))

    yield Stage(
        choices=Choices(vehicle=VehicleChoice.MUJOCO),
        operators=people(draw, world, ledger),
        beset=beset,
    )


class DisturbedDrone(Vehicle):
    """The simulated drone in wind, with rotors that fail, and with a position that jumps.

    Args:
        inner: the drone.
        draw: which faults come.
        ledger: is told from when on nothing could keep it in the air.
    """

    def __init__(self, inner: MujocoSimulator, draw: Draw, ledger: Ledger) -> None:
        self._inner, self._draw, self._ledger = inner, draw, ledger
        rng = np.random.default_rng([draw.number, 11])
        self._heading, self._rotor = float(rng.uniform(0, 2 * math.pi)), int(rng.integers(4))
        self._offset = rng.normal(size=3)
        self._rng = rng

    def state(self) -> VehicleState:
        """See `Vehicle.state`."""
        return self._inner.state()

    def command(self, motion: Motion) -> None:
        """See `Vehicle.command`."""
        self._inner.command(motion)

    def brake(self) -> None:
        """See `Vehicle.brake`."""
        self._inner.brake()

    def hold(self) -> None:
        """See `Vehicle.hold`."""
        self._inner.hold()

    def advance(self, until_s: float) -> tuple[VehicleInput, ...]:
        """Flies on in small steps, each with the disturbance of its moment."""
        while True:
            now_s = self._inner.state().time_s
            self._inner.disturbance = self._now(now_s)
            events = self._inner.advance(min(now_s + GUST_S, until_s))
            if events or self._inner.state().time_s >= until_s - 1e-9:
                return events

    def _now(self, now_s: float) -> Disturbance:
        wind, weak, lost, jump = (self._on(kind, now_s) for kind in (
            FaultKind.WIND, FaultKind.MOTOR_WEAK, FaultKind.MOTOR_LOST, FaultKind.POSE_JUMPS,
        ))  # fmt: skip
        rotors = [1.0] * 4
        if weak is not None:
            rotors[self._rotor] = 1.0 - (1.0 - WEAKEST) * weak.size
        if lost is not None:
            rotors[self._rotor] = 0.0
            self._ledger.beyond_s = min(self._ledger.beyond_s, now_s)
        blown: Vec3 = (0.0, 0.0, 0.0)
        if wind is not None:
            force = wind.size * MOST_WIND_N * (1.0 + 0.5 * math.sin(3.0 * now_s + self._heading))
            blown = (force * math.cos(self._heading), force * math.sin(self._heading), 0.2 * force)
        off: Vec3 = (0.0, 0.0, 0.0)
        if jump is not None:
            x, y, z = (float(v) for v in self._offset / np.linalg.norm(self._offset) * jump.size * JUMP_M)
            off = (x, y, z)
        a, b, c, d = rotors
        return Disturbance(wind_n=blown, rotors=(a, b, c, d), position_error_m=off)

    def _on(self, kind: FaultKind, now_s: float) -> Fault | None:
        fault = self._draw.first(kind)
        return fault if fault is not None and fault.is_on(now_s) else None


class FaultyCamera(Camera):
    """A camera that goes, whose picture stands still while the drone flies on, or whose depth is wrong.

    Wrong depth reads too near, what is not there, or nothing. Depth that reads too far is not among the faults.

    Args:
        inner: the true one.
        draw: which faults come.
        ledger: knows the time; is told when the camera is gone.
    """

    def __init__(self, inner: Camera, draw: Draw, ledger: Ledger) -> None:
        self._inner, self._draw, self._ledger = inner, draw, ledger
        self._rng = np.random.default_rng([draw.number, 13])
        self._last: Frame | None = None
        self._told: set[FaultKind] = set()

    def capture(self) -> Frame:
        """See `Camera.capture`."""
        if self._on(FaultKind.CAMERA_GONE) is not None:
            self._tell(FaultKind.CAMERA_GONE)
            raise DeviceError("the camera does not answer any more")
        frame = self._inner.capture()
        if self._on(FaultKind.CAMERA_FROZEN) is not None and self._last is not None:
            return replace(frame, rgb=self._last.rgb, depth_m=self._last.depth_m)
        wrong = self._on(FaultKind.DEPTH_WRONG)
        if wrong is not None:
            frame = self._wrong(frame, wrong)
        self._last = frame
        return frame

    def _wrong(self, frame: Frame, fault: Fault) -> Frame:
        depth, (height, width) = frame.depth_m.copy(), frame.depth_m.shape
        if fault.size < 0.3:
            depth *= 1.0 - fault.size  # everything reads too near
        elif fault.size < 0.9:
            depth[self._rng.random((height, width)) < HOLES * fault.size] = np.nan
            spikes = self._rng.random((height, width)) < SPIKES * fault.size
            depth[spikes] = np.minimum(depth[spikes], self._rng.uniform(0.3, 3.0, int(spikes.sum())))
        else:
            depth[:] = np.nan
        return replace(frame, depth_m=depth.astype(frame.depth_m.dtype))

    def _on(self, kind: FaultKind) -> Fault | None:
        fault = self._draw.first(kind)
        return fault if fault is not None and fault.is_on(self._ledger.now_s) else None

    def _tell(self, kind: FaultKind) -> None:
        if kind not in self._told:
            self._told.add(kind)
            self._ledger.tell(kind)
