"""Flight by physics, and that both simulators mean the same."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from itertools import pairwise

import numpy as np
import pytest
from tests.driving import act, follow

from mintpilot.core.errors import DeviceError
from mintpilot.core.geometry import Vec3
from mintpilot.core.mission import Outcome
from mintpilot.core.task import Action
from mintpilot.core.trajectory import FlightEnd, FlightLog, VehicleState
from mintpilot.simulation.kinematic import KinematicSimulator
from mintpilot.simulation.mujoco_vehicle import MujocoSimulator
from mintpilot.simulation.scene import FlightRules, Person, Scene

from .flights import START, block, line, room, scene, smoke, stop

pytest.importorskip("mujoco", reason="MuJoCo is not installed")
pytestmark = pytest.mark.sim

RULES = FlightRules()
ROUTE: tuple[Vec3, ...] = (START, (6, 2, 1.5), (6, 6, 2.0), (9, 4, 1.2), (3, 6, 2.5))


def rms_m(logs: list[FlightLog]) -> float:
    errors = np.concatenate([np.linalg.norm(log.position_m - log.reference_m, axis=1) for log in logs])
    return float(np.sqrt((errors**2).mean()))


def fly_route(seed: int, rules: FlightRules = RULES) -> tuple[MujocoSimulator, list[FlightLog]]:
    vehicle = MujocoSimulator(scene(), rules, seed=seed)
    return vehicle, [follow(vehicle, line(a, b, speed_mps=0.8)) for a, b in pairwise(ROUTE)]


def test_tracks_closely_in_noise_and_gusts() -> None:
    """Peak speed 1.5 m/s, 0.01 m noise, 0.2 N gusts: the target is 0.05 m."""
    vehicle, logs = fly_route(seed=1)
    assert all(log.end is FlightEnd.ARRIVED for log in logs)
    assert max(np.linalg.norm(np.diff(log.position_m, axis=0), axis=1).max() for log in logs) > 0.02
    assert 0.002 < rms_m(logs) < 0.05
    assert vehicle.final().outcome is Outcome.SUCCESS


def test_same_seed_same_flight_and_other_seeds_differ() -> None:
    (_, a), (_, b), (_, c) = fly_route(3), fly_route(3), fly_route(4)
    for first, second in zip(a, b, strict=True):
        np.testing.assert_array_equal(first.position_m, second.position_m)
    assert not np.array_equal(a[0].position_m[:50], c[0].position_m[:50])


def test_measured_positions_are_noisy_and_logged_ones_true() -> None:
    vehicle = MujocoSimulator(scene(), RULES, seed=0)
    seen = np.array([vehicle.state().position_m for _ in range(400)])
    assert seen.std(axis=0) == pytest.approx(RULES.position_noise_m, rel=0.2)
    np.testing.assert_allclose(seen.mean(axis=0), START, atol=0.003)
    exact = MujocoSimulator(scene(), FlightRules(position_noise_m=0.0), seed=0)
    assert exact.state().position_m == START


def worlds() -> list[tuple[str, Scene, Vec3, Outcome]]:
    occupant = Person(id="person-2", position_m=(10.5, 6.5, 0), must_be_found=False)
    return [
        ("free", scene(), (8, 5, 2), Outcome.SUCCESS),
        ("wall", scene(solids=(block((5, 0, 0), (5.2, 8, 3), kind="wall"),)), (8, 2, 1.5), Outcome.COLLISION),
        ("room", scene(rooms=(room(occupant),)), (10.5, 6.5, 1.5), Outcome.COLLISION),
        ("side", scene(), (11.95, 2, 1.5), Outcome.COLLISION),
        ("smoke", scene(smokes=(smoke(toxic=True),)), (8, 2, 1.5), Outcome.TOXIC_SMOKE),
        ("clear smoke", scene(smokes=(smoke(toxic=False),)), (8, 2, 1.5), Outcome.SUCCESS),
        ("roof", scene(), (2, 2, 3.7), Outcome.LEFT_VOLUME),
        ("late", scene(solids=(block((5, 0, 0), (5.2, 8, 3), appears_s=0.5),)), (8, 2, 1.5), Outcome.COLLISION),
        ("later", scene(solids=(block((5, 0, 0), (5.2, 8, 3), appears_s=60.0),)), (8, 2, 1.5), Outcome.SUCCESS),
    ]


@pytest.mark.parametrize(("world", "goal", "outcome"), [w[1:] for w in worlds()], ids=[w[0] for w in worlds()])
def test_both_simulators_mean_the_same(world: Scene, goal: Vec3, outcome: Outcome) -> None:
    way = line(START, goal)
    ends = []
    for vehicle in (KinematicSimulator(world, RULES, seed=0), MujocoSimulator(world, RULES, seed=0)):
        vehicle.begin_mission()
        log = follow(vehicle, way)
        assert vehicle.final().outcome is outcome
        assert (vehicle.verdict() is None) == (log.end is FlightEnd.ARRIVED)
        ends.append((log, vehicle.state()))
    (exact, at), (real, near) = ends
    np.testing.assert_allclose(real.position_m[-1], exact.position_m[-1], atol=0.15)
    assert real.time_s[-1] == pytest.approx(exact.time_s[-1], abs=1.0)
    assert near.yaw_rad == pytest.approx(at.yaw_rad, abs=0.1)


def test_the_watch_stops_it_and_it_flies_on() -> None:
    for vehicle in (KinematicSimulator(scene(), RULES, seed=0), MujocoSimulator(scene(), RULES, seed=0)):
        seen: list[VehicleState] = []
        log = follow(vehicle, line(START, (9, 2, 1.5)), _after(1.6, seen))
        assert log.end is FlightEnd.INTERRUPTED
        np.testing.assert_allclose(np.diff([s.time_s for s in seen]), 0.5, atol=1e-6)
        state = vehicle.state()
        assert np.linalg.norm(state.velocity_mps) < 0.1
        assert 3 < state.position_m[0] < 8
        assert follow(vehicle, line(state.position_m, START)).end is FlightEnd.ARRIVED


def _after(time_s: float, seen: list[VehicleState]) -> Callable[[VehicleState], bool]:
    def watch(state: VehicleState) -> bool:
        seen.append(state)
        return state.time_s > time_s

    return watch


def test_touching_the_floor_is_a_collision() -> None:
    vehicle = MujocoSimulator(scene(), RULES, seed=0)
    log = follow(vehicle, line(START, (2, 2, 0.02), speed_mps=0.6))
    assert log.end is FlightEnd.FAILED
    assert vehicle.final().outcome is Outcome.COLLISION
    assert follow(vehicle, line(vehicle.state().position_m, START)).end is FlightEnd.FAILED
    act(vehicle, stop(Action.GO, START), 0.5)
    vehicle.hold()


def test_holding_and_acting_keep_the_place() -> None:
    vehicle = MujocoSimulator(scene(), RULES, seed=2)
    vehicle.begin_mission()
    for _ in range(5):
        act(vehicle, stop(Action.GO, START), 2.0)
        vehicle.hold()
    state = vehicle.state()
    assert state.time_s == pytest.approx(10.0, abs=1.0)
    np.testing.assert_allclose(state.position_m, START, atol=0.12)


def test_a_closed_simulator_says_so() -> None:
    with MujocoSimulator(scene(), RULES, seed=0) as vehicle:
        pass
    vehicle.close()
    vehicle.hold()
    with pytest.raises(DeviceError, match="closed"):
        follow(vehicle, line(START, (3, 2, 1.5)))
    with pytest.raises(DeviceError, match="closed"):
        vehicle.capture()


def test_pictures_come_from_the_drone() -> None:
    with MujocoSimulator(scene(), RULES, seed=0, camera_size=(64, 48)) as vehicle:
        frame = vehicle.capture()
        assert frame.rgb.shape == (48, 64, 3)
        pose = frame.world_from_camera
        assert np.linalg.norm(pose[:3, 3] - START) < 0.3
        assert pose[0, 2] > 0.9, "looks along x"
        assert -0.5 < pose[2, 2] < -0.05, "slightly down"
        ahead = frame.depth_m[24, 28:36]
        assert np.nanmedian(ahead) == pytest.approx(5.5, abs=1.0), "the floor, 15 degrees down from 1.5 m"


def test_the_package_imports_without_mujoco_and_says_what_to_install() -> None:
    code = (
        "import sys; sys.modules['mujoco'] = None\n"
        "from mintpilot.core.errors import MissingPartError\n"
        "from mintpilot.core.geometry import Box\n"
        "from mintpilot.simulation.mujoco_vehicle import MujocoSimulator\n"
        "from mintpilot.simulation.scene import FlightRules, Scene\n"
        "scene = Scene(name='x', volume=Box(lo_m=(0, 0, 0), hi_m=(4, 4, 3)), start_m=(2, 2, 1))\n"
        "try:\n"
        "    MujocoSimulator(scene, FlightRules(), seed=0)\n"
        "except MissingPartError as error:\n"
        "    print('mintpilot[sim]' in str(error))\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "True"
