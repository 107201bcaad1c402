"""The mission file's reader: every mistake is found, with its place, the value, the rule and what to write instead."""

import copy
from pathlib import Path

import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st

from mintpilot.core.errors import InputError, MissionError
from mintpilot.mission_file import yaml_places
from mintpilot.mission_file.reader import MissionFileError, find_problems, read_mission
from mintpilot.mission_file.yaml_places import scalar

ROOT = Path(__file__).parents[2]
MAP = "image: map.pgm\nresolution: 1.0\norigin: [0, 0, 0]\n"
PIXELS = "P2\n8 4\n255\n" + "254 254 254 254 254 254 254 254\n" * 3 + "254 0 254 205 254 254 254 254\n"
"""8 x 4 m; in the southern row the second cell is a wall, the fourth unknown."""
MISSION = {
    "mintpilot": 1,
    "name": "m",
    "instruction": "Bring the box to the injured person.",
    "world": {
        "map": "map.yaml",
        "start_m": [0.5, 3.5],
        "regions": [
            {"id": "smoke-1", "description": "the smoke", "box": {"lo_m": [2, 1, 0], "hi_m": [4, 3, 2]}},
            {"id": "area-1", "description": "the area", "polygon": [[5, 1], [6, 1], [6, 2]]},
        ],
        "rooms": [
            {
                "id": "room-1",
                "description": "the room",
                "door": {"lo_m": [7, 0, 0], "hi_m": [7, 1, 2]},
                "viewpoint_m": [6.5, 0.5],
            }
        ],
        "objects": [
            {"id": "box-1", "label": "box", "position_m": [7, 3]},
            {"id": "box-2", "label": "box", "position_m": [1, 2]},
        ],
    },
    "goals": [
        {"action": "pick", "phrase": "the box", "label": "box"},
        {"action": "go", "position_m": [0.5, 0.5]},
    ],
}
SCENE = {
    "mintpilot": 1,
    "name": "s",
    "instruction": "Go to the red box.",
    "world": {
        "scene": {
            "volume": {"lo_m": [0, 0, 0], "hi_m": [10, 8, 4]},
            "start_m": [1, 1, 1.2],
            "solids": [
                {"id": "box-1", "kind": "box", "extent_m": {"lo_m": [4, 4, 0], "hi_m": [5, 5, 1]}},
                {"id": "rack-1", "kind": "rack", "extent_m": {"lo_m": [6, 1, 0], "hi_m": [7, 5, 2]}},
            ],
            "persons": [{"id": "person-1", "position_m": [8, 7, 0]}],
            "goal_objects": ["box-1"],
        }
    },
}


def write(folder: Path, text: str | bytes) -> Path:
    (folder / "map.yaml").write_text(MAP)
    (folder / "map.pgm").write_text(PIXELS)
    path = folder / "mission.yaml"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return path


def changed(mission: dict, place: str, value: object) -> str:
    """The mission as text with one place set; ``...`` removes it."""
    mission = copy.deepcopy(mission)
    *steps, last = [int(step) if step.isdigit() else step for step in place.split("/")]
    target = mission
    for step in steps:
        target = target[step]
    if value is ...:
        del target[last]
    elif isinstance(last, int) and last == len(target):
        target.append(value)
    else:
        target[last] = value
    return yaml.safe_dump(mission, sort_keys=False)


@pytest.mark.parametrize("mission", [MISSION, SCENE], ids=["map", "scene"])
def test_sound_missions_have_no_problems(tmp_path, mission):
    path = write(tmp_path, yaml.safe_dump(mission, sort_keys=False))
    assert find_problems(path) == []
    assert read_mission(path).name == mission["name"]


