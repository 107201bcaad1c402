"""Check of vehicles: simulators and links to autopilots."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from mintpilot.conformance.sample import require
from mintpilot.core.geometry import Vec3
from mintpilot.core.plan import Site, Stop
from mintpilot.core.ports import Vehicle
from mintpilot.core.task import Action
from mintpilot.core.trajectory import FlightEnd, FlightLog, Trajectory, VehicleState

NEAR_M = 0.5
"""A vehicle that is farther from where it should hover is not there."""


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
    log = vehicle.follow(_straight(begun, goal_m, speed_mps))
    _check_log(log, vehicle)
    require(log.end is FlightEnd.ARRIVED, vehicle, f"the free move ended '{log.end}' ({log.reason}); it must arrive")
    arrived = _state(vehicle)
    off_m = math.dist(arrived.position_m, goal_m)
    require(
        off_m <= NEAR_M, vehicle, f"it hovers {off_m:.2f} m from the end of the trajectory; within {NEAR_M} m it must"
    )
    require(arrived.time_s > begun.time_s, vehicle, "its clock stood still while it flew")
    require(arrived.endurance_left_s <= begun.endurance_left_s, vehicle, "it has more endurance after a flight")

    site = Site(position_m=arrived.position_m)
    vehicle.act(Stop(id="go:1", action=Action.GO, sites=(site,)), 0.5)
    require(_state(vehicle).time_s > arrived.time_s, vehicle, "its clock stood still while it acted")
    vehicle.hold()
    vehicle.hold()
    _check_stop(make(), move_m, speed_mps)


def _check_stop(vehicle: Vehicle, move_m: Vec3, speed_mps: float) -> None:
    """A watch is called with the state in flight, and its wish to stop is obeyed."""
    begun = _state(vehicle)
    seen: list[VehicleState] = []

    def watch(state: VehicleState) -> bool:
        seen.append(state)
        return True

    goal_m = np.asarray(begun.position_m) + move_m
    log = vehicle.follow(_straight(begun, goal_m, speed_mps), watch)
    _check_log(log, vehicle)
    require(bool(seen), vehicle, "the watch was never called in a flight of some seconds; at the camera's rate it must")
    require(len(seen) == 1, vehicle, f"the watch asked for a stop and was called {len(seen) - 1} times more")
    require(log.end is FlightEnd.INTERRUPTED, vehicle, f"the watch asked for a stop, but the flight ended '{log.end}'")
    speed = float(np.linalg.norm(_state(vehicle).velocity_mps))
    require(speed < 0.3, vehicle, f"it moves at {speed:.2f} m/s after a stop; it must hover")


def _state(vehicle: Vehicle) -> VehicleState:
    state = vehicle.state()
    numbers = [state.time_s, *state.position_m, *state.velocity_mps, state.yaw_rad]
    require(bool(np.isfinite(numbers).all()), vehicle, f"its state is not finite: {state}")
    return state


def _check_log(log: FlightLog, vehicle: Vehicle) -> None:
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
