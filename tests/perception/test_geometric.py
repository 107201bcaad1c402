from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scenes import Block, picture, pose

from mintpilot.core.observation import CameraModel, Detection, Frame
from mintpilot.perception.geometric import GeometricPerception

PAINTS = {
    "red": (0.80, 0.06, 0.06),
    "green": (0.08, 0.55, 0.15),
    "blue": (0.06, 0.18, 0.75),
    "yellow": (0.90, 0.80, 0.08),
    "orange": (0.95, 0.42, 0.04),
    "purple": (0.45, 0.10, 0.62),
    "white": (0.93, 0.93, 0.93),
    "black": (0.03, 0.03, 0.03),
}
DATA = Path(__file__).parents[3] / "shared" / "data" / "rgbd"


def detect(frame: Frame) -> tuple[Detection, ...]:
    return GeometricPerception().detect(frame, 7)


def word(detection: Detection, name: str) -> str:
    return next((a.value for a in detection.attributes if a.name == name), "")


def a_box(edge: float, paint: tuple[float, float, float], x: float = 2.6) -> Block:
    return Block(lo_m=(x, -edge / 2, 0.0), hi_m=(x + edge, edge / 2, edge), colour=paint)


def a_frame(width: int, height: int, depth: np.ndarray, rgb: np.ndarray | None = None) -> Frame:
    lens = CameraModel(width=width, height=height, fx=width, fy=width, cx=width / 2, cy=height / 2)
    return Frame(
        time_s=0.0,
        rgb=np.zeros((height, width, 3), np.uint8) if rgb is None else rgb,
        depth_m=depth.astype(np.float32),
        camera=lens,
        world_from_camera=pose((0.0, 0.0, 1.5), 0.0, 0.2),
    )


@pytest.mark.long
@pytest.mark.parametrize("colour", sorted(PAINTS))
@pytest.mark.parametrize("light", [(1.0, 1.0, 1.0), (0.75, 0.74, 0.70)])
def test_a_box_is_found_with_its_place_colour_size_and_shape(colour: str, light: tuple[float, float, float]) -> None:
    (found,) = detect(picture([a_box(0.5, PAINTS[colour])], light=light))
    assert found.label == "box"
    assert word(found, "colour") == colour
    assert word(found, "size") == "medium"
    assert word(found, "shape") == "cubic"
    assert found.position_m == pytest.approx((2.85, 0.0, 0.25), abs=0.1)
    left, top, right, bottom = found.pixels
    assert 0 <= left < 160 < right <= 320
    assert 0 <= top < bottom <= 240
    assert found.frame_index == 7


@pytest.mark.parametrize(("edge", "size"), [(0.3, "small"), (0.5, "medium"), (0.8, "large")])
def test_sizes_are_measured(edge: float, size: str) -> None:
    (found,) = detect(picture([a_box(edge, PAINTS["red"])]))
    assert word(found, "size") == size


def test_boxes_of_one_colour_apart_in_depth_are_two() -> None:
    blocks = [a_box(0.4, PAINTS["red"], 2.2), replace(a_box(0.6, PAINTS["red"], 4.0), lo_m=(4.0, -0.1, 0.0))]
    assert [d.label for d in detect(picture(blocks))] == ["box", "box"]


def test_an_empty_hall_shows_nothing() -> None:
    for seed in range(3):
        assert detect(picture([], seed=seed)) == ()


def test_walls_and_tall_things_are_no_objects() -> None:
    grey = (0.5, 0.5, 0.5)
    wall = Block(lo_m=(3.0, -3.0, 0.0), hi_m=(3.2, -0.5, 3.0), colour=grey)
    rack = Block(lo_m=(3.0, 0.8, 0.0), hi_m=(5.0, 1.6, 2.5), colour=(0.1, 0.2, 0.5))
    assert not [d for d in detect(picture([wall, rack])) if d.label == "box"]


