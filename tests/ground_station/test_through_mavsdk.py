"""Plans that are written here are read, uploaded and downloaded again by MAVSDK's own importer."""

from __future__ import annotations

import math

import pytest

from mintpilot.conformance.vehicle_double.fence import HOME_ALTITUDE_M, HOME_DEG
from mintpilot.conformance.vehicle_double.parameters import Flavour
from mintpilot.conformance.vehicle_double.serving import DoubleSetup, VehicleDouble, free_port
from mintpilot.core.georeference import GeodeticPoint
from mintpilot.ground_station.flight_plan import FlightPlan, Item, ItemKind
from mintpilot.ground_station.qgroundcontrol import Firmware, plan_text
from mintpilot.vehicle.address import parse_address
from mintpilot.vehicle.connecting import connected

pytest.importorskip("mavsdk", reason="needs mavsdk")
pytest.importorskip("pymavlink", reason="needs pymavlink")
pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("mavlink")]

TAKE_OFF, WAYPOINT, GRIPPER, RETURN = 22, 16, 211, 20


def place(north_m: float, east_m: float, up_m: float) -> GeodeticPoint:
    latitude, longitude = HOME_DEG
    return GeodeticPoint(
        latitude_deg=latitude + north_m / 111_319.5,
        longitude_deg=longitude + east_m / (111_319.5 * math.cos(math.radians(latitude))),
        altitude_m=up_m,
    )


PLAN = FlightPlan(
    home=GeodeticPoint(latitude_deg=HOME_DEG[0], longitude_deg=HOME_DEG[1], altitude_m=HOME_ALTITUDE_M),
    items=(
        Item(kind=ItemKind.TAKE_OFF, place=place(0, 0, 3)),
        Item(kind=ItemKind.WAYPOINT, place=place(5, 4, 3), hold_s=2.0),
        Item(kind=ItemKind.GRAB),
        Item(kind=ItemKind.WAYPOINT, place=place(1, -4, 2)),
        Item(kind=ItemKind.RELEASE),
    ),
    fence=tuple((place(n, e, 0).latitude_deg, place(n, e, 0).longitude_deg) for n, e in ((-9, -9), (9, -9), (9, 9))),
    rally=(place(0, 0, 3),),
)


@pytest.mark.parametrize(("flavour", "firmware"), [(Flavour.PX4, "px4"), (Flavour.ARDUPILOT, "ardupilot")])
def test_a_plan_goes_through_mavsdks_importer_to_the_autopilot_and_back(flavour: Flavour, firmware: Firmware) -> None:
    from mavsdk.plugins.mission_raw import MissionRaw

    port = free_port()
    with VehicleDouble(DoubleSetup(flavour=flavour, port=port)) as double:
        mavsdk, system = connected(parse_address(f"mavlink://udpin:127.0.0.1:{port}"))
        try:
            raw = MissionRaw(system)
            imported = raw.import_qgroundcontrol_mission_from_string(plan_text(PLAN, firmware))
            raw.upload_mission(imported.mission_items)
            raw.upload_geofence(imported.geofence_items)
            back = raw.download_mission()
            state = double.state()
        finally:
            mavsdk.destroy()
    home_first = flavour is Flavour.ARDUPILOT  # item 0 is home there, and nothing is flown to it
    expected = (WAYPOINT,) * home_first + (TAKE_OFF, WAYPOINT, GRIPPER, WAYPOINT, GRIPPER)
    assert state.mission_commands == expected
    assert [item.command for item in back] == list(expected)
    assert state.fence_corners == 3
    first = back[1 + home_first]
    assert (first.x / 1e7, first.y / 1e7, first.z) == pytest.approx(
        (PLAN.items[1].place.latitude_deg, PLAN.items[1].place.longitude_deg, 3.0), abs=2e-7
    )
    assert first.param1 == pytest.approx(2.0)
    if home_first:
        assert (back[0].x / 1e7, back[0].y / 1e7) == pytest.approx(HOME_DEG, abs=2e-7)
