"""ROS map_server files: pixels, thresholds, modes, axes, and everything that can be wrong with them."""

import os
import zlib
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from PIL import Image

from mintpilot.core.errors import LimitError, MapError
from mintpilot.core.semantic_map import Cell
from mintpilot.mapping import picture_map
from mintpilot.mapping.occupancy import Mode, load_ros_map

DATA = Path(__file__).parents[2].parent / "shared" / "data" / "occupancy"
FREE, OCCUPIED, UNKNOWN = int(Cell.FREE), int(Cell.OCCUPIED), int(Cell.UNKNOWN)


def write(folder: Path, pixels: object = ((254, 0, 205),), name: str = "map.pgm", **keys: object) -> Path:
    """A map whose first row of pixels is the top one."""
    if pixels is not None:
        Image.fromarray(np.array(pixels, np.uint8)).save(folder / name)
    values = {"image": name, "resolution": 0.5, "origin": "[0, 0, 0]", **keys}
    path = folder / "map.yaml"
    path.write_text("".join(f"{key}: {value}\n" for key, value in values.items() if value is not None))
    return path


def test_free_occupied_and_unknown_pixels(tmp_path):
    cells = load_ros_map(write(tmp_path, free_thresh=0.196, occupied_thresh=0.65)).cells
    assert cells.tolist() == [[[FREE, OCCUPIED, UNKNOWN]]]


def test_what_map_saver_wrote_for_unknown_is_never_free(tmp_path):
    """With free_thresh 0.25, as map_saver writes it, shade 205 is free to map_server; not to us."""
    cells = load_ros_map(write(tmp_path, ((205, 206, 204),), free_thresh=0.25)).cells
    assert cells.tolist() == [[[UNKNOWN, FREE, FREE]]]


def test_columns_run_east_and_the_lowest_row_is_the_southern_one(tmp_path):
    path = write(tmp_path, ((0, 254, 254), (254, 254, 254)), origin="[-1.0, 2.0, 0.0]")
    semantic_map = load_ros_map(path, height_m=1.2)
    frame = semantic_map.frame
    assert frame.shape == (1, 2, 3)
    assert frame.is_flat
    assert semantic_map.cells[0, 1, 0] == OCCUPIED  # top left pixel: north-west
    np.testing.assert_allclose(frame.centres_of((0, 1, 0)), [[-0.75, 2.75, 1.2]])


@pytest.mark.parametrize(
    ("mode", "negate", "shade", "expected"),
    [
        ("trinary", 0, 255, FREE),
        ("trinary", 0, 0, OCCUPIED),
        ("trinary", 0, 128, UNKNOWN),
        ("trinary", 1, 255, OCCUPIED),
        ("trinary", 1, 0, FREE),
        ("trinary", 1, 205, OCCUPIED),
        ("scale", 0, 205, UNKNOWN),
        ("scale", 1, 50, UNKNOWN),
        ("trinary", 1, 50, UNKNOWN),
        ("scale", 0, 206, FREE),
        ("scale", 0, 128, UNKNOWN),
        ("scale", 0, 10, OCCUPIED),
        ("raw", 0, 0, FREE),
        ("raw", 1, 0, FREE),
        ("raw", 0, 50, UNKNOWN),
        ("raw", 0, 100, OCCUPIED),
        ("raw", 0, 101, UNKNOWN),
        ("raw", 0, 255, UNKNOWN),
    ],
)
def test_modes_and_negation(tmp_path, mode, negate, shade, expected):
    path = write(tmp_path, ((shade,),), mode=mode, negate=negate, free_thresh=0.25, occupied_thresh=0.65)
    assert load_ros_map(path).cells.item() == expected