BAD = [
    # place that is changed, new value, where the problem is, words of the message
    ("mintpilot", 2, "mintpilot", ["2 is not allowed", "known: 1"]),
    ("mintpilot", ..., "", ["'mintpilot' is missing", "mintpilot: 1"]),
    ("name", ..., "name", ["'name' is missing"]),
    ("name", "two words", "name", ["'two words'", "letters, digits"]),
    ("name", 7, "name", ["7 must be text", '"7"']),
    ("instruction", "", "instruction", ["must not be empty"]),
    ("instrution", "x", "instrution", ["unknown key 'instrution'", "did you mean 'instruction'?"]),
    ("world", {}, "world", ["scenario", "scene", "map"]),
    ("world", 3, "world", ["scenario", "scene", "map"]),
    ("world", {"scenario": "fire-warehous"}, "world.scenario", ["did you mean 'fire-warehouse'?"]),
    ("world", {"scenario": "fire-warehouse", "seed": -1}, "world.seed", ["-1 must be at least 0"]),
    ("world/map", "none.yaml", "world.map", ["there is no map", "none.yaml"]),
    ("world/map", "map.pgm", "world.map", ["'map.pgm' must end in .yaml"]),
    ("world/resolution_m", 0.5, "world.resolution_m", ["names its own resolution"]),
    ("world/start_m", [0.5], "world.start_m", ["at least 2 items"]),
    ("world/start_m", [0.5, "x"], "world.start_m[1]", ["'x' must be a number"]),
    ("world/start_m", [0.5, float("nan")], "world.start_m[1]", [".nan must be a finite number"]),
    ("world/start_m", [99, 0], "world.start_m", ["[99.0, 0.0] is outside the map", "[8.0, 4.0, "]),
    ("world/start_m", [1.5, 0.5], "world.start_m", ["is in an occupied cell"]),
    ("world/start_m", [3.5, 0.5], "world.start_m", ["is in an unknown cell"]),
    ("world/regions/0/prior_passable", 1.4, "world.regions[0].prior_passable", ["1.4 must be at most 1"]),
    ("world/regions/0/prior_passable", -0.1, "world.regions[0].prior_passable", ["-0.1 must be at least 0"]),
    ("world/regions/0/prior_passable", "half", "world.regions[0].prior_passable", ["'half' must be a number"]),
    ("world/regions/0/descripton", "x", "world.regions[0].descripton", ["did you mean 'description'?"]),
    ("world/regions/0/kind", "smok", "world.regions[0].kind", ["did you mean 'smoke'?"]),
    ("world/regions/0/box", ..., "world.regions[0]", ["exactly one of box, polygon and mask", "not none"]),
    ("world/regions/0/mask", "map.yaml", "world.regions[0]", ["not box and mask"]),
    ("world/regions/0/box/hi_m", [1, 3, 2], "world.regions[0].box.hi_m[0]", ["1 is below 2", "swap"]),
    ("world/regions/0/box/hi_m", [1, 3], "world.regions[0].box.hi_m", ["2 numbers, 3 are wanted"]),
    ("world/regions/0/heights_m", [0, 1], "world.regions[0].heights_m", ["with a polygon only"]),
    ("world/regions/0/truth", "maybe", "world.regions[0].truth", ["known: blocked, passable"]),
    ("world/regions/0/id", "area-1", "world.regions[1].id", ["'area-1' is the id of world.regions[0] already"]),
    ("world/regions/1/id", "box-1", "world.objects[0].id", ["'box-1'", "world.regions[1]"]),
    ("world/regions/1/polygon", [[5, 1], [6, 1]], "world.regions[1].polygon", ["at least 3 items"]),
    ("world/regions/1/polygon", [[50, 1], [60, 1], [60, 9]], "world.regions[1].polygon", ["covers no cell"]),
    ("world/regions/1/heights_m", [2, 1], "world.regions[1].heights_m", ["[2, 1] must rise"]),
    ("world/rooms/0/viewpoint_m", [1.5, 0.5], "world.rooms[0].viewpoint_m", ["occupied cell"]),
    ("world/rooms/0/prior_occupied", 2, "world.rooms[0].prior_occupied", ["2 must be at most 1"]),
    ("world/objects/0/position_m", [7, 30], "world.objects[0].position_m", ["outside the map"]),
    ("world/objects/0/size_m", [1, -1, 1], "world.objects[0].size_m[1]", ["-1 must not be below 0"]),
    ("world/objects/0/attributes", {"colour": 3}, "world.objects[0].attributes.colour", ["3"]),
    ("goals", [], "goals", ["at least 1 items"]),
    (
        "goals/0/action",
        "fly",
        "goals[0].action",
        ["'fly' is not allowed", "known: count, deliver, go, look, photograph"],
    ),
    ("goals/0/object", "box-1", "goals[0]", ["exactly one of", "not phrase and object"]),
    ("goals/0/truth", "box-7", "goals[0].truth", ["no object 'box-7'", "did you mean 'box-"]),
    ("goals/1", {"action": "go", "object": "bax-2"}, "goals[1].object", ["did you mean 'box-2'?"]),
    ("goals/1", {"action": "look", "room": "room-2"}, "goals[1].room", ["did you mean 'room-1'?"]),
    ("goals/1", {"action": "go", "room": "room-1", "label": "x"}, "goals[1].label", ["goes with a phrase only"]),
    ("goals/1/position_m", [9, 9], "goals[1].position_m", ["outside the map"]),
    ("vehicle", {"radius_m": 0}, "vehicle.radius_m", ["0 must be above 0"]),
    ("vehicle", {"endurance_s": "long"}, "vehicle.endurance_s", ["'long' must be a number"]),
    ("asking", {"answer_error": 0.5}, "asking.answer_error", ["0.5 must be below 0.5"]),
    ("asking", {"max_questions": 1.5}, "asking.max_questions", ["1.5 must be a whole number"]),
    ("asking", {"rule": "papr"}, "asking.rule", ["did you mean 'paper'?"]),
    ("survey", {"spacing_m": 3}, "survey", ["needs no survey"]),
    ("priors", {"passable": 7}, "priors.passable", ["7 must be at most 1"]),
    ("operator", {"answer_error": -1}, "operator.answer_error", ["-1 must be at least 0"]),
    ("truth", {"smoke-9": "passable"}, "truth.smoke-9", ["no region, room or phrase", "did you mean 'smoke-1'?"]),
    (
        "looks",
        [{"at": "smoke-9", "viewpoint_m": [0.5, 0.5]}],
        "looks[0].at",
        ["no region 'smoke-9'", "mean 'smoke-1'?"],
    ),
    (
        "looks",
        [{"at": "smoke-1", "viewpoint_m": [0.5, 0.5], "dwell_s": s} for s in (2, 3)],
        "looks[1].at",
        ["'smoke-1' is looked at twice"],
    ),
    ("looks", [{"at": "smoke-1", "viewpoint_m": [2, 5], "sees": 0}], "looks[0].sees", ["0 must be above 0"]),
    ("looks", [{"at": "smoke-1", "viewpoint_m": [99, 5]}], "looks[0].viewpoint_m", ["outside the map"]),
    ("looks", [{"at": "smoke-1", "viewpoint_m": [1.5, 0.5]}], "looks[0].viewpoint_m", ["occupied cell"]),
    ("world/regions/0/description", 3, "world.regions[0].description", ["3 must be text", "what the operator"]),
    ("world/regions/0/description", {"en": 5}, "world.regions[0].description.en", ["5 must be text"]),
    ("world/regions/0/description", {"xx": "y"}, "world.regions[0].description.xx", ["known: de, en, es, fr"]),
    ("world/regions/0/description", {}, "world.regions[0].description", ["at least 1 items"]),
    ("truth", {"smoke-1": "present"}, "truth.smoke-1", ["'present' is not a value", "blocked, passable"]),
    ("truth", {"the box": "box-9"}, "truth.the box", ["'box-9' is not a value"]),
    ("truth", {"room-1": True}, "truth.room-1", ["true must be text"]),
    (
        "correlations",
        [{"gaps": ["obstacle:smoke-1"], "joint": [{"values": ["passable"], "probability": 1}]}],
        "correlations[0].gaps",
        ["at least 2 items"],
    ),
]


