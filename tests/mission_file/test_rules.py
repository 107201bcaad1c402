"""`rules:` in mission files: every pattern, and what is said of mistakes (method, section 14)."""

import pytest

from mintpilot.mission_file.reader import find_problems, read_mission
from mintpilot.mission_file.ruling import rules_of

FILE = """mintpilot: 1
name: ruled
instruction: look into the room and go to the box
world:
  map: hall.map
  resolution_m: 0.5
  height_m: 1.0
  start_m: [1, 1]
  objects: [{{id: box-1, label: box, position_m: [7, 5, 1.0]}}]
  regions: [{{id: smoke-1, kind: smoke, description: the smoke, box: {{lo_m: [4, 0, 0], hi_m: [5, 3, 2]}}}}]
  rooms: [{{id: room-1, door: {{lo_m: [1, 5.5, 0], hi_m: [2, 6, 2]}}, viewpoint_m: [1.5, 4.5], description: the room}}]
goals: [{{action: go, object: box-1, id: box}}, {{action: look, room: room-1, id: look}}]
rules:
{rules}
"""


def problems(tmp_path, *rules):
    path = tmp_path / "m.yaml"
    (tmp_path / "hall.map").write_text("type octile\nheight 12\nwidth 16\nmap\n" + ("." * 16 + "\n") * 12)
    path.write_text(FILE.format(rules="\n".join(f"  - {rule}" for rule in rules)))
    return path, [p.message for p in find_problems(path) if p.path.startswith("rules")]


@pytest.mark.parametrize(
    ("rule", "formula"),
    [
        ("{never: touches(smoke-1)}", "G !touches(smoke-1)"),
        ("{always: in(smoke-1)}", "G inside(smoke-1)"),
        ("{never: touches(smoke), before: looked(room-1)}", "(looked(room-1) R (!touches(smoke) | looked(room-1)))"),
        ("{first: did(look), then: at(box)}", "((!at(box) U did(look)) & F at(box))"),
        ("{after: at(box), eventually: at(look)}", "G (!at(box) | F at(look))"),
        ("{end: 'within(people, 2)'}", "F G within(people, 2)"),
        ("'G (carrying(box) -> !touches(smoke-1))'", "G (carrying(box) -> !touches(smoke-1))"),
    ],
)
def test_every_pattern_is_read(tmp_path, rule, formula):
    path, found = problems(tmp_path, rule)
    assert not found
    assert [r.formula for r in rules_of(read_mission(path))] == [formula]


@pytest.mark.long
@pytest.mark.parametrize(
    ("rules", "said"),
    [
        (["{never: touches(smoke-2)}"], "did you mean 'smoke-1'"),
        (["{never: looked(rom-1)}"], "did you mean 'room-1'"),
        (["{never: at(bx)}"], "did you mean 'box'"),
        (["{never: 'within(peopel, 2)'}"], "did you mean 'people'"),
        (["{never: 'within(smoke-3, 2)'}"], "there is no thing, region or people"),
        (["{never: carrying(bxo)}"], "did you mean 'box'"),
        (["{never: touch(smoke-1)}"], "Did you mean 'touches'"),
        (["{never: touches(smoke-1), then: at(box)}"], "is no rule; known"),
        (["{}"], "nothing is no rule"),
        (["'G X at(box)'"], "there is no X"),
        (["'G at(box) &'"], "column 12"),
        (["{nevr: at(box)}"], "did you mean 'never'"),
        (["{never: at(box)}", "{first: did(look), then: at(box)}"], "contradict each other"),
        (["'at(box) & !at(box)'"], "contradicts itself"),
        (["'at(box) | !at(box)'"], "it says nothing"),
        ([f"'{' & '.join(f'F within(people, {i + 1})' for i in range(9))}'"], "more than 256 states"),
    ],
)
def test_a_mistake_is_told_at_its_rule(tmp_path, rules, said):
    _, found = problems(tmp_path, *rules)
    assert len(found) == 1
    assert said in found[0]


def test_an_automaton_of_32_states_is_taken(tmp_path):
    _, found = problems(tmp_path, f"'{' & '.join(f'F within(people, {i + 1})' for i in range(5))}'")
    assert not found


@pytest.mark.parametrize("subject", ["box", "boxes", "the boxes", "box-1", "people", "smoke", "smoke-1"])
def test_what_a_distance_may_be_kept_from(tmp_path, subject):
    assert not problems(tmp_path, f"{{never: 'within({subject}, 0.5)'}}")[1]


@pytest.mark.parametrize(
    ("rule", "said"),
    [
        ("{never: touches(smoke)}", ""),
        ("{never: touches(smoke-2)}", ""),
        ("{never: touches(smok-2)}", "there is no region 'smok-2'; did you mean 'smoke-1'"),
        ("{never: looked(bathroom)}", "there is no room 'bathroom'"),
        ("{never: at(bx)}", "there is no goal with the id 'bx'"),
    ],
)
def test_names_are_checked_as_far_as_they_go_before_the_drone_has_drawn_a_map(tmp_path, rule, said):
    path = tmp_path / "m.yaml"
    path.write_text(
        "mintpilot: 1\nname: ruled\ninstruction: find the injured person\nworld: {scenario: fire-warehouse}\n"
        f"rules: ['{rule}']\n".replace("['{", "[{").replace("}']", "}]")
    )
    found = [p.message for p in find_problems(path) if p.path.startswith("rules")]
    assert (found == []) if not said else (len(found) == 1 and said in found[0]), found
