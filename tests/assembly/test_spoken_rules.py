"""Missions whose rules are said in the instruction, measured on what was flown (method, section 14)."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tests.assembly.test_instruction_missions import ROOMS, flown, written

from mintpilot.assembly.api import plan_mission
from mintpilot.assembly.validation import check_mission
from mintpilot.cli.think import lines_of
from mintpilot.core.mission import Outcome

RADIUS_M = 0.2
LAB = {"id": "zone-7", "description": "the old lab", "passable": True, "box": {"lo_m": [5, 1, 0], "hi_m": [7, 5, 2]}}
HALL = {"id": "hall", "description": "the hall", "passable": True, "box": {"lo_m": [0, 0, 0], "hi_m": [12, 5, 2]}}
CLOUD = {"id": "smoke-1", "kind": "smoke", "description": "the smoke", "passable": True,
         "box": {"lo_m": [5, 1, 0], "hi_m": [7, 5, 2]}}  # fmt: skip
LAMP = {"id": "lamp-1", "label": "lamp", "position_m": [9.5, 2.0, 0.2]}
SLIM = {"radius_m": RADIUS_M, "margin_m": 0.1}


def mission(tmp_path: Path, instruction: str, regions: list[dict[str, object]]) -> Path:
    world = {"map": "hall.map", "objects": [LAMP], "rooms": ROOMS, "regions": regions, "start_m": [1.5, 2.0]}
    return written(tmp_path, instruction, world=world, vehicle=SLIM)


def away_m(path_m: np.ndarray, region: dict[str, object]) -> np.ndarray:
    """Metres from each pose to the region's box, on the flat map."""
    low, high = (np.array(region["box"][end][:2], float) for end in ("lo_m", "hi_m"))
    return np.linalg.norm(path_m[:, :2] - np.clip(path_m[:, :2], low, high), axis=1)


def test_what_is_never_to_be_entered_is_flown_around(tmp_path: Path) -> None:
    outcome, path_m, _ = flown(mission(tmp_path, "Go to the lamp", [LAB]))
    assert outcome is Outcome.SUCCESS
    assert away_m(path_m, LAB).min() < RADIUS_M
    outcome, path_m, _ = flown(mission(tmp_path, "Never enter the lab. Go to the lamp", [LAB]))
    assert outcome is Outcome.SUCCESS
    assert away_m(path_m, LAB).min() >= RADIUS_M


def test_the_smoke_is_not_entered_before_the_room_was_looked_into(tmp_path: Path) -> None:
    words = "Look into the garage before you go through the smoke. Then go to the lamp"
    outcome, path_m, stops = flown(mission(tmp_path, words, [CLOUD]))
    assert outcome is Outcome.SUCCESS
    assert stops[0] == "look:1"
    inside = np.flatnonzero(away_m(path_m, CLOUD) < RADIUS_M)
    view = next(np.array(room["viewpoint_m"]) for room in ROOMS if room["id"] == "garage")
    looked = np.flatnonzero(np.linalg.norm(path_m[:, :2] - view, axis=1) < 0.5)[0]
    assert not inside.size or inside[0] > looked
    _, plain_m, _ = flown(mission(tmp_path, "Look into the garage, then go to the lamp", [CLOUD]))
    assert (away_m(plain_m, CLOUD) < RADIUS_M).any()


def test_the_body_stays_within_the_hall(tmp_path: Path) -> None:
    low, high = (np.array(HALL["box"][end][:2], float) for end in ("lo_m", "hi_m"))
    outcome, path_m, _ = flown(mission(tmp_path, "Look into the garage and go to the lamp", [HALL]))
    assert outcome is Outcome.SUCCESS
    assert (path_m[:, :2] + RADIUS_M > high).any()
    outcome, path_m, _ = flown(mission(tmp_path, "Always stay within the hall and go to the lamp", [HALL]))
    assert outcome is Outcome.SUCCESS
    assert (path_m[:, :2] - RADIUS_M >= low - 1e-6).all()
    assert (path_m[:, :2] + RADIUS_M <= high + 1e-6).all()


def test_it_comes_back_at_the_end(tmp_path: Path) -> None:
    outcome, path_m, stops = flown(mission(tmp_path, "Come back at the end. Go to the lamp.", []))
    assert (outcome, stops[:2]) == (Outcome.SUCCESS, ["go:1", "go:2"])
    assert np.linalg.norm(path_m[-1, :2] - [1.5, 2.0]) < 0.75


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("Never enter the hall. Go to the lamp", "there is no region of that name; regions: 'the old lab'"),
        ("Stay within the hall. Go to the lamp", "there is no region of that name"),
        ("Look into the garage before you go through the smoke. Never look", "not understood"),
    ],
)
def test_a_region_that_is_not_there_is_told_with_those_that_are(tmp_path: Path, words: str, said: str) -> None:
    assert any(said in problem.message for problem in check_mission(mission(tmp_path, words, [LAB])))


def test_rules_are_shown_with_the_steps_before_anything_is_flown(tmp_path: Path) -> None:
    words = "Look into the garage before you go through the smoke. Never enter the lab. Go to the lamp"
    path = mission(tmp_path, words, [CLOUD, {**LAB, "box": {"lo_m": [2, 4, 0], "hi_m": [3, 5, 2]}}])
    report = plan_mission(path)
    assert report.rules == ["never enter the smoke before this is done: look into the garage", "never enter the lab"]
    shown = list(lines_of(report))
    assert [f"  rule: {rule}" for rule in report.rules] == shown[3:5]
    told = list(lines_of(plan_mission(path, lang="de")))
    assert told[3].startswith("  Regel: nie hinein: der Rauch, bevor dies getan ist: hineinsehen")