def test_plain_pgm_and_png_and_16_bits_say_the_same(tmp_path):
    (tmp_path / "plain.pgm").write_text("P2\n# by hand\n3 1\n255\n254 0 128\n")
    (tmp_path / "deep.pgm").write_bytes(b"P5\n3 1\n65535\n" + np.array([65000, 0, 32768], ">u2").tobytes())
    Image.fromarray(np.array([[254, 0, 128]], np.uint8)).save(tmp_path / "grey.png")
    Image.fromarray(np.array([[[254] * 3, [0] * 3, [128] * 3]], np.uint8)).save(tmp_path / "colour.png")
    for name in ("plain.pgm", "deep.pgm", "grey.png", "colour.png"):
        assert load_ros_map(write(tmp_path, None, name)).cells.tolist() == [[[FREE, OCCUPIED, UNKNOWN]]], name


def test_what_is_not_opaque_is_unknown(tmp_path):
    Image.fromarray(np.array([[[254, 254, 254, 255], [254, 254, 254, 200], [0, 0, 0, 0]]], np.uint8), "RGBA").save(
        tmp_path / "see-through.png"
    )
    cells = load_ros_map(write(tmp_path, None, "see-through.png")).cells
    assert cells.tolist() == [[[FREE, UNKNOWN, UNKNOWN]]]


def test_grey_colour_and_palette_entries_marked_as_transparent_are_unknown(tmp_path):
    grey = Image.fromarray(np.array([[254, 250, 0]], np.uint8))
    grey.save(tmp_path / "grey.png", transparency=250)
    Image.fromarray(np.array([[[254] * 3, [250] * 3, [0] * 3]], np.uint8)).save(
        tmp_path / "colour.png", transparency=(250, 250, 250)
    )
    palette = grey.convert("P")
    palette.save(tmp_path / "palette.png", transparency=250)
    Image.fromarray(np.array([[255, 0, 0]], np.uint8)).convert("1").save(tmp_path / "bits.png", transparency=1)
    deep = Image.fromarray(np.array([[65000, 64000, 0]], np.uint16))
    deep.save(tmp_path / "deep.png", transparency=64000)
    for mode in Mode:
        for name in ("grey.png", "colour.png", "palette.png"):
            keys = {"mode": mode, "negate": 1} if mode is Mode.RAW else {"mode": mode}
            cells = load_ros_map(write(tmp_path, None, name, **keys)).cells.ravel().tolist()
            assert cells[1] == UNKNOWN, (mode, name)
    assert load_ros_map(write(tmp_path, None, "bits.png")).cells.tolist() == [[[UNKNOWN, OCCUPIED, OCCUPIED]]]
    assert load_ros_map(write(tmp_path, None, "deep.png")).cells.tolist() == [[[FREE, UNKNOWN, OCCUPIED]]]
    assert load_ros_map(write(tmp_path, None, "grey.png")).cells.tolist() == [[[FREE, UNKNOWN, OCCUPIED]]]


def _chunk(kind: bytes, data: bytes) -> bytes:
    return len(data).to_bytes(4, "big") + kind + data + zlib.crc32(kind + data).to_bytes(4, "big")


@pytest.mark.parametrize(("bits", "clear", "expected"), [(2, 3, UNKNOWN), (4, 15, UNKNOWN), (2, 1, FREE)])
def test_transparency_of_pictures_with_few_bits_a_pixel(tmp_path, bits, clear, expected):
    """One white pixel; by the standard the transparent grey value is given in the picture's own bits."""
    head = (1).to_bytes(4, "big") * 2 + bytes([bits, 0, 0, 0, 0])
    data = [(b"IHDR", head), (b"tRNS", clear.to_bytes(2, "big")), (b"IDAT", zlib.compress(b"\x00\xff")), (b"IEND", b"")]
    (tmp_path / "few.png").write_bytes(b"\x89PNG\r\n\x1a\n" + b"".join(_chunk(*part) for part in data))
    assert load_ros_map(write(tmp_path, None, "few.png")).cells.item() == expected


@pytest.mark.parametrize("name", ["map.jpg", "map.png", "map.webp"])
def test_pictures_compressed_with_losses_are_refused_by_name(tmp_path, name):
    picture = Image.fromarray(np.full((8, 8), 254, np.uint8))
    picture.save(tmp_path / name, format="WEBP" if name.endswith("webp") else "JPEG")
    with pytest.raises(MapError, match=r"(JPEG|lossy WebP) picture.*PGM or PNG"):
        load_ros_map(write(tmp_path, None, name))


