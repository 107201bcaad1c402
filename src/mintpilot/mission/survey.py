"""The survey: a flight that makes the map, itself never entering what is not known passable."""

from __future__ import annotations

import math

import numpy as np

from mintpilot.core.errors import InfeasibleError
from mintpilot.core.events import LegFlown, MapUpdated, Noticed
from mintpilot.core.geometry import Floats, Vec3
from mintpilot.core.mission import Mission, SurveySettings
from mintpilot.core.plan import VehicleLimits
from mintpilot.core.ports import Recorder, Vehicle
from mintpilot.core.semantic_map import SemanticMap
from mintpilot.core.trajectory import FlightEnd, Trajectory
from mintpilot.mission.eyes import CameraEyes, stations
from mintpilot.planning.checks import check_path, check_trajectory
from mintpilot.planning.reach import nearest_reachable
from mintpilot.planning.trajectory import plan_trajectory

TURN_RATE_RADPS = 1.2
"""How fast the drone turns on the spot while it looks around."""
SWEEP_RAD = 2 * math.pi
"""A full turn at each station."""
WORTH_M = 0.6
"""A hop shorter than this brings the drone no nearer to a station."""
MAX_HOPS = 6
"""Hops towards one station before it is given up."""


def survey(
    mission: Mission, settings: SurveySettings, *, vehicle: Vehicle, eyes: CameraEyes, recorder: Recorder
) -> SemanticMap:
    """Looks around from a lattice of stations, as far as known free space leads to them, and comes back.

    Every hop ends at the known-flyable place nearest to the next station, so the drone never flies where it has not
    seen free space, and keeps out of every region whose passability is open.

    Args:
        mission: where to fly and with what vehicle.
        settings: height, spacing and speed of the survey.
        vehicle: hovering at the mission's start.
        eyes: what turns pictures into the map.
        recorder: told about every flight.

    Returns:
        The map; the vehicle hovers at the start again, or as near to it as known free space allows.

    Raises:
        DeviceError: the vehicle's or the camera's link is gone.
    """
    surveyor = _Surveyor(mission, settings, vehicle, eyes, recorder)
    surveyor.sweep()
    lo, hi = mission.volume.lo_m, mission.volume.hi_m
    for station in stations(lo, hi, height_m=settings.height_m, spacing_m=settings.spacing_m):
        if not surveyor.go_towards(station):
            return surveyor.map
        surveyor.sweep()
    surveyor.go_towards(mission.start_m)
    recorder.record(MapUpdated(map=surveyor.map, why="survey"))
    return surveyor.map


class _Surveyor:
    def __init__(
        self, mission: Mission, settings: SurveySettings, vehicle: Vehicle, eyes: CameraEyes, recorder: Recorder
    ) -> None:
        self._limits: VehicleLimits = mission.limits
        self._settings = settings
        self._vehicle = vehicle
        self._eyes = eyes
        self._recorder = recorder
        start = np.asarray([mission.start_m], float)
        eyes.flown(start, self._limits.radius_m + self._limits.margin_m)
        self.map = eyes.look(None)

    def sweep(self) -> None:
        """Turns once around on the spot, taking pictures."""
        state = self._vehicle.state()
        self._fly(_turn(np.asarray(state.position_m), state.yaw_rad, SWEEP_RAD), watch_way=False)
        self.map = self._eyes.look(self.map)

    def go_towards(self, goal_m: Vec3) -> bool:
        """Hops towards the goal while that brings the drone nearer. False when the vehicle cannot fly any more."""
        for _ in range(MAX_HOPS):
            here = np.asarray(self._vehicle.state().position_m)
            if np.linalg.norm(here - goal_m) < self._settings.spacing_m / 8:
                return True
            path = nearest_reachable(self.map, self._limits, start_m=tuple(here), goal_m=goal_m)
            if path is None or np.linalg.norm(path[-1] - goal_m) > np.linalg.norm(here - goal_m) - WORTH_M:
                return True
            trajectory = self._trajectory(path)
            if trajectory is None:
                return True
            if not self._fly(trajectory, watch_way=True):
                return False
            self.map = self._eyes.look(self.map)
        return True

    def _trajectory(self, path: Floats) -> Trajectory | None:
        yaw = self._vehicle.state().yaw_rad
        speed = self._settings.speed_mps
        try:
            trajectory = plan_trajectory(path, map=self.map, limits=self._limits, start_yaw_rad=yaw, speed_mps=speed)
        except InfeasibleError as error:
            self._recorder.record(Noticed(kind="survey", text=str(error)))
            return None
        refusal = check_trajectory(trajectory, self.map, self._limits)
        if refusal:
            self._recorder.record(Noticed(kind="survey", text=refusal))
            return None
        return trajectory

    def _fly(self, trajectory: Trajectory, *, watch_way: bool) -> bool:
        def watch(_state: object) -> bool:
            self._eyes.glance()
            if not watch_way:
                return False
            self.map = self._eyes.redraw(self.map)
            position = np.asarray(self._vehicle.state().position_m)
            nearest = int(np.argmin(np.linalg.norm(trajectory.position_m - position, axis=1)))
            return bool(check_path(trajectory.position_m[nearest + 1 :: 10], self.map, self._limits))

        log = self._vehicle.follow(trajectory, watch)
        self._recorder.record(LegFlown(phase="survey", stop_id="", trajectory=trajectory, log=log))
        self._eyes.flown(log.position_m, self._limits.radius_m)
        return log.end is not FlightEnd.FAILED


def _turn(position_m: Floats, yaw_rad: float, angle_rad: float, sample_s: float = 0.02) -> Trajectory:
    """A turn on the spot with smooth start and end."""
    duration = abs(angle_rad) / TURN_RATE_RADPS
    count = max(2, math.ceil(duration / sample_s) + 1)
    time_s = np.linspace(0.0, duration, count)
    share = time_s / duration
    smooth = share - np.sin(2 * math.pi * share) / (2 * math.pi)
    zeros = np.zeros((count, 3))
    return Trajectory(
        time_s=time_s,
        position_m=np.repeat(position_m[None], count, axis=0),
        velocity_mps=zeros,
        acceleration_mps2=zeros.copy(),
        yaw_rad=yaw_rad + angle_rad * smooth,
    )
