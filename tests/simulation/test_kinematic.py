"""The kinematic simulator: exact flight, geometry of touches, interruptions, refusals."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.driving import act, ended, follow, land

from mintpilot.core.errors import DeviceError, InputError
from mintpilot.core.mission import Outcome
from mintpilot.core.motion import FollowTrajectory, MotionEnd, PerformAction
from mintpilot.core.task import Action
from mintpilot.core.trajectory import FlightEnd, Trajectory, VehicleState
from mintpilot.simulation.kinematic import KinematicSimulator
from mintpilot.simulation.obstacles import Obstacles
from mintpilot.simulation.reference import BRAKING_MPS2, braked
from mintpilot.simulation.scene import FlightRules, Person, Scene, Shape

from .flights import START, block, line, room, scene, smoke, stop

RULES = FlightRules()


def simulator(world: Scene | None = None, rules: FlightRules = RULES) -> KinematicSimulator:
    return KinematicSimulator(world or scene(), rules, seed=0)


def test_flies_exactly_and_hovers() -> None:
    vehicle = simulator()
    way = line(START, (6, 4, 2))
    log = follow(vehicle, way)
    assert log.end is FlightEnd.ARRIVED
    np.testing.assert_allclose(log.position_m[-1], (6, 4, 2))
    assert (log.position_m == log.reference_m).all()
    state = vehicle.state()
    assert state.time_s == pytest.approx(way.duration_s)
    assert state.velocity_mps == (0, 0, 0)
    assert state.yaw_rad == pytest.approx(way.yaw_rad[-1])


def test_a_wall_in_the_way_is_a_collision_and_ends_it() -> None:
    vehicle = simulator(scene(solids=(block((5, 0, 0), (5.2, 8, 3)),)))
    log = follow(vehicle, line(START, (8, 2, 1.5)))
    assert log.end is FlightEnd.FAILED
    assert "crate-1" in log.reason
    assert log.position_m[-1, 0] == pytest.approx(5 - RULES.radius_m, abs=0.06)
    verdict = vehicle.verdict()
    assert verdict is not None
    assert verdict.outcome is Outcome.COLLISION
    here = vehicle.state().position_m
    again = follow(vehicle, line(here, START))
    assert again.end is FlightEnd.FAILED
    act(vehicle, stop(Action.GO, here), 1.0)
    vehicle.hold()
    assert vehicle.state().position_m == here


@pytest.mark.long
@settings(deadline=None, max_examples=200)
@given(
    shape=st.sampled_from(Shape),
    point=st.tuples(st.floats(3.0, 7.0), st.floats(2.0, 6.0), st.floats(0.2, 3.2)),
    size=st.tuples(st.floats(0.2, 2.0), st.floats(0.2, 2.0), st.floats(0.2, 1.0)),
)
def test_touching_is_hull_against_shape(
    shape: Shape, point: tuple[float, float, float], size: tuple[float, float, float]
) -> None:
    """Against the least distance over a cloud of points of the solid's volume."""
    centre = np.array([5.0, 4.0, 1.5])
    half = np.asarray(size) / 2
    solid = block(tuple(centre - half), tuple(centre + half), shape=shape)
    grid = np.stack(np.meshgrid(*[np.linspace(-1, 1, 41)] * 3), axis=-1).reshape(-1, 3) * half
    if shape is Shape.CYLINDER:
        grid = grid[np.hypot(grid[:, 0], grid[:, 1]) <= half[:2].min()]
    if shape is Shape.SPHERE:
        grid = grid[np.linalg.norm(grid, axis=1) <= half.min()]
    off = grid + centre - point
    slack = 0.06  # of the cloud
    hull = np.maximum(np.hypot(off[:, 0], off[:, 1]) - RULES.radius_m, np.abs(off[:, 2]) - RULES.half_height_m)
    touched = Obstacles(scene(solids=(solid,)), RULES).first_touch(np.array([point]), np.zeros(1))
    if hull.min() < -1e-9:
        assert touched == (0, "crate-1")
    elif hull.min() > slack:
        assert touched is None


@pytest.mark.parametrize(
    ("goal", "what"), [((11.9, 2, 1.5), "outer wall"), ((10.5, 6, 1.5), "room-1"), ((8, 2.0, 0.3), "person-1")]
)
def test_walls_rooms_and_people_can_be_touched(goal: tuple[float, float, float], what: str) -> None:
    world = scene(rooms=(room(None),), persons=(Person(id="person-1", position_m=(8, 2, 0)),))
    log = follow(simulator(world), line(START, goal))
    assert log.end is FlightEnd.FAILED
    assert what in log.reason


def test_late_solids_count_from_their_time_of_the_mission_on() -> None:
    world = scene(solids=(block((5, 0, 0), (5.2, 8, 3), appears_s=6.0),))
    early, late, survey = simulator(world), simulator(world), simulator(world)
    early.begin_mission()
    assert follow(early, line(START, (8, 2, 1.5))).end is FlightEnd.ARRIVED
    late.begin_mission()
    act(late, stop(Action.GO, START), 6.0)
    assert follow(late, line(START, (8, 2, 1.5))).end is FlightEnd.FAILED
    act(survey, stop(Action.GO, START), 6.0)
    assert follow(survey, line(START, (8, 2, 1.5))).end is FlightEnd.ARRIVED


