"""Geometric tracking control on SE(3) (Lee, Leok and McClamroch 2010) with an integral term, compiled."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mintpilot.core.compiled import compiled
from mintpilot.core.geometry import Floats
from mintpilot.simulation.quadrotor import Airframe

GRAVITY_MPS2 = 9.81


@dataclass(frozen=True, slots=True, kw_only=True)
class Gains:
    """Gains per unit of mass or inertia: the closed loop does not change with the airframe."""

    position: float = 16.0
    """1/s²."""
    velocity: float = 6.5
    """1/s."""
    integral: float = 10.0
    """1/s³; takes out steady wind and wrong mass."""
    integral_limit_mps2: float = 1.5
    """Most that the integral term may command."""
    attitude: tuple[float, float, float] = (250.0, 250.0, 60.0)
    """1/s², about x, y, z."""
    rate: tuple[float, float, float] = (22.0, 22.0, 9.0)
    """1/s, about x, y, z."""


class Controller:
    """Commands the rotors from a measured state and a reference, at a fixed rate. Holds the integral.

    Args:
        airframe: what it flies.
        step_s: time between calls; at most 5 ms.
        gains: of the loops.
    """

    def __init__(self, airframe: Airframe, step_s: float, gains: Gains | None = None) -> None:
        g = gains or Gains()
        self._gains = np.array([g.position, g.velocity, g.integral, g.integral_limit_mps2, *g.attitude, *g.rate])
        self._mass = airframe.mass_kg
        self._inertia = np.asarray(airframe.inertia_kgm2, float)
        self._mixer = airframe.mixer
        self._most = airframe.max_thrust_n
        self._step_s = step_s
        self._integral = np.zeros(3)
        self._thrust = np.zeros(4)

    def thrusts(
        self,
        position_m: Floats,
        quaternion: Floats,
        velocity_mps: Floats,
        rate_rad_s: Floats,
        reference: Floats,
    ) -> Floats:
        """Thrusts of the four rotors, newtons; the same array each time.

        Args:
            position_m: (3,) measured, world.
            quaternion: (4,) attitude, w first, world from body.
            velocity_mps: (3,) measured, world.
            rate_rad_s: (3,) angular rate, body.
            reference: (10,) wanted position, velocity, acceleration and yaw.
        """
        _control(
            position_m,
            quaternion,
            velocity_mps,
            rate_rad_s,
            reference,
            self._gains,
            self._mass,
            self._inertia,
            self._mixer,
            self._most,
            self._step_s,
            self._integral,
            self._thrust,
        )
        return self._thrust


def slewed(yaw_rad: Floats, start_rad: float, most_rad: float) -> Floats:
    """Headings (n,) approached from the present one by at most ``most_rad`` a step, the short way round."""
    return np.asarray(_slewed(np.asarray(yaw_rad, float), start_rad, most_rad))


@compiled()
def _slewed(yaw: Floats, start: float, most: float) -> Floats:
    out = np.empty(len(yaw))
    now = start
    for i in range(len(yaw)):
        gap = (yaw[i] - now + np.pi) % (2 * np.pi) - np.pi
        now += min(max(gap, -most), most)
        out[i] = now
    return out


@compiled()
def _control(
    p: Floats,
    q: Floats,
    v: Floats,
    w: Floats,
    ref: Floats,
    gains: Floats,
    mass: float,
    inertia: Floats,
    mixer: Floats,
    most: float,
    step: float,
    integral: Floats,
    out: Floats,
) -> None:
    # Wanted force: errors of place and speed, their integral, the reference's acceleration, weight.
    force = np.empty(3)
    for i in range(3):
        error = ref[i] - p[i]
        bound = gains[3] / gains[2] if gains[2] > 0 else 0.0
        integral[i] = min(max(integral[i] + error * step, -bound), bound)
        wanted = gains[0] * error + gains[1] * (ref[3 + i] - v[i]) + gains[2] * integral[i] + ref[6 + i]
        force[i] = mass * (wanted + (GRAVITY_MPS2 if i == 2 else 0.0))
    a, x, y, z = q
    now = np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * a), 2 * (x * z + y * a)],
            [2 * (x * y + z * a), 1 - 2 * (x * x + z * z), 2 * (y * z - x * a)],
            [2 * (x * z - y * a), 2 * (y * z + x * a), 1 - 2 * (x * x + y * y)],
        ]
    )
    lift = max(force[0] * now[0, 2] + force[1] * now[1, 2] + force[2] * now[2, 2], 0.0)
    # Wanted attitude: thrust axis along the force, nose along the heading.
    up = force / max(np.sqrt((force * force).sum()), 1e-6)
    nose = np.array([np.cos(ref[9]), np.sin(ref[9]), 0.0])
    left = np.cross(up, nose)
    left /= max(np.sqrt((left * left).sum()), 1e-6)
    goal = np.empty((3, 3))
    goal[:, 0], goal[:, 1], goal[:, 2] = np.cross(left, up), left, up
    twist = goal.T @ now
    off = 0.5 * np.array([twist[2, 1] - twist[1, 2], twist[0, 2] - twist[2, 0], twist[1, 0] - twist[0, 1]])
    gyro = np.cross(w, inertia * w)
    wrench = np.empty(4)
    wrench[0] = lift
    for i in range(3):
        wrench[1 + i] = inertia[i] * (-gains[4 + i] * off[i] - gains[7 + i] * w[i]) + gyro[i]
    for i in range(4):
        out[i] = min(max((mixer[i] * wrench).sum(), 0.0), most)
