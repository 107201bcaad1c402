"""A drone that follows its trajectory exactly: for fast tests and big benchmarks."""

from __future__ import annotations

import numpy as np

from mintpilot.core.geometry import Floats
from mintpilot.core.mission import Verdict
from mintpilot.core.plan import Stop
from mintpilot.core.ports import Judge, Vehicle, Watch
from mintpilot.core.trajectory import FlightEnd, FlightLog, Trajectory, VehicleState
from mintpilot.simulation.judge import SceneJudge, collision
from mintpilot.simulation.obstacles import Obstacles
from mintpilot.simulation.reference import Reference, as_vec3, braked, check_start, hover, sampled, time_steps
from mintpilot.simulation.scene import FlightRules, Scene

STEP_S = 0.02
"""Time between the moments at which the world is looked at, seconds."""


class KinematicSimulator(Vehicle, Judge):
    """Flies in simulated time, without physics, disturbance or camera; judged by geometry.

    The hull is an upright cylinder (`mintpilot.simulation.obstacles`); touching a solid ends the mission as in physics.

    Args:
        scene: the world.
        rules: what ends a flight.
        seed: taken so that simulators are made alike; nothing here is random.
        watch_every_s: time between calls of a watch, seconds.
    """

    def __init__(self, scene: Scene, rules: FlightRules, *, seed: int, watch_every_s: float = 0.5) -> None:
        del seed
        self._judge = SceneJudge(scene, rules)
        self._obstacles = Obstacles(scene, rules)
        self._watch_every_s = watch_every_s
        self._time_s = 0.0
        self._position: Floats = np.asarray(scene.start_m, float)
        self._velocity: Floats = np.zeros(3)
        self._yaw = 0.0

    def begin_mission(self) -> None:
        """The survey is over: the mission's clock starts, with a fresh battery. Call it without a survey, too."""
        self._judge.begin_mission(self._time_s)

    def state(self) -> VehicleState:
        """Where it is, exactly."""
        return VehicleState(
            time_s=self._time_s,
            position_m=as_vec3(self._position),
            velocity_mps=as_vec3(self._velocity),
            yaw_rad=self._yaw,
            endurance_left_s=self._judge.endurance_left_s(self._time_s),
        )

    def follow(self, trajectory: Trajectory, watch: Watch | None = None) -> FlightLog:
        """Flies the trajectory in no time of this machine's clock.

        Raises:
            InputError: the trajectory is empty, malformed or not finite.
            DeviceError: it does not begin where the vehicle is.
        """
        check_start(trajectory, as_vec3(self._position))
        if self._judge.verdict() is not None:
            return self._grounded()
        way = sampled(trajectory, time_steps(trajectory.duration_s, STEP_S))
        failure = self._first_failure(way)
        end = FlightEnd.ARRIVED
        stopped = self._watched(way, failure, watch)
        if stopped is not None:
            way = _joined(way, stopped, braked(trajectory, float(way.time_s[stopped]), STEP_S))
            failure = self._first_failure(way)
            end = FlightEnd.INTERRUPTED
        if failure is not None:
            self._judge.fail(failure[1])
            end = FlightEnd.FAILED
        last = failure[0] if failure is not None else len(way.time_s) - 1
        times = self._time_s + way.time_s[: last + 1]
        self._place(way, last)
        if end is not FlightEnd.FAILED:
            self._velocity = np.zeros(3)
            self._judge.hovered(as_vec3(self._position))
        positions = way.position_m[: last + 1]
        reason = failure[1].reason if failure is not None else ""
        return FlightLog(
            end=end, time_s=times, position_m=positions.copy(), reference_m=positions.copy(), reason=reason
        )

    def act(self, stop: Stop, dwell_s: float) -> None:
        """Does what the stop is for; the time spent counts."""
        if self._judge.verdict() is not None:
            return
        here = hover(self._position, self._yaw, time_steps(dwell_s, 0.1))
        failure = self._first_failure(here)
        self._place(here, failure[0] if failure is not None else len(here.time_s) - 1)
        if failure is not None:
            self._judge.fail(failure[1])
        else:
            self._judge.acted(stop, as_vec3(self._position))

    def hold(self) -> None:
        """Stays where it is."""
        self._velocity = np.zeros(3)

    def verdict(self) -> Verdict | None:
        """The failure that has happened, if any."""
        return self._judge.verdict()

    def final(self) -> Verdict:
        """The verdict at the end."""
        return self._judge.final()

    def _first_failure(self, way: Reference) -> tuple[int, Verdict] | None:
        times = self._time_s + way.time_s
        failure = self._judge.first_failure(times, way.position_m)
        touch = self._obstacles.first_touch(way.position_m, times - self._time_s + self._judge.mission_s(self._time_s))
        if touch is not None and (failure is None or touch[0] <= failure[0]):
            return touch[0], collision(f"'{touch[1]}'")
        return failure

    def _watched(self, way: Reference, failure: tuple[int, Verdict] | None, watch: Watch | None) -> int | None:
        """The sample at which the watch asked for a stop, if it did before the flight's end or failure."""
        if watch is None:
            return None
        start_s = self._time_s
        last = failure[0] if failure is not None else len(way.time_s) - 1
        every = max(round(self._watch_every_s / STEP_S), 1)
        for sample in range(every, last, every):
            self._time_s = start_s
            self._place(way, sample)
            stop = watch(self.state())
            self._time_s = start_s
            if stop:
                return sample
        return None

    def _place(self, way: Reference, sample: int) -> None:
        self._time_s += float(way.time_s[sample])
        self._position = way.position_m[sample].copy()
        self._velocity = way.velocity_mps[sample].copy()
        self._yaw = float(way.yaw_rad[sample])

    def _grounded(self) -> FlightLog:
        verdict = self._judge.verdict()
        here = self._position[None].copy()
        return FlightLog(
            end=FlightEnd.FAILED,
            time_s=np.array([self._time_s]),
            position_m=here,
            reference_m=here.copy(),
            reason=verdict.reason if verdict is not None else "",
        )


def _joined(way: Reference, at: int, rest: Reference) -> Reference:
    """The way up to a sample, then the rest, whose first sample is that one."""
    return Reference(
        time_s=np.concatenate([way.time_s[:at], rest.time_s]),
        position_m=np.concatenate([way.position_m[:at], rest.position_m]),
        velocity_mps=np.concatenate([way.velocity_mps[:at], rest.velocity_mps]),
        acceleration_mps2=np.concatenate([way.acceleration_mps2[:at], rest.acceleration_mps2]),
        yaw_rad=np.concatenate([way.yaw_rad[:at], rest.yaw_rad]),
    )
