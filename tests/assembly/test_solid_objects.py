"""Objects listed on a map: solid where they are and as large as they are, for the planner and for the judge."""

from pathlib import Path

import numpy as np
import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st
from PIL import Image
from tests.oracles.clearance import densely

from mintpilot.assembly.api import run_mission
from mintpilot.assembly.validation import check_mission
from mintpilot.assembly.worlds import build_world
from mintpilot.core.events import LegFlown
from mintpilot.core.mission import Outcome
from mintpilot.mission_file.reader import read_mission
from mintpilot.simulation.obstacles import Obstacles

LORRY = {"id": "lorry", "label": "truck", "position_m": [4.0, 3.0, 1.2], "size_m": [2.0, 2.5, 2.4]}
GOAL = {"id": "crate-red", "label": "crate", "position_m": [7.2, 3.0, 0.3], "attributes": {"colour": "red"}}


def mission(folder: Path, *objects: dict[str, object], **changes: object) -> Path:
    """A hall of 8 x 6 m with cells of 0.1 m, crossed from west to east."""
    pixels = np.full((60, 80), 254, np.uint8)
    pixels[[0, -1]] = pixels[:, [0, -1]] = 0
    Image.fromarray(pixels).save(folder / "hall.png")
    (folder / "hall.yaml").write_text("image: hall.png\nresolution: 0.1\norigin: [0, 0, 0]\nfree_thresh: 0.196\n")
    world = {"map": "hall.yaml", "start_m": [1.0, 3.0], "objects": list(objects), **changes}
    text = {"mintpilot": 1, "name": "hall", "instruction": "Go to the red crate.", "world": world}
    path = folder / "mission.yaml"
    path.write_text(yaml.safe_dump(text))
    return path


def flown(path: Path) -> tuple[Outcome, np.ndarray]:
    legs: list[np.ndarray] = []
    told = lambda event: legs.append(event.log.position_m) if isinstance(event, LegFlown) else None  # noqa: E731
    return run_mission(path, vehicle="kinematic", progress=told).outcome, np.concatenate(legs)


def to_box(points: np.ndarray, thing: dict[str, object]) -> np.ndarray:
    """Distances (n,) on the ground from points to an object's box."""
    centre, half = np.array(thing["position_m"])[:2], np.array(thing["size_m"])[:2] / 2
    return np.linalg.norm(np.maximum(np.abs(points[:, :2] - centre) - half, 0), axis=1)


def test_a_lorry_in_the_way_is_flown_around(tmp_path):
    outcome, way = flown(mission(tmp_path, GOAL, LORRY))
    assert outcome is Outcome.SUCCESS
    assert to_box(densely(way, 0.01), LORRY).min() >= 0.4 - 1e-6


@pytest.mark.parametrize(
    "thing",
    [
        {**LORRY, "solid": False},
        {**LORRY, "size_m": [0.0, 0.0, 0.0]},
        {**LORRY, "position_m": [4.0, 3.0, 0.2], "size_m": [2.0, 2.5, 0.4]},
    ],
    ids=["not solid", "no size", "too low to be in the way"],
)
def test_what_is_no_matter_or_lies_low_is_not_in_the_way(tmp_path, thing):
    outcome, way = flown(mission(tmp_path, GOAL, thing))
    assert outcome is Outcome.SUCCESS
    assert np.ptp(way[:, 1]) < 0.2


def test_the_judge_knows_solid_objects_too(tmp_path):
    world = build_world(read_mission(mission(tmp_path, GOAL, LORRY)), base=tmp_path, seed=None)
    obstacles = Obstacles(world.scene, world.rules)
    beside = np.array([[2.71, 3.0, 1.0], [2.69, 3.0, 1.0]])
    assert obstacles.first_touch(beside[:1], np.zeros(1)) == (0, "lorry")
    assert obstacles.first_touch(beside[1:], np.zeros(1)) is None


@pytest.mark.parametrize("verb", ["Go to", "Count", "Bring the red crate to"])
def test_what_is_the_goal_stays_solid(tmp_path, verb):
    big = {**LORRY, "attributes": {"colour": "blue"}}
    path = mission(tmp_path, GOAL, big)
    text = yaml.safe_load(path.read_text())
    text["instruction"] = f"{verb} the blue truck."
    path.write_text(yaml.safe_dump(text))
    outcome, way = flown(path)
    assert outcome is Outcome.SUCCESS
    gaps = to_box(densely(way, 0.01), big)
    assert gaps.min() >= 0.4 - 1e-6
    assert gaps[-1] < 0.8


def test_a_start_inside_or_beside_a_solid_object_is_told_at_its_line(tmp_path):
    for x in (3.0, 2.75):
        (problem,) = check_mission(mission(tmp_path, GOAL, LORRY, start_m=[x, 3.0]))
        assert "from an object, nearer than the vehicle's radius of 0.3 m" in problem.message
    assert not check_mission(mission(tmp_path, GOAL, LORRY, start_m=[2.65, 3.0]))
    (problem,) = check_mission(mission(tmp_path, GOAL, LORRY, start_m=[0.3, 3.0]))
    assert "0.20 m from something occupied or unknown" in problem.message


@settings(deadline=None, max_examples=30)
@given(
    x=st.floats(2.5, 6.5), y=st.floats(1.5, 4.5), size=st.tuples(*[st.floats(0.0, 2.0)] * 2), low=st.floats(0.0, 3.0)
)
def test_every_cell_that_an_object_fills_is_barred(tmp_path_factory, x, y, size, low):
    folder = tmp_path_factory.mktemp("hall")
    thing = {"id": "thing", "label": "thing", "position_m": [x, y, low + 0.25], "size_m": [*size, 0.5]}
    map = build_world(read_mission(mission(folder, thing, GOAL)), base=folder, seed=None).map
    points = np.random.default_rng(0).uniform(-0.5, 0.5, (200, 3)) * np.array([*size, 0.0]) + np.array([x, y, 1.0])
    barred = map.cells[tuple(map.frame.cells_of(points).T)] != 1
    in_the_way = low < 1.4 - 1e-9 and low + 0.5 > 0.6 + 1e-9
    assert barred.all() if in_the_way else True
    if low > 1.4 + 1e-9:
        assert (map.cells == 2).sum() == 2 * 80 + 2 * 60 - 4