@pytest.mark.long
@pytest.mark.parametrize(("place", "value", "where", "words"), BAD, ids=[f"{b[0]}={b[1]}"[:60] for b in BAD])
def test_each_mistake_is_named_with_its_place(tmp_path, place, value, where, words):
    path = write(tmp_path, changed(MISSION, place, value))
    problems = find_problems(path)
    assert [problem.path for problem in problems] == [where], [str(p) for p in problems]
    text = str(problems[0])
    assert text.startswith(f"{path}:{problems[0].line}")
    for word in words:
        assert word in text
    with pytest.raises(MissionError, match="1 mistake in"):
        read_mission(path)


JOINT = {
    "gaps": ["obstacle:smoke-1", "obstacle:area-1"],
    "joint": [
        {"values": ["passable", "passable"], "probability": 0.7},
        {"values": ["blocked", "blocked"], "probability": 0.3},
    ],
}


@pytest.mark.parametrize(
    ("place", "value", "where", "words"),
    [
        ("joint/0/probability", 0.6, "correlations[0].joint", ["sum to 0.9", "must sum to 1"]),
        ("joint/0/values", ["passable"], "correlations[0].joint[0].values", ["1 values for 2 gaps"]),
        ("joint/0/values", ["passable", "open"], "correlations[0].joint[0].values[1]", ["'open' is not a value"]),
        ("joint/0/values", ["blocked", "blocked"], "correlations[0].joint[1]", ["given twice"]),
        ("gaps/1", "obstacle:aria-1", "correlations[0].gaps[1]", ["did you mean 'obstacle:area-1'?"]),
    ],
)
def test_correlations_that_contradict_themselves(tmp_path, place, value, where, words):
    group = yaml.safe_load(changed(JOINT, place, value))
    (problem,) = find_problems(write(tmp_path, changed(MISSION, "correlations", [group])))
    assert problem.path == where
    assert all(word in problem.message for word in words), problem.message