def test_other_formats_are_not_opened_at_all(tmp_path):
    (tmp_path / "map.eps").write_text("%!PS-Adobe-3.0 EPSF-3.0\n%%BoundingBox: 0 0 10 10\nshowpage\n")
    with pytest.raises(MapError, match="not a picture that can be read"):
        load_ros_map(write(tmp_path, None, "map.eps"))


def test_pipes_and_devices_are_refused(tmp_path):
    os.mkfifo(tmp_path / "pipe.pgm")
    (tmp_path / "zero.pgm").symlink_to("/dev/zero")
    for name in ("pipe.pgm", "zero.pgm"):
        with pytest.raises(MapError, match=f"{name}.*no regular file"):
            load_ros_map(write(tmp_path, None, name))
    os.mkfifo(tmp_path / "pipe.yaml")
    with pytest.raises(MapError, match="no regular file"):
        load_ros_map(tmp_path / "pipe.yaml")


def test_aliases_in_the_header_are_refused(tmp_path):
    (tmp_path / "map.yaml").write_text("a: &a [x, x]\nimage: [*a, *a]\nresolution: 1\norigin: [0, 0, 0]\n")
    with pytest.raises(MapError, match="alias"):
        load_ros_map(tmp_path / "map.yaml")


@pytest.mark.long
@given(
    yaw=st.one_of(st.floats(-4, 4), st.sampled_from([np.pi / 2, -np.pi / 2, np.pi, np.pi / 4])),
    seed=st.integers(0, 10**6),
)
@settings(max_examples=30, deadline=None)
def test_turned_maps_free_nothing_and_thin_no_wall(tmp_path_factory, yaw, seed):
    """A point of the world lies in one pixel; whatever cell of the turned map it lies in says no more than that."""
    rng = np.random.default_rng(seed)
    shades = rng.choice([254, 254, 254, 0, 205], size=(5, 7)).astype(np.uint8)
    folder = tmp_path_factory.mktemp("map")
    turned = load_ros_map(write(folder, shades, origin=f"[3.0, -2.0, {yaw!r}]"))
    local = rng.uniform(-1, 8, size=(3000, 2))
    c, s = np.cos(yaw), np.sin(yaw)
    world = np.array([3.0, -2.0]) + 0.5 * local @ np.array([[c, s], [-s, c]])
    cells = turned.frame.cells_of(np.column_stack([world, np.full(len(world), 1.0)]))
    column, row = np.floor(local).astype(int).T
    inside = (column >= 0) & (column < 7) & (row >= 0) & (row < 5)
    pixel = np.where(inside, shades[::-1][np.where(inside, row, 0), np.where(inside, column, 0)], 205)
    on_map = turned.frame.contains(cells)
    assert on_map[inside].all()
    state = np.full(len(world), UNKNOWN)
    state[on_map] = turned.cells[tuple(cells[on_map].T)]
    assert (pixel[state == FREE] == 254).all()
    assert (state[pixel == 0] == OCCUPIED).all()


def test_a_quarter_turn_keeps_every_pixel(tmp_path):
    path = write(tmp_path, ((254, 0, 205), (254, 254, 254)), origin=f"[1.0, 0.0, {np.pi / 2}]")
    turned = load_ros_map(path)
    assert turned.frame.origin_m == pytest.approx((0.0, 0.0, 0.75))
    assert turned.cells[0].tolist() == [[FREE, FREE], [OCCUPIED, FREE], [UNKNOWN, FREE]]


@given(
    shade=st.integers(0, 255),
    free=st.floats(0.01, 0.5),
    gap=st.floats(0.01, 0.4),
    negate=st.booleans(),
)
@settings(max_examples=50, deadline=None)
def test_never_free_and_occupied_at_once_and_order_is_kept(tmp_path_factory, shade, free, gap, negate):
    folder = tmp_path_factory.mktemp("map")
    path = write(folder, ((shade, 255 - shade),), free_thresh=free, occupied_thresh=free + gap, negate=int(negate))
    here, mirrored = load_ros_map(path).cells.ravel().tolist()
    occupancy = (shade if negate else 255 - shade) / 255
    assert here != FREE or occupancy < free
    assert here != OCCUPIED or occupancy > free + gap
    assert not (here == FREE and mirrored == FREE and free < 0.5)


