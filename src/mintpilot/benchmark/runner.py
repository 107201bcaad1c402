"""Runs what is left of an experiment and keeps every record as it comes."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Literal, TypeAlias

from mintpilot.benchmark.experiment import Experiment, WorldTask, tasks_of
from mintpilot.benchmark.on_ray import RayPool
from mintpilot.benchmark.pool import ProcessPool
from mintpilot.benchmark.records import Record, TrialRecord
from mintpilot.benchmark.store import RecordStore, finished_in
from mintpilot.core.errors import UnknownNameError

Executor: TypeAlias = Literal["process", "ray"]
Heard: TypeAlias = Callable[["Progress", Record], object]
"""Called with every record, after it was kept."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Progress:
    """How far a run is."""

    trials: int
    """Of the whole experiment."""
    before: int
    """Trials that had a record before."""
    done: int
    """Trials flown in this run."""
    seconds: float
    """Since this run began, start of the workers included."""

    @property
    def per_minute(self) -> float:
        """Missions per minute of this run."""
        return 60 * self.done / self.seconds if self.seconds > 0 else 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class RunOptions:
    """How an experiment is run; nothing of it changes a record."""

    folder: Path
    jobs: int = 2
    executor: Executor = "process"
    ray_address: str = ""
    only: frozenset[str] = frozenset()
    """Methods that are flown now; empty: all."""


def run_experiment(experiment: Experiment, options: RunOptions, heard: Heard) -> Progress:
    """Flies every trial that has no record yet.

    Raises:
        RecordError: the folder cannot be used, or the disk is full. What was written is kept.
        UnknownNameError: a method in ``only`` is not compared by this experiment.
        MissingPartError: the executor, or MuJoCo, is not installed.
        DeviceError: there is no Ray cluster at that address.
    """
    names = {method.name for cell in experiment.cells for method in cell.methods}
    for name in sorted(options.only - names):
        raise UnknownNameError("method", name, sorted(names))
    with RecordStore(options.folder, experiment) as store:
        finished = finished_in(options.folder)
        flown = [
            m.name for cell in experiment.cells for m in cell.methods if not options.only or m.name in options.only
        ]
        total = experiment.trials * len(flown)
        tasks = [_only(task, options.only) for task in tasks_of(experiment, finished)]
        tasks = [task for task in tasks if task.methods or task.survey_world]
        before, done = total - sum(len(task.methods) for task in tasks), 0
        begun = time.perf_counter()
        for worker, record in _fly(experiment, options, tasks) if tasks else ():
            store.append(worker, record)
            done += isinstance(record, TrialRecord)
            heard(Progress(trials=total, before=before, done=done, seconds=time.perf_counter() - begun), record)
        return Progress(trials=total, before=before, done=done, seconds=time.perf_counter() - begun)


def _only(task: WorldTask, only: frozenset[str]) -> WorldTask:
    """The task with those methods alone; empty: with all."""
    return task.model_copy(update={"methods": tuple(m for m in task.methods if not only or m in only)})


def _fly(experiment: Experiment, options: RunOptions, tasks: list[WorldTask]) -> Iterator[tuple[str, Record]]:
    if options.executor == "ray":
        return RayPool(experiment, options.jobs, options.ray_address).run(tasks)
    return ProcessPool(experiment, options.jobs).run(tasks)
