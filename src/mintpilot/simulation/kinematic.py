"""A drone that follows its trajectory exactly: for fast tests and big benchmarks."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from mintpilot.core.errors import DeviceError
from mintpilot.core.geometry import Floats, Vec3
from mintpilot.core.inputs import MotionEnded
from mintpilot.core.message import verbatim
from mintpilot.core.mission import Verdict
from mintpilot.core.motion import FollowTrajectory, Land, Motion, MotionEnd, PerformAction, TakeOff
from mintpilot.core.ports import Judge, Vehicle
from mintpilot.core.trajectory import FlightEnd, FlightLog, VehicleState
from mintpilot.simulation.judge import SceneJudge, collision
from mintpilot.simulation.obstacles import Obstacles
from mintpilot.simulation.reference import (
    Reference,
    as_vec3,
    braked,
    check_start,
    descent,
    hover,
    joined,
    sampled,
    time_steps,
)
from mintpilot.simulation.scene import FlightRules, Scene

STEP_S = 0.02
"""Time between the moments at which the world is looked at, seconds."""
_ACT_STEP_S = 0.1
_SOON_S = 1e-9


@dataclass(slots=True)
class _Flown:
    """The motion that is being made, worked out to its end."""

    motion: Motion
    begun_s: float
    way: Reference
    last: int
    """Row at which it ends."""
    failure: Verdict | None
    """What ends it there; None: nothing does."""
    braked: bool = False


class KinematicSimulator(Vehicle, Judge):
    """Flies in simulated time, without physics, disturbance or camera; judged by geometry.

    The hull is an upright cylinder (`mintpilot.simulation.obstacles`); touching a solid ends the mission as in physics.

    Args:
        scene: the world.
        rules: what ends a flight.
        seed: taken so that simulators are made alike; nothing here is random.
    """

    def __init__(self, scene: Scene, rules: FlightRules, *, seed: int) -> None:
        del seed
        self._floor_m = scene.volume.lo_m[2]
        self._judge = SceneJudge(scene, rules)
        self._obstacles = Obstacles(scene, rules)
        self._time_s = 0.0
        self._position: Floats = np.asarray(scene.start_m, float)
        self._velocity: Floats = np.zeros(3)
        self._yaw = 0.0
        self._flown: _Flown | None = None
        self._refused: MotionEnded | None = None

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

    def command(self, motion: Motion) -> None:
        """Begins a motion.

        Raises:
            InputError: a trajectory is empty, malformed or not finite.
        """
        match motion:
            case FollowTrajectory():
                try:
                    check_start(motion.trajectory, as_vec3(self._position))
                except DeviceError as error:
                    self._refused = self._ended(motion, MotionEnd.REFUSED, reason=str(error))
                    return
                way = sampled(motion.trajectory, time_steps(motion.trajectory.duration_s, STEP_S))
            case PerformAction():
                way = hover(self._position, self._yaw, time_steps(motion.dwell_s, _ACT_STEP_S))
            case Land():
                way = self._until_touch(descent(self._position, self._yaw, self._floor_m, STEP_S))
            case TakeOff():
                way = hover(self._position, self._yaw, np.zeros(2))
        self._begin(motion, way)

    def brake(self) -> None:
        """Brakes along the trajectory; an act is broken off, a descent stops where it is."""
        flown = self._flown
        if flown is None or flown.braked:
            return
        at = self._row(flown)
        if isinstance(flown.motion, FollowTrajectory):
            rest = braked(flown.motion.trajectory, float(flown.way.time_s[at]), STEP_S)
            flown.way = joined(flown.way, at, rest)
        else:
            flown.way = joined(flown.way, at, hover(self._position, self._yaw, flown.way.time_s[at : at + 1]))
        flown.braked = True
        self._look_ahead(flown)

    def advance(self, until_s: float) -> tuple[MotionEnded, ...]:
        """Flies on in no time of this machine's clock; see `Vehicle.advance`."""
        if self._refused is not None:
            refused, self._refused = self._refused, None
            return (refused,)
        flown = self._flown
        if flown is None:
            self._hover_until(until_s)
            return ()
        end_s = flown.begun_s + float(flown.way.time_s[flown.last])
        if until_s < end_s - _SOON_S:
            self._time_s = max(self._time_s, until_s)
            self._place(flown.way, self._row(flown))
            return ()
        self._time_s = max(self._time_s, end_s)
        self._place(flown.way, flown.last)
        return (self._finish(flown),)

    def hold(self) -> None:
        """Stays where it is."""
        self._velocity = np.zeros(3)
        self._flown = None

    def carry(self, time_s: float, position_m: Vec3, velocity_mps: Vec3) -> None:
        """Somebody else flies it: it is there now, having come straight from where it was. That way is judged."""
        way = np.array([self._position, position_m], float)
        times = np.array([self._time_s, max(time_s, self._time_s)])
        failure = self._judge.first_failure(times, way)
        touch = self._obstacles.first_touch(way, times)
        if touch is not None:
            self._judge.fail(collision(verbatim(f"'{touch[1]}'")))
        elif failure is not None:
            self._judge.fail(failure[1])
        self._time_s, self._position = float(times[1]), way[1]
        self._velocity = np.asarray(velocity_mps, float)

    def verdict(self) -> Verdict | None:
        """The failure that has happened, if any."""
        return self._judge.verdict()

    def final(self) -> Verdict:
        """The verdict at the end."""
        return self._judge.final()

    def people(self) -> tuple[int, int]:
        """(people found who must be, people who must be found)."""
        return self._judge.people()

    def _begin(self, motion: Motion, way: Reference) -> None:
        if self._judge.verdict() is not None:
            way = hover(self._position, self._yaw, np.zeros(1))
        flown = _Flown(motion=motion, begun_s=self._time_s, way=way, last=len(way.time_s) - 1, failure=None)
        self._look_ahead(flown)
        self._flown = flown

    def _look_ahead(self, flown: _Flown) -> None:
        """Works out where the motion ends."""
        verdict = self._judge.verdict()
        failure = (0, verdict) if verdict is not None else self._first_failure(flown.way, flown.begun_s)
        flown.last = len(flown.way.time_s) - 1 if failure is None else failure[0]
        flown.failure = None if failure is None else failure[1]

    def _first_failure(self, way: Reference, begun_s: float) -> tuple[int, Verdict] | None:
        times = begun_s + way.time_s
        failure = self._judge.first_failure(times, way.position_m)
        touch = self._obstacles.first_touch(way.position_m, way.time_s + self._judge.mission_s(begun_s))
        if touch is not None and (failure is None or touch[0] <= failure[0]):
            return touch[0], collision(verbatim(f"'{touch[1]}'"))
        return failure

    def _until_touch(self, way: Reference) -> Reference:
        """A descent to the ground, or to right above the first thing below."""
        touch = self._obstacles.first_touch(way.position_m, way.time_s + self._judge.mission_s(self._time_s))
        return way if touch is None else way.until(max(touch[0], 1))

    def _finish(self, flown: _Flown) -> MotionEnded:
        self._flown = None
        if flown.failure is not None:
            self._judge.fail(flown.failure)
            return self._ended(flown.motion, MotionEnd.FAILED, log=_log(flown), reason=str(flown.failure.reason))
        self._velocity = np.zeros(3)
        if isinstance(flown.motion, PerformAction):
            if not flown.braked:
                self._judge.acted(flown.motion.stop, as_vec3(self._position))
        elif not isinstance(flown.motion, TakeOff):
            self._judge.hovered(as_vec3(self._position))
        end = MotionEnd.STOPPED if flown.braked else MotionEnd.ARRIVED
        ended = self._ended(flown.motion, end, log=_log(flown))
        if not isinstance(flown.motion, PerformAction):
            return ended
        return replace(ended, view=self._judge.view(flown.motion.stop, as_vec3(self._position)))

    def _ended(self, motion: Motion, end: MotionEnd, *, log: FlightLog | None = None, reason: str = "") -> MotionEnded:
        return MotionEnded(time_s=self._time_s, motion=motion.id, end=end, vehicle=self.state(), log=log, reason=reason)

    def _hover_until(self, until_s: float) -> None:
        self._time_s = max(self._time_s, until_s)
        failure = self._judge.first_failure(np.array([self._time_s]), self._position[None])
        if failure is not None:
            self._judge.fail(failure[1])

    def _row(self, flown: _Flown) -> int:
        """The row of the way at which the drone is now."""
        row = int(np.searchsorted(flown.way.time_s, self._time_s - flown.begun_s + _SOON_S, side="right")) - 1
        return min(max(row, 0), flown.last)

    def _place(self, way: Reference, row: int) -> None:
        self._position = way.position_m[row].copy()
        self._velocity = way.velocity_mps[row].copy()
        self._yaw = float(way.yaw_rad[row])


def _log(flown: _Flown) -> FlightLog | None:
    """What was flown; None for acts."""
    if isinstance(flown.motion, PerformAction | TakeOff):
        return None
    ends = {True: FlightEnd.FAILED, False: FlightEnd.INTERRUPTED if flown.braked else FlightEnd.ARRIVED}
    positions = flown.way.position_m[: flown.last + 1]
    return FlightLog(
        end=ends[flown.failure is not None],
        time_s=flown.begun_s + flown.way.time_s[: flown.last + 1],
        position_m=positions.copy(),
        reference_m=positions.copy(),
        reason=str(flown.failure.reason) if flown.failure is not None else "",
    )
