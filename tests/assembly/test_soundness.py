"""``check`` also tells what only building a mission's parts can: each mistake at its place."""

from pathlib import Path

import pytest

from mintpilot import check_mission

FORM = """mintpilot: 1
name: sound
instruction: {instruction}
world:
  scenario: medicine-boxes
  parameters: {{{parameters}}}
asking: {{{asking}}}
"""
SOUND = "Pick up the box and bring it to the injured person."


def problems(tmp_path: Path, *, instruction: str = SOUND, parameters: str = "", asking: str = ""):
    path = tmp_path / "mission.yaml"
    path.write_text(FORM.format(instruction=instruction, parameters=parameters, asking=asking))
    return check_mission(path)


def test_a_sound_mission_has_no_problems(tmp_path):
    assert problems(tmp_path, parameters="most: 4", asking="objective: ec2") == []


@pytest.mark.parametrize(
    ("changes", "line", "path", "said"),
    [
        ({"instruction": "Frobnicate the zorb."}, 3, "instruction", "not understood"),
        ({"parameters": "mots: 3"}, 6, "world.parameters.mots", "Did you mean 'most'"),
        ({"parameters": "most: three"}, 6, "world.parameters.most", "must be a number"),
        ({"parameters": "cruise_mps: -1"}, 6, "world.parameters.cruise_mps", "cruise_mps = -1"),
        ({"asking": "objective: information-gian"}, 7, "asking.objective", "Did you mean 'information-gain'"),
        ({"asking": "impact_metric: freshet"}, 7, "asking.impact_metric", "Did you mean 'frechet'"),
    ],
)
def test_every_mistake_is_told_at_its_place(tmp_path, changes, line, path, said):
    (problem,) = problems(tmp_path, **changes)
    assert (problem.line, problem.path) == (line, path)
    assert said in problem.message


def test_all_mistakes_are_told_at_once(tmp_path):
    found = problems(tmp_path, instruction="Frobnicate.", parameters="mots: 3", asking="objective: luck")
    assert [problem.line for problem in found] == [3, 6, 7]


def test_what_a_given_map_does_not_have_is_told_at_the_goal(tmp_path):
    (tmp_path / "hall.map").write_text("type octile\nheight 3\nwidth 3\nmap\n...\n...\n...\n")
    (tmp_path / "mission.yaml").write_text("""mintpilot: 1
name: hall
instruction: Take the box.
world:
  map: hall.map
  start_m: [0.5, 0.5]
  objects: [{id: crate, label: box, position_m: [2.5, 2.5], attributes: {colour: red}}]
goals:
  - {action: pick, phrase: the red box, label: box, attributes: {colour: red}}
  - {action: deliver, phrase: the blue barrel, label: barrel}
""")
    (problem,) = check_mission(tmp_path / "mission.yaml")
    assert (problem.line, problem.path) == (10, "goals[1]")
    assert "'the blue barrel'" in problem.message
