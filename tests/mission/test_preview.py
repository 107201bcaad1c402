"""The expected number of questions: exact while that is little work, else the mean over played histories."""

from pathlib import Path

import pytest

from mintpilot.assembly.components import Choices, deliberation_parts
from mintpilot.assembly.worlds import build_world
from mintpilot.mission.preview import SAMPLES, preview

from .scenes import hall


def previewed(choices: Choices | None = None, scene: dict | None = None, **bounds: object):
    world = build_world(hall(**(scene or {})), base=Path(), seed=0)
    parts = deliberation_parts(world, choices or Choices())
    return preview(world.map, parts, **bounds)


def test_all_histories_of_answers_are_followed_when_they_are_few():
    seen = previewed()
    assert (seen.played, seen.error) == (0, 0.0)
    assert seen.expected_questions == 1.0


def test_where_they_are_too_many_some_are_played():
    seen = previewed(max_deliberations=0)
    assert seen.played == SAMPLES
    assert seen.expected_questions == 1.0
    assert seen.error == 0.0


def test_a_played_mean_lies_near_the_exact_one_and_is_the_same_every_time():
    world = build_world(_scenario(), base=Path(), seed=11)
    parts = deliberation_parts(world, Choices())
    exact, played, again = (preview(world.map, parts, max_deliberations=n) for n in (1000, 0, 0))
    assert exact.played == 0
    assert played.expected_questions == again.expected_questions
    assert played.expected_questions == pytest.approx(exact.expected_questions, abs=4 * played.error + 0.05)


def _scenario():
    from mintpilot.mission_file.schema import MissionFile

    return MissionFile.model_validate(
        {
            "mintpilot": 1,
            "name": "w",
            "instruction": "find everybody who is hurt",
            "world": {"scenario": "fire-warehouse", "parameters": {"smokes": 2, "rooms": 1}},
        }
    )
