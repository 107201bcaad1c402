"""The same trials on a Ray cluster. `ray` is an extra; nothing else imports it."""

from __future__ import annotations

import importlib
import os
import platform
from collections.abc import Iterator, Sequence
from typing import Any

from mintpilot.benchmark.experiment import Experiment, WorldTask
from mintpilot.benchmark.records import Record, parse_record
from mintpilot.benchmark.trial import CRASHED, broken_trial
from mintpilot.core.errors import DeviceError, MintPilotError, MissingPartError


class RayPool:
    """Tasks on the workers of a cluster, one world each.

    A trial that computes too long is ended by its own alarm. Where a worker dies, its task is tried again method by
    method, and a method at which a worker dies once more is recorded as crashed.

    Args:
        experiment: the configuration.
        jobs: number of workers of a local cluster; not used with an address.
        address: of a running cluster, e.g. ``auto`` or ``ray://head:10001``; empty: a local one is started.

    Raises:
        MissingPartError: ray is not installed.
        DeviceError: there is no cluster at that address.
    """

    def __init__(self, experiment: Experiment, jobs: int, address: str = "") -> None:
        self._experiment = experiment
        try:
            self._ray: Any = importlib.import_module("ray")
        except ImportError as error:
            raise MissingPartError(
                "ray is not installed; pip install 'mintpilot[ray]', or use --executor process"
            ) from error
        self._ours = not self._ray.is_initialized()
        if self._ours:
            try:
                if address:
                    self._ray.init(address=address, log_to_driver=False)
                else:
                    os.environ.setdefault("RAY_USAGE_STATS_ENABLED", "0")
                    self._ray.init(num_cpus=jobs, include_dashboard=False, log_to_driver=False)
            except (ConnectionError, OSError, RuntimeError, ValueError) as error:
                raise DeviceError(f"no Ray cluster can be used at '{address or 'this machine'}': {error}") from error

    def run(self, tasks: Sequence[WorldTask]) -> Iterator[tuple[str, Record]]:
        """Name of the worker and record, for each trial, as they come in.

        Raises:
            MintPilotError: the work itself cannot be done; what a method does is recorded.
        """
        ray = self._ray
        remote = ray.remote(num_cpus=1, max_retries=0)(_work)
        config = self._experiment.model_dump_json()
        pending = {remote.remote(config, task.model_dump_json()): (task, 1) for task in tasks}
        try:
            while pending:
                (ready,), _ = ray.wait(list(pending), num_returns=1)
                task, attempt = pending.pop(ready)
                try:
                    worker, failure, lines = ray.get(ready)
                except ray.exceptions.WorkerCrashedError:
                    if attempt > 1:
                        yield "driver", self._crashed(task)
                        continue
                    for part in _split(task):
                        pending[remote.remote(config, part.model_dump_json())] = (part, attempt + 1)
                    continue
                if failure:
                    raise MintPilotError(failure)
                for line in lines:
                    yield worker, parse_record(line, worker)
        finally:
            for reference in pending:
                ray.cancel(reference, force=True)
            if self._ours:
                ray.shutdown()

    def _crashed(self, task: WorldTask) -> Record:
        if not task.methods:
            raise MintPilotError(f"Ray workers died while they drew world {task.seed}; is there enough memory?")
        cell = self._experiment.cells[task.cell]
        reason = f"the Ray worker of '{task.methods[0]}' died"
        return broken_trial(self._experiment, cell, task.seed, task.methods[0], CRASHED, reason)


def _split(task: WorldTask) -> list[WorldTask]:
    """The same work in parts of one record each."""
    parts = [task.model_copy(update={"methods": (), "survey_world": True})] if task.survey_world else []
    return parts + [task.model_copy(update={"methods": (m,), "survey_world": False}) for m in task.methods]


def _work(config: str, task: str) -> tuple[str, str, list[str]]:
    """On a worker: its name, what failed (empty: nothing), and the records as JSON."""
    from mintpilot.benchmark.work import do_task

    experiment = Experiment.model_validate_json(config)
    name = f"{platform.node()}-{os.getpid()}"
    try:
        records = do_task(experiment, WorldTask.model_validate_json(task), lambda _method: None)
        return name, "", [record.model_dump_json() for record in records]
    except MintPilotError as error:
        return name, str(error), []
