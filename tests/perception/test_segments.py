from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from people_to_see import POSTURES, picture_of, posture
from scenes import Block, picture

from mintpilot.core.observation import OBJECT, Detection, Frame
from mintpilot.perception import lump_weights, lumps
from mintpilot.perception.door_frames import EVIDENCE
from mintpilot.perception.door_weights import WEIGHTS
from mintpilot.perception.segments import SegmentPerception

TABLE = Block(lo_m=(1.6, -0.8, 0.70), hi_m=(2.8, 0.8, 0.74), colour=(0.55, 0.5, 0.45))
CARTON = Block(lo_m=(2.0, -0.3, 0.74), hi_m=(2.2, -0.05, 0.9), colour=(0.2, 0.2, 0.6))
TIN = Block(lo_m=(2.1, 0.3, 0.74), hi_m=(2.3, 0.5, 1.0), colour=(0.7, 0.1, 0.1))


def detect(frame: Frame) -> tuple[Detection, ...]:
    return SegmentPerception().detect(frame, 3)


def near(found: tuple[Detection, ...], block: Block) -> list[Detection]:
    middle = (np.asarray(block.lo_m) + block.hi_m) / 2
    return [d for d in found if np.linalg.norm(np.asarray(d.position_m) - middle) < 0.15]


def person(found: tuple[Detection, ...]) -> float:
    return max((g.probability for d in found for g in d.names if g.label == "person"), default=0.0)


def test_things_on_a_table_are_found_where_they_are_and_the_table_is_none() -> None:
    found = detect(picture([TABLE, CARTON, TIN], eye=(0.0, 0.0, 1.5), pitch_rad=0.35))
    for block in (CARTON, TIN):
        (thing,) = near(found, block)
        assert thing.label in ("box", OBJECT)
        assert ("place", "on the table") in {(a.name, a.value) for a in thing.attributes}
        assert abs(thing.box_m.lo_m[2] - 0.74) < 0.03
    assert all(max(d.box_m.size_m[:2]) < 1.0 for d in found if d.score > 0.5)


@pytest.mark.parametrize("paint", [(0.9, 0.9, 0.9), (0.47, 0.47, 0.47), (0.1, 0.5, 0.2)])
def test_what_stands_is_found_whatever_its_colour(paint: tuple[float, float, float]) -> None:
    block = Block(lo_m=(2.6, -0.25, 0.0), hi_m=(3.1, 0.25, 0.5), colour=paint)
    (thing,) = near(detect(picture([block])), block)
    assert thing.label == "box"


@pytest.mark.long
@pytest.mark.parametrize(
    ("name", "turned"),
    [
        pytest.param(name, turned, marks=() if (number + turn) % 2 == 0 else pytest.mark.slow)
        for number, name in enumerate(POSTURES)
        for turn, turned in enumerate([0.4, 2.0])
    ],
)
def test_people_in_any_posture_are_named_or_asked_about(name: str, turned: float) -> None:
    found = detect(picture_of(posture(name), turned_rad=turned, at=(2.6, 0.1), seed=5))
    assert person(found) >= 0.25


@pytest.mark.parametrize(
    "blocks",
    [
        [Block(lo_m=(2.6, -0.25, 0.0), hi_m=(3.0, 0.2, 1.6), colour=(0.5, 0.5, 0.6))],
        [Block(lo_m=(2.6, -0.8, 0.0), hi_m=(3.1, 0.8, 0.35), colour=(0.5, 0.4, 0.3))],
        [TABLE, CARTON, TIN],
    ],
)
def test_furniture_is_nobody(blocks: list[Block]) -> None:
    assert person(detect(picture(blocks))) < 0.25


@pytest.mark.parametrize("paint", [(0.95, 0.95, 0.95), (0.1, 0.35, 0.15), (0.3, 0.2, 0.1)])
def test_a_shut_door_of_any_colour_is_found_in_its_wall(paint: tuple[float, float, float]) -> None:
    wall = Block(lo_m=(4.0, -5.0, 0.0), hi_m=(4.2, 5.0, 3.0), colour=(0.6, 0.6, 0.55))
    leaf = Block(lo_m=(3.97, -0.3, 0.0), hi_m=(4.0, 0.6, 2.05), colour=paint)
    doors = [d for d in detect(picture([wall, leaf], pitch_rad=0.12)) if d.label == "door"]
    assert len(doors) == 1
    assert np.linalg.norm(np.asarray(doors[0].position_m)[:2] - (4.0, 0.15)) < 0.15


