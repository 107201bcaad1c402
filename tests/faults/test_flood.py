"""Whoever talks without end does not stop the mission's clock, and an order does not wait behind the talk."""

from __future__ import annotations

from mintpilot.assembly.components import Choices, VehicleChoice, components_for
from mintpilot.conformance.sample import sample_world
from mintpilot.core.inputs import MoreTimeWanted, OperatorInput, Ordered
from mintpilot.core.mission import Outcome
from mintpilot.core.ports import Operator
from mintpilot.core.query import Order, Question
from mintpilot.mission.loop import fly_mission
from mintpilot.mission.shell import MOST_UNTIMED
from mintpilot.recording.recorders import MemoryRecorder

TOO_MANY = 3000


class Chatter(Operator):
    """Says something at every poll; after a time an order, behind all else."""

    attended = False
    hears_once = False

    def __init__(self, at_once: int, order_s: float) -> None:
        self._at_once, self._order_s = at_once, order_s
        self.polls = 0
        self.ordered_s: float | None = None

    def show(self, question: Question, patience_s: float) -> None:
        """Does not answer."""

    def withdraw(self, question: str, why: str) -> None:
        """Does not care."""

    def tell(self, text: str) -> None:
        """Does not listen."""

    def poll(self, time_s: float) -> tuple[OperatorInput, ...]:
        self.polls += 1
        assert self.polls < TOO_MANY, "the clock stands still"
        events: list[OperatorInput] = [MoreTimeWanted(time_s=time_s, question="q0")] * self._at_once
        if self.ordered_s is None and time_s >= self._order_s:
            self.ordered_s = time_s
            events.append(Ordered(time_s=time_s, order=Order.RETURN, operator="chatter", text="return"))
        return tuple(events)


def flown(at_once: int, order_s: float):
    operator, recorder = Chatter(at_once, order_s), MemoryRecorder()
    world, choices = sample_world(), Choices(vehicle=VehicleChoice.KINEMATIC)
    with components_for(world, choices, operators=(operator,), recorder=recorder) as made:
        return fly_mission(made), made.vehicle.state().time_s, operator, recorder


def test_one_word_at_every_poll_does_not_stop_the_clock() -> None:
    verdict, time_s, _, _ = flown(1, 6.0)
    assert verdict.outcome is Outcome.ABORTED
    assert time_s > 6.0


def test_an_order_comes_before_what_waits() -> None:
    verdict, _, operator, recorder = flown(MOST_UNTIMED + 10, 3.0)
    taken = [event for event in recorder.events if type(event).__name__ == "OrderTaken"]
    assert operator.ordered_s is not None
    assert taken[0].time_s - operator.ordered_s <= 0.5
    assert verdict.outcome is Outcome.ABORTED