def test_a_sound_correlation_passes_and_a_gap_in_two_groups_does_not(tmp_path):
    assert find_problems(write(tmp_path, changed(MISSION, "correlations", [JOINT]))) == []
    problems = find_problems(write(tmp_path, changed(MISSION, "correlations", [JOINT, copy.deepcopy(JOINT)])))
    assert {problem.path for problem in problems} == {f"correlations[{i}].gaps[{j}]" for i in (0, 1) for j in (0, 1)}


@pytest.mark.parametrize(
    ("place", "value", "where", "words"),
    [
        ("start_m", [1, 1, 5], "start_m", ["outside the volume"]),
        ("start_m", [6.5, 2, 1], "start_m", ["inside 'rack-1'"]),
        ("volume/hi_m", [10, -1, 4], "volume.hi_m[1]", ["-1 is below 0"]),
        ("volume/hi_m", [10, 8, 0], "volume", ["no space to fly in"]),
        ("goal_objects", ["box-7"], "goal_objects[0]", ["did you mean 'box-1'?"]),
        ("persons/0/id", "box-1", "persons[0].id", ["'box-1' is the id of world.scene.solids[0] already"]),
        ("persons/0/position_m", [80, 7, 0], "persons[0].position_m", ["outside the volume"]),
        ("solids/0/shape", "cone", "solids[0].shape", ["box, cylinder, sphere"]),
        ("smokes", [{"id": "s", "extent_m": SCENE["world"]["scene"]["volume"]}], "smokes[0].toxic", ["is missing"]),
    ],
)
def test_scenes_that_contradict_themselves(tmp_path, place, value, where, words):
    (problem,) = find_problems(write(tmp_path, changed(SCENE, f"world/scene/{place}", value)))
    assert problem.path == f"world.scene.{where}"
    assert all(word in problem.message for word in words), problem.message


def test_names_of_things_are_known_on_given_maps_only(tmp_path):
    mission = {**SCENE, "goals": [{"action": "go", "object": "box-1"}], "truth": {"smoke-1": "passable"}}
    problems = find_problems(write(tmp_path, yaml.safe_dump(mission, sort_keys=False)))
    assert [problem.path for problem in problems] == ["goals[0].object", "truth"]


def test_all_mistakes_are_listed_in_the_order_of_the_file(tmp_path):
    text = changed(MISSION, "world/regions/0/prior_passable", 3)
    text = text.replace("name: m", "name: 5").replace("label: box", "lable: box")
    problems = find_problems(write(tmp_path, text))
    assert len(problems) == 7  # name, prior; in two objects and a goal: the unknown key, and the label that is missing
    assert [p.line for p in problems] == sorted(p.line for p in problems)
    assert problems[0].line == 2
    with pytest.raises(MissionFileError, match="7 mistakes") as caught:
        read_mission(tmp_path / "mission.yaml")
    assert caught.value.problems == tuple(problems)
    assert isinstance(caught.value, InputError)


