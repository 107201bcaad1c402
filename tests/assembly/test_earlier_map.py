"""Missions that begin with the map of an earlier one."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from tests.mission.scenes import hall

from mintpilot.assembly.api import run_mission
from mintpilot.assembly.earlier_map import earlier_map, in_words, without_permissions
from mintpilot.cli.main import main
from mintpilot.core.errors import InputError, MapError, RecordError
from mintpilot.core.geometry import Box, GridFrame
from mintpilot.core.observation import CameraModel, Frame, RegionKind
from mintpilot.core.plan import VehicleLimits
from mintpilot.core.semantic_map import Cell, Knowledge, Region, Room, SemanticMap
from mintpilot.mapping.builder import MapBuilder

GRID = GridFrame(origin_m=(0.0, 0.0, 0.0), resolution_m=0.25, shape=(12, 16, 24))
VOLUME = Box(lo_m=(0.0, 0.0, 0.0), hi_m=(6.0, 4.0, 3.0))


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("runs") / "yesterday"
    run_mission(hall(toxic=False), vehicle="kinematic", out=out)
    return out


@pytest.mark.long
def test_the_last_map_of_a_run_is_taken_without_its_permissions(run: Path) -> None:
    first = earlier_map(run, now_s=0.0)
    assert first.age_s == 0.0
    later = earlier_map(run, now_s=first_written_s(run) + 19 * 3600)
    assert "19 hours old" in str(later.words)
    assert [region.passable for region in later.map.regions] == [Knowledge.OPEN]
    assert (later.map.cells == Cell.FREE).any()


def first_written_s(run: Path) -> float:
    from mintpilot.recording.event_log import read_event_log

    return max(logged.at_s for logged in read_event_log(run))


def test_nothing_that_somebody_said_is_taken_over_and_what_was_drawn_stays_closed() -> None:
    def region(name: str, passable: Knowledge) -> Region:
        return Region(id=name, kind=RegionKind.AREA, cells=np.array([1, 2], np.int64), passable=passable)

    room = Room(
        id="room-1",
        door_m=VOLUME,
        viewpoint_m=(1, 1, 1),
        occupied=Knowledge.NO,
        searched=True,
        best_view=(1, 0, 0, 1, 1),
    )
    map = SemanticMap(
        frame=GRID,
        cells=np.zeros(GRID.shape, np.uint8),
        regions=(region("smoke-1", Knowledge.YES), region("smoke-2", Knowledge.NO), region("told-7", Knowledge.NO)),
        rooms=(room,),
    )
    opened = without_permissions(map)
    assert {r.id: r.passable for r in opened.regions} == dict.fromkeys(
        ("smoke-1", "smoke-2", "drawn-earlier-1"), Knowledge.OPEN
    )
    again = without_permissions(replace(opened, regions=(*opened.regions, region("told-1", Knowledge.NO))))
    assert [r.id for r in again.regions] == ["smoke-1", "smoke-2", "drawn-earlier-1", "drawn-earlier-2"]
    assert (opened.rooms[0].occupied, opened.rooms[0].searched, opened.rooms[0].best_view) == (
        Knowledge.OPEN,
        False,
        None,
    )


@pytest.mark.long
def test_one_look_outweighs_an_earlier_map() -> None:
    """Yesterday all was free; now a wall stands 2 m in front of the camera."""
    builder = MapBuilder(GRID, limits=VehicleLimits(), volume=VOLUME)
    cells = np.full(GRID.shape, Cell.FREE, np.uint8)
    cells[:, :, 8] = Cell.OCCUPIED
    builder.begin_with(SemanticMap(frame=GRID, cells=cells))
    before = builder.snapshot()
    assert (before.cells == cells).all()
    looking = np.array([[0, 0, 1, 0.6], [-1, 0, 0, 2.0], [0, -1, 0, 1.5], [0, 0, 0, 1]], float)
    lens = CameraModel(width=64, height=48, fx=60.0, fy=60.0, cx=32.0, cy=24.0)
    depth = np.full((48, 64), 3.0, np.float32)
    frame = Frame(
        time_s=0.0, rgb=np.zeros((48, 64, 3), np.uint8), depth_m=depth, camera=lens, world_from_camera=looking
    )
    z, y = 6, 8
    builder.integrate(frame, ())
    assert builder.snapshot().cells[z, y, 8] != Cell.OCCUPIED, "what is seen through once is not solid"
    builder.integrate(frame, ())
    after = builder.snapshot()
    assert after.cells[z, y, 8] == Cell.FREE, "what is gone is free"
    assert after.cells[z, y, 14] == Cell.OCCUPIED, "what has come is seen"
    assert after.cells[z, 0, 20] == Cell.FREE, "what was not looked at is as it was"


@pytest.mark.long
def test_it_must_fit_the_place_and_a_camera_must_look_again(run: Path, tmp_path: Path) -> None:
    builder = MapBuilder(GRID, limits=VehicleLimits(), volume=VOLUME)
    with pytest.raises(MapError, match="another lattice"):
        builder.begin_with(earlier_map(run).map)
    with pytest.raises(InputError, match="needs a camera"):
        run_mission(hall(), vehicle="kinematic", earlier=run, out=tmp_path / "refused")
    assert not (tmp_path / "refused").exists(), "what is refused leaves no run behind"
    with pytest.raises(RecordError):
        earlier_map(tmp_path)


@pytest.mark.parametrize(
    ("age_s", "words"), [(5, "less than a minute"), (61, "1 minute"), (7300, "2 hours"), (9e5, "10 days")]
)
def test_ages_are_said_as_people_do(age_s: float, words: str) -> None:
    assert str(in_words(age_s)) == words


@pytest.mark.slow
@pytest.mark.sim
def test_a_mission_begins_with_it_in_place_of_a_survey(tmp_path: Path) -> None:
    first = run_mission(hall(toxic=False), vehicle="mujoco", out=tmp_path / "first")
    second = run_mission(hall(toxic=False), vehicle="mujoco", out=tmp_path / "second", earlier=tmp_path / "first")
    assert (first.outcome, second.outcome) == ("success", "success")
    assert any(notice.kind == "map" and "first" in notice.text for notice in second.notices)
    assert len(second.questions) == len(first.questions) == 1, "what was permitted is asked again"
    assert main(["replay", str(tmp_path / "second"), "--verify"]) == 0
