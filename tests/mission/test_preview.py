"""A preview is bounded in work and in time, and says so."""

import itertools
from pathlib import Path

from mintpilot.assembly.components import Choices, deliberation_parts
from mintpilot.assembly.worlds import build_world
from mintpilot.mission.preview import preview

from .scenes import hall


def previewed(**bounds: object):
    world = build_world(hall(), base=Path(), seed=0)
    parts = deliberation_parts(world, Choices())
    return preview(world.map, parts, **bounds)


def test_all_histories_of_answers_are_followed_when_there_is_time():
    seen = previewed(clock=lambda: 0.0)
    assert seen.complete
    assert seen.expected_questions == 1.0


def test_when_the_time_is_over_the_mean_is_a_lower_bound():
    seconds = itertools.count(step=60.0)
    seen = previewed(clock=lambda: next(seconds))
    assert not seen.complete
    assert seen.expected_questions == 1.0


def test_no_more_is_deliberated_than_allowed():
    assert not previewed(max_deliberations=0).complete
