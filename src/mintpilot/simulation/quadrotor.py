"""The drone: a body with four rotors, a collision hull and two cameras, added to a MuJoCo world."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from mintpilot.core.geometry import Floats, Vec3
from mintpilot.simulation.engine import load_mujoco
from mintpilot.simulation.scene import FlightRules

DRONE = "drone"
"""Name of the body; ``drone:hull`` is what collides."""
HULL = f"{DRONE}:hull"
_HIDDEN_GROUP = 4
_GREY, _ORANGE = (0.05, 0.05, 0.06, 1.0), (0.95, 0.42, 0.05, 1.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class Airframe:
    """Masses, lengths and rotors."""

    mass_kg: float = 1.3
    inertia_kgm2: Vec3 = (0.0123, 0.0123, 0.0224)
    """About the body's x, y and z axes."""
    arm_m: float = 0.17
    """From the centre to each rotor."""
    drag_torque_m: float = 0.016
    """Torque of a rotor about its axis per newton of thrust."""
    max_thrust_n: float = 8.0
    """Of one rotor."""
    motor_lag_s: float = 0.02
    """First-order lag of the thrust."""
    spin: float = 1.0
    """Sense of the front right rotor: 1 turns the body left, -1 right (ArduPilot's X frame)."""
    camera_fovy_deg: float = 58.0
    camera_pitch_rad: float = 0.26
    """How far the camera looks down."""

    @property
    def rotors(self) -> tuple[tuple[float, float, float], ...]:
        """For each rotor: x and y in arm lengths' components, metres, and the sign of its drag torque."""
        r = self.arm_m * math.sqrt(0.5)
        s = self.spin
        return ((r, -r, s), (-r, -r, -s), (-r, r, s), (r, r, -s))

    @property
    def mixer(self) -> Floats:
        """(4, 4): thrusts of the rotors, newtons, from (thrust, torques about x, y, z)."""
        wrench = np.array([(1.0, y, -x, sign * self.drag_torque_m) for x, y, sign in self.rotors]).T
        return np.asarray(np.linalg.inv(wrench))


def add_quadrotor(spec: Any, start_m: Vec3, *, rules: FlightRules, airframe: Airframe | None = None) -> None:
    """Adds the drone, hovering level at ``start_m``, to a ``mujoco.MjSpec``.

    Body ``drone`` with free joint ``drone``; actuators ``rotor:0`` to ``rotor:3`` (thrust in newtons, with lag);
    cameras ``rgbd`` (forward and slightly down) and ``chase`` (from behind). The hull ``drone:hull``, a cylinder as
    the rules say, is all of it that collides, and is not drawn.
    """
    mujoco = load_mujoco()
    frame = airframe or Airframe()
    geom, camera = mujoco.mjtGeom, spec.worldbody
    body = camera.add_body(name=DRONE, pos=list(start_m))
    body.add_freejoint(name=DRONE)
    body.explicitinertial = True
    body.mass, body.inertia = frame.mass_kg, list(frame.inertia_kgm2)
    body.ipos, body.iquat = [0, 0, 0], [1, 0, 0, 0]
    size = [rules.radius_m, rules.half_height_m, 0]
    body.add_geom(name=HULL, type=geom.mjGEOM_CYLINDER, size=size, mass=0, group=_HIDDEN_GROUP)
    _add_looks(body, geom, frame)
    for i, (x, y, sign) in enumerate(frame.rotors):
        body.add_site(name=f"rotor:{i}", pos=[x, y, 0.02], size=[0.01] * 3, group=_HIDDEN_GROUP)
        rotor = spec.add_actuator(
            name=f"rotor:{i}",
            trntype=mujoco.mjtTrn.mjTRN_SITE,
            target=f"rotor:{i}",
            gear=[0, 0, 1, 0, 0, sign * frame.drag_torque_m],
            ctrllimited=True,
            ctrlrange=[0, frame.max_thrust_n],
        )
        rotor.dyntype = mujoco.mjtDyn.mjDYN_FILTEREXACT
        rotor.dynprm[0] = frame.motor_lag_s
    s, c = math.sin(frame.camera_pitch_rad), math.cos(frame.camera_pitch_rad)
    body.add_camera(name="rgbd", pos=[0.16, 0, -0.02], xyaxes=[0, -1, 0, s, 0, c], fovy=frame.camera_fovy_deg)
    body.add_camera(
        name="chase",
        pos=[-1.4, 0, 0.6],
        xyaxes=[0, -1, 0, 0.35, 0, 1],
        fovy=65,
        mode=mujoco.mjtCamLight.mjCAMLIGHT_TRACK,
    )


def _add_looks(body: Any, geom: Any, frame: Airframe) -> None:
    """What is drawn: hull, battery, arms and rotor discs. None of it collides or weighs."""
    plain = {"mass": 0, "contype": 0, "conaffinity": 0, "group": 1}
    body.add_geom(type=geom.mjGEOM_BOX, size=[0.09, 0.06, 0.03], rgba=_GREY, **plain)
    body.add_geom(type=geom.mjGEOM_BOX, pos=[0, 0, 0.045], size=[0.06, 0.03, 0.015], rgba=_ORANGE, **plain)
    for x, y, _ in frame.rotors:
        body.add_geom(
            type=geom.mjGEOM_CAPSULE, fromto=[0, 0, 0.01, x, y, 0.02], size=[0.012, 0, 0], rgba=_GREY, **plain
        )
        disc = (0.2, 0.2, 0.2, 0.35)
        body.add_geom(type=geom.mjGEOM_CYLINDER, pos=[x, y, 0.035], size=[0.085, 0.002, 0], rgba=disc, **plain)
