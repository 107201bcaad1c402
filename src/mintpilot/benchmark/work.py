"""What a worker does with one world: its own record, then one for each method that has not flown in it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TypeAlias

from mintpilot.assembly.registry import load
from mintpilot.benchmark.conditions import believed_world, true_world
from mintpilot.benchmark.experiment import Experiment, WorldTask
from mintpilot.benchmark.omniscient import survey_world
from mintpilot.benchmark.records import Record
from mintpilot.benchmark.shared_survey import SharedSurvey
from mintpilot.benchmark.trial import fly_trial
from mintpilot.benchmark.warm import WarmPlanner

Begin: TypeAlias = Callable[[str], object]
"""Told the method that begins; the empty string for the world's own record."""


def do_task(experiment: Experiment, task: WorldTask, begin: Begin) -> Iterator[Record]:
    """The records of one world, in order, each as soon as it is there."""
    cell = experiment.cells[task.cell]
    begin("")
    world = true_world(cell, task.seed)
    planner = WarmPlanner(load("planner", "grid")())
    if task.survey_world:
        yield survey_world(world, experiment=experiment.name, cell=cell.name, planner=planner)
    believed = believed_world(world, cell.condition)
    shared = planner if experiment.share_plans else None
    survey = SharedSurvey() if experiment.share_survey else None
    for method in cell.methods:
        if method.name in task.methods:
            begin(method.name)
            yield fly_trial(experiment, cell, method, believed, shared, survey)
