"""A preview is bounded in work, and says how its figure was found."""

from pathlib import Path

from mintpilot.assembly.components import Choices, deliberation_parts
from mintpilot.assembly.worlds import build_world
from mintpilot.mission.preview import preview

from .scenes import hall


def previewed(**bounds: int):
    world = build_world(hall(), base=Path(), seed=0)
    parts = deliberation_parts(world, Choices())
    return preview(world.map, parts, **bounds)


def test_all_histories_of_answers_are_followed_where_they_are_few():
    seen = previewed()
    assert (seen.complete, seen.histories, seen.standard_error) == (True, 0, 0.0)
    assert seen.expected_questions == 1.0


def test_where_they_are_too_many_the_mean_is_estimated_from_drawn_ones():
    seen = previewed(max_deliberations=0, histories=5)
    assert (seen.complete, seen.histories) == (False, 5)
    assert seen.expected_questions == 1.0
    assert seen.standard_error == 0.0