@pytest.mark.parametrize("frame_colour", [(0.5, 0.5, 0.46), (0.72, 0.72, 0.68)])
def test_a_door_in_the_colour_of_its_wall_is_found_by_its_frame(frame_colour: tuple[float, float, float]) -> None:
    paint = (0.6, 0.6, 0.55)
    wall = Block(lo_m=(4.0, -5.0, 0.0), hi_m=(4.2, 5.0, 3.0), colour=paint)
    leaf = Block(lo_m=(3.99, -0.3, 0.0), hi_m=(4.0, 0.6, 2.05), colour=paint)
    frame = [
        Block(lo_m=(3.98, a, 0.0), hi_m=(4.0, b, top), colour=frame_colour)
        for a, b, top in ((-0.37, -0.3, 2.12), (0.6, 0.67, 2.12))
    ]
    lintel = Block(lo_m=(3.98, -0.37, 2.05), hi_m=(4.0, 0.67, 2.12), colour=frame_colour)
    doors = [d for d in detect(picture([wall, leaf, *frame, lintel], pitch_rad=0.12)) if d.label == "door"]
    assert len(doors) == 1
    assert np.linalg.norm(np.asarray(doors[0].position_m)[:2] - (4.0, 0.15)) < 0.15


def test_a_wall_between_a_corner_and_a_panel_is_no_door() -> None:
    wall = Block(lo_m=(4.0, -5.0, 0.0), hi_m=(4.2, 5.0, 3.0), colour=(0.6, 0.6, 0.55))
    corner = Block(lo_m=(2.0, 1.0, 0.0), hi_m=(4.0, 1.2, 3.0), colour=(0.6, 0.6, 0.55))
    stripe = Block(lo_m=(3.99, -0.06, 0.0), hi_m=(4.0, 0.0, 3.0), colour=(0.2, 0.2, 0.25))
    assert not [d for d in detect(picture([wall, corner, stripe], pitch_rad=0.12)) if d.label == "door"]


def test_a_shut_door_between_panels_as_wide_as_it_is_one_door() -> None:
    """Battens between the panels run up past the lintel, and a rail above goes on all along the wall."""
    wood, dark = (0.5, 0.36, 0.24), (0.34, 0.24, 0.16)
    wall = Block(lo_m=(4.0, -3, 0), hi_m=(4.3, 3, 2.8), colour=wood)
    leaf = Block(lo_m=(3.99, -0.4, 0.0), hi_m=(4.0, 0.5, 2.05), colour=dark)
    battens = [Block(lo_m=(3.985, y, 0), hi_m=(4.0, y + 0.06, 2.4), colour=dark) for y in (-2.3, -1.4, 1.4, 2.3)]
    rail = Block(lo_m=(3.985, -3, 2.4), hi_m=(4.0, 3, 2.46), colour=dark)
    doors = [d for d in detect(picture([wall, leaf, *battens, rail], pitch_rad=0.12)) if d.label == "door"]
    likely = [d for d in doors if d.score > 0.5]
    assert len(likely) == 1
    assert np.linalg.norm(np.asarray(likely[0].position_m)[:2] - (4.0, 0.05)) < 0.15


def test_every_piece_of_evidence_has_its_weight() -> None:
    assert tuple(name for name, _ in WEIGHTS) == EVIDENCE
    assert tuple(name for name, _ in lump_weights.WEIGHTS) == lumps.FEATURES


def test_a_bare_wall_has_no_door_and_a_sunlit_floor_no_fire() -> None:
    frame = picture([])
    glare = frame.rgb.copy()
    glare[150:, 60:250] = (250, 150, 40)
    glare[150:, 100:140] = (255, 200, 60)
    labels = {d.label for d in detect(replace(frame, rgb=glare))}
    assert not labels & {"fire", "smoke", "door", "person"}


def test_a_wall_in_one_even_bright_colour_is_no_smoke() -> None:
    frame = picture([])
    white = np.full_like(frame.rgb, 235)
    assert not {d.label for d in detect(replace(frame, rgb=white))} & {"smoke", "fire"}


def test_each_body_is_one_thing_when_boxes_are_stacked() -> None:
    low = Block(lo_m=(2.4, -0.4, 0.0), hi_m=(3.0, 0.4, 0.4), colour=(0.6, 0.5, 0.3))
    high = Block(lo_m=(2.55, -0.2, 0.4), hi_m=(2.85, 0.2, 0.75), colour=(0.6, 0.5, 0.3))
    found = detect(picture([low, high], eye=(0.0, 0.0, 1.7), pitch_rad=0.4))
    assert len(near(found, low)) == 1
    assert len(near(found, high)) == 1
