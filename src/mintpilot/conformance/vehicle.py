"""Check of vehicles: simulators and links to autopilots."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from mintpilot.conformance.sample import require
from mintpilot.core.geometry import Vec3
from mintpilot.core.inputs import MotionEnded
from mintpilot.core.motion import FollowTrajectory, MotionEnd, PerformAction
from mintpilot.core.plan import Site, Stop
from mintpilot.core.ports import Vehicle
from mintpilot.core.task import Action
from mintpilot.core.trajectory import FlightLog, Trajectory, VehicleState

NEAR_M = 0.5
"""A vehicle that is farther from where it should hover is not there."""
MOST_ADVANCES = 200
"""Half-second pieces of time in which any motion of the check must end."""


def check_vehicle(make: Callable[[], Vehicle], *, move_m: Vec3 = (1.5, 0.0, 0.0), speed_mps: float = 0.5) -> None:
    """Flies to and fro, is stopped on the way, hovers, acts and holds.

    Args:
        make: makes a fresh vehicle that hovers, or is ready to; called more than once.
        move_m: a straight move that is free of obstacles from where it begins.
        speed_mps: mean speed of the move.

    Raises:
        ConformanceError: it breaks the contract of `mintpilot.core.ports.Vehicle`.
    """
    vehicle = make()
    begun = _state(vehicle)
    goal_m = np.asarray(begun.position_m) + move_m
    log = _flown(vehicle, FollowTrajectory(id=1, trajectory=_straight(begun, goal_m, speed_mps)), MotionEnd.ARRIVED)
    _check_log(log, vehicle)
    arrived = _state(vehicle)
    off_m = math.dist(arrived.position_m, goal_m)
    require(
        off_m <= NEAR_M, vehicle, f"it hovers {off_m:.2f} m from the end of the trajectory; within {NEAR_M} m it must"
    )
    require(arrived.time_s > begun.time_s, vehicle, "its clock stood still while it flew")
    require(arrived.endurance_left_s <= begun.endurance_left_s, vehicle, "it has more endurance after a flight")

    stop = Stop(id="go:1", action=Action.GO, sites=(Site(position_m=arrived.position_m),))
    _flown(vehicle, PerformAction(id=2, stop=stop, dwell_s=0.5), MotionEnd.ARRIVED)
    acted = _state(vehicle)
    require(acted.time_s > arrived.time_s, vehicle, "its clock stood still while it acted")
    vehicle.advance(acted.time_s + 0.5)
    require(_state(vehicle).time_s > acted.time_s, vehicle, "its clock stood still while it hovered")
    vehicle.brake()
    require(vehicle.advance(_state(vehicle).time_s + 0.2) == (), vehicle, "it ends a motion that nobody has begun")
    vehicle.hold()
    vehicle.hold()
    _check_stop(make(), move_m, speed_mps)
    _check_steps(make(), move_m, speed_mps)


def _check_stop(vehicle: Vehicle, move_m: Vec3, speed_mps: float) -> None:
    """Told to brake in flight, it comes to rest on its way and says so once."""
    begun = _state(vehicle)
    goal_m = np.asarray(begun.position_m) + move_m
    trajectory = _straight(begun, goal_m, speed_mps)
    vehicle.command(FollowTrajectory(id=7, trajectory=trajectory))
    early = vehicle.advance(begun.time_s + trajectory.duration_s / 2)
    require(early == (), vehicle, f"a motion of {trajectory.duration_s:.1f} s has ended in half of its time: {early}")
    vehicle.brake()
    vehicle.brake()
    ended = _until_ended(vehicle, 7)
    require(ended.end is MotionEnd.STOPPED, vehicle, f"it was told to brake, but the motion ended '{ended.end}'")
    require(ended.log is not None, vehicle, "a flight that was stopped has a log")
    speed = float(np.linalg.norm(_state(vehicle).velocity_mps))
    require(speed < 0.3, vehicle, f"it moves at {speed:.2f} m/s after a stop; it must hover")
    left_m = math.dist(_state(vehicle).position_m, goal_m)
    require(left_m > NEAR_M / 2, vehicle, f"it is {left_m:.2f} m from its goal though it was told to brake half way")


def _check_steps(vehicle: Vehicle, move_m: Vec3, speed_mps: float) -> None:
    """Time passes no further than it was told."""
    begun = _state(vehicle)
    goal_m = np.asarray(begun.position_m) + move_m
    vehicle.command(FollowTrajectory(id=9, trajectory=_straight(begun, goal_m, speed_mps)))
    for number in range(1, 6):
        until_s = begun.time_s + 0.1 * number
        vehicle.advance(until_s)
        late_s = _state(vehicle).time_s - until_s
        require(late_s < 0.1, vehicle, f"told to advance to {until_s:.2f} s it went on for {late_s:.2f} s more")


def _flown(vehicle: Vehicle, motion: FollowTrajectory | PerformAction, end: MotionEnd) -> FlightLog | None:
    vehicle.command(motion)
    ended = _until_ended(vehicle, motion.id)
    what = type(motion).__name__
    require(ended.end is end, vehicle, f"{what} ended '{ended.end}' ({ended.reason}); it must end '{end}'")
    return ended.log


def _until_ended(vehicle: Vehicle, motion: int) -> MotionEnded:
    """Lets time pass until the motion has ended."""
    for _ in range(MOST_ADVANCES):
        for event in vehicle.advance(_state(vehicle).time_s + 0.5):
            require(isinstance(event, MotionEnded), vehicle, f"a link changed though nothing is wrong: {event}")
            assert isinstance(event, MotionEnded)
            require(event.motion == motion, vehicle, f"motion {event.motion} ended; {motion} was begun")
            return event
    require(False, vehicle, f"motion {motion} has not ended after {MOST_ADVANCES} calls of `advance`")
    raise AssertionError  # pragma: no cover


def _state(vehicle: Vehicle) -> VehicleState:
    state = vehicle.state()
    numbers = [state.time_s, *state.position_m, *state.velocity_mps, state.yaw_rad]
    require(bool(np.isfinite(numbers).all()), vehicle, f"its state is not finite: {state}")
    return state


def _check_log(log: FlightLog | None, vehicle: Vehicle) -> None:
    require(log is not None, vehicle, "a flight has a log")
    assert log is not None
    n = len(log.time_s)
    require(n >= 1, vehicle, "its log is empty; the place where it began is in it at least")
    shapes = log.position_m.shape == (n, 3) and log.reference_m.shape == (n, 3)
    rule = f"log of {n} times with positions {log.position_m.shape} and references {log.reference_m.shape}; (n, 3) each"
    require(shapes, vehicle, rule)
    require(bool((np.diff(log.time_s) >= 0).all()), vehicle, "the times of its log do not ascend")
    require(bool(np.isfinite(log.position_m).all()), vehicle, "the positions of its log are not finite")


def _straight(state: VehicleState, goal_m: np.ndarray, speed_mps: float) -> Trajectory:
    """From rest to rest along a line, smooth in acceleration."""
    start_m = np.asarray(state.position_m, float)
    duration_s = float(np.linalg.norm(goal_m - start_m)) / speed_mps
    time_s = np.linspace(0.0, duration_s, max(round(duration_s / 0.02), 2) + 1)
    t = (time_s / duration_s)[:, None]
    way = goal_m - start_m
    return Trajectory(
        time_s=time_s,
        position_m=start_m + way * (10 * t**3 - 15 * t**4 + 6 * t**5),
        velocity_mps=way * (30 * t**2 - 60 * t**3 + 30 * t**4) / duration_s,
        acceleration_mps2=way * (60 * t - 180 * t**2 + 120 * t**3) / duration_s**2,
        yaw_rad=np.full(len(time_s), state.yaw_rad),
    )
