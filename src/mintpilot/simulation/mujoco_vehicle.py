"""A drone in MuJoCo: four rotors, a controller at 250 Hz, gusts, noise, contacts, an RGB-D camera."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
from scipy.signal import lfilter

from mintpilot.core.errors import DeviceError
from mintpilot.core.geometry import Floats, Vec3
from mintpilot.core.mission import Verdict
from mintpilot.core.observation import Frame
from mintpilot.core.plan import Stop
from mintpilot.core.ports import Camera, Judge, Vehicle, Watch
from mintpilot.core.trajectory import FlightEnd, FlightLog, Trajectory, VehicleState
from mintpilot.simulation.control import GRAVITY_MPS2, Controller, slewed
from mintpilot.simulation.engine import load_mujoco
from mintpilot.simulation.judge import SceneJudge
from mintpilot.simulation.quadrotor import DRONE, HULL, Airframe, add_quadrotor
from mintpilot.simulation.reference import Reference, braked, check_start, sampled
from mintpilot.simulation.scene import FlightRules, Scene
from mintpilot.simulation.world import build_world, place_late_solids

_JUDGED_EVERY = 10  # steps
_LOGGED_EVERY = 5  # steps
_SETTLE_S = 2.0
_GUST_S = 1.0
_YAW_RATE_RAD_S = 2.0


class MujocoSimulator(Vehicle, Camera, Judge):
    """Flies in simulated time with physics, much faster than real time. Close it, or use it in a ``with``.

    Any contact of the drone, with the floor too, is a collision and ends the mission. It starts hovering at the scene's
    start, heading along x. Positions it reports carry noise; flight logs hold the true ones.

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
        self._mujoco = load_mujoco()
        world = build_world(scene) if spec is None else spec
        airframe = Airframe()
        add_quadrotor(world, scene.start_m, radius_m=rules.radius_m, airframe=airframe)
        self.model = world.compile()
        self.data = self._mujoco.MjData(self.model)
        self._scene, self._rules, self._seed, self._camera_size = scene, rules, seed, camera_size
        self._judge = SceneJudge(scene, rules)
        self._step_s = float(self.model.opt.timestep)
        self._controller = Controller(airframe, self._step_s)
        self._watch_every = max(round(watch_every_s / self._step_s), 1)
        self._flight_rng, self._state_rng = (np.random.default_rng([seed, stream]) for stream in (1, 2))
        self._gust = np.zeros(3)
        self._late = any(s.appears_s > 0 for s in scene.solids)
        self._renderer: Any = None
        self._closed = False
        self._attach()
        self.data.act[:] = self.data.ctrl[:] = airframe.mass_kg * GRAVITY_MPS2 / 4
        self._bring_late_solids()
        self._mujoco.mj_forward(self.model, self.data)

    def begin_mission(self) -> None:
        """The survey is over: the mission's clock starts, with a fresh battery. Call it without a survey, too."""
        self._judge.begin_mission(self._time_s)

    def state(self) -> VehicleState:
        """Where it measures itself to be."""
        noise = self._state_rng.normal(0.0, self._rules.position_noise_m, 3) if self._rules.position_noise_m else 0.0
        return VehicleState(
            time_s=self._time_s,
            position_m=_vec3(self._position + noise),
            velocity_mps=_vec3(self._velocity),
            yaw_rad=self._yaw,
            endurance_left_s=self._judge.endurance_left_s(self._time_s),
        )

    def follow(self, trajectory: Trajectory, watch: Watch | None = None) -> FlightLog:
        """Flies the trajectory; returns when it hovers at its end, has stopped, or has failed.

        Raises:
            InputError: the trajectory is empty, malformed or not finite.
            DeviceError: it does not begin where the vehicle is, or the simulator is closed.
        """
        self._check_open()
        check_start(trajectory, _vec3(self._position))
        steps = max(int(np.ceil(trajectory.duration_s / self._step_s - 1e-9)), 1)
        way = sampled(trajectory, np.minimum(self._step_s * np.arange(1, steps + 1), trajectory.duration_s))
        log = _Log()
        log.add(self._time_s, self._position, trajectory.position_m[0])
        stopped = self._fly(way, log, watch)
        end = FlightEnd.ARRIVED
        if stopped is not None and self.verdict() is None:
            end = FlightEnd.INTERRUPTED
            way = braked(trajectory, float(way.time_s[stopped]), self._step_s)
            self._fly(way, log)
        self._settle(way, log)
        verdict = self.verdict()
        if verdict is None:
            self._judge.hovered(_vec3(self._position))
            return log.ended(end)
        return log.ended(FlightEnd.FAILED, verdict.reason)

    def act(self, stop: Stop, dwell_s: float) -> None:
        """Does what the stop is for while hovering for ``dwell_s`` seconds.

        Raises:
            DeviceError: the simulator is closed.
        """
        self._check_open()
        steps = max(int(np.ceil(dwell_s / self._step_s - 1e-9)), 1)
        self._fly(_hover(self._position, self._yaw, steps, self._step_s), _Log())
        if self.verdict() is None:
            self._judge.acted(stop, _vec3(self._position))

    def hold(self) -> None:
        """Comes to rest where it is; does nothing after a failure."""
        if self._closed or self.verdict() is not None:
            return
        self._settle(_hover(self._position, self._yaw, 1, self._step_s), _Log())

    def capture(self) -> Frame:
        """What the drone's camera sees now; the camera's place is known as well as the drone's.

        Raises:
            DeviceError: the simulator is closed.
        """
        self._check_open()
        if self._renderer is None:
            from mintpilot.simulation.render import SceneRenderer

            width, height = self._camera_size
            self._renderer = SceneRenderer(self.model, self._scene, seed=self._seed, width=width, height=height)
        self._mujoco.mj_forward(self.model, self.data)
        frame: Frame = self._renderer.capture(self.data, self._time_s)
        pose = frame.world_from_camera.copy()
        if self._rules.position_noise_m:
            pose[:3, 3] += self._state_rng.normal(0.0, self._rules.position_noise_m, 3)
        return replace(frame, world_from_camera=pose)

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

    def _attach(self) -> None:
        """Views of the drone's part of the state."""
        joint, data = self.model.joint(DRONE), self.data
        q, v = int(joint.qposadr[0]), int(joint.dofadr[0])
        self._position: Floats = data.qpos[q : q + 3]
        self._quaternion: Floats = data.qpos[q + 3 : q + 7]
        self._velocity: Floats = data.qvel[v : v + 3]
        self._rate: Floats = data.qvel[v + 3 : v + 6]
        self._force: Floats = data.xfrc_applied[self.model.body(DRONE).id, :3]
        self._hull = int(self.model.geom(HULL).id)

    @property
    def _time_s(self) -> float:
        return float(self.data.time)

    @property
    def _yaw(self) -> float:
        w, x, y, z = self._quaternion
        return math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))

    def _fly(self, way: Reference, log: _Log, watch: Watch | None = None) -> int | None:
        """Steps along a reference, one step a row, until its end, a failure, or the watch's wish: then its row."""
        n = len(way.time_s)
        noise = self._flight_rng.normal(0.0, 1.0, (n, 6)) * self._rules.position_noise_m
        gusts = self._gusts(n)
        yaw = slewed(way.yaw_rad, self._yaw, _YAW_RATE_RAD_S * self._step_s)
        rows = np.column_stack([way.position_m, way.velocity_mps, way.acceleration_mps2, yaw])
        recent: list[Floats] = []
        for i in range(n):
            if self.verdict() is not None:
                return None
            self._step(rows[i], noise[i], gusts[i])
            recent.append(self._position.copy())
            if len(recent) == _JUDGED_EVERY or i == n - 1:
                self._judge_recent(recent)
                self._bring_late_solids()
            if (i + 1) % _LOGGED_EVERY == 0 or i == n - 1 or self.verdict() is not None:
                log.add(self._time_s, self._position, way.position_m[i])
            due = watch is not None and (i + 1) % self._watch_every == 0 and i < n - 1
            if due and watch is not None and self.verdict() is None and watch(self.state()):
                return i
        return None

    def _step(self, row: Floats, noise: Floats, gust: Floats) -> None:
        data = self.data
        data.ctrl[:] = self._controller.thrusts(
            self._position + noise[:3], self._quaternion, self._velocity + noise[3:], self._rate, row
        )
        self._force[:] = gust
        self._mujoco.mj_step(self.model, data)
        if data.ncon:
            for pair in data.contact.geom[: data.ncon]:
                if self._hull in pair:
                    other = int(pair[0] if pair[1] == self._hull else pair[1])
                    self._judge.touched(self._described(other))
                    return

    def _settle(self, way: Reference, log: _Log) -> None:
        """Hovers at the last row of a reference until it is at rest there, for a while at most."""
        goal, yaw = way.position_m[-1], float(way.yaw_rad[-1])
        for _ in range(int(_SETTLE_S / 0.1)):
            calm = np.linalg.norm(self._velocity) < 0.1 and np.linalg.norm(self._position - goal) < 0.06
            if calm or self.verdict() is not None:
                return
            self._fly(_hover(goal, yaw, max(round(0.1 / self._step_s), 1), self._step_s), log)

    def _judge_recent(self, recent: list[Floats]) -> None:
        times = self._time_s - self._step_s * np.arange(len(recent) - 1, -1, -1)
        self._judge.observe(times, np.asarray(recent))
        recent.clear()

    def _gusts(self, n: int) -> Floats:
        """(n, 3) newtons: first-order coloured noise of the rules' standard deviation, going on from the last flight."""
        keep = math.exp(-self._step_s / _GUST_S)
        kicks = self._flight_rng.normal(0.0, self._rules.wind_n * math.sqrt(1 - keep**2), (n, 3))
        gusts: Floats = lfilter([1.0], [1.0, -keep], kicks, axis=0, zi=keep * self._gust[None])[0]
        self._gust = gusts[-1].copy()
        return gusts

    def _bring_late_solids(self) -> None:
        if self._late:
            place_late_solids(self.model, self.data, self._scene, self._judge.mission_s(self._time_s))

    def _described(self, geom: int) -> str:
        parts = str(self.model.geom(geom).name).split(":")
        return f"'{parts[1]}'" if len(parts) > 2 else "the building"

    def _check_open(self) -> None:
        if self._closed:
            raise DeviceError("the simulator is closed: make a new one")


class _Log:
    """Collects true places and where they should have been."""

    def __init__(self) -> None:
        self._time: list[float] = []
        self._position: list[Floats] = []
        self._reference: list[Floats] = []

    def add(self, time_s: float, position_m: Floats, reference_m: Floats) -> None:
        self._time.append(time_s)
        self._position.append(position_m.copy())
        self._reference.append(reference_m.copy())

    def ended(self, end: FlightEnd, reason: str = "") -> FlightLog:
        return FlightLog(
            end=end,
            time_s=np.asarray(self._time),
            position_m=np.asarray(self._position),
            reference_m=np.asarray(self._reference),
            reason=reason,
        )


def _hover(position_m: Floats, yaw_rad: float, steps: int, step_s: float) -> Reference:
    still = np.zeros((steps, 3))
    return Reference(
        time_s=step_s * np.arange(1, steps + 1),
        position_m=position_m + still,
        velocity_mps=still,
        acceleration_mps2=still,
        yaw_rad=np.full(steps, yaw_rad),
    )


def _vec3(row: Floats) -> Vec3:
    return (float(row[0]), float(row[1]), float(row[2]))
