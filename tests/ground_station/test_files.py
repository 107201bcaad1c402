"""Flight plans in files: written, read back, refused."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mintpilot.core.errors import MapError, MissionError
from mintpilot.core.geometry import Box
from mintpilot.core.georeference import GeodeticPoint, Georeference
from mintpilot.core.mission import Mission
from mintpilot.core.plan import Leg, Plan, Site, Stop, VehicleLimits
from mintpilot.core.task import Action
from mintpilot.ground_station.flight_plan import FlightPlan, Item, ItemKind, flight_plan_of
from mintpilot.ground_station.geojson import geojson_text
from mintpilot.ground_station.qgroundcontrol import plan_text, read_plan
from mintpilot.ground_station.waypoints import read_waypoints, waypoints_text

PLACELESS = (ItemKind.GRAB, ItemKind.RELEASE, ItemKind.RETURN)
points = st.builds(
    GeodeticPoint,
    latitude_deg=st.floats(-89, 89).map(lambda x: round(x, 7)),
    longitude_deg=st.floats(-179, 179).map(lambda x: round(x, 7)),
    altitude_m=st.floats(0, 500).map(lambda x: round(x, 3)),
)
holds = st.floats(0, 100).map(lambda x: round(x, 3))
items = st.one_of(
    st.builds(Item, kind=st.just(ItemKind.WAYPOINT), place=points, hold_s=holds),
    st.builds(Item, kind=st.sampled_from([ItemKind.TAKE_OFF, ItemKind.HOVER, ItemKind.LAND]), place=points),
    st.builds(Item, kind=st.sampled_from(PLACELESS)),
)
plans = st.builds(FlightPlan, home=points, items=st.lists(items, max_size=6).map(tuple))


@pytest.mark.long
@given(
    plan=plans,
    fence=st.lists(st.tuples(st.floats(-80, 80), st.floats(-170, 170)), min_size=3, max_size=5).map(tuple),
    firmware=st.sampled_from(["px4", "ardupilot"]),
)
def test_a_plan_file_comes_back_as_it_was(plan: FlightPlan, fence: tuple, firmware: str) -> None:
    whole = FlightPlan(home=plan.home, items=plan.items, fence=fence, rally=(plan.home,), cruise_mps=3.0)
    assert read_plan(plan_text(whole, firmware), "x.plan") == whole  # type: ignore[arg-type]


@given(plan=plans)
def test_a_waypoint_list_comes_back_as_it_was(plan: FlightPlan) -> None:
    read = read_waypoints(waypoints_text(plan), "x.waypoints")
    assert read.home == plan.home
    assert read.items == plan.items


def mission(**changes: object) -> Mission:
    given: dict = {
        "name": "m",
        "instruction": "go",
        "start_m": (1.0, 1.0, 2.0),
        "volume": Box(lo_m=(0.0, 0.0, 0.0), hi_m=(100.0, 50.0, 10.0)),
        "limits": VehicleLimits(cruise_mps=3.0),
        "georeference": Georeference(latitude_deg=47.0, longitude_deg=8.0, altitude_m=400.0),
    }
    return Mission(**{**given, **changes})


def flown(*legs: tuple[Action, list]) -> Plan:
    made = []
    for number, (action, path) in enumerate(legs):
        stop = Stop(id=f"s{number}", action=action, sites=(Site(position_m=path[-1]),), dwell_s=4.0)
        made.append(Leg(stop=stop, site=stop.sites[0], path_m=np.asarray(path, float), length_m=1.0, duration_s=1.0))
    return Plan(legs=tuple(made), cost_s=1.0, relies_on=frozenset(), enters=frozenset())


def test_turning_points_stops_and_gripper_are_in_the_plan() -> None:
    start, bend, middle, box = (1, 1, 2), (11, 1, 2), (11, 6, 2), (11, 11, 3)
    plan = flight_plan_of(
        flown((Action.PICK, [start, bend, middle, (11, 8, 2), box]), (Action.GO, [box, start])), mission()
    )
    kinds = [item.kind for item in plan.items]
    assert kinds == [
        ItemKind.TAKE_OFF, ItemKind.WAYPOINT, ItemKind.WAYPOINT, ItemKind.WAYPOINT, ItemKind.GRAB,
        ItemKind.WAYPOINT, ItemKind.HOVER,
    ]  # fmt: skip
    assert [item.hold_s for item in plan.items] == [0, 0, 0, 4.0, 0, 4.0, 0]
    reference = mission().georeference
    assert reference is not None
    here = plan.items[3].place
    assert here is not None
    assert here.altitude_m == 3.0
    local = reference.local(
        GeodeticPoint(latitude_deg=here.latitude_deg, longitude_deg=here.longitude_deg, altitude_m=403)
    )
    assert local == pytest.approx(box, abs=1e-3)
    assert plan.home.altitude_m == pytest.approx(400.0, abs=1e-3)
    assert len(plan.fence) == 4


def test_what_cannot_be_exported_is_said() -> None:
    with pytest.raises(MapError, match=r"world\.georeference"):
        flight_plan_of(flown((Action.GO, [(0, 0, 1), (1, 0, 1)])), mission(georeference=None))
    with pytest.raises(MissionError, match="no legs"):
        flight_plan_of(flown(), mission())


def test_geojson_has_the_way_its_points_and_the_fence() -> None:
    plan = flight_plan_of(flown((Action.GO, [(1, 1, 2), (50, 40, 2)])), mission())
    document = json.loads(geojson_text(plan))
    kinds = [(f["geometry"]["type"], f["properties"]["what"]) for f in document["features"]]
    assert kinds[0] == ("LineString", "way")
    assert kinds[-1] == ("Polygon", "fence")
    ring = document["features"][-1]["geometry"]["coordinates"][0]
    assert ring[0] == ring[-1]
    assert len(ring) == 5
    assert 7.9 < ring[0][0] < 8.1, "longitude comes first"


GOOD = json.loads(plan_text(FlightPlan(home=GeodeticPoint(latitude_deg=1, longitude_deg=2, altitude_m=3), items=())))


def changed(**parts: object) -> str:
    return json.dumps({**GOOD, **parts})


ITEM = {"type": "SimpleItem", "command": 16, "frame": 3, "params": [0, 0, 0, None, 47, 8, 10]}


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "no JSON"),
        ("[" * 5000, "no JSON"),
        ("{}", "fileType"),
        (changed(fileType="GeoFence"), "fileType"),
        (changed(mission={**GOOD["mission"], "items": [{"type": "ComplexItem", "complexItemType": "scan"}]}), "scan"),
        (changed(mission={**GOOD["mission"], "items": [{**ITEM, "command": 93}]}), "command 93"),
        (changed(mission={**GOOD["mission"], "items": [{**ITEM, "frame": 0}]}), "frame 0"),
        (changed(mission={**GOOD["mission"], "items": [{**ITEM, "params": [0]}]}), "item 1"),
        (changed(mission={**GOOD["mission"], "items": [{**ITEM, "params": [0, 0, 0, 0, 470, 8, 1]}]}), "470"),
        (changed(mission={**GOOD["mission"], "items": [{**ITEM, "params": [0, 0, 0, 0, 47, 8, math.nan]}]}), "item 1"),
        (changed(geoFence={"polygons": [{"inclusion": False, "polygon": [[1, 2], [1, 3], [2, 2]]}]}), "exclusion"),
        (changed(geoFence={"circles": [{}]}), "circular"),
    ],
)  # fmt: skip
def test_plan_files_that_cannot_be_flown_are_refused_by_what_they_are(text: str, said: str) -> None:
    with pytest.raises(MissionError, match=said):
        read_plan(text, "x.plan")


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "QGC WPL 110"),
        ("QGC WPL 110\n", "no way-points"),
        ("QGC WPL 110\n0\t1\t0\n", "3 columns"),
        ("QGC WPL 110\n0 1 0 16 0 0 0 0 x 8 400 1\n", "x.waypoints:2"),
        ("QGC WPL 110\n0 1 0 16 0 0 0 0 nan 8 400 1\n", "finite"),
        ("QGC WPL 110\n0 1 0 16 0 0 0 0 47 8 400 1\n1 0 3 82 0 0 0 0 47 8 10 1\n", "command 82"),
        ("QGC WPL 110\n0 1 0 16 0 0 0 0 47 8 400 1\n1 0 0 16 0 0 0 0 47 8 10 1\n", "frame 0"),
    ],
)
def test_waypoint_lists_that_cannot_be_flown_are_refused_at_their_line(text: str, said: str) -> None:
    with pytest.raises(MissionError, match=said):
        read_waypoints(text, "x.waypoints")


def test_commands_that_move_nothing_are_left_out() -> None:
    text = "QGC WPL 110\n0 1 0 16 0 0 0 0 47 8 400 1\n1 0 3 178 0 5 -1 0 0 0 0 1\n2 0 3 20 0 0 0 0 0 0 0 1\n"
    assert [item.kind for item in read_waypoints(text, "x").items] == [ItemKind.RETURN]
