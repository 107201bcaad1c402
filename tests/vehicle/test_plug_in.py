"""A vehicle that somebody else brings: its name is the scheme of an address."""

from importlib.metadata import EntryPoint
from pathlib import Path

import pytest

from mintpilot.assembly import registry
from mintpilot.assembly.api import vehicle_choice
from mintpilot.assembly.components import VehicleChoice
from mintpilot.assembly.real_vehicle import make_vehicle
from mintpilot.assembly.worlds import build_world
from mintpilot.core.errors import UnknownNameError
from mintpilot.mission_file.reader import read_mission

EXAMPLES = Path(__file__).parents[2] / "examples"


class ToyVehicle:
    """Keeps what it was made with."""

    def __init__(self, address, envelope, *, endurance_s, georeference, accept_failsafes):
        self.address, self.envelope, self.accepted = address, envelope, accept_failsafes


@pytest.fixture
def installed(monkeypatch):
    entry = EntryPoint(name="toy", value=f"{__name__}:ToyVehicle", group="mintpilot.vehicle")
    monkeypatch.setattr(registry, "_plug_ins", lambda port: (entry,) if port == "vehicle" else ())


def test_ours_is_in_the_table():
    assert registry.names("vehicle") == ("mavlink",)
    assert registry.load("vehicle", "mavlink").__name__ == "MavlinkVehicle"


@pytest.mark.usefixtures("installed")
def test_a_plug_in_is_called_with_the_address_and_what_is_safe():
    assert vehicle_choice("toy://attic") is VehicleChoice.MAVLINK
    path = EXAMPLES / "medicine.yaml"
    world = build_world(read_mission(path), base=path.parent, seed=0)
    vehicle = make_vehicle(world, "toy://attic", accept_failsafes=True)
    assert isinstance(vehicle, ToyVehicle)
    assert vehicle.address == "toy://attic"
    assert vehicle.accepted
    assert vehicle.envelope.volume.contains([world.mission.start_m])[0]


def test_a_scheme_that_nobody_brings_is_told():
    with pytest.raises(UnknownNameError, match="mavlink"):
        vehicle_choice("toy://attic")
