"""Clouds that turned out to be one are passable only if all of them are."""

from __future__ import annotations

import pytest

from mintpilot.core.semantic_map import Knowledge
from mintpilot.mapping.fusion import joint_knowledge

YES, NO, OPEN = Knowledge.YES, Knowledge.NO, Knowledge.OPEN


@pytest.mark.parametrize(
    ("answers", "joint"),
    [({YES}, YES), ({YES, OPEN}, OPEN), ({YES, NO}, NO), ({NO, OPEN}, NO), ({OPEN}, OPEN), (set(), OPEN)],
)
def test_the_answer_of_a_merged_cloud(answers: set[Knowledge], joint: Knowledge) -> None:
    assert joint_knowledge(answers) is joint
