"""One survey for all methods of a world."""

from __future__ import annotations

import pytest

from mintpilot.benchmark.conditions import believed_world, true_world
from mintpilot.benchmark.experiments import boxes, table1
from mintpilot.benchmark.shared_survey import SharedSurvey
from mintpilot.benchmark.trial import fly_trial
from mintpilot.core.mission import Outcome


def test_only_table1_in_physics_shares() -> None:
    assert table1(trials=1, seed=0, vehicle="mujoco").share_survey
    assert not table1(trials=1, seed=0, vehicle="kinematic").share_survey
    assert not boxes(trials=1, seed=0, vehicle="mujoco").share_survey


@pytest.mark.slow
@pytest.mark.sim
def test_who_takes_a_survey_over_flies_as_if_it_were_its_own() -> None:
    experiment = table1(trials=1, seed=3, vehicle="mujoco")
    cell = experiment.cells[0]
    world = believed_world(true_world(cell, 3), cell.condition)
    mint = next(m for m in cell.methods if m.name == "mint")
    survey = SharedSurvey()
    alone = fly_trial(experiment, cell, mint, world)
    first = fly_trial(experiment, cell, mint, world, survey=survey)
    second = fly_trial(experiment, cell, mint, world, survey=survey)
    assert alone.outcome == Outcome.SUCCESS.value
    for shared in (first, second):
        assert (shared.outcome, [a.query for a in shared.asked]) == (alone.outcome, [a.query for a in alone.asked])
        assert shared.planned_s == pytest.approx(alone.planned_s, rel=0.05)
    assert first.frames == alone.frames
    assert second.frames < alone.frames / 4
    assert second.survey_s < first.survey_s / 20