def test_a_brown_leaf_in_a_wall_is_a_door() -> None:
    wall = Block(lo_m=(5.0, -3.0, 0.0), hi_m=(6.0, 3.0, 2.8), colour=(0.8, 0.8, 0.78))
    leaf = Block(lo_m=(4.96, -0.45, 0.0), hi_m=(5.0, 0.45, 2.05), colour=(0.45, 0.24, 0.11))
    found = [d for d in detect(picture([wall, leaf], eye=(0.0, 0.0, 1.4), pitch_rad=0.1)) if d.label == "door"]
    (door,) = found
    assert door.position_m == pytest.approx((4.97, 0.0, 1.02), abs=0.12)
    assert door.box_m.size_m[0] < 0.3


def test_painted_wall_without_leaf_is_no_door() -> None:
    wall = Block(lo_m=(5.0, -3.0, 0.0), hi_m=(6.0, 3.0, 2.8), colour=(0.45, 0.24, 0.11))
    assert not [d for d in detect(picture([wall], eye=(0.0, 0.0, 1.4), pitch_rad=0.1)) if d.label == "door"]


def cloud_ahead(colour: tuple[int, int, int] = (150, 146, 140)) -> tuple[Frame, np.ndarray]:
    """A cloud 2.6 m ahead, soft in depth and without contrast, its middle in that colour; and its pixels."""
    clear = picture([], pitch_rad=0.2)
    rng = np.random.default_rng(0)
    depth, rgb = clear.depth_m.copy(), clear.rgb.copy()
    inside = np.zeros(depth.shape, bool)
    inside[40:200, 110:230] = True
    inside &= depth > 3.0
    depth[inside] = 2.6 + rng.exponential(0.12, int(inside.sum()))
    depth[inside & (rng.random(depth.shape) < 0.2)] = np.nan
    rgb[inside] = (150, 146, 140)
    middle = inside.copy()
    middle[:, :150] = middle[:, 190:] = False
    rgb[middle] = colour
    frame = Frame(time_s=0.0, rgb=rgb, depth_m=depth, camera=clear.camera, world_from_camera=clear.world_from_camera)
    return frame, inside


def test_a_cloud_is_smoke_by_its_soft_depth_alone() -> None:
    frame, inside = cloud_ahead()
    (smoke,) = [d for d in detect(frame) if d.label == "smoke"]
    assert smoke.points_m is not None
    ahead = (smoke.points_m - frame.world_from_camera[:3, 3]) @ frame.world_from_camera[:3, 2]
    assert np.median(ahead) == pytest.approx(2.7, abs=0.1)
    left, top, right, bottom = smoke.pixels
    assert (right - left) * (bottom - top) > 0.7 * inside.sum()


@pytest.mark.parametrize(
    ("colour", "glows"), [((205, 130, 88), True), ((150, 146, 140), False), ((88, 130, 205), False)]
)
def test_smoke_glows_in_the_light_of_flames(colour: tuple[int, int, int], glows: bool) -> None:
    found = detect(cloud_ahead(colour)[0])
    assert [d for d in found if d.label == "smoke"]
    assert bool([d for d in found if d.label == "glow"]) == glows
    assert not [d for d in found if d.label == "fire"]


def test_a_wall_seen_edge_on_is_no_smoke() -> None:
    eye = (0.0, 0.0, 1.4)
    clear = picture(
        [Block(lo_m=(0.5, 0.12, 0.0), hi_m=(6.0, 2.0, 2.6), colour=(0.5, 0.5, 0.5))], eye=eye, pitch_rad=0.0
    )
    rng = np.random.default_rng(2)
    depth = clear.depth_m.copy()
    lens = clear.camera
    v, u = np.mgrid[: lens.height, : lens.width] + 0.5
    across, up = (u - lens.cx) / lens.fx * depth, (v - lens.cy) / lens.fy * depth
    side = (np.abs(across + 0.12) < 0.03) & (depth > 0.55) & (depth < 6.0)
    assert side.sum() > 1000
    rays_m = np.sqrt(depth**2 + across**2 + up**2)
    lost = side & (rng.random(depth.shape) < 0.6)  # a sensor gets few returns from a surface seen edge-on
    rough = side & ~lost
    depth[rough] += rng.normal(0, 0.25, int(rough.sum())) * (depth[rough] / rays_m[rough])
    depth[lost] = np.nan
    # What is left lies in the wall's plane: each return is where its ray meets it, further away or nearer.
    frame = Frame(
        time_s=0.0,
        rgb=clear.rgb,
        depth_m=depth.astype(np.float32),
        camera=lens,
        world_from_camera=clear.world_from_camera,
    )
    assert not [d for d in detect(frame) if d.label == "smoke"]


