"""From missions and runs to flight plans, and from flight plans to missions."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

from mintpilot import run_mission
from mintpilot.cli.main import main
from mintpilot.core.errors import MintPilotError
from mintpilot.core.geometry import GridFrame
from mintpilot.core.semantic_map import Cell, SemanticMap
from mintpilot.ground_station.qgroundcontrol import read_plan
from mintpilot.mapping.outline import within_fence
from mintpilot.mission_file.reader import find_problems, read_mission

HERE = "  georeference: {latitude: 47.0, longitude: 8.0, altitude_m: 400.0}\n"
GEO = "{latitude: 47.0, longitude: 8.0, altitude_m: 400.0}"


def site(folder: Path, extra: str = "", world: str = f"  georeference: {GEO}\n", regions: str = "") -> Path:
    """A mission on a free field of 20 x 20 m."""
    Image.fromarray(np.full((100, 100), 254, np.uint8)).save(folder / "field.png")
    (folder / "field.yaml").write_text(
        "image: field.png\nresolution: 0.2\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.25\n"
    )
    path = folder / "mission.yaml"
    goals = extra or "goals:\n  - {action: go, position_m: [15, 10]}\n"
    path.write_text(
        "mintpilot: 1\nname: field\ninstruction: go there\nworld:\n  map: field.yaml\n  start_m: [2, 2]\n"
        f"{world}{regions}{goals}"
    )
    return path


def test_a_mission_is_exported_and_its_plan_is_a_mission_again(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = site(tmp_path)
    out = tmp_path / "field.plan"
    assert main(["export", str(path), "--out", str(out)]) == 0
    assert read_plan(out.read_text(), "field.plan").items
    again = read_mission(site(tmp_path, extra="flight_plan: field.plan\n"))
    assert again.goals is not None
    assert again.goals[-1].position_m == pytest.approx((15.0, 10.0), abs=0.15)
    assert again.world.fence is not None  # type: ignore[union-attr]
    assert main(["export", str(path), "--to", "wpl"]) == 0
    assert "QGC WPL 110" in capsys.readouterr().out


@pytest.mark.long
def test_a_plan_that_rests_on_a_question_is_exported_from_its_run(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    regions = (
        "  regions:\n    - {id: smoke, kind: smoke, description: the grey smoke, truth: passable,\n"
        "       box: {lo_m: [8, 0, 0], hi_m: [9, 20, 3]}}\n"
    )
    path = site(tmp_path, regions=regions)
    assert main(["export", str(path)]) == 2
    assert "grey smoke" in capsys.readouterr().err
    record = run_mission(path, vehicle="kinematic", out=tmp_path / "run")
    assert record.outcome.value == "success"
    assert main(["export", str(tmp_path / "run"), "--to", "geojson"]) == 0
    assert json.loads(capsys.readouterr().out)["type"] == "FeatureCollection"


def test_a_plan_given_as_a_mission_is_refused_by_what_it_is(tmp_path: Path) -> None:
    main(["export", str(site(tmp_path)), "--out", str(tmp_path / "field.plan")])
    (problem,) = find_problems(tmp_path / "field.plan")
    assert "3 way-points and a fence of 4 corners" in problem.message
    assert "flight_plan: field.plan" in problem.message
    (tmp_path / "x.waypoints").write_text("hello")
    (problem,) = find_problems(tmp_path / "x.waypoints")
    assert "QGC WPL 110" in problem.message


@pytest.mark.parametrize(
    ("extra", "world", "said"),
    [
        ("flight_plan: nothing.plan\n", HERE, "nothing.plan"),
        ("flight_plan: field.plan\n", "", "georeference"),
        ("flight_plan: field.plan\ngoals:\n  - {action: go, position_m: [1, 1]}\n", HERE, "remove one"),
        ("flight_plan: field.plan\n", f"  georeference: {GEO}\n  fence: [[0,0],[9,0],[9,9]]\n", "remove one"),
        ("flight_plan: field.plan\n", "  georeference: {latitude: 57.0, longitude: 8.0}\n", "km from the map's origin"),
    ],
)  # fmt: skip
def test_flight_plans_that_do_not_fit_are_told(tmp_path: Path, extra: str, world: str, said: str) -> None:
    main(["export", str(site(tmp_path)), "--out", str(tmp_path / "field.plan")])
    problems = find_problems(site(tmp_path, extra=extra, world=world))
    assert any(said in problem.message for problem in problems), problems


def test_an_export_needs_a_georeference(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["export", str(site(tmp_path, world=""))]) == 2
    assert "world.georeference" in capsys.readouterr().err


def test_nothing_is_flown_outside_the_fence(tmp_path: Path) -> None:
    path = site(tmp_path, world=f"  georeference: {GEO}\n  fence: [[0, 0], [10, 0], [10, 20], [0, 20]]\n")
    try:
        reached = run_mission(path, vehicle="kinematic").outcome.value == "success"
    except MintPilotError:
        reached = False
    assert not reached


CORNERS = st.lists(st.tuples(st.floats(-3, 13), st.floats(-3, 13)), min_size=3, max_size=3)


@given(corners=CORNERS, resolution=st.sampled_from([0.3, 0.5, 1.0]))
def test_cells_that_stay_free_lie_wholly_inside_a_fence(corners: list[tuple[float, float]], resolution: float) -> None:
    count = int(10 / resolution)
    frame = GridFrame(origin_m=(0.0, 0.0, 0.0), resolution_m=resolution, shape=(1, count, count))
    field = SemanticMap(frame=frame, cells=np.full(frame.shape, Cell.FREE, np.uint8))
    kept = within_fence(field, corners).cells[0] == Cell.FREE
    ys, xs = np.nonzero(kept)
    for dx in (0.01, 0.5, 0.99):  # points of each kept cell against half-planes of the triangle
        for dy in (0.01, 0.5, 0.99):
            px, py = (xs + dx) * resolution, (ys + dy) * resolution
            (ax, ay), (bx, by), (cx, cy) = corners
            sides = np.stack([
                (bx - ax) * (py - ay) - (by - ay) * (px - ax),
                (cx - bx) * (py - by) - (cy - by) * (px - bx),
                (ax - cx) * (py - cy) - (ay - cy) * (px - cx),
            ])  # fmt: skip
            assert ((sides >= -1e-6).all(0) | (sides <= 1e-6).all(0)).all()
