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
from mintpilot.core.trajectory import FlightEnd, Trajectory, VehicleState
from mintpilot.mission.eyes import CameraEyes
from mintpilot.mission.lookout import Lookout
from mintpilot.mission.retreat import is_stranded, way_back
from mintpilot.planning.checks import check_trajectory
from mintpilot.planning.reach import LookAround, next_view, way_to
from mintpilot.planning.sight import inspect
from mintpilot.planning.trajectory import plan_trajectory

TURN_RATE_RADPS = 1.6
"""How fast the drone turns on the spot while it looks around."""
SWEEP_RAD = 2 * math.pi
"""A full turn at each place."""
TAKE_OFF_CLEAR_M = 1.0
"""Whoever puts the drone down vouches for this much free space around its hover point: cameras see nothing right above
or below."""
ARRIVED_M = 0.6
"""Nearer than this is there."""
MAX_HOPS = 6
"""Attempts to come home when news keep stopping the drone."""


def survey(
    mission: Mission, settings: SurveySettings, *, vehicle: Vehicle, eyes: CameraEyes, recorder: Recorder
) -> SemanticMap:
    """Looks around from one place after the other, as far as known free space leads, and comes back.

    The next place is where much that is unknown lies around, and that is not far. The drone never flies where it has
    not seen free space, and keeps out of every region whose passability is open.

    Args:
        mission: where to fly and with what vehicle.
        settings: speed, and bounds of the effort.
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
    while surveyor.has_time() and surveyor.go_on():
        surveyor.sweep()
    surveyor.go_to(mission.start_m)
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
        self._begun_s = vehicle.state().time_s
        self._seen_from: list[Vec3] = []
        self._track: list[Floats] = []
        eyes.flown(np.asarray([mission.start_m], float), TAKE_OFF_CLEAR_M)
        self.map = eyes.look(None)
        self._look = LookAround(apart_m=settings.spacing_m / 2)
        self._inspected = np.zeros(self.map.frame.shape, bool)

    def has_time(self) -> bool:
        """Whether the survey may go on."""
        return self._vehicle.state().time_s - self._begun_s < self._settings.longest_s

    def sweep(self) -> None:
        """Turns once around on the spot, taking pictures."""
        state = self._vehicle.state()
        self._fly(_turn(np.asarray(state.position_m), state.yaw_rad, SWEEP_RAD), watch_way=False)
        self._seen_from.append(state.position_m)
        self.map = self._eyes.redraw(self.map)
        look = self._look
        inspect(
            self.map,
            self._inspected,
            np.asarray(state.position_m),
            close_m=look.close_m,
            elevation_rad=look.elevation_rad,
        )

    def go_on(self) -> bool:
        """Flies to the next place worth looking around from. False when there is none, or nothing can be flown."""
        self._get_out()
        here = self._vehicle.state().position_m
        seen_from = np.asarray(self._seen_from)
        path = next_view(
            self.map,
            self._limits,
            start_m=here,
            seen_from_m=seen_from,
            inspected=self._inspected,
            settings=self._look,
        )
        if path is None:
            return False
        trajectory = self._trajectory(path)
        if trajectory is None:
            x, y, z = (float(v) for v in path[-1])
            self._seen_from.append((x, y, z))  # it cannot be reached; look elsewhere
            return True
        return self._fly(trajectory, watch_way=True)

    def go_to(self, goal_m: Vec3) -> None:
        """Flies to a place, as often as news on the way stop the drone."""
        for _ in range(MAX_HOPS):
            self._get_out()
            here = self._vehicle.state().position_m
            path = way_to(self.map, self._limits, start_m=here, goal_m=goal_m)
            trajectory = None if path is None else self._trajectory(path)
            if trajectory is None or not self._fly(trajectory, watch_way=True):
                return
            if np.linalg.norm(np.asarray(self._vehicle.state().position_m) - goal_m) < ARRIVED_M:
                return

    def _get_out(self) -> None:
        """Goes back the way it came when something uncertain was found all around it."""
        state = self._vehicle.state()
        if not is_stranded(self.map, self._limits, state):
            return
        track = np.vstack(self._track) if self._track else np.zeros((0, 3))
        trajectory = way_back(self.map, self._limits, state, track)
        if trajectory is not None:
            self._recorder.record(Noticed(kind="retreat", text="The drone went back the way it came."))
            self._fly(trajectory, watch_way=False)

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
        lookout = Lookout(trajectory.position_m[::10], self._limits)

        def watch(state: VehicleState) -> bool:
            self._eyes.glance()
            if not watch_way:
                return False
            self.map = self._eyes.redraw(self.map)
            return bool(lookout.trouble(state.position_m, self.map))

        log = self._vehicle.follow(trajectory, watch)
        self._recorder.record(LegFlown(phase="survey", stop_id="", trajectory=trajectory, log=log))
        self._eyes.flown(log.position_m, self._limits.radius_m)
        self._track.append(log.position_m[::10])
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
