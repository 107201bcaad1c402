"""Deliberation in a process of its own: it decides what the inline worker decides, and its death is an event."""

from __future__ import annotations

import functools
import os
import signal
import time
from collections.abc import Callable, Iterator
from dataclasses import replace

import pytest
from tests.mission.scenes import hall

from mintpilot.assembly.components import Choices, components_for, deliberation_parts, scripted_operator
from mintpilot.assembly.worlds import build_world
from mintpilot.core.difference import first_difference
from mintpilot.core.errors import DeviceError, InputError
from mintpilot.core.inputs import DeliberationEnded
from mintpilot.mission.deliberation import DeliberationParts
from mintpilot.mission.loop import fly_mission
from mintpilot.mission.process_worker import DEATHS, ProcessWorker
from mintpilot.mission.requests import Request
from mintpilot.mission.worker import InlineWorker
from mintpilot.mission_file.schema import OperatorSpec
from mintpilot.recording.recorders import MemoryRecorder

WORLD = build_world(hall(), base=None, seed=0)
MAKE = functools.partial(deliberation_parts, WORLD, Choices(vehicle="kinematic"))


class Remembering(InlineWorker):
    """Keeps what was asked for, and what came of it."""

    kept: list[tuple[Request, DeliberationEnded]] = []  # noqa: RUF012

    def submit(self, request: Request, time_s: float) -> None:
        super().submit(request, time_s)
        self.kept.append((request, self._done[-1][1]))


@pytest.fixture(scope="module")
def thoughts() -> list[tuple[Request, DeliberationEnded]]:
    """All requests of one mission, with what the inline worker decided."""
    Remembering.kept = []
    person = scripted_operator(WORLD, OperatorSpec())
    with components_for(
        WORLD, Choices(vehicle="kinematic"), operators=(person,), recorder=MemoryRecorder()
    ) as components:
        fly_mission(replace(components, worker=Remembering))
    return Remembering.kept


@pytest.fixture(scope="module")
def worker() -> Iterator[ProcessWorker]:
    made = ProcessWorker(MAKE)
    yield made
    made.close()


def pid_of(worker: ProcessWorker) -> int:
    assert worker.pid is not None
    return worker.pid


def wait(worker: ProcessWorker, time_s: float = 0.0) -> DeliberationEnded:
    for _ in range(6000):
        done = worker.poll(time_s)
        if done:
            (event,) = done
            return event
        time.sleep(0.01)
    raise AssertionError("nothing came back")


@pytest.mark.long
def test_it_decides_what_the_inline_worker_decides(
    worker: ProcessWorker, thoughts: list[tuple[Request, DeliberationEnded]]
) -> None:
    assert len(thoughts) >= 3
    for request, inline in thoughts:
        worker.submit(request, 1.0)
        ended = wait(worker, 2.5)
        assert ended.request == request.id
        assert ended.time_s == 2.5
        assert first_difference(inline.decision, ended.decision, tolerance=1e-9) == ""


@pytest.mark.long
def test_only_the_newest_request_waits(
    worker: ProcessWorker, thoughts: list[tuple[Request, DeliberationEnded]]
) -> None:
    first, second, third = (replace(thoughts[0][0], id=900 + n) for n in range(3))
    for request in (first, second, third):
        worker.submit(request, 0.0)
    assert wait(worker).request == first.id
    assert wait(worker).request == third.id
    assert worker.poll(0.0) == ()


@pytest.mark.long
def test_a_process_that_dies_gives_a_failure_and_is_started_again(
    thoughts: list[tuple[Request, DeliberationEnded]],
) -> None:
    request = thoughts[0][0]
    worker = ProcessWorker(MAKE)
    try:
        os.kill(pid_of(worker), signal.SIGSTOP)
        worker.submit(request, 0.0)
        os.kill(pid_of(worker), signal.SIGKILL)
        ended = wait(worker)
        assert ended.decision is None
        assert "-9" in ended.reason
        worker.submit(replace(request, id=77), 0.0)
        assert wait(worker).decision is not None
    finally:
        worker.close()


@pytest.mark.long
def test_a_process_that_dies_again_and_again_is_given_up(thoughts: list[tuple[Request, DeliberationEnded]]) -> None:
    worker = ProcessWorker(MAKE)
    try:
        os.kill(pid_of(worker), signal.SIGSTOP)
        worker.submit(replace(thoughts[0][0], id=7), 0.0)
        os.kill(pid_of(worker), signal.SIGKILL)
        assert wait(worker).request == 7
        worker.submit(replace(thoughts[0][0], id=8), 0.0)  # waits for the next process to get ready
        for _ in range(DEATHS - 2):
            died = pid_of(worker)
            os.kill(died, signal.SIGKILL)
            while pid_of(worker) == died:
                assert worker.poll(0.0) == ()
        os.kill(pid_of(worker), signal.SIGKILL)
        failed = wait(worker)
        assert (failed.request, failed.decision) == (8, None)
        worker.submit(replace(thoughts[0][0], id=55), 0.0)
        ended = wait(worker)
        assert (ended.request, ended.decision) == (55, None)
    finally:
        worker.close()
        worker.close()


@pytest.mark.long
def test_a_stuck_process_is_replaced_when_a_newer_request_comes(
    thoughts: list[tuple[Request, DeliberationEnded]],
) -> None:
    now_s = 0.0
    worker = ProcessWorker(MAKE, stuck_s=5.0, clock=lambda: now_s)
    try:
        stuck = pid_of(worker)
        os.kill(stuck, signal.SIGSTOP)
        worker.submit(thoughts[0][0], 0.0)
        assert worker.poll(0.0) == ()
        now_s = 6.0
        worker.submit(replace(thoughts[0][0], id=88), 0.0)
        assert worker.pid != stuck
        assert wait(worker).request == 88
    finally:
        worker.close()


def _no_parts() -> DeliberationParts:
    raise InputError("there is no planner 'x'")


def _never() -> DeliberationParts:
    time.sleep(60.0)
    raise InputError("too late")


@pytest.mark.long
@pytest.mark.parametrize(("make", "ready_s", "said"), [(_no_parts, 60.0, "no planner 'x'"), (_never, 0.2, "0.2 s")])
def test_a_process_that_does_not_get_ready_is_an_error(
    make: Callable[[], DeliberationParts], ready_s: float, said: str
) -> None:
    with pytest.raises(DeviceError, match=said):
        ProcessWorker(make, ready_s=ready_s)
