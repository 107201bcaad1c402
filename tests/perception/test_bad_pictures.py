"""Pictures that no camera should give: nothing dangerous or living is claimed of them, and nothing breaks."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from scenes import Block, picture

from mintpilot.core.observation import Detection, Frame
from mintpilot.core.ports import Perception
from mintpilot.perception.geometric import GeometricPerception
from mintpilot.perception.segments import SegmentPerception

BOX = Block(lo_m=(2.6, -0.25, 0.0), hi_m=(3.1, 0.25, 0.5), colour=(0.6, 0.5, 0.3))
RNG = np.random.default_rng(5)


def _depth(frame: Frame, made: np.ndarray) -> Frame:
    return replace(frame, depth_m=made.astype(np.float32))


def _colour(frame: Frame, made: np.ndarray) -> Frame:
    return replace(frame, rgb=np.broadcast_to(made, frame.rgb.shape).astype(np.uint8).copy())


def _holed(frame: Frame, share: float) -> Frame:
    return _depth(frame, np.where(RNG.random(frame.depth_m.shape) < share, np.nan, frame.depth_m))


BAD: dict[str, Callable[[Frame], Frame]] = {
    "no depth": lambda f: _depth(f, np.zeros(f.depth_m.shape)),
    "depth is not a number": lambda f: _depth(f, np.full(f.depth_m.shape, np.nan)),
    "endless depth": lambda f: _depth(f, np.full(f.depth_m.shape, np.inf)),
    "negative depth": lambda f: _depth(f, -f.depth_m),
    "one depth": lambda f: _depth(f, np.full(f.depth_m.shape, 1.0)),
    "depth in millimetres": lambda f: _depth(f, 1000 * f.depth_m),
    "depth is noise": lambda f: _depth(f, RNG.uniform(0.3, 8.0, f.depth_m.shape)),
    "half of the depth is missing": lambda f: _holed(f, 0.5),
    "most of the depth is missing": lambda f: _holed(f, 0.95),
    "a single return": lambda f: _depth(f, np.eye(*f.depth_m.shape) * (np.arange(f.depth_m.shape[1]) == 40)),
    "black": lambda f: _colour(f, np.zeros(3)),
    "over-exposed": lambda f: _colour(f, np.full(3, 255)),
    "all orange": lambda f: _colour(f, np.array([255, 140, 20])),
    "colour is noise": lambda f: _colour(f, RNG.integers(0, 256, f.rgb.shape)),
    "black without depth": lambda f: _colour(_depth(f, np.zeros(f.depth_m.shape)), np.zeros(3)),
}


def certain(found: tuple[Detection, ...]) -> set[str]:
    return {d.label for d in found if d.label in ("person", "fire", "smoke", "glow", "door")}


@pytest.mark.long
@pytest.mark.parametrize("name", BAD)
def test_nothing_dangerous_is_claimed_of_a_bad_picture(name: str) -> None:
    bad = BAD[name](picture([BOX], pitch_rad=0.35))
    found = SegmentPerception().detect(bad, 0)
    assert not certain(found) - {"smoke" if "noise" in name and "depth" in name else ""}
    for one in found:
        assert np.isfinite([*one.box_m.lo_m, *one.box_m.hi_m]).all()
        assert 0 <= one.score <= 1


@pytest.mark.long
@pytest.mark.parametrize("name", BAD)
@pytest.mark.parametrize("perception", [GeometricPerception, SegmentPerception])
def test_no_bad_picture_breaks_perception(name: str, perception: type[Perception]) -> None:
    perception().detect(BAD[name](picture([BOX], pitch_rad=0.35)), 0)


@pytest.mark.parametrize("size", [(1, 1), (8, 8), (17, 3)])
def test_a_tiny_picture_shows_nothing(size: tuple[int, int]) -> None:
    height, width = size
    frame = picture([BOX])
    small = Frame(
        time_s=0.0,
        rgb=frame.rgb[:height, :width].copy(),
        depth_m=frame.depth_m[:height, :width].copy(),
        camera=replace(frame.camera, width=width, height=height),
        world_from_camera=frame.world_from_camera,
    )
    assert SegmentPerception().detect(small, 0) == ()
