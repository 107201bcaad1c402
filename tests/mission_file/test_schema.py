"""The schema of mission files: it mirrors core and the simulation, and what is published is current."""

import json
from dataclasses import MISSING, fields
from pathlib import Path

import jsonschema
import pytest
import yaml

from mintpilot.core.errors import MissionError
from mintpilot.core.gap import ABSENT, BLOCKED, PASSABLE, PRESENT
from mintpilot.core.geometry import Box
from mintpilot.core.mission import AskingSettings, CriticalityRule, SurveySettings
from mintpilot.core.observation import RegionKind
from mintpilot.core.plan import VehicleLimits
from mintpilot.core.task import Action
from mintpilot.mission_file import schema, schema_scene, schema_world
from mintpilot.mission_file.reader import json_schema, read_mission
from mintpilot.mission_file.schema_core import asking_of, correlations_of, limits_of, mission_of, task_of, truths_of
from mintpilot.mission_file.schema_map import map_of
from mintpilot.simulation import scene

ROOT = Path(__file__).parents[2]
EXAMPLES = [*sorted((ROOT / "examples").glob("*.yaml")), ROOT / "examples" / "my-building" / "mission.yaml"]


@pytest.mark.parametrize(
    ("spec", "noun", "differs"),
    [
        (schema.VehicleSpec, VehicleLimits, {"endurance_s", "returns"}),
        (schema.AskingSpec, AskingSettings, {"strategy_arguments"}),
        (schema.SurveySpec, SurveySettings, {"resolution_m"}),
        (schema_scene.SolidSpec, scene.Solid, {"attributes"}),
        (schema_scene.SmokeSpec, scene.Smoke, set()),
        (schema_scene.PersonSpec, scene.Person, set()),
        (schema_scene.ClosedRoomSpec, scene.ClosedRoom, set()),
        (schema_scene.SceneSpec, scene.Scene, {"name", "landmarks"}),
    ],
)
def test_fields_and_defaults_are_those_of_the_nouns(spec, noun, differs):
    ours = {name: field.get_default(call_default_factory=True) for name, field in spec.model_fields.items()}
    theirs = {f.name: f.default for f in fields(noun)}
    assert set(ours) - differs == set(theirs) - differs
    for name in set(ours) - differs:
        if theirs[name] is not MISSING:
            assert ours[name] == theirs[name], name


def test_words_are_those_of_the_nouns():
    assert set(schema_world.Passability.__args__) == {PASSABLE, BLOCKED}
    assert set(schema_world.Occupancy.__args__) == {PRESENT, ABSENT}
    assert set(schema_world.RegionSpec.model_fields["kind"].annotation.__args__) == set(RegionKind)
    assert set(schema.GoalSpec.model_fields["action"].annotation.__args__) == set(Action)
    assert set(schema.AskingSpec.model_fields["rule"].annotation.__args__) == set(CriticalityRule)
    assert set(schema_scene.SolidSpec.model_fields["shape"].annotation.__args__) == set(scene.Shape)


def test_the_published_schema_is_current():
    published = ROOT / "docs" / "mission.schema.json"
    assert published.read_text(encoding="utf-8") == json_schema(), "run: make docs"


@pytest.mark.long
@pytest.mark.parametrize("path", EXAMPLES, ids=lambda p: p.parent.name + "/" + p.name)
def test_examples_obey_the_published_schema(path):
    validator = jsonschema.Draft202012Validator(json.loads(json_schema()))
    validator.validate(yaml.safe_load(path.read_text(encoding="utf-8")))


def test_every_key_is_described():
    definitions = json.loads(json_schema())["$defs"]
    bare = [
        f"{name}.{key}"
        for name, definition in definitions.items()
        for key, value in definition.get("properties", {}).items()
        if "description" not in value
    ]
    assert bare == []


def test_the_example_map_becomes_core_nouns():
    path = ROOT / "examples" / "my-building" / "mission.yaml"
    file = read_mission(path)
    semantic_map = map_of(file.world, path.parent, file.priors)
    (region,) = semantic_map.regions
    assert (region.id, region.prior_passable, region.passable) == ("smoke-1", 0.6, "open")
    centres = semantic_map.frame.centres_of(
        [(0, *divmod(int(cell), semantic_map.frame.shape[2])) for cell in region.cells]
    )
    assert (centres[:, :2] > (6.5, 3.1)).all()
    assert (centres[:, :2] < (9.7, 6.7)).all()
    assert semantic_map.rooms[0].viewpoint_m == (10.8, 2.0, 1.2)
    assert semantic_map.object("box-red").values("colour") == {"red"}
    assert truths_of(file) == {"smoke-1": "passable", "room-1": "absent", "the box": "box-red"}
    task = task_of(file, layer_m=1.2)
    assert [goal.action for goal in task.subgoals] == [Action.PICK, Action.DELIVER]
    assert task.seeks_people
    mission = mission_of(file, start_m=(1.5, 5.0, 1.2), volume=semantic_map.frame.box)
    assert mission.survey is None
    assert limits_of(file).endurance_s == float("inf")
    assert asking_of(file).max_questions == 10
    assert correlations_of(file) == ()


def test_a_battery_below_take_off_and_landing_is_refused_with_what_they_need():
    file = read_mission(EXAMPLES[0])
    empty = file.model_copy(update={"vehicle": file.vehicle.model_copy(update={"endurance_s": 1.0, "reserve_s": 0.0})})
    with pytest.raises(MissionError, match=r"endurance_s = 1: take-off, landing and the reserve alone need 1\.6 s"):
        mission_of(empty, start_m=(1.0, 1.0, 1.2), volume=Box(lo_m=(0, 0, 0), hi_m=(9, 9, 3)))
