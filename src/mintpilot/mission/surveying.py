"""The survey: a flight that makes the map, itself never entering what is not known passable."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from mintpilot.core.decisions import Explore
from mintpilot.core.geometry import Floats
from mintpilot.core.message import message
from mintpilot.core.trajectory import Trajectory
from mintpilot.mission.directives import BeginTask
from mintpilot.mission.navigation import ARRIVED_M
from mintpilot.mission.requests import Purpose, SurveyProgress
from mintpilot.mission.state import Activity, Goal
from mintpilot.mission.transition import Transition

TURN_RATE_RADPS = 1.6
"""How fast the drone turns on the spot while it looks around, radians per second."""
SWEEP_RAD = 2 * math.pi
"""A full turn at each place."""
MAX_HOPS = 6
"""Flights towards the start or a landing place, when news keep stopping the drone on its way."""
_SAMPLE_S = 0.02


def begin_survey(t: Transition) -> None:
    """The first map is there: looks around, or goes straight to the task where no survey is flown."""
    if not t.state.setup.surveys:
        begin_task(t)
        return
    t.set(survey=SurveyProgress(begun_s=t.state.clock_s))
    sweep(t)


def sweep(t: Transition) -> None:
    """Turns once around on the spot, taking pictures."""
    vehicle = t.state.vehicle
    t.follow(turn(np.asarray(vehicle.position_m), vehicle.yaw_rad, SWEEP_RAD), Activity.SWEEP)


def next_place(t: Transition) -> None:
    """Has the next place to look around from worked out, or the way home when the time is over."""
    survey, settings = t.state.survey, t.state.setup.mission.survey
    if survey is None or settings is None:
        begin_task(t)
        return
    if not survey.homeward and t.state.clock_s - survey.begun_s >= settings.longest_s:
        t.set(survey=replace(survey, homeward=True))
    t.request(Purpose.SURVEY)


def swept(t: Transition) -> None:
    """The map of a sweep is drawn: this place has been looked around from."""
    survey = t.state.survey
    if survey is not None:
        t.set(survey=replace(survey, seen_from_m=(*survey.seen_from_m, t.state.vehicle.position_m)))
    next_place(t)


def go_on(t: Transition, decision: Explore) -> None:
    """Flies to the next place, back out, or home; or ends the survey."""
    survey = t.state.survey
    if survey is None:
        begin_task(t)
        return
    for note in decision.notes:
        t.note("survey", note)
    survey = replace(survey, inspected=decision.inspected, seen_from_m=(*survey.seen_from_m, *decision.unreachable_m))
    t.set(survey=survey)
    if decision.trajectory is None:
        if survey.homeward or at_start(t):
            begin_task(t)
        else:
            t.set(survey=replace(survey, homeward=True))
            t.request(Purpose.SURVEY)
        return
    path_m = decision.trajectory.position_m[::10]
    if decision.retreat:
        t.note("retreat", message("The drone went back the way it came."))
        t.set(retreats=t.state.retreats + 1)
        t.follow(decision.trajectory, Activity.SURVEY_BACK)
    elif survey.homeward:
        t.set(survey=replace(survey, hops=survey.hops + 1))
        t.follow(decision.trajectory, Activity.SURVEY_BACK, path_m)
    else:
        t.follow(decision.trajectory, Activity.EXPLORE, path_m)


def came_back(t: Transition) -> None:
    """A flight towards the start, or back out of a doubtful place, has ended."""
    survey = t.state.survey
    if survey is not None and survey.homeward and (at_start(t) or survey.hops >= MAX_HOPS):
        begin_task(t)
    else:
        next_place(t)


def at_start(t: Transition) -> bool:
    """Whether the vehicle is where the mission begins."""
    return math.dist(t.state.vehicle.position_m, t.state.setup.mission.start_m) < ARRIVED_M


def begin_task(t: Transition) -> None:
    """The survey is over: the clock of the task starts; the next tick brings the battery with which it is flown."""
    t.set(goal=Goal.TASK, activity=Activity.NONE, task_begun_s=t.state.clock_s, retreats=0, survey=None)
    t.give(BeginTask())


def turn(position_m: Floats, yaw_rad: float, angle_rad: float) -> Trajectory:
    """A turn on the spot with smooth start and end, from that place (3,) and heading."""
    duration = abs(angle_rad) / TURN_RATE_RADPS
    count = max(2, math.ceil(duration / _SAMPLE_S) + 1)
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
