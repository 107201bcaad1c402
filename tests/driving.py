"""Drives vehicles and operators through their ports, one motion or one question at a time."""

from __future__ import annotations

import itertools
import time
from collections.abc import Callable
from dataclasses import replace

from mintpilot.core.inputs import Answered, MotionEnded, Ordered
from mintpilot.core.motion import FollowTrajectory, Land, Motion, PerformAction
from mintpilot.core.plan import Stop
from mintpilot.core.ports import Operator, Vehicle
from mintpilot.core.query import Answer, Order, Question, Reply
from mintpilot.core.trajectory import FlightLog, Trajectory, VehicleState

_NUMBERS = itertools.count(1)


def ended(vehicle: Vehicle, motion: Motion, watch: Callable[[VehicleState], bool] | None = None) -> MotionEnded:
    """Makes a motion to its end; a watch is called every half second of flight, and may want it to brake."""
    vehicle.command(motion)
    for _ in range(10_000):
        for event in vehicle.advance(vehicle.state().time_s + 0.5):
            assert event.motion == motion.id
            return event
        if watch is not None and watch(vehicle.state()):
            vehicle.brake()
            watch = None
    raise AssertionError("the motion never ends")


def follow(vehicle: Vehicle, trajectory: Trajectory, watch: Callable[[VehicleState], bool] | None = None) -> FlightLog:
    """Flies a trajectory; the log of it."""
    event = ended(vehicle, FollowTrajectory(id=next(_NUMBERS), trajectory=trajectory), watch)
    assert event.log is not None, event.reason
    return event.log


def act(vehicle: Vehicle, stop: Stop, dwell_s: float) -> MotionEnded:
    """Does what a stop is for."""
    return ended(vehicle, PerformAction(id=next(_NUMBERS), stop=stop, dwell_s=dwell_s))


def land(vehicle: Vehicle) -> MotionEnded:
    """Lands right below."""
    return ended(vehicle, Land(id=next(_NUMBERS)))


def ask(
    operator: Operator,
    question: Question,
    patience_s: float,
    *,
    better: Callable[[float], Question | None] = lambda waited_s: None,
    real: bool = False,
) -> Answer | Order:
    """Puts a question and polls until there is an answer, an order, or silence; with ``real`` by the wall's clock.

    ``better`` is asked at every poll for better words.
    """
    question = replace(question, id=question.id or f"q{next(_NUMBERS)}")
    operator.show(question, patience_s)
    begun, waited_s = time.monotonic(), 0.0
    while waited_s <= patience_s:
        for event in operator.poll(waited_s):
            if isinstance(event, Ordered):
                operator.withdraw(question.id, "an order came")
                return event.order
            if isinstance(event, Answered):
                assert event.question == question.id
                operator.withdraw(question.id, "it was answered")
                return event.answer
        words = better(waited_s)
        if words is not None:
            operator.show(replace(words, id=question.id), patience_s - waited_s)
        if real:
            time.sleep(0.01)
            waited_s = time.monotonic() - begun
        else:
            waited_s += 0.25
    operator.withdraw(question.id, "no answer came in time")
    return Answer(reply=Reply.TIMEOUT, latency_s=patience_s)
