"""A drone flown by physics: four rotors, a controller at 250 Hz, gusts, noise, contacts, an RGB-D camera."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from mintpilot.core.errors import DeviceError
from mintpilot.core.geometry import Floats, Vec3
from mintpilot.core.inputs import MotionEnded
from mintpilot.core.mission import Verdict
from mintpilot.core.motion import FollowTrajectory, Land, Motion, MotionEnd, PerformAction, TakeOff
from mintpilot.core.observation import Frame
from mintpilot.core.ports import Camera, Judge, Vehicle
from mintpilot.core.trajectory import FlightEnd, FlightLog, VehicleState
from mintpilot.simulation.control import slewed
from mintpilot.simulation.judge import SceneJudge
from mintpilot.simulation.mujoco_drone import Disturbance, Gusts, MujocoDrone
from mintpilot.simulation.quadrotor import Airframe, add_quadrotor
from mintpilot.simulation.reference import Reference, as_vec3, braked, check_start, descent, hover, sampled, time_steps
from mintpilot.simulation.render import SceneRenderer
from mintpilot.simulation.scene import FlightRules, Scene
from mintpilot.simulation.world import build_world, place_late_solids

_JUDGED_EVERY, _LOGGED_EVERY = 10, 5  # steps
_SETTLE_S, _SETTLE_STEP_S, _SETTLED_M, _SETTLED_MPS = 2.0, 0.1, 0.06, 0.1
_YAW_RATE_RAD_S = 2.0
_ROUNDING = 1e-6  # steps


class MujocoSimulator(Vehicle, Camera, Judge):
    """Flies in simulated time with physics, much faster than real time. Close it, or use it in a ``with``.

    Any contact of the drone, with the floor too, is a collision and ends the mission. It starts hovering at the scene's
    start, heading along x. Positions it reports carry noise; flight logs hold the true ones. Drawing belongs to the
    thread that takes the first picture.

    Args:
        scene: the world.
        rules: what ends a flight, noise and gusts.
        seed: of noise and gusts: the same seed and calls give the same flight.
        spec: an editable world (``mujoco.MjSpec``) of the same scene without a drone; None: built from the scene.
        camera_size: width and height of the pictures, pixels.

    Attributes:
        disturbance: what goes wrong with it from now on; whoever tries faults out sets it.

    Raises:
        MissingPartError: MuJoCo is not installed.
    """

    def __init__(
        self,
        scene: Scene,
        rules: FlightRules,
        *,
        seed: int,
        spec: Any = None,
        camera_size: tuple[int, int] = (320, 240),
    ) -> None:
        world = build_world(scene) if spec is None else spec
        airframe = Airframe()
        add_quadrotor(world, scene.start_m, rules=rules, airframe=airframe)
        self._drone = MujocoDrone(world.compile(), airframe)
        self._scene, self._rules, self._seed, self._camera_size = scene, rules, seed, camera_size
        self._judge = SceneJudge(scene, rules)
        self._flown: _Flown | None = None
        self._refused: MotionEnded | None = None
        self._rng, self._state_rng, gust_rng = (np.random.default_rng([seed, stream]) for stream in range(3))
        self._gusts = Gusts(rules.wind_n, self._drone.step_s, gust_rng)
        self.disturbance = Disturbance()
        self._goal_m: Floats = np.asarray(scene.start_m, float)
        self._late = any(s.appears_s > 0 for s in scene.solids)
        self._renderer: SceneRenderer | None = None
        self._closed = False
        self._bring_late_solids()

    def begin_mission(self) -> None:
        """The survey is over: the mission's clock starts, with a fresh battery. Call it without a survey, too."""
        self._judge.begin_mission(self._drone.time_s)

    @property
    def position_m(self) -> Vec3:
        """Where it truly is."""
        return as_vec3(self._drone.position_m)

    def state(self) -> VehicleState:
        """Where it measures itself to be."""
        drone = self._drone
        noise = self._state_rng.normal(0.0, self._rules.position_noise_m, 3)
        return VehicleState(
            time_s=drone.time_s,
            position_m=as_vec3(drone.position_m + noise + self.disturbance.position_error_m),
            velocity_mps=as_vec3(drone.velocity_mps),
            yaw_rad=drone.yaw_rad,
            endurance_left_s=self._judge.endurance_left_s(drone.time_s),
        )

    def command(self, motion: Motion) -> None:
        """Begins a motion.

        Raises:
            InputError: a trajectory is empty, malformed or not finite.
            DeviceError: the simulator is closed.
        """
        self._check_open()
        drone, step_s = self._drone, self._drone.step_s
        log = _Log()
        match motion:
            case FollowTrajectory(trajectory=trajectory):
                try:
                    check_start(trajectory, as_vec3(drone.position_m + self.disturbance.position_error_m))
                except DeviceError as error:
                    self._refused = self._ended(motion, MotionEnd.REFUSED, reason=str(error))
                    return
                way = sampled(trajectory, time_steps(trajectory.duration_s, step_s)[1:])
                log.add(drone.time_s, drone.position_m, trajectory.position_m[0])
            case PerformAction():
                way = hover(self._goal_m, drone.yaw_rad, time_steps(motion.dwell_s, step_s)[1:])
            case Land():
                way = descent(self._goal_m, drone.yaw_rad, self._scene.volume.lo_m[2], step_s)
            case TakeOff():
                way = hover(self._goal_m, drone.yaw_rad, np.zeros(0))
        self._flown = _Flown(motion=motion, way=way, rows=self._rows(way), log=log)

    def brake(self) -> None:
        """Brakes along the trajectory; an act is broken off, a descent stops where it is."""
        flown = self._flown
        if flown is None or flown.braked:
            return
        step_s, at = self._drone.step_s, max(flown.row - 1, 0)
        if isinstance(flown.motion, FollowTrajectory):
            flown.way = braked(flown.motion.trajectory, float(flown.way.time_s[at]), step_s)
        else:
            flown.way = hover(self._goal_m, self._drone.yaw_rad, np.zeros(0))
        flown.rows, flown.row, flown.braked, flown.settling_s = self._rows(flown.way), 0, True, 0.0

    def advance(self, until_s: float) -> tuple[MotionEnded, ...]:
        """Steps the physics on; see `Vehicle.advance`."""
        self._check_open()
        if self._refused is not None:
            refused, self._refused = self._refused, None
            return (refused,)
        flown, step_s = self._flown, self._drone.step_s
        left = math.ceil((until_s - self._drone.time_s) / step_s - _ROUNDING)
        left = max(left, int(until_s > self._drone.time_s))  # never stand still for want of a whole step
        if flown is None:
            self._hover(left, self._drone.yaw_rad, _Log())
            return ()
        while left > 0 or (flown.row >= len(flown.rows) and self._is_over(flown)):
            if self.verdict() is not None or (flown.row >= len(flown.rows) and self._is_over(flown)):
                self._flown = None
                return (self._finished(flown),)
            if flown.row < len(flown.rows):
                n = min(left, len(flown.rows) - flown.row)
                self._fly(flown.rows[flown.row : flown.row + n], flown.log)
                flown.row += n
            else:
                n = min(left, round(_SETTLE_STEP_S / step_s))
                self._hover(n, float(flown.rows[-1, 9]) if len(flown.rows) else self._drone.yaw_rad, flown.log)
                flown.settling_s += n * step_s
            left -= n
        return ()

    def hold(self) -> None:
        """Comes to rest where it should be; does nothing after a failure."""
        self._flown = None
        settling_s, yaw_rad = 0.0, self._drone.yaw_rad
        while not self._closed and self.verdict() is None and settling_s < _SETTLE_S and not self._is_calm():
            self._hover(round(_SETTLE_STEP_S / self._drone.step_s), yaw_rad, _Log())
            settling_s += _SETTLE_STEP_S

    def capture(self) -> Frame:
        """What the drone's camera sees now; the camera's place is known as well as the drone's.

        Raises:
            DeviceError: the simulator is closed.
        """
        frame: Frame = self._drawn(lambda renderer, data, time_s: renderer.capture(data, time_s))
        pose = frame.world_from_camera.copy()
        pose[:3, 3] += self._state_rng.normal(0.0, self._rules.position_noise_m, 3)
        pose[:3, 3] += self.disturbance.position_error_m
        return replace(frame, world_from_camera=pose)

    def picture(self, camera: str = "chase", width: int = 960, height: int = 540) -> Any:
        """A view for people (height, width, 3) from ``chase``, ``overview`` or ``plan``.

        Raises:
            DeviceError: the simulator is closed.
            UnknownNameError: there is no such camera.
        """
        return self._drawn(lambda renderer, data, time_s: renderer.picture(data, camera, width, height, time_s=time_s))

    def verdict(self) -> Verdict | None:
        """The failure that has happened, if any."""
        return self._judge.verdict()

    def final(self) -> Verdict:
        """The verdict at the end."""
        return self._judge.final()

    def people(self) -> tuple[int, int]:
        """(people found who must be, people who must be found)."""
        return self._judge.people()

    def close(self) -> None:
        """Frees the drawing context. Safe to call twice."""
        self._closed = True
        if self._renderer is not None:
            self._renderer.close()
            self._renderer = None

    def __enter__(self) -> MujocoSimulator:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _rows(self, way: Reference) -> Floats:
        """A reference as the controller takes it (n, 10): position, velocity, acceleration, heading."""
        yaw = slewed(way.yaw_rad, self._drone.yaw_rad, _YAW_RATE_RAD_S * self._drone.step_s)
        return np.column_stack([way.position_m, way.velocity_mps, way.acceleration_mps2, yaw])

    def _fly(self, rows: Floats, log: _Log) -> None:
        """Steps along a reference, one step a row, until its end or a failure."""
        drone, n = self._drone, len(rows)
        noise = self._rng.normal(0.0, self._rules.position_noise_m, (n, 6))
        noise[:, :3] += self.disturbance.position_error_m
        gusts = self._gusts.draw(n) + self.disturbance.wind_n
        drone.rotors[:] = self.disturbance.rotors
        recent: list[Floats] = []
        for i in range(n):
            if self.verdict() is not None:
                return
            touched = drone.step(rows[i], noise[i], gusts[i])
            self._goal_m = rows[i, :3]
            recent.append(drone.position_m.copy())
            if touched or len(recent) == _JUDGED_EVERY or i == n - 1:
                self._judge_recent(recent, touched)
            if (i + 1) % _LOGGED_EVERY == 0 or i == n - 1 or self.verdict() is not None:
                log.add(drone.time_s, drone.position_m, rows[i, :3])

    def _hover(self, steps: int, yaw_rad: float, log: _Log) -> None:
        """Hovers at the last goal for so many steps."""
        if steps > 0:
            self._fly(self._rows(hover(self._goal_m, yaw_rad, np.zeros(steps))), log)

    def _is_calm(self) -> bool:
        drone = self._drone
        off = float(np.linalg.norm(drone.position_m - self._goal_m))
        return off < _SETTLED_M and float(np.linalg.norm(drone.velocity_mps)) < _SETTLED_MPS

    def _is_over(self, flown: _Flown) -> bool:
        """Whether a motion whose rows are flown is at rest: flights are waited for, for a while at most."""
        if isinstance(flown.motion, PerformAction | TakeOff):
            return True
        return flown.settling_s >= _SETTLE_S or self._is_calm()

    def _finished(self, flown: _Flown) -> MotionEnded:
        verdict, motion = self.verdict(), flown.motion
        if verdict is not None:
            return self._ended(motion, MotionEnd.FAILED, log=flown.ended(FlightEnd.FAILED, str(verdict.reason)))
        here = as_vec3(self._drone.position_m)
        if isinstance(motion, PerformAction) and not flown.braked:
            self._judge.acted(motion.stop, here)
        elif isinstance(motion, FollowTrajectory | Land):
            self._judge.hovered(here)
        if flown.braked:
            return self._ended(motion, MotionEnd.STOPPED, log=flown.ended(FlightEnd.INTERRUPTED))
        ended = self._ended(motion, MotionEnd.ARRIVED, log=flown.ended(FlightEnd.ARRIVED))
        return replace(ended, view=self._judge.view(motion.stop, here)) if isinstance(motion, PerformAction) else ended

    def _ended(self, motion: Motion, end: MotionEnd, *, log: FlightLog | None = None, reason: str = "") -> MotionEnded:
        state = self.state()
        reason = reason or (log.reason if log is not None else "")
        return MotionEnded(time_s=state.time_s, motion=motion.id, end=end, vehicle=state, log=log, reason=reason)

    def _judge_recent(self, recent: list[Floats], touched: str) -> None:
        """Judges the positions since the last time; the touch, if any, came with the last of them."""
        times = self._drone.time_s - self._drone.step_s * np.arange(len(recent) - 1, -1, -1, dtype=float)
        self._judge.observe(np.asarray(times, float), np.asarray(recent))
        if touched:
            self._judge.touched(touched)
        recent.clear()
        self._bring_late_solids()

    def _bring_late_solids(self) -> None:
        if self._late:
            mission_s = self._judge.mission_s(self._drone.time_s)
            place_late_solids(self._drone.model, self._drone.data, self._scene, mission_s)

    def _drawn(self, draw: Callable[[SceneRenderer, Any, float], Any]) -> Any:
        self._check_open()
        if self._renderer is None:
            width, height = self._camera_size
            self._renderer = SceneRenderer(self._drone.model, self._scene, seed=self._seed, width=width, height=height)
        self._drone.refresh()
        return draw(self._renderer, self._drone.data, self._drone.time_s)

    def _check_open(self) -> None:
        if self._closed:
            raise DeviceError("the simulator is closed: make a new one")


@dataclass(slots=True)
class _Flown:
    """The motion that is being made."""

    motion: Motion
    way: Reference
    rows: Floats
    """As the controller takes it (n, 10)."""
    log: _Log
    row: int = 0
    """The next one."""
    settling_s: float = 0.0
    braked: bool = False

    def ended(self, end: FlightEnd, reason: str = "") -> FlightLog | None:
        """What was flown; None for acts and for what was not begun."""
        return None if isinstance(self.motion, PerformAction | TakeOff) else self.log.ended(end, reason)


class _Log:
    """Collects true places and where they should have been."""

    def __init__(self) -> None:
        self._rows: list[tuple[float, Floats, Floats]] = []

    def add(self, time_s: float, position_m: Floats, reference_m: Floats) -> None:
        self._rows.append((time_s, position_m.copy(), reference_m.copy()))

    def ended(self, end: FlightEnd, reason: str = "") -> FlightLog:
        times, positions, references = zip(*self._rows, strict=True) if self._rows else ((), (), ())
        return FlightLog(
            end=end,
            time_s=np.array(times),
            position_m=np.array(positions).reshape(-1, 3),
            reference_m=np.array(references).reshape(-1, 3),
            reason=reason,
        )
