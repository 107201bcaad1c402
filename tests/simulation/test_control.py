"""The controller and the airframe, without a physics engine."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mintpilot.simulation.control import GRAVITY_MPS2, Controller, slewed
from mintpilot.simulation.quadrotor import Airframe

AIRFRAME = Airframe()
LEVEL = np.array([1.0, 0.0, 0.0, 0.0])


def wrench(thrusts: np.ndarray) -> np.ndarray:
    """Thrust and torques that four rotor thrusts make."""
    return np.linalg.solve(AIRFRAME.mixer, thrusts)


def hover_reference() -> np.ndarray:
    return np.zeros(10)


def test_hovering_takes_the_weight_and_no_torque() -> None:
    out = Controller(AIRFRAME, 0.004).thrusts(np.zeros(3), LEVEL, np.zeros(3), np.zeros(3), hover_reference())
    np.testing.assert_allclose(wrench(out), [AIRFRAME.mass_kg * GRAVITY_MPS2, 0, 0, 0], atol=1e-12)


@settings(deadline=None, max_examples=50)
@given(
    position=st.tuples(*[st.floats(-50, 50)] * 3),
    velocity=st.tuples(*[st.floats(-20, 20)] * 3),
    quaternion=st.tuples(*[st.floats(-1, 1)] * 4).filter(lambda q: np.linalg.norm(q) > 0.1),
)
def test_thrusts_are_finite_and_within_the_rotors_reach(
    position: tuple[float, ...], velocity: tuple[float, ...], quaternion: tuple[float, ...]
) -> None:
    attitude = np.asarray(quaternion) / np.linalg.norm(quaternion)
    out = Controller(AIRFRAME, 0.004).thrusts(
        np.asarray(position), attitude, np.asarray(velocity), np.zeros(3), hover_reference()
    )
    assert ((out >= 0) & (out <= AIRFRAME.max_thrust_n)).all()


def test_tilts_towards_where_it_should_be() -> None:
    controller = Controller(AIRFRAME, 0.004)
    reference = hover_reference()
    reference[0] = 0.2
    forward = wrench(controller.thrusts(np.zeros(3), LEVEL, np.zeros(3), np.zeros(3), reference))
    assert forward[2] > 1e-3, "pitching nose down tips the thrust along x"
    assert forward[1] == pytest.approx(0.0, abs=1e-12)
    assert forward[3] == pytest.approx(0.0, abs=1e-12)
    reference = hover_reference()
    reference[9] = 0.3
    left = wrench(Controller(AIRFRAME, 0.004).thrusts(np.zeros(3), LEVEL, np.zeros(3), np.zeros(3), reference))
    assert left[3] > 1e-3, "turns counter-clockwise"


def test_the_integral_grows_against_a_steady_error_up_to_its_limit() -> None:
    controller = Controller(AIRFRAME, 0.004)
    low = np.array([0.0, 0.0, -0.1])
    lifts = [
        wrench(controller.thrusts(low, LEVEL, np.zeros(3), np.zeros(3), hover_reference()))[0] for _ in range(1000)
    ]
    assert lifts[100] > lifts[0]
    assert lifts[-1] == lifts[-2] == pytest.approx(lifts[0] + 1.5 * AIRFRAME.mass_kg, abs=0.02)


def test_the_mixer_inverts_the_rotors_geometry() -> None:
    for rotor, (x, y, sign) in enumerate(AIRFRAME.rotors):
        one = np.eye(4)[rotor]
        np.testing.assert_allclose(wrench(one), [1.0, y, -x, sign * AIRFRAME.drag_torque_m], atol=1e-12)


@settings(deadline=None, max_examples=50)
@given(start=st.floats(-4, 4), goal=st.floats(-20, 20))
def test_headings_slew_the_short_way_and_arrive(start: float, goal: float) -> None:
    out = slewed(np.full(200, goal), start, 0.02)
    steps = np.diff(np.concatenate([[start], out]))
    assert np.abs(steps).max() <= 0.02 + 1e-12
    assert np.abs(out - start).max() <= np.pi + 1e-9
    assert np.cos(out[-1] - goal) == pytest.approx(1.0)
