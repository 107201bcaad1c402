"""A drone flown by physics: four rotors, a controller at 250 Hz, gusts, noise, contacts, an RGB-D camera."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from mintpilot.core.errors import DeviceError
from mintpilot.core.geometry import Floats
from mintpilot.core.mission import Verdict
from mintpilot.core.observation import Frame
from mintpilot.core.plan import Stop
from mintpilot.core.ports import Camera, Judge, Vehicle, Watch
from mintpilot.core.trajectory import FlightEnd, FlightLog, Trajectory, VehicleState
from mintpilot.simulation.control import slewed
from mintpilot.simulation.judge import SceneJudge
from mintpilot.simulation.mujoco_drone import Gusts, MujocoDrone
from mintpilot.simulation.quadrotor import Airframe, add_quadrotor
from mintpilot.simulation.reference import Reference, as_vec3, braked, check_start, hover, sampled, time_steps
from mintpilot.simulation.render import SceneRenderer
from mintpilot.simulation.scene import FlightRules, Scene
from mintpilot.simulation.world import build_world, place_late_solids

_JUDGED_EVERY, _LOGGED_EVERY = 10, 5  # steps
_SETTLE_S, _SETTLED_M, _SETTLED_MPS = 2.0, 0.06, 0.1
_YAW_RATE_RAD_S = 2.0


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
        watch_every_s: time between calls of a watch, seconds.

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
        watch_every_s: float = 0.5,
    ) -> None:
        world = build_world(scene) if spec is None else spec
        airframe = Airframe()
        add_quadrotor(world, scene.start_m, rules=rules, airframe=airframe)
        self._drone = MujocoDrone(world.compile(), airframe)
        self._scene, self._rules, self._seed, self._camera_size = scene, rules, seed, camera_size
        self._judge = SceneJudge(scene, rules)
        self._watch_every = max(round(watch_every_s / self._drone.step_s), 1)
        self._rng, self._state_rng, gust_rng = (np.random.default_rng([seed, stream]) for stream in range(3))
        self._gusts = Gusts(rules.wind_n, self._drone.step_s, gust_rng)
        self._goal_m: Floats = np.asarray(scene.start_m, float)
        self._late = any(s.appears_s > 0 for s in scene.solids)
        self._renderer: SceneRenderer | None = None
        self._closed = False
        self._bring_late_solids()

    def begin_mission(self) -> None:
        """The survey is over: the mission's clock starts, with a fresh battery. Call it without a survey, too."""
        self._judge.begin_mission(self._drone.time_s)

    def state(self) -> VehicleState:
        """Where it measures itself to be."""
        drone = self._drone
        noise = self._state_rng.normal(0.0, self._rules.position_noise_m, 3)
        return VehicleState(
            time_s=drone.time_s,
            position_m=as_vec3(drone.position_m + noise),
            velocity_mps=as_vec3(drone.velocity_mps),
            yaw_rad=drone.yaw_rad,
            endurance_left_s=self._judge.endurance_left_s(drone.time_s),
        )

    def follow(self, trajectory: Trajectory, watch: Watch | None = None) -> FlightLog:
        """Flies the trajectory; returns when it hovers at its end, has stopped, or has failed.

        Raises:
            InputError: the trajectory is empty, malformed or not finite.
            DeviceError: it does not begin where the vehicle is, or the simulator is closed.
        """
        self._check_open()
        check_start(trajectory, as_vec3(self._drone.position_m))
        step_s = self._drone.step_s
        way = sampled(trajectory, time_steps(trajectory.duration_s, step_s)[1:])
        log = _Log()
        log.add(self._drone.time_s, self._drone.position_m, trajectory.position_m[0])
        stopped = self._fly(way, log, watch)
        end = FlightEnd.ARRIVED
        if stopped is not None:
            end = FlightEnd.INTERRUPTED
            way = braked(trajectory, float(way.time_s[stopped]), step_s)
            self._fly(way, log)
        self._settle(float(way.yaw_rad[-1]), log)
        verdict = self.verdict()
        if verdict is not None:
            return log.ended(FlightEnd.FAILED, verdict.reason)
        self._judge.hovered(as_vec3(self._drone.position_m))
        return log.ended(end)

    def act(self, stop: Stop, dwell_s: float) -> None:
        """Does what the stop is for while hovering for ``dwell_s`` seconds.

        Raises:
            DeviceError: the simulator is closed.
        """
        self._check_open()
        times = time_steps(dwell_s, self._drone.step_s)[1:]
        self._fly(hover(self._goal_m, self._drone.yaw_rad, times), _Log())
        if self.verdict() is None:
            self._judge.acted(stop, as_vec3(self._drone.position_m))

    def hold(self) -> None:
        """Comes to rest where it should be; does nothing after a failure."""
        if not self._closed:
            self._settle(self._drone.yaw_rad, _Log())

    def capture(self) -> Frame:
        """What the drone's camera sees now; the camera's place is known as well as the drone's.

        Raises:
            DeviceError: the simulator is closed.
        """
        frame: Frame = self._drawn(lambda renderer, data, time_s: renderer.capture(data, time_s))
        pose = frame.world_from_camera.copy()
        pose[:3, 3] += self._state_rng.normal(0.0, self._rules.position_noise_m, 3)
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

    def _fly(self, way: Reference, log: _Log, watch: Watch | None = None) -> int | None:
        """Steps along a reference, one step a row, until its end, a failure, or the watch's wish: then its row."""
        drone, n = self._drone, len(way.time_s)
        noise = self._rng.normal(0.0, self._rules.position_noise_m, (n, 6))
        gusts = self._gusts.draw(n)
        yaw = slewed(way.yaw_rad, drone.yaw_rad, _YAW_RATE_RAD_S * drone.step_s)
        rows = np.column_stack([way.position_m, way.velocity_mps, way.acceleration_mps2, yaw])
        recent: list[Floats] = []
        for i in range(n):
            if self.verdict() is not None:
                return None
            touched = drone.step(rows[i], noise[i], gusts[i])
            self._goal_m = way.position_m[i]
            recent.append(drone.position_m.copy())
            if touched or len(recent) == _JUDGED_EVERY or i == n - 1:
                self._judge_recent(recent, touched)
            if (i + 1) % _LOGGED_EVERY == 0 or i == n - 1 or self.verdict() is not None:
                log.add(drone.time_s, drone.position_m, way.position_m[i])
            due = (i + 1) % self._watch_every == 0 and i < n - 1 and self.verdict() is None
            if watch is not None and due and watch(self.state()):
                return i
        return None

    def _settle(self, yaw_rad: float, log: _Log) -> None:
        """Hovers at the last goal until it is at rest there, for a while at most."""
        drone = self._drone
        for _ in range(round(_SETTLE_S / 0.1)):
            off = float(np.linalg.norm(drone.position_m - self._goal_m))
            calm = off < _SETTLED_M and float(np.linalg.norm(drone.velocity_mps)) < _SETTLED_MPS
            if calm or self.verdict() is not None:
                return
            self._fly(hover(self._goal_m, yaw_rad, time_steps(0.1, drone.step_s)[1:]), log)

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


class _Log:
    """Collects true places and where they should have been."""

    def __init__(self) -> None:
        self._rows: list[tuple[float, Floats, Floats]] = []

    def add(self, time_s: float, position_m: Floats, reference_m: Floats) -> None:
        self._rows.append((time_s, position_m.copy(), reference_m.copy()))

    def ended(self, end: FlightEnd, reason: str = "") -> FlightLog:
        times, positions, references = zip(*self._rows, strict=True)
        return FlightLog(
            end=end,
            time_s=np.array(times),
            position_m=np.array(positions),
            reference_m=np.array(references),
            reason=reason,
        )
