"""Values in mission files: what is refused and how, and a mission that asks for one (method, section 13)."""

from __future__ import annotations

import copy
import shutil
from pathlib import Path

import numpy as np
import pytest
import yaml

from mintpilot.assembly.components import Choices, components_for
from mintpilot.assembly.worlds import build_world
from mintpilot.core.errors import MissionError
from mintpilot.core.mission import Outcome
from mintpilot.core.query import Question, Reply
from mintpilot.interaction.scripted import FunctionOperator, ScriptedOperator
from mintpilot.mission.loop import fly_mission
from mintpilot.mission_file.reader import read_mission
from mintpilot.recording.recorders import MemoryRecorder

BUILDING = Path(__file__).parents[2] / "examples" / "my-building"
WIDTH = {"id": "width", "of": "smoke-1", "what": "clearance_m", "range": [0.3, 2.0], "prior": [[0.5, 0.5], [1.2, 0.5]]}


def written(folder: Path, values: object, **region: object) -> Path:
    for file in BUILDING.iterdir():
        shutil.copy(file, folder)
    mission = yaml.safe_load((BUILDING / "mission.yaml").read_text())
    smoke = mission["world"]["regions"][0]
    for key in ("prior_passable", "truth"):
        smoke.pop(key, None)
    smoke |= region
    mission["values"] = values
    mission["asking"]["delta_c_s"] = 0.2
    (folder / "mission.yaml").write_text(yaml.safe_dump(mission))
    return folder / "mission.yaml"


@pytest.mark.parametrize(
    ("change", "said"),
    [({"range": [2.0, 0.3]}, "must rise"), ({"range": [-1.0, 2.0]}, "must rise"), ({"truth": 3.0}, "not within"),
     ({"prior": {"mean": 9.0, "sigma": 0.5}}, "mean 9 is not within the range"),
     ({"prior": [[3.0, 1.0]]}, "not within the range"), ({"prior": [[1.0, 0.4]]}, "must sum to 1"),
     ({"prior": [[1.0, 1.4], [1.1, -0.4]]}, "no probability"), ({"of": "smoke-9"}, "there is no region 'smoke-9'"),
     ({"what": "open_until"}, "clearance_m"), ({"truth": "three feet"}, "three feet"), ({"truth": "3,5 m"}, "3,5 m"),
     ({"prior": {"mean": 1.0, "sigma": 0.0}}, "sigma")],
)  # fmt: skip
def test_what_cannot_be_is_refused_with_its_place(tmp_path: Path, change: dict[str, object], said: str) -> None:
    with pytest.raises(MissionError) as caught:
        read_mission(written(tmp_path, [{**WIDTH, **change}]))
    assert said in str(caught.value)
    assert "values" in str(caught.value)


@pytest.mark.parametrize("region", [{"prior_passable": 0.3}, {"truth": "passable"}, {"passable": True}])
def test_a_region_with_a_value_says_nothing_besides(tmp_path: Path, region: dict[str, object]) -> None:
    with pytest.raises(MissionError, match="keep one of them"):
        read_mission(written(tmp_path, [WIDTH], **region))


def test_one_region_has_one_value(tmp_path: Path) -> None:
    with pytest.raises(MissionError, match="has 2 values"):
        read_mission(written(tmp_path, [WIDTH, {**copy.deepcopy(WIDTH), "id": "other"}]))


@pytest.mark.parametrize("truth", [0.5, 1.2])
def test_a_passage_is_asked_for_by_its_width(tmp_path: Path, truth: float) -> None:
    path = written(tmp_path, [{**WIDTH, "truth": truth}])
    world = build_world(read_mission(path), base=tmp_path, seed=0)
    knows = ScriptedOperator(world.truth, rng=np.random.default_rng(0))
    put: list[Question] = []
    replies: list[Reply] = []

    def reply(question: Question, patience_s: float):
        put.append(question)
        answer = knows.answer(question, patience_s)
        replies.append(answer.reply)
        return answer

    with components_for(
        world, Choices(vehicle="kinematic"), operators=(FunctionOperator(reply),), recorder=MemoryRecorder()
    ) as made:
        assert fly_mission(made).outcome is Outcome.SUCCESS
    asked = {question.text: answer for question, answer in zip(put, replies, strict=True)}
    expected = Reply.YES if truth >= 0.8 else Reply.NO
    assert asked.get("Is the grey smoke in the middle gate at least 0.8 m wide?") is expected