YAML = [
    (b"", 1, "the file is empty"),
    (b"- a\n- b\n", 1, "a mission is a mapping"),
    (b"mintpilot: 1\nname: [a\n", 3, "not YAML"),
    (b"mintpilot: 1\n\tname: a\n", 2, "not YAML"),
    (b"mintpilot: 1\nname: a\nname: b\n", 3, "'name' is given again (first on line 2)"),
    (b"mintpilot: 1\nname: &x a\ninstruction: *x\n", 2, "anchors (&)"),
    (b"mintpilot: 1\nname: !!python/object/apply:os.system [ls]\n", 2, "the tag"),
    (b"mintpilot: 1\n---\nmintpilot: 1\n", 2, "second document"),
    (b"mintpilot: 1\n[1, 2]: x\n", 2, "a key must be a word"),
    (b"mintpilot: 1\nname: \xff\xfe\n", 2, "byte 0xff is not UTF-8"),
    (b"mintpilot: 1\nname: \x00\n", 1, "not YAML"),
    (b"a: " + b"[" * 200 + b"]" * 200, 1, "nested deeper"),
    (b"a: " + b"[" * 100_000, 1, "nested deeper"),
    (b"a: [" + b"1," * 60_000 + b"]", 1, "more than 50000 values"),
    (b"#" * 1_000_001, 1, "more than 1000000 bytes"),
]


@pytest.mark.long
@pytest.mark.parametrize(("data", "line", "words"), YAML, ids=[y[2] for y in YAML])
def test_unreadable_yaml(tmp_path, data, line, words):
    problems = find_problems(write(tmp_path, data))
    assert words in problems[0].message, problems[0]
    assert problems[0].line == line


def test_missing_file_and_folder(tmp_path):
    assert "there is no file" in find_problems(tmp_path / "none.yaml")[0].message
    assert "no regular file" in find_problems(tmp_path)[0].message


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("1e-3", 0.001), ("-2", -2), (".5", 0.5), ("1.", 1.0), ("no", "no"), ("on", "on"), ("12:30", "12:30"),
        ("2026-11-22", "2026-11-22"), ("0x10", "0x10"), ("true", True), ("null", None), ("", None),
        ("-.inf", float("-inf")), ("1_000", "1_000"), ("9" * 30, float("9" * 30)),
    ],
)  # fmt: skip
def test_plain_words_are_read_as_yaml_1_2_has_it(text, value):
    assert scalar(text) == value
    assert type(scalar(text)) is type(value)


@given(st.binary(max_size=300))
@settings(max_examples=150, deadline=None)
def test_no_bytes_whatever_raise(tmp_path_factory, data):
    path = tmp_path_factory.getbasetemp() / "fuzz.yaml"
    path.write_bytes(data)
    assert find_problems(path)


values = st.recursive(
    st.none() | st.booleans() | st.integers(-5, 5) | st.floats() | st.text("abc -1:{", max_size=6),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.sampled_from(["id", "map", "box", "x"]), inner),
    max_leaves=6,
)


def _places(value: object, path: str = "") -> list[str]:
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    return [place for key, inner in items for place in (f"{path}{key}", *_places(inner, f"{path}{key}/"))]


@pytest.mark.long
@given(mission=st.sampled_from([MISSION, SCENE]), data=st.data(), value=values)
@settings(max_examples=80, deadline=None)
def test_any_value_in_any_place_is_accepted_or_named_there(tmp_path_factory, mission, data, value):
    place = data.draw(st.sampled_from(_places(mission)))
    folder = tmp_path_factory.getbasetemp()
    for problem in find_problems(write(folder, changed(mission, place, value))):
        assert problem.message
        assert 1 <= problem.line <= 200


def test_bounds_are_those_that_the_messages_state():
    assert (yaml_places.MAX_BYTES, yaml_places.MAX_DEPTH, yaml_places.MAX_VALUES) == (1_000_000, 20, 50_000)


@pytest.mark.parametrize("line", ['name: "half \\ud800"', '"half \\udfff": 1'])
def test_half_a_surrogate_pair_is_no_text(tmp_path, line):
    path = tmp_path / "mission.yaml"
    path.write_text(f"mintpilot: 1\n{line}\n")
    (problem,) = find_problems(path)
    assert problem.line == 2
    assert "surrogate" in problem.message


def test_what_steers_a_terminal_is_spelt_out(tmp_path):
    path = tmp_path / "mission.yaml"
    path.write_text('mintpilot: 1\nname: "a\\x1b[2J\\nb"\ninstruction: Go.\nworld: {scenario: medicine-boxes}\n')
    (problem,) = find_problems(path)
    assert problem.path == "name"
    assert "U+001B" in problem.message
    assert problem.message.isprintable()
