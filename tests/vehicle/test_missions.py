"""Whole missions over MAVLink, in real time, against the vehicle double."""

from __future__ import annotations

import math
import threading
import time
from pathlib import Path

import pytest
import yaml
from pymap3d import enu2geodetic

from mintpilot.assembly.api import run_mission
from mintpilot.assembly.preflight import preflight
from mintpilot.assembly.worlds import build_world
from mintpilot.cli.main import main
from mintpilot.conformance.vehicle_double.faults import Fault, TimedFault
from mintpilot.conformance.vehicle_double.fence import HOME_ALTITUDE_M, HOME_DEG
from mintpilot.conformance.vehicle_double.parameters import Flavour
from mintpilot.conformance.vehicle_double.serving import DoubleSetup, DoubleState, VehicleDouble, free_port
from mintpilot.core.events import Asked, FrameSeen
from mintpilot.core.inputs import Ordered
from mintpilot.core.query import Order
from mintpilot.mission_file.reader import read_mission
from mintpilot.mission_file.schema import MissionFile

pytest.importorskip("mavsdk", reason="needs mavsdk")
pytest.importorskip("pymavlink", reason="needs pymavlink")
pytestmark = pytest.mark.xdist_group("mavlink")

FLAVOURS = list(Flavour)
EXAMPLES = Path(__file__).parents[2] / "examples"


class Helper:
    """Nobody who answers, but somebody who says 'continue' when a thing was attached or taken."""

    attended = False
    hears_once = False

    def __init__(self) -> None:
        self.told: list[str] = []
        self._done = 0

    def show(self, question, patience_s):
        """It does not answer."""

    def withdraw(self, question, why):
        """Nothing to do."""

    def tell(self, text):
        self.told.append(text)

    def poll(self, time_s):
        wanted = sum("by hand" in text for text in self.told)
        orders = [Ordered(time_s=time_s, order=Order.CONTINUE)] * (wanted - self._done)
        self._done = wanted
        return tuple(orders)


def flown(
    mission: str, flavour: Flavour, *faults: TimedFault, later: Fault | None = None, operator="scripted", tmp=None
):
    """The record of a mission, the double in the end, and the events; ``later`` comes once the drone flies level."""
    path = EXAMPLES / f"{mission}.yaml"
    world = build_world(read_mission(path), base=path.parent, seed=0)
    setup = DoubleSetup(flavour=flavour, port=free_port(), faults=faults, scene=world.scene, rules=world.rules)
    events = []
    with VehicleDouble(setup) as double:
        watch = threading.Thread(target=_switch_on, args=(double, later)) if later is not None else None
        if watch is not None:
            watch.start()
        record = run_mission(
            path, vehicle=f"mavlink://udpin:127.0.0.1:{setup.port}", seed=0, operator=operator, out=tmp,
            progress=events.append,
        )  # fmt: skip
        if watch is not None:
            watch.join()
        return record, double.state(), events


def _switch_on(double: VehicleDouble, fault: Fault) -> None:
    """Once it flies level; a pilot brings it down in the end, so that the program may."""
    end_s = time.monotonic() + 120
    while time.monotonic() < end_s and max(map(abs, double.state().velocity[:2])) < 0.5:
        time.sleep(0.05)
    double.switch_on(fault)
    if fault is Fault.PILOT:
        time.sleep(5.0)
        double.switch_on(Fault.SILENCE)


def is_down(state: DoubleState) -> bool:
    return not state.armed and not state.airborne


@pytest.mark.flight
@pytest.mark.parametrize("flavour", FLAVOURS)
def test_the_medicine_is_brought(flavour, tmp_path):
    record, state, events = flown("medicine", flavour, tmp=tmp_path / "run")
    assert record.outcome.value == "success", record.reason
    assert is_down(state)
    assert not state.verdict
    assert [event for event in events if isinstance(event, Asked)]
    assert main(["replay", str(tmp_path / "run"), "--verify"]) == 0


@pytest.mark.slow
@pytest.mark.parametrize("flavour", FLAVOURS)
def test_the_person_in_the_burning_warehouse_is_reached(flavour):
    record, state, events = flown("fire-warehouse", flavour)
    assert record.outcome.value == "success", record.reason
    assert is_down(state)
    assert not state.verdict
    assert [event for event in events if isinstance(event, Asked)]