@pytest.mark.parametrize(
    ("keys", "words"),
    [
        ({"image": None}, ["lacks image"]),
        ({"resolution": None, "origin": None}, ["resolution, origin"]),
        ({"resolution": 0}, ["0.0", "from 0.0001"]),
        ({"resolution": -0.05}, ["-0.05"]),
        ({"resolution": "fine"}, ["'fine'", "number"]),
        ({"resolution": ".nan"}, ["nan", "number"]),
        ({"origin": "[1e300, 0, 0]"}, ["1e300", "local coordinates"]),
        ({"origin": "[0, 0, .inf]"}, ["inf", "number"]),
        ({"resolution": "1\nresolution: 2"}, ["more than once"]),
        ({"origin": "[0]"}, ["[0]", "[x, y, yaw]"]),
        ({"origin": "here"}, ["'here'", "[x, y, yaw]"]),
        ({"free_thresh": 0.7, "occupied_thresh": 0.6}, ["0.7", "0.6", "free below occupied"]),
        ({"occupied_thresh": 1.5}, ["1.5", "from 0 to 1"]),
        ({"negate": 2}, ["negate 2", "0 or 1"]),
        ({"mode": "fancy"}, ["'fancy'", "trinary, scale, raw"]),
        ({"image": "other.pgm"}, ["other.pgm", "no picture"]),
        ({"image": 3}, ["image 3", "name of the picture"]),
    ],
)
def test_malformed_headers(tmp_path, keys, words):
    with pytest.raises(MapError) as caught:
        load_ros_map(write(tmp_path, **keys))
    for word in words:
        assert word in str(caught.value)


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b"P5",
        b"P5\n4 4\n255\n123",
        b"P5\n0 4\n255\n",
        b"P5\n-1 4\n255\n",
        b"no picture",
        b"P2\n2 2\n255\n1 2 x 4\n",
    ],
)
def test_broken_pictures(tmp_path, data):
    (tmp_path / "broken.pgm").write_bytes(data)
    with pytest.raises(MapError, match=r"broken\.pgm"):
        load_ros_map(write(tmp_path, None, "broken.pgm"))


@pytest.mark.parametrize("text", ["", "- a list\n", "image: [unclosed\n", "\x00\x01"])
def test_broken_yaml(tmp_path, text):
    (tmp_path / "map.yaml").write_text(text)
    with pytest.raises(MapError, match=r"map\.yaml"):
        load_ros_map(tmp_path / "map.yaml")


def test_missing_file_and_folder_in_its_place(tmp_path):
    with pytest.raises(MapError, match="there is no map"):
        load_ros_map(tmp_path / "none.yaml")
    with pytest.raises(MapError, match="no regular file"):
        load_ros_map(tmp_path)


def test_huge_maps_are_refused(tmp_path, monkeypatch):
    monkeypatch.setattr(picture_map, "MAX_CELLS", 10)
    with pytest.raises(LimitError, match=r"12 cells, more than the 10.*coarser"):
        load_ros_map(write(tmp_path, np.full((3, 4), 254)))


def test_a_picture_that_claims_to_be_huge_is_refused_before_it_is_read(tmp_path):
    (tmp_path / "bomb.pgm").write_bytes(b"P5\n100000 100000\n255\n")
    with pytest.raises(LimitError, match=r"bomb\.pgm"):
        load_ros_map(write(tmp_path, None, "bomb.pgm"))


@pytest.mark.skipif(not DATA.exists(), reason="the shared data is not beside the project")
def test_the_depot_that_others_made():
    semantic_map = load_ros_map(DATA / "depot.yaml")
    assert semantic_map.frame.shape == (1, 307, 604)
    counts = np.bincount(semantic_map.cells.ravel(), minlength=3)
    assert counts.tolist() == [8894, 170587, 5947]