@pytest.mark.parametrize("wish_s", [0.4, 1.0, 2.2])
def test_the_watch_stops_it_on_its_way(wish_s: float) -> None:
    vehicle = simulator()
    way = line(START, (9, 2, 1.5))
    seen: list[VehicleState] = []

    def watch(state: VehicleState) -> bool:
        seen.append(state)
        return state.time_s >= wish_s

    log = follow(vehicle, way, watch)
    assert log.end is FlightEnd.INTERRUPTED
    np.testing.assert_allclose(np.diff([s.time_s for s in seen]), 0.5)
    assert vehicle.state().velocity_mps == (0, 0, 0)
    assert START[0] < vehicle.state().position_m[0] < 9
    assert (np.diff(log.time_s) > 0).all()
    speed = np.linalg.norm(np.diff(log.position_m, axis=0), axis=1) / np.diff(log.time_s)
    assert speed[-1] < 0.1
    assert np.abs(np.diff(speed)).max() < 0.2, "no jolt"
    assert follow(vehicle, line(vehicle.state().position_m, START)).end is FlightEnd.ARRIVED


def test_braking_keeps_to_the_curve_and_its_own_derivatives() -> None:
    way = line(START, (9, 5, 2.5), step_s=0.002)
    stop_way = braked(way, way.duration_s / 2, 0.002)
    velocity = np.diff(stop_way.position_m, axis=0) / 0.002
    np.testing.assert_allclose(velocity, (stop_way.velocity_mps[1:] + stop_way.velocity_mps[:-1]) / 2, atol=5e-3)
    acceleration = np.diff(stop_way.velocity_mps, axis=0) / 0.002
    middle = (stop_way.acceleration_mps2[1:] + stop_way.acceleration_mps2[:-1]) / 2
    np.testing.assert_allclose(acceleration[:-1], middle[:-1], atol=2e-2)
    own = np.linalg.norm(way.acceleration_mps2, axis=1).max()
    assert np.linalg.norm(stop_way.acceleration_mps2, axis=1).max() <= BRAKING_MPS2 + own
    assert not stop_way.velocity_mps[-1].any()


def test_smoke_endurance_and_volume_end_the_flight() -> None:
    toxic = simulator(scene(smokes=(smoke(toxic=True),)))
    log = follow(toxic, line(START, (8, 2, 1.5)))
    assert log.end is FlightEnd.FAILED
    assert log.position_m[-1, 0] == pytest.approx(5.0 - RULES.radius_m, abs=0.06)
    tired = simulator(rules=FlightRules(endurance_s=3.0))
    tired.begin_mission()
    assert tired.state().endurance_left_s == 3.0
    log = follow(tired, line(START, (9, 2, 1.5)))
    assert log.time_s[-1] == pytest.approx(3.0, abs=0.05)
    assert tired.final().outcome is Outcome.ENDURANCE
    high = simulator()
    follow(high, line(START, (2, 2, 4)))
    assert high.final().outcome is Outcome.LEFT_VOLUME


def test_acts_take_their_time() -> None:
    vehicle = simulator(rules=FlightRules(endurance_s=5.0))
    vehicle.begin_mission()
    act(vehicle, stop(Action.GO, START), 2.0)
    assert vehicle.state().endurance_left_s == pytest.approx(3.0)
    act(vehicle, stop(Action.GO, START), 4.0)
    assert vehicle.final().outcome is Outcome.ENDURANCE


def broken(**changes: np.ndarray) -> Trajectory:
    way = line(START, (6, 2, 1.5))
    fields = {name: np.array(getattr(way, name)) for name in Trajectory.__slots__}
    return Trajectory(**{**fields, **changes})


def bad_trajectories() -> list[tuple[Trajectory, type[Exception], str]]:
    n = len(line(START, (6, 2, 1.5)).time_s)
    nan = np.full((n, 3), np.nan)
    none = Trajectory(
        time_s=np.zeros(0),
        position_m=np.zeros((0, 3)),
        velocity_mps=np.zeros((0, 3)),
        acceleration_mps2=np.zeros((0, 3)),
        yaw_rad=np.zeros(0),
    )
    return [
        (none, InputError, "empty"),
        (broken(position_m=nan), InputError, "position_m is not finite at sample 0"),
        (broken(velocity_mps=np.zeros((n, 2))), InputError, "velocity_mps has shape"),
        (broken(time_s=np.zeros(n)), InputError, "do not ascend"),
        (line((4, 2, 1.5), (6, 2, 1.5)), DeviceError, "2.00 m from the vehicle"),
    ]


@pytest.mark.parametrize(("way", "error", "words"), bad_trajectories())
def test_what_cannot_be_followed_is_refused(way: Trajectory, error: type[Exception], words: str) -> None:
    vehicle = simulator()
    if error is DeviceError:
        refused = ended(vehicle, FollowTrajectory(id=1, trajectory=way))
        assert refused.end is MotionEnd.REFUSED
        assert words in refused.reason
    else:
        with pytest.raises(error, match=words):
            follow(vehicle, way)
    assert vehicle.state().position_m == START
    assert follow(vehicle, line(START, (6, 2, 1.5))).end is FlightEnd.ARRIVED


def test_it_lands_on_the_ground_and_on_what_stands_there() -> None:
    free = simulator()
    assert land(free).end is MotionEnd.ARRIVED
    assert free.state().position_m[2] == pytest.approx(0.15, abs=0.01)
    box = simulator(scene(solids=(block((1, 1, 0), (3, 3, 0.8)),)))
    assert land(box).end is MotionEnd.ARRIVED
    assert 0.8 < box.state().position_m[2] < 1.0
    assert box.verdict() is None


def test_an_act_that_is_broken_off_does_not_count() -> None:
    vehicle = simulator()
    begun = vehicle.state().time_s
    event = ended(vehicle, PerformAction(id=1, stop=stop(Action.GO, START), dwell_s=5.0), lambda state: True)
    assert event.end is MotionEnd.STOPPED
    assert vehicle.state().time_s - begun < 1.0