@pytest.mark.slow
@pytest.mark.sim
@pytest.mark.parametrize("flavour", FLAVOURS)
def test_with_a_camera_it_makes_its_own_map_and_asks(flavour):
    """Nothing is known of the room before the flight: pictures are drawn where the double says it is."""
    pytest.importorskip("mujoco", reason="needs MuJoCo")
    path = EXAMPLES / "medicine.yaml"
    world = build_world(read_mission(path), base=path.parent, seed=0)
    setup = DoubleSetup(flavour=flavour, port=free_port(), scene=world.scene, rules=world.rules, camera_port=0)
    events = []
    with VehicleDouble(setup) as double:
        record = run_mission(
            path, vehicle=f"mavlink://udpin:127.0.0.1:{setup.port}", camera=f"sim://127.0.0.1:{double.state().camera_port}",
            seed=0, progress=events.append,
        )  # fmt: skip
        assert record.outcome.value == "success", record.reason
        assert is_down(double.state())
        assert not double.state().verdict
    assert [event for event in events if isinstance(event, Asked)]
    assert [event for event in events if isinstance(event, FrameSeen)]


@pytest.mark.slow
def test_without_a_gripper_somebody_is_asked_to_lend_a_hand():
    helper = Helper()
    record, state, _ = flown("medicine", Flavour.PX4, TimedFault(fault=Fault.NO_GRIPPER), operator=("scripted", helper))
    assert record.outcome.value == "success", record.reason
    assert is_down(state)
    assert sum("by hand" in text for text in helper.told) == 2


@pytest.mark.slow
@pytest.mark.parametrize("flavour", FLAVOURS)
@pytest.mark.parametrize(
    ("fault", "outcome"),
    [
        (Fault.PILOT, "aborted"),
        (Fault.SILENCE, "vehicle-failed"),
        (Fault.HEARTBEAT, "vehicle-failed"),
        (Fault.POSITION_JUMP, "no-safe-plan"),
    ],
)
def test_a_fault_in_flight_ends_the_mission_safely(flavour, fault, outcome):
    record, state, _ = flown("medicine", flavour, later=fault)
    assert record.outcome.value == outcome, record.reason
    assert not state.verdict
    assert state.mode in ("land", "hold", "pilot")


@pytest.mark.slow
@pytest.mark.parametrize("flavour", FLAVOURS)
def test_preflight_sets_and_reads_back(flavour, capsys):
    port = free_port()
    with VehicleDouble(DoubleSetup(flavour=flavour, port=port)) as double:
        checks = preflight(EXAMPLES / "medicine.yaml", f"mavlink://udpin:127.0.0.1:{port}")
        assert all(check.ok for check in checks), [check for check in checks if not check.ok]
        assert double.state().fence_corners == 4
        assert not double.state().armed


@pytest.mark.slow
@pytest.mark.parametrize("flavour", FLAVOURS)
def test_a_map_that_lies_on_the_earth_and_is_turned(flavour):
    """The double is at home; the map's origin lies where its start is there, its y axis pointing to the north-east."""
    heading = math.radians(40)
    x, y = 1.5, 5.0
    east, north = x * math.cos(heading) + y * math.sin(heading), y * math.cos(heading) - x * math.sin(heading)
    latitude, longitude, _ = enu2geodetic(-east, -north, 0.0, *HOME_DEG, HOME_ALTITUDE_M)
    base = EXAMPLES / "my-building"
    mission = yaml.safe_load((base / "mission.yaml").read_text())
    mission["world"]["georeference"] = {
        "latitude": float(latitude), "longitude": float(longitude), "altitude_m": HOME_ALTITUDE_M,
        "heading_rad": heading,
    }  # fmt: skip
    port = free_port()
    with VehicleDouble(DoubleSetup(flavour=flavour, port=port)) as double:
        record = run_mission(
            MissionFile.model_validate(mission), base=base, vehicle=f"mavlink://udpin:127.0.0.1:{port}"
        )
        assert record.outcome.value == "success", record.reason
        assert is_down(double.state())
        assert double.state().fence_corners == 4
