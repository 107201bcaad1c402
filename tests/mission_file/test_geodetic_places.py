"""Latitude and longitude in mission files, and where a map lies on the earth."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mintpilot.core.errors import MapError
from mintpilot.core.georeference import GeodeticPoint, Georeference
from mintpilot.mission_file.reader import find_problems, read_mission

EARTH_M = 6_371_000.0


@given(
    latitude=st.floats(-80, 80),
    longitude=st.floats(-180, 180),
    heading=st.floats(-7, 7),
    place=st.tuples(st.floats(-3000, 3000), st.floats(-3000, 3000), st.floats(-50, 300)),
)
def test_there_and_back(latitude: float, longitude: float, heading: float, place: tuple[float, float, float]) -> None:
    reference = Georeference(latitude_deg=latitude, longitude_deg=longitude, altitude_m=120.0, heading_rad=heading)
    assert reference.local(reference.geodetic(place)) == pytest.approx(place, abs=1e-5)


@pytest.mark.parametrize(
    ("heading", "place", "north", "east"),
    [(0.0, (0.0, 100.0, 0.0), 100, 0), (0.0, (100.0, 0.0, 0.0), 0, 100), (math.pi / 2, (0.0, 100.0, 0.0), 0, 100),
     (math.pi / 2, (100.0, 0.0, 0.0), -100, 0)],
)  # fmt: skip
def test_heading_turns_the_y_axis_clockwise_from_north(
    heading: float, place: tuple[float, float, float], north: float, east: float
) -> None:
    there = Georeference(latitude_deg=10.0, longitude_deg=20.0, heading_rad=heading).geodetic(place)
    moved_north = math.radians(there.latitude_deg - 10.0) * EARTH_M
    moved_east = math.radians(there.longitude_deg - 20.0) * EARTH_M * math.cos(math.radians(10.0))
    assert (moved_north, moved_east) == (pytest.approx(north, abs=1.0), pytest.approx(east, abs=1.0))


def test_places_far_away_and_numbers_out_of_range_are_refused() -> None:
    with pytest.raises(MapError, match=r"km from the map's origin"):
        Georeference(latitude_deg=0, longitude_deg=0).local(
            GeodeticPoint(latitude_deg=1.0, longitude_deg=0.0, altitude_m=0.0)
        )
    with pytest.raises(MapError, match="latitude 91"):
        Georeference(latitude_deg=91, longitude_deg=0)
    with pytest.raises(MapError, match="finite"):
        Georeference(latitude_deg=math.nan, longitude_deg=0)


MISSION = """
mintpilot: 1
name: field
instruction: go to the well
world:
  scene:
    volume: {lo_m: [-50, -50, 0], hi_m: [50, 50, 20]}
    start_m: [0, 0, 2]
GEO
goals:
  - {action: go, position_m: PLACE}
"""
GEO = "  georeference: {latitude: 47.0, longitude: 8.0, altitude_m: 400.0}"


def written(folder: Path, place: str, geo: str = GEO) -> Path:
    path = folder / "m.yaml"
    path.write_text(MISSION.replace("PLACE", place).replace("GEO", geo))
    return path


def test_latitude_and_longitude_become_metres(tmp_path: Path) -> None:
    flat = read_mission(written(tmp_path, "{latitude: 47.0001, longitude: 8.0}"))
    assert flat.goals[0].position_m == (pytest.approx(0.0, abs=0.01), pytest.approx(11.12, abs=0.02))
    high = read_mission(written(tmp_path, "{latitude: 47.0001, longitude: 8.0, altitude_m: 405}"))
    assert high.goals[0].position_m is not None
    assert high.goals[0].position_m[2] == pytest.approx(5.0, abs=0.01)


@pytest.mark.parametrize(
    ("place", "geo", "said"),
    [
        ("{latitude: 47.0001, longitude: 8.0}", "", "no georeference"),
        ("{latitude: 47.0001}", GEO, "longitude"),
        ("{latitude: 97, longitude: 8.0}", GEO, "97"),
        ("{latitude: 48, longitude: 8.0}", GEO, "km from the map's origin"),
        ("[0, 10]", "  georeference: {latitude: 470, longitude: 8.0}", "470"),
    ],
)
def test_what_cannot_be_placed_is_told_at_its_line(tmp_path: Path, place: str, geo: str, said: str) -> None:
    (problem, *_) = find_problems(written(tmp_path, place, geo))
    assert said in problem.message
    assert problem.line > 5
