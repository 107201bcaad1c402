"""Thirty random sequences of faults through the real library: whatever happens, it is left safe."""

from __future__ import annotations

import time
from random import Random

import pytest
from tests.vehicle.test_through_mavsdk import both, set_out, waited

from mintpilot.conformance.vehicle_double.faults import Fault
from mintpilot.conformance.vehicle_double.parameters import Flavour
from mintpilot.conformance.vehicle_double.room import PAD, room
from mintpilot.core.errors import DeviceError
from mintpilot.core.motion import Land, TakeOff
from mintpilot.vehicle.mavlink_vehicle import MavlinkVehicle

pytest.importorskip("mavsdk", reason="needs mavsdk")
pytest.importorskip("pymavlink", reason="needs pymavlink")
pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("mavlink")]

FAULTS = (Fault.SILENCE, Fault.HEARTBEAT, Fault.POSITION_LOST, Fault.POSITION_JUMP, Fault.PILOT, Fault.BATTERY,
          Fault.DELAY, Fault.REORDER, Fault.DUPLICATE, Fault.CORRUPT)  # fmt: skip
GOALS = [(4.0, 3.0, 1.5), (3.0, 6.0, 2.0), (7.0, 2.0, 1.2)]


@pytest.mark.parametrize("seed", range(30))
def test_it_is_left_safe(seed):
    random = Random(seed)
    flavour = random.choice(list(Flavour))
    west = random.random() < 0.3
    with both(flavour, envelope=room(landable="west" if west else True)) as (double, vehicle):
        piloted = _fly(double, vehicle, random)
        if piloted:
            time.sleep(1.5)
            before = len(double.state().set_points_s)
            time.sleep(1.0)
            assert len(double.state().set_points_s) == before, "set-points while a pilot flies"
            assert double.state().mode == "pilot"
            double.switch_on(Fault.SILENCE)  # nobody needs our heartbeats any more
            return
        vehicle.close()
        assert waited(lambda: _is_safe(double.state()), 60.0), double.state()


def _fly(double, vehicle: MavlinkVehicle, random: Random) -> bool:
    """Flies about while faults come; whether a pilot has taken over."""
    piloted = False
    try:
        vehicle.command(TakeOff(id=1, height_m=PAD[2]))
        for number in range(4):
            vehicle.advance(vehicle.state().time_s + random.uniform(1.0, 4.0))
            if vehicle.airborne and random.random() < 0.7:
                set_out(vehicle, random.choice(GOALS))
            if random.random() < 0.6:
                fault = random.choice(FAULTS)
                double.switch_on(fault)
                piloted = piloted or (fault is Fault.PILOT and double.state().airborne)
            if random.random() < 0.2:
                time.sleep(random.uniform(0.2, 4.0))  # the loop hangs
            if random.random() < 0.2:
                vehicle.brake()
            if random.random() < 0.1:
                vehicle.command(Land(id=100 + number))
    except DeviceError:
        pass  # the link is gone, and that was said
    return piloted


def _is_safe(state) -> bool:
    """On the ground, in its own fail-safe or landing, or hovering."""
    still = max(map(abs, state.velocity)) < 0.2
    return (
        (not state.airborne and not state.armed)
        or (still and state.mode in ("hold", "follow"))
        or state.mode == "pilot"
    )
