"""Whole missions from words, on a map of one's own: new steps, named rooms, distances."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import yaml

from mintpilot.assembly.api import plan_mission, run_mission
from mintpilot.assembly.understanding import understand_instructions
from mintpilot.assembly.validation import check_mission
from mintpilot.core.errors import InputError
from mintpilot.core.events import Event, LegFlown
from mintpilot.core.mission import Outcome
from mintpilot.models.doubles import FunctionModel

MAP = "type octile\nheight 8\nwidth 12\nmap\n" + "\n".join(["@" * 12, *["@" + "." * 10 + "@"] * 6, "@" * 12]) + "\n"
LAMP = {"id": "lamp-1", "label": "lamp", "position_m": [9.5, 4.0, 0.2]}
GUARD = {"id": "guard-1", "label": "person", "position_m": [5.5, 4.0, 0.2]}
ROOMS = [
    {
        "id": name, "description": f"the closed {name}", "viewpoint_m": [x, 5.5],
        "door": {"lo_m": [x - 0.5, 6.9, 0.0], "hi_m": [x + 0.5, 7.0, 2.0]},
    }
    for name, x in (("pantry", 3.5), ("garage", 8.5))
]  # fmt: skip


def written(tmp_path: Path, instruction: str, **changes: object) -> Path:
    (tmp_path / "hall.map").write_text(MAP)
    world = {"map": "hall.map", "objects": [LAMP, GUARD], "rooms": ROOMS, "start_m": [1.5, 4.0]}
    path = tmp_path / "mission.yaml"
    text = {"mintpilot": 1, "name": "hall", "instruction": instruction, "world": world, **changes}
    path.write_text(yaml.safe_dump(text, sort_keys=False))
    return path


def flown(path: Path) -> tuple[Outcome, np.ndarray, list[str]]:
    legs: list[LegFlown] = []

    def note(event: Event) -> None:
        legs.extend([event] if isinstance(event, LegFlown) else [])

    record = run_mission(path, vehicle="kinematic", progress=note)
    return record.outcome, np.vstack([leg.log.position_m for leg in legs]), [leg.stop_id for leg in legs]


@pytest.mark.parametrize(
    ("words", "keep_away"),
    [
        ("Go to the lamp and stay 1 m away from people.", []),
        ("Go to the lamp.", [{"from": "people", "metres": 1}]),
    ],
)
def test_the_body_keeps_its_distance_from_people(
    tmp_path: Path, words: str, keep_away: list[dict[str, object]]
) -> None:
    outcome, path_m, _ = flown(written(tmp_path, words, keep_away=keep_away))
    assert outcome is Outcome.SUCCESS
    low, high = np.array([5.3, 3.8]), np.array([5.7, 4.2])
    gaps = np.linalg.norm(path_m[:, :2] - np.clip(path_m[:, :2], low, high), axis=1)
    assert gaps.min() >= 1 + 0.3


def test_a_distance_that_cannot_be_kept_is_asked_about(tmp_path: Path) -> None:
    report = plan_mission(written(tmp_path, "Go to the lamp and stay 3 m away from people."))
    assert report.query is not None
    assert "the space within 3 m of people" in report.query.text
    assert (report.keep_out, [step.text for step in report.steps]) == (["people (3 m)"], ["go to the lamp"])


def test_who_starts_too_near_asks_before_anything_is_flown(tmp_path: Path) -> None:
    report = plan_mission(written(tmp_path, "Go to the lamp and stay 4 m away from people."))
    assert report.query is not None
    assert "nothing can be flown" in report.gaps[0].why or "none the other way" in report.gaps[0].why


def test_counting_and_looking_are_flown_in_order(tmp_path: Path) -> None:
    outcome, _, stops = flown(written(tmp_path, "Search the garage for the keys, then count the lamps and come back."))
    assert outcome is Outcome.SUCCESS
    assert stops == ["look:1", "count:2:lamp-1", "go:3"]


def test_a_room_or_thing_that_is_not_there_is_found_by_check(tmp_path: Path) -> None:
    (problem,) = check_mission(written(tmp_path, "Go to the office."))
    assert "Seen was the closed garage, the closed pantry" in problem.message
    (problem,) = check_mission(written(tmp_path, "Go to the lamp.", keep_away=[{"from": "not them"}]))
    assert problem.path == "keep_away[0].from"


def test_a_distance_from_what_is_not_there_is_found_by_check_and_refused(tmp_path: Path) -> None:
    nobody = written(tmp_path, "Go to the lamp.", keep_away=[{"from": "people"}, {"from": "smoke"}])
    assert not check_mission(nobody)  # they come and go
    barrels = written(tmp_path, "Go to the lamp.", keep_away=[{"from": "people"}, {"from": "the barrels"}])
    (problem,) = check_mission(barrels)
    assert problem.path == "keep_away[1].from"
    assert "matches 'the barrels'" in problem.message
    with pytest.raises(InputError, match="the barrels"):
        plan_mission(barrels)
    (problem,) = check_mission(written(tmp_path, "Go to the lamp. Stay 2 m away from the barrels."))
    assert problem.path == "instruction"


def test_what_a_model_reads_must_be_on_the_map(tmp_path: Path) -> None:
    path = written(tmp_path, "Go to the lamp.")
    for thing, word in (("the lamp", ""), ("the statue", "the statue")):
        model = FunctionModel(lambda _, thing=thing: f'{{"steps": [{{"action": "go", "target": "{thing}"}}]}}')
        (read,) = understand_instructions(["Flieg hinüber"], mission=path, llm=model)
        assert (read.task is None, word in read.reason) == (bool(word), True)
        assert read.task is None or read.task.needs_confirmation


def test_slowly_takes_longer_and_no_picture_is_promised_without_a_camera(tmp_path: Path) -> None:
    quick = plan_mission(written(tmp_path, "Go to the lamp.")).plan_cost_s
    slow = plan_mission(written(tmp_path, "Go slowly to the lamp.")).plan_cost_s
    assert quick is not None
    assert slow == pytest.approx(2 * (quick - 2.0) + 2.0)
    with pytest.raises(Exception, match="no camera"):
        run_mission(written(tmp_path, "Photograph the lamp."), vehicle="kinematic")
