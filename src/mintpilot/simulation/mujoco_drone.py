"""The drone's own part of a MuJoCo world: its state, its rotors under control, gusts, and what it touches."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from mintpilot.core.geometry import Floats, Vec3
from mintpilot.simulation.control import GRAVITY_MPS2, Controller
from mintpilot.simulation.engine import load_mujoco
from mintpilot.simulation.quadrotor import DRONE, HULL, Airframe


@dataclass(frozen=True, slots=True, kw_only=True)
class Disturbance:
    """What goes wrong with a simulated drone beyond its usual noise and gusts, for trials of faults."""

    wind_n: Vec3 = (0.0, 0.0, 0.0)
    """Force of a wind that does not change, newtons."""
    rotors: tuple[float, float, float, float] = (1.0, 1.0, 1.0, 1.0)
    """Share of the commanded thrust that each rotor gives."""
    position_error_m: Vec3 = (0.0, 0.0, 0.0)
    """How far off it measures itself to be: its control, its reports and its pictures alike."""


class MujocoDrone:
    """Steps a compiled world that holds a drone, with the rotors under control.

    Args:
        model: the compiled world with the drone of `add_quadrotor`.
        airframe: what was added.

    Raises:
        MissingPartError: MuJoCo is not installed.
    """

    def __init__(self, model: Any, airframe: Airframe) -> None:
        self._mujoco = load_mujoco()
        self.model, self.data = model, self._mujoco.MjData(model)
        self.step_s = float(model.opt.timestep)
        self._controller = Controller(airframe, self.step_s)
        joint, data = model.joint(DRONE), self.data
        q, v = int(joint.qposadr[0]), int(joint.dofadr[0])
        # Views: they follow the state.
        self.position_m: Floats = data.qpos[q : q + 3]
        self._quaternion: Floats = data.qpos[q + 3 : q + 7]
        self.velocity_mps: Floats = data.qvel[v : v + 3]
        self._rate: Floats = data.qvel[v + 3 : v + 6]
        self._force: Floats = data.xfrc_applied[model.body(DRONE).id, :3]
        self.rotors: Floats = np.ones(4)
        """Share of the commanded thrust that each rotor gives."""
        self._hull = int(model.geom(HULL).id)
        data.act[:] = data.ctrl[:] = airframe.mass_kg * GRAVITY_MPS2 / 4
        self.refresh()

    @property
    def time_s(self) -> float:
        """Seconds since the world began."""
        return float(self.data.time)

    @property
    def yaw_rad(self) -> float:
        """Heading, from -pi to pi."""
        w, x, y, z = self._quaternion
        return math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))

    def refresh(self) -> None:
        """Brings places of bodies and cameras up to the state; call before drawing."""
        self._mujoco.mj_forward(self.model, self.data)

    def step(self, reference: Floats, noise: Floats, gust_n: Floats) -> str:
        """One step of control and physics.

        Args:
            reference: (10,) wanted position, velocity, acceleration and heading.
            noise: (6,) errors of the measured position and velocity.
            gust_n: (3,) force of the wind.

        Returns:
            What the drone touches after it, in words; empty: nothing.
        """
        data = self.data
        data.ctrl[:] = self._controller.thrusts(
            self.position_m + noise[:3], self._quaternion, self.velocity_mps + noise[3:], self._rate, reference
        )
        data.ctrl[:] *= self.rotors
        self._force[:] = gust_n
        self._mujoco.mj_step(self.model, data)
        return self._touched() if data.ncon else ""

    def _touched(self) -> str:
        for first, second in self.data.contact.geom[: self.data.ncon]:
            if self._hull in (first, second):
                other = int(second if first == self._hull else first)
                parts = str(self.model.geom(other).name).split(":")
                return f"'{parts[1]}'" if len(parts) > 2 else "the building"
        return ""


class Gusts:
    """Wind as coloured noise: gusts of a second or so, with no mean.

    Args:
        deviation_n: standard deviation of each component, newtons.
        step_s: time between samples.
        rng: draws it.
    """

    _LENGTH_S = 1.0

    def __init__(self, deviation_n: float, step_s: float, rng: np.random.Generator) -> None:
        self._keep = math.exp(-step_s / self._LENGTH_S)
        self._kick_n = deviation_n * math.sqrt(1 - self._keep**2)
        self._rng = rng
        self._last = rng.normal(0.0, deviation_n, 3)

    def draw(self, n: int) -> Floats:
        """The next n samples (n, 3), newtons, going on from the last ones."""
        from scipy.signal import lfilter  # a second of start-up: only who flies with physics pays for it

        kicks = self._rng.normal(0.0, self._kick_n, (n, 3))
        memory = self._keep * self._last[None]
        gusts: Floats = lfilter([1.0], [1.0, -self._keep], kicks, axis=0, zi=memory)[0]
        self._last = gusts[-1].copy()
        return gusts
