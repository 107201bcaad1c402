"""Declared regions: boxes, polygons and masks cover every cell that they share volume with, and no other."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from PIL import Image

from mintpilot.core.errors import MapError
from mintpilot.core.geometry import Box, GridFrame
from mintpilot.core.semantic_map import Cell, SemanticMap
from mintpilot.mapping.occupancy import load_ros_map
from mintpilot.mapping.outline import cells_in_box, cells_in_polygon, regions_from_mask

DATA = Path(__file__).parents[2].parent / "shared" / "data" / "occupancy"
FRAME = GridFrame(origin_m=(-1.0, 2.0, 0.0), resolution_m=0.5, shape=(2, 6, 8))
coordinate = st.floats(-2, 6, allow_nan=False).map(lambda v: round(v, 3))


def places(frame: GridFrame, flat: np.ndarray) -> set[tuple[int, ...]]:
    return {tuple(int(i) for i in cell) for cell in np.argwhere(_mask(frame, flat))}


def _mask(frame: GridFrame, flat: np.ndarray) -> np.ndarray:
    mask = np.zeros(frame.size, bool)
    mask[flat] = True
    return mask.reshape(frame.shape)


def test_box_covers_the_cells_that_it_touches_with_volume():
    cells = cells_in_box(FRAME, Box(lo_m=(-0.5, 2.5, 0.0), hi_m=(0.5, 3.0, 0.5)))
    assert places(FRAME, cells) == {(0, 1, 1), (0, 1, 2)}
    assert len(cells_in_box(FRAME, Box(lo_m=(-0.51, 2.5, 0.0), hi_m=(0.5, 3.0, 0.5)))) == 3
    assert len(cells_in_box(FRAME, Box(lo_m=(50, 50, 0), hi_m=(51, 51, 1)))) == 0


def test_heights_do_not_count_on_a_flat_map():
    flat = GridFrame(origin_m=(0, 0, 1.0), resolution_m=0.5, shape=(1, 4, 4))
    assert len(cells_in_box(flat, Box(lo_m=(0, 0, 0), hi_m=(1, 1, 0.2)))) == 4
    assert len(cells_in_polygon(flat, [(0, 0), (1, 0), (1, 1), (0, 1)], (0, 0.2))) == 4


@given(x=st.tuples(coordinate, coordinate), y=st.tuples(coordinate, coordinate), z=st.tuples(coordinate, coordinate))
@settings(max_examples=60, deadline=None)
def test_a_rectangle_as_polygon_covers_what_it_covers_as_box(x, y, z):
    (x0, x1), (y0, y1), (z0, z1) = sorted(x), sorted(y), sorted(z)
    if min(x1 - x0, y1 - y0, z1 - z0) < 0.01:
        return
    box = cells_in_box(FRAME, Box(lo_m=(x0, y0, z0), hi_m=(x1, y1, z1)))
    polygon = cells_in_polygon(FRAME, [(x0, y0), (x1, y0), (x1, y1), (x0, y1)], (z0, z1))
    assert box.tolist() == polygon.tolist()


@given(st.lists(st.tuples(coordinate, coordinate), min_size=3, max_size=7))
@settings(max_examples=60, deadline=None)
def test_a_polygon_covers_every_point_inside_it(corners):
    covered = _mask(FRAME, cells_in_polygon(FRAME, corners))[0]
    x, y = np.meshgrid(np.linspace(-0.99, 2.99, 41), np.linspace(2.01, 4.99, 31))
    inside = np.zeros(x.shape, bool)
    for (ax, ay), (bx, by) in zip(corners, [*corners[1:], corners[0]], strict=True):
        if ay != by:
            inside ^= ((ay > y) != (by > y)) & (x < ax + (y - ay) / (by - ay) * (bx - ax))
    # Points a hair from an edge may fall on either side by rounding: their cell is checked with its neighbours.
    columns, rows = ((x[inside] + 1.0) / 0.5).astype(int), ((y[inside] - 2.0) / 0.5).astype(int)
    missing = ~covered[rows, columns]
    assert missing.sum() == 0


@given(st.lists(st.tuples(coordinate, coordinate), min_size=3, max_size=6), st.integers(0, 5))
@settings(max_examples=30, deadline=None)
def test_neither_direction_nor_first_corner_matters(corners, shift):
    turned = [*corners[shift % len(corners) :], *corners[: shift % len(corners)]]
    expected = cells_in_polygon(FRAME, corners).tolist()
    assert cells_in_polygon(FRAME, turned).tolist() == expected
    assert cells_in_polygon(FRAME, turned[::-1]).tolist() == expected


def test_a_polygon_smaller_than_a_cell_has_that_cell():
    assert places(FRAME, cells_in_polygon(FRAME, [(-0.4, 2.1), (-0.3, 2.1), (-0.4, 2.2)], (0, 0.1))) == {(0, 0, 1)}


@pytest.mark.parametrize("corners", [[(0, 0), (1, 1)], [(0, 0), (1, float("nan")), (1, 1)]])
def test_malformed_polygons(corners):
    with pytest.raises(MapError, match="three or more finite corners"):
        cells_in_polygon(FRAME, corners)


def flat_map(rows: list[str]) -> SemanticMap:
    cells = np.array([[Cell.FREE if c == "." else Cell.OCCUPIED for c in row] for row in rows], np.uint8)[None]
    return SemanticMap(frame=GridFrame(origin_m=(0, 0, 0), resolution_m=1.0, shape=cells.shape), cells=cells)


def save_mask(path: Path, rows: list[str]) -> Path:
    """A picture whose last row is the southern one."""
    Image.fromarray(np.array([[0 if c == "x" else 254 for c in row] for row in rows[::-1]], np.uint8)).save(path)
    return path


def test_each_connected_area_of_a_mask_is_a_region(tmp_path):
    mask = save_mask(tmp_path / "mask.pgm", ["x....", "x..xx", "...xx", "....."])
    regions = regions_from_mask(
        flat_map(["....."] * 4), mask, name="closed", description="the closed area", prior_passable=0.2
    )
    assert [(r.id, len(r.cells), r.prior_passable) for r in regions] == [("closed-1", 4, 0.2), ("closed-2", 2, 0.2)]
    assert regions[1].cells.tolist() == [0, 5]
    assert regions[0].description == "the closed area 1"


def test_walls_are_no_part_of_a_region_and_one_area_keeps_its_name(tmp_path):
    mask = save_mask(tmp_path / "mask.pgm", ["xxx", "..."])
    (region,) = regions_from_mask(flat_map(["..@", "..."]), mask, name="a")
    assert region.id == "a"
    assert region.cells.tolist() == [0, 1]


def test_a_mask_with_its_own_origin_is_laid_where_it_belongs(tmp_path):
    save_mask(tmp_path / "mask.pgm", ["x.", "..", ".x"])
    (tmp_path / "mask.yaml").write_text("image: mask.pgm\nresolution: 1.0\norigin: [2.0, 1.0, 0]\n")
    regions = regions_from_mask(flat_map(["...."] * 3), tmp_path / "mask.yaml", name="a")
    assert [r.cells.tolist() for r in regions] == [[1 * 4 + 2]]  # the other corner lies outside the map


def test_masks_that_do_not_fit(tmp_path):
    mask = save_mask(tmp_path / "mask.pgm", ["x."])
    with pytest.raises(MapError, match="2 x 1 pixels, the map 3 x 1"):
        regions_from_mask(flat_map(["..."]), mask, name="a")
    (tmp_path / "mask.yaml").write_text("image: mask.pgm\nresolution: 0.5\norigin: [0, 0, 0]\n")
    with pytest.raises(MapError, match=r"0\.5 m a pixel, the map 1\.0"):
        regions_from_mask(flat_map([".."]), tmp_path / "mask.yaml", name="a")
    voxels = SemanticMap(frame=FRAME, cells=np.ones(FRAME.shape, np.uint8))
    with pytest.raises(MapError, match="needs a flat map"):
        regions_from_mask(voxels, mask, name="a")


@pytest.mark.skipif(not DATA.exists(), reason="the shared data is not beside the project")
def test_the_keep_out_mask_that_others_made():
    regions = regions_from_mask(load_ros_map(DATA / "depot.yaml"), DATA / "depot_keepout.yaml", name="keep-out")
    sizes = [len(r.cells) for r in regions]
    assert sizes == sorted(sizes, reverse=True)
    assert sizes[0] > 10_000
    joined = np.concatenate([r.cells for r in regions])
    assert len(np.unique(joined)) == len(joined)
    assert all((np.diff(r.cells) > 0).all() for r in regions)


def test_many_corners_on_many_cells_are_covered():
    frame = GridFrame(origin_m=(0, 0, 0), resolution_m=0.1, shape=(1, 3000, 3000))
    turn = np.linspace(0, 2 * np.pi, 60, endpoint=False)
    corners = [(150 + 140 * np.cos(a), 150 + 140 * np.sin(a)) for a in turn]
    covered = cells_in_polygon(frame, corners)
    area = 0.5 * 60 * 1400**2 * np.sin(2 * np.pi / 60)
    assert area <= covered.size <= area + 12_000
