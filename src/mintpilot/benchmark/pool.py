"""Processes of this machine that fly trials. A worker that hangs or dies costs the trial it was at, never the run."""

from __future__ import annotations

import multiprocessing
import os
import signal
import time
from collections import deque
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from multiprocessing.connection import Connection, wait
from multiprocessing.context import SpawnContext, SpawnProcess

from mintpilot.benchmark.experiment import Experiment, WorldTask
from mintpilot.benchmark.records import Record, parse_record
from mintpilot.benchmark.trial import CRASHED, TIMED_OUT, broken_trial
from mintpilot.core.errors import MintPilotError

GRACE_S = 10.0
"""A worker that is this much over a trial's limit is ended: it did not even answer the alarm."""
ATTEMPTS = 2
"""A trial at which a worker died is tried so often: a worker may have been killed by chance."""


@dataclass(slots=True, eq=False)
class _Worker:
    number: int
    process: SpawnProcess
    pipe: Connection
    task: WorldTask | None = None
    at: str | None = None
    """Method that it is at."""
    since: float = 0.0
    done: set[str] = field(default_factory=set)


class ProcessPool:
    """Spawned processes with one pipe each.

    Args:
        experiment: the configuration.
        jobs: number of processes.
    """

    def __init__(self, experiment: Experiment, jobs: int) -> None:
        self._experiment = experiment
        self._jobs = jobs
        self._workers: list[_Worker] = []
        self._tries: dict[tuple[int, int, str], int] = {}
        self._started = 0
        self._context: SpawnContext = multiprocessing.get_context("spawn")

    def run(self, tasks: Sequence[WorldTask]) -> Iterator[tuple[str, Record]]:
        """Name of the worker and record, for each trial, as they come in.

        Raises:
            MintPilotError: the work itself cannot be done (an unknown scenario, say); what a method does is recorded.
        """
        self._waiting = deque(tasks)
        for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "LP_NUM_THREADS"):
            os.environ.setdefault(name, "1")
        try:
            for _ in range(min(self._jobs, len(tasks))):
                self._start()
            while any(worker.task is not None for worker in self._workers):
                ready = wait([worker.pipe for worker in self._workers], timeout=1.0)
                for worker in list(self._workers):
                    if worker.pipe in ready:
                        yield from self._heard(worker)
                    elif self._overdue(worker):
                        yield from self._lost(worker, TIMED_OUT)
        finally:
            self._end()

    def _end(self) -> None:
        """Idle workers end by themselves once their pipe is closed; busy ones are not waited for."""
        for worker in self._workers:
            worker.pipe.close()
            if worker.task is not None:
                worker.process.kill()
        for worker in self._workers:
            worker.process.join(5.0)
            worker.process.kill()

    def _start(self) -> None:
        ours, theirs = self._context.Pipe()
        process = self._context.Process(target=_serve, args=(self._experiment.model_dump_json(), theirs), daemon=True)
        process.start()
        theirs.close()
        worker = _Worker(number=self._started, process=process, pipe=ours)
        self._started += 1
        self._workers.append(worker)
        self._give(worker)

    def _give(self, worker: _Worker) -> None:
        worker.task = self._waiting.popleft() if self._waiting else None
        worker.at, worker.done = None, set()
        if worker.task is not None:
            try:
                worker.pipe.send(worker.task.model_dump_json())
            except OSError:
                self._waiting.appendleft(worker.task)  # it died idle; hearing nothing from it will show that

    def _heard(self, worker: _Worker) -> Iterator[tuple[str, Record]]:
        try:
            kind, text = worker.pipe.recv()
        except (EOFError, OSError):
            yield from self._lost(worker, CRASHED)
            return
        if kind == "begin":
            worker.at, worker.since = text, time.monotonic()
        elif kind == "record":
            if worker.at is not None:
                worker.done.add(worker.at)
                worker.at = None
            yield f"worker-{worker.number}", parse_record(text, f"worker {worker.number}")
        elif kind == "failed":
            raise MintPilotError(text)
        else:
            self._give(worker)

    def _overdue(self, worker: _Worker) -> bool:
        limit = self._experiment.time_limit_s + GRACE_S
        return worker.at is not None and time.monotonic() - worker.since > limit

    def _lost(self, worker: _Worker, outcome: str) -> Iterator[tuple[str, Record]]:
        """Ends a worker, tells what became of its trial, and starts another one for what is left."""
        worker.process.kill()
        worker.process.join()
        worker.pipe.close()
        self._workers.remove(worker)
        task = worker.task
        if task is not None:
            at = worker.at if worker.at is not None else ""
            key = (task.cell, task.seed, at)
            self._tries[key] = self._tries.get(key, 0) + 1
            given_up = outcome == TIMED_OUT or self._tries[key] >= ATTEMPTS
            if given_up and not at:
                raise MintPilotError(
                    f"{self._tries[key]} workers died while they drew world {task.seed}; is there enough memory? "
                    "Try fewer --jobs; what is finished is kept"
                )
            if given_up:
                worker.done.add(at)
                yield "parent", self._broken(task, at, outcome, worker.process.exitcode)
            methods = tuple(m for m in task.methods if m not in worker.done)
            survey = task.survey_world and "" not in worker.done
            if methods or survey:
                self._waiting.appendleft(task.model_copy(update={"methods": methods, "survey_world": survey}))
        if self._waiting:
            self._start()

    def _broken(self, task: WorldTask, method: str, outcome: str, code: int | None) -> Record:
        if outcome == TIMED_OUT:
            limit = self._experiment.time_limit_s
            reason = f"'{method}' was not done within {limit:g} s of computing and did not stop; its process was ended"
        else:
            reason = f"the process of '{method}' died {ATTEMPTS} times (exit code {code})"
        return broken_trial(self._experiment, self._experiment.cells[task.cell], task.seed, method, outcome, reason)


def _serve(experiment_json: str, pipe: Connection) -> None:
    """A worker's whole life: tasks in, records out, until the pipe is closed."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    from mintpilot.benchmark.work import do_task

    experiment = Experiment.model_validate_json(experiment_json)
    while True:
        try:
            task = WorldTask.model_validate_json(pipe.recv())
        except (EOFError, OSError):
            return
        try:
            for record in do_task(experiment, task, lambda method: pipe.send(("begin", method))):
                pipe.send(("record", record.model_dump_json()))
            pipe.send(("done", ""))
        except MintPilotError as error:
            pipe.send(("failed", str(error)))
            return
        except BrokenPipeError:
            return
