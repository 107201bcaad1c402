"""A mission that a program made is held to the same rules as one that is read from a file."""

from __future__ import annotations

import pytest
from tests.mission.scenes import hall

from mintpilot import plan_mission, run_mission
from mintpilot.mission_file.reader import MissionFileError
from mintpilot.mission_file.schema import MissionFile


def twice_placed() -> MissionFile:
    goal = {"action": "go", "phrase": "the far end", "position_m": [10.0, 2.0, 1.2]}
    return MissionFile.model_validate({**hall().model_dump(exclude_unset=True), "goals": [goal]})


@pytest.mark.parametrize("do", [plan_mission, lambda file: run_mission(file, vehicle="kinematic")])
def test_a_contradiction_is_refused_at_its_key(do) -> None:
    with pytest.raises(
        MissionFileError, match=r"(?s)mission 'hall' \(goals\[0\]\): where is it\? exactly one of"
    ) as told:
        do(twice_placed())
    assert [problem.line for problem in told.value.problems] == [0]