def test_a_noisier_sensor_does_not_make_smoke_of_walls() -> None:
    clear = picture([a_box(0.5, PAINTS["red"])])
    rng = np.random.default_rng(1)
    noise = rng.normal(0, 2.0, clear.depth_m.shape) * (0.003 + 0.0008 * clear.depth_m**2)
    frame = Frame(
        time_s=0.0,
        rgb=clear.rgb,
        depth_m=(clear.depth_m + noise).astype(np.float32),
        camera=clear.camera,
        world_from_camera=clear.world_from_camera,
    )
    assert not [d for d in detect(frame) if d.label == "smoke"]


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf, 0.0, -3.0])
def test_depth_that_is_missing_shows_nothing(value: float) -> None:
    assert detect(a_frame(320, 240, np.full((240, 320), value))) == ()


@pytest.mark.parametrize(("width", "height"), [(1, 1), (3, 2), (16, 16), (17, 40), (64, 1)])
def test_tiny_pictures_are_harmless(width: int, height: int) -> None:
    assert all(isinstance(d, Detection) for d in detect(a_frame(width, height, np.full((height, width), 2.0))))


@given(seed=st.integers(0, 10_000), holes=st.floats(0, 1), far=st.floats(0.1, 1e4))
@settings(deadline=None, max_examples=20)
def test_random_pictures_never_crash_it(seed: int, holes: float, far: float) -> None:
    rng = np.random.default_rng(seed)
    depth = rng.uniform(0, far, (48, 64))
    depth[rng.random(depth.shape) < holes] = rng.choice([np.nan, np.inf, 0.0, -1.0])
    rgb = rng.integers(0, 256, (48, 64, 3), dtype=np.uint8)
    for found in detect(a_frame(64, 48, depth, rgb)):
        assert np.isfinite([found.box_m.lo_m, found.box_m.hi_m]).all()
        assert 0 <= found.score <= 1


def test_the_same_picture_gives_the_same_detections() -> None:
    frame = picture([a_box(0.5, PAINTS["blue"])])
    assert [(d.label, d.box_m, d.attributes) for d in detect(frame)] == [
        (d.label, d.box_m, d.attributes) for d in detect(frame)
    ]


@pytest.mark.long
@pytest.mark.skipif(not DATA.is_dir(), reason="needs ../shared/data/rgbd beside the project")
def test_real_pictures_give_finite_things() -> None:
    from PIL import Image

    lens = CameraModel(width=640, height=480, fx=525.0, fy=525.0, cx=319.5, cy=239.5)
    pairs = [(DATA / "color" / f"{i:05d}.jpg", DATA / "depth" / f"{i:05d}.png", 1000.0) for i in range(5)]
    pairs += [(DATA / "tum_desk" / f"{i}.png", DATA / "tum_desk" / f"{i}_depth.png", 5000.0) for i in (1, 2)]
    for rgb, depth, per_metre in pairs:
        with Image.open(rgb) as colours, Image.open(depth) as distances:
            frame = Frame(
                time_s=0.0,
                rgb=np.array(colours.convert("RGB")),
                depth_m=(np.asarray(distances, np.float32) / np.float32(per_metre)),
                camera=lens,
                world_from_camera=pose((0.0, 0.0, 1.3), 0.0, 0.5),
            )
        for found in detect(frame):
            assert max(found.box_m.size_m) < 20
