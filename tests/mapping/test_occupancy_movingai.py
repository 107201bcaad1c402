"""MovingAI maps: terrain, axes, malformed files, and agreement with the benchmark's own scenarios."""

from pathlib import Path

import numpy as np
import pytest

from mintpilot.core.errors import LimitError, MapError
from mintpilot.core.semantic_map import Cell
from mintpilot.mapping import picture_map
from mintpilot.mapping.movingai import load_movingai

DATA = Path(__file__).parents[2].parent / "shared" / "data" / "planning"
needs_data = pytest.mark.skipif(not DATA.exists(), reason="the shared data is not beside the project")
HEAD = "type octile\nheight 2\nwidth 8\nmap\n"


def flat(tmp_path: Path, text: str) -> Path:
    path = tmp_path / "a.map"
    path.write_text(text)
    return path


def voxel(tmp_path: Path, text: str) -> Path:
    path = tmp_path / "a.3dmap"
    path.write_text(text)
    return path


def test_terrain(tmp_path):
    cells = load_movingai(flat(tmp_path, HEAD + ".GS@OTW.\n........\n")).cells
    assert (cells[0, 0] == Cell.FREE).tolist() == [True, True, True, False, False, False, False, True]
    assert (cells[0, 1] == Cell.FREE).all()


def test_x_is_the_column_and_y_the_row_of_the_file(tmp_path):
    semantic_map = load_movingai(flat(tmp_path, HEAD + "........\n.....@..\n"), resolution_m=0.5, height_m=2.0)
    assert semantic_map.cells[0, 1, 5] == Cell.OCCUPIED
    np.testing.assert_allclose(semantic_map.frame.centres_of((0, 1, 5)), [[2.75, 0.75, 2.0]])


def test_the_three_numbers_of_a_voxel_are_x_y_z(tmp_path):
    semantic_map = load_movingai(voxel(tmp_path, "voxel 4 3 2\n3 2 1\n0 0 0\n"))
    assert semantic_map.frame.shape == (2, 3, 4)
    occupied = np.argwhere(semantic_map.cells == Cell.OCCUPIED)
    np.testing.assert_allclose(semantic_map.frame.centres_of(occupied), [[0.5, 0.5, 0.5], [3.5, 2.5, 1.5]])


def test_windows_line_ends(tmp_path):
    path = tmp_path / "a.map"
    path.write_bytes((HEAD + "........\n@.......\n").replace("\n", "\r\n").encode())
    assert load_movingai(path).cells[0, 1, 0] == Cell.OCCUPIED


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "first lines"),
        ("hello\n", "first lines"),
        ("type octile\nheight two\nwidth 8\nmap\n", "height two"),
        ("type octile\nheight 0\nwidth 8\nmap\n", "is empty"),
        (HEAD + "........\n", "truncated"),
        (HEAD + "........\n...", "line 6 has 3 cells"),
        (HEAD + "........\n..x.....\n", "line 6, column 3: terrain 'x'"),
    ],
)
def test_malformed_flat_maps(tmp_path, text, words):
    with pytest.raises(MapError, match=words):
        load_movingai(flat(tmp_path, text))


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "first line must be"),
        ("voxel 3 3\n", "first line must be"),
        ("voxel 3 3 -3\n", "whole number"),
        ("voxel 0 3 3\n", "is empty"),
        ("voxel 3 3 3\n0 0\n", "truncated"),
        ("voxel 3 3 3\n0 0 1", "truncated"),
        ("voxel 3 3 3\n0 a 0\n", "three whole numbers"),
        ("voxel 3 3 3\n0 3 0\n", r"\[0, 3, 0\] is outside 3 x 3 x 3"),
        ("voxel 3 3 3\n0 -1 0\n", "outside"),
        ("voxel 3 3 3\n0 99999999999999999999 0\n", "outside"),
    ],
)
def test_malformed_voxel_maps(tmp_path, text, words):
    with pytest.raises(MapError, match=words):
        load_movingai(voxel(tmp_path, text))


def test_missing_unreadable_and_huge(tmp_path, monkeypatch):
    with pytest.raises(MapError, match="there is no map"):
        load_movingai(tmp_path / "none.map")
    with pytest.raises(MapError, match="no regular file"):
        load_movingai(tmp_path)
    with pytest.raises(LimitError, match="coarser"):
        load_movingai(voxel(tmp_path, "voxel 100000 100000 100000\n"))
    monkeypatch.setattr(picture_map, "MAX_CELLS", 10)
    with pytest.raises(LimitError, match="16 cells"):
        load_movingai(flat(tmp_path, HEAD + "........\n" * 2))


@needs_data
@pytest.mark.parametrize("name", ["warehouse-10-20-10-2-1", "random-64-64-20", "room-64-64-16"])
def test_starts_and_goals_of_the_benchmark_are_free(name):
    cells = load_movingai(DATA / f"{name}.map").cells[0]
    rows = [line.split() for line in (DATA / f"{name}-random-1.scen").read_text().splitlines()[1:]]
    places = np.array([[int(v) for v in row[4:8]] for row in rows])
    assert len(places) >= 200
    assert (cells[places[:, 1], places[:, 0]] == Cell.FREE).all()
    assert (cells[places[:, 3], places[:, 2]] == Cell.FREE).all()


@needs_data
@pytest.mark.parametrize("name", ["Simple", "Complex"])
def test_starts_and_goals_of_the_voxel_benchmark_are_free(name):
    cells = load_movingai(DATA / f"{name}.3dmap").cells
    rows = (DATA / f"{name}.3dmap.3dscen").read_text().splitlines()[2:]
    places = np.array([[int(v) for v in row.split()[:6]] for row in rows])
    for x, y, z in (places[:, :3].T, places[:, 3:].T):
        assert (cells[z, y, x] == Cell.FREE).all()
    assert (cells == Cell.OCCUPIED).any()
