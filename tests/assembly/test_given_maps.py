"""Missions on a map of one's own are flown and judged by what their file declares."""

from pathlib import Path

import pytest
import yaml

from mintpilot.assembly.api import run_mission
from mintpilot.assembly.declared import wanted_of
from mintpilot.assembly.worlds import build_world
from mintpilot.core.mission import Outcome
from mintpilot.core.plan import Site, Stop
from mintpilot.core.task import Action
from mintpilot.mission_file.reader import read_mission
from mintpilot.simulation.judge import SceneJudge

MAP = "type octile\nheight 8\nwidth 12\nmap\n" + "\n".join(["@" * 12, *["@" + "." * 10 + "@"] * 6, "@" * 12]) + "\n"
BOXES = [
    {"id": "near", "label": "box", "position_m": [3.5, 4.5, 0.2], "attributes": {"colour": "red"}},
    {"id": "far", "label": "box", "position_m": [9.5, 6.5, 0.2], "attributes": {"colour": "blue"}},
]
SOMEBODY = {"id": "anna", "label": "person", "position_m": [9.5, 1.5, 0.2]}


def mission(tmp_path: Path, **changes: object) -> Path:
    (tmp_path / "hall.map").write_text(MAP)
    world = {"map": "hall.map", "start_m": [1.5, 1.5], "objects": [*BOXES, SOMEBODY], **changes.pop("world", {})}
    text = {"mintpilot": 1, "name": "hall", "instruction": "Pick up the box.", "world": world, **changes}
    text.setdefault("vehicle", {"radius_m": 0.3})
    path = tmp_path / "mission.yaml"
    path.write_text(yaml.safe_dump(text, sort_keys=False))
    return path


def fly(path: Path):
    return run_mission(path, vehicle="kinematic")


@pytest.mark.parametrize("meant", ["near", "far"])
def test_the_box_that_was_declared_is_asked_for_and_taken(tmp_path, meant):
    record = fly(mission(tmp_path, goals=[{"action": "pick", "phrase": "the box", "label": "box", "truth": meant}]))
    assert record.outcome is Outcome.SUCCESS
    assert record.questions[0].reply.value in ("yes", "no")


def test_where_no_truth_is_declared_whatever_is_taken_counts(tmp_path):
    world = build_world(read_mission(mission(tmp_path)), base=tmp_path, seed=None)
    assert world.scene.goal_objects == ("",)
    judge = SceneJudge(world.scene, world.rules)
    judge.acted(Stop(id="pick:1", action=Action.PICK, sites=(Site(position_m=(9.5, 6.5, 1.0)),)), (9.5, 6.0, 1.0))
    assert judge.final().outcome is Outcome.SUCCESS


def test_the_truth_of_a_phrase_counts_without_goals_too(tmp_path):
    world = build_world(read_mission(mission(tmp_path, truth={"the box": "far"})), base=tmp_path, seed=None)
    assert world.scene.goal_objects == ("far",)


def test_taking_another_box_than_the_declared_one_fails(tmp_path):
    goals = [{"action": "pick", "phrase": "the box", "label": "box", "truth": "far"}]
    world = build_world(read_mission(mission(tmp_path, goals=goals)), base=tmp_path, seed=None)
    judge = SceneJudge(world.scene, world.rules)
    judge.acted(Stop(id="pick:1", action=Action.PICK, sites=(Site(position_m=(3.5, 4.5, 1.0)),)), (3.5, 4.0, 1.0))
    verdict = judge.final()
    assert verdict.outcome is Outcome.WRONG_TARGET
    assert "'near'" in str(verdict.reason)
    assert "'far' was meant" in str(verdict.reason)


def test_a_bare_place_is_reached_even_where_a_thing_stands_on_it(tmp_path):
    goals = [{"action": "go", "position_m": [9.5, 6.5]}, {"action": "pick", "object": "near"}]
    path = mission(tmp_path, goals=goals)
    world = build_world(read_mission(path), base=tmp_path, seed=None)
    assert world.scene.goal_objects == ("go:1", "near")
    assert SceneJudge(world.scene, world.rules).final().outcome is Outcome.NOT_REACHED
    assert fly(path).outcome is Outcome.SUCCESS


def test_people_on_the_map_must_be_found_when_people_are_sought(tmp_path):
    path = mission(tmp_path, goals=[{"action": "go", "position_m": [1.5, 6.5]}], seeks_people=True)
    record = fly(path)
    assert record.outcome is Outcome.PERSON_MISSED
    assert "'anna'" in record.reason


def test_a_person_who_is_no_goal_need_not_be_found(tmp_path):
    file = read_mission(mission(tmp_path, goals=[{"action": "go", "position_m": [1.5, 6.5]}]))
    world = build_world(file, base=tmp_path, seed=None)
    assert wanted_of(world.map, world.task, {}, (1.5, 1.5, 1.0)).people == frozenset()


def test_a_flight_high_above_the_things_of_a_flat_map_still_reaches_them(tmp_path):
    goals = [{"action": "pick", "object": "far"}, {"action": "deliver", "phrase": "the person", "label": "person"}]
    path = mission(tmp_path, world={"height_m": 4.0}, goals=goals)
    assert fly(path).outcome is Outcome.SUCCESS
