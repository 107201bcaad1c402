"""Deliberations that come late or fail, links that break: the shell with real parts, judged by the simulator."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.mission.scenes import hall, wall

from mintpilot.assembly.components import Choices, components_for
from mintpilot.assembly.worlds import build_world
from mintpilot.core.errors import DeviceError
from mintpilot.core.events import LegFlown
from mintpilot.core.mission import Outcome, Verdict
from mintpilot.core.ports import Operator
from mintpilot.core.query import Answer, Order, Reply
from mintpilot.core.semantic_map import SemanticMap
from mintpilot.interaction.scripted import RecordedOperator
from mintpilot.mission.components import MissionComponents
from mintpilot.mission.loop import fly_mission
from mintpilot.mission.map_source import MapSource
from mintpilot.mission.transition import DELIBERATION_S
from mintpilot.mission.worker import InlineWorker
from mintpilot.recording.recorders import MemoryRecorder

Change = Callable[[MissionComponents], MissionComponents]


def fly(*operators: Operator, change: Change = lambda made: made, **scene: object) -> tuple[Verdict, np.ndarray, list]:
    world = build_world(hall(**scene), base=None, seed=0)  # type: ignore[arg-type]
    recorder = MemoryRecorder()
    with components_for(world, Choices(vehicle="kinematic"), operators=operators, recorder=recorder) as made:
        verdict = fly_mission(change(made))
    flown = [e.log.position_m for e in recorder.events if isinstance(e, LegFlown)]
    return verdict, np.vstack(flown) if flown else np.zeros((0, 3)), recorder.events


def late(seconds: float) -> Change:
    return lambda made: replace(made, worker=lambda parts: InlineWorker(parts, delay_s=seconds))


def in_cloud(path: np.ndarray) -> bool:
    return bool(((path[:, 0] > 5.2) & (path[:, 0] < 7.0) & (path[:, 1] > 0.2) & (path[:, 1] < 3.6)).any())


def kinds(events: list) -> list[str]:
    return [event.kind for event in events if type(event).__name__ == "Noticed"]


@pytest.mark.long
@settings(max_examples=25, deadline=None)
@given(
    delay_s=st.floats(0.0, 20.0),
    toxic=st.booleans(),
    replies=st.lists(st.sampled_from([Reply.YES, Reply.NO, Reply.UNSURE]), max_size=3),
    latency_s=st.floats(0.0, 40.0),
    orders=st.lists(st.tuples(st.floats(0.0, 60.0), st.sampled_from(Order)), max_size=3),
)
def test_late_deliberations_orders_and_answers_end_safely(
    delay_s: float, toxic: bool, replies: list[Reply], latency_s: float, orders: list[tuple[float, Order]]
) -> None:
    answers = [Answer(reply=reply, latency_s=latency_s, text=reply.value) for reply in replies]
    operator = RecordedOperator(answers, orders=sorted(orders, key=lambda item: item[0]))
    verdict, path, _ = fly(operator, change=late(delay_s), toxic=toxic, endurance_s=400.0)
    said_yes = Reply.YES in replies
    assert verdict.outcome in {Outcome.SUCCESS, Outcome.ABORTED, Outcome.NO_SAFE_PLAN} or (
        toxic and said_yes and verdict.outcome is Outcome.TOXIC_SMOKE
    ), verdict
    assert said_yes or not in_cloud(path)


def test_a_deliberation_that_never_comes_in_time_ends_at_the_start() -> None:
    verdict, path, events = fly(RecordedOperator([Reply.NO]), change=late(DELIBERATION_S + 5))
    assert verdict.outcome is Outcome.NO_SAFE_PLAN
    assert "deliberation" in kinds(events)
    assert len(path) == 0


def test_a_fault_in_deliberation_flies_the_cautious_plan_that_was_checked_last() -> None:
    class Broken(InlineWorker):
        """Fails once the first question was answered."""

        def submit(self, request, time_s):  # type: ignore[no-untyped-def]
            super().submit(request, time_s)
            if request.state.asked:
                due_s, done = self._done.pop()
                keep = request.purpose.value != "mission"
                self._done.append((due_s, done if keep else replace(done, decision=None, reason="a fault")))

    verdict, path, events = fly(
        RecordedOperator([Reply.YES]), change=lambda made: replace(made, worker=Broken), toxic=False
    )
    assert verdict.outcome is Outcome.SUCCESS, verdict
    assert not in_cloud(path), "the cautious plan needs no yes"
    assert "deliberation" in kinds(events)


class Failing(MapSource):
    """A camera that is gone after some looks."""

    def __init__(self, inner: MapSource, looks: int) -> None:
        self._inner, self._left = inner, looks

    def look(self) -> None:
        self._left -= 1
        if self._left < 0:
            raise DeviceError("the camera is unplugged")
        self._inner.look()

    def draw(self, previous: SemanticMap | None) -> SemanticMap:
        return self._inner.draw(previous)

    def flown(self, points_m: np.ndarray, radius_m: float) -> None:
        self._inner.flown(points_m, radius_m)


@pytest.mark.parametrize("looks", [0, 1, 3, 7])
def test_without_a_camera_it_brakes_holds_and_returns(looks: int) -> None:
    def blind(made: MissionComponents) -> MissionComponents:
        return replace(made, map_source=Failing(made.map_source, looks), watch_map=True)

    verdict, path, events = fly(RecordedOperator([Reply.NO]), change=blind, solids=[wall("late", 8.0, (0.5, 1.0))])
    assert verdict.outcome is Outcome.NO_SAFE_PLAN, verdict
    assert "camera" in str(verdict.reason).lower()
    assert "link" in kinds(events)
    legs = [e for e in events if isinstance(e, LegFlown)]
    if len(legs) > 1:
        assert np.linalg.norm(path[-1] - (1.5, 2.0, 1.2)) < 0.7
        waited_s = legs[-1].log.time_s[0] - legs[-2].log.time_s[-1]
        assert 3.0 < waited_s < 6.0, "it waits whether the camera comes back"


class Leaving(RecordedOperator):
    """Goes away after a time."""

    def __init__(self, at_s: float, answers: list[Reply]) -> None:
        super().__init__(answers)
        self._at_s = at_s

    def poll(self, time_s: float):  # type: ignore[no-untyped-def]
        if time_s >= self._at_s:
            raise DeviceError("the operator's link is gone")
        return super().poll(time_s)


def test_when_all_operators_are_gone_the_flight_goes_on_and_returns() -> None:
    verdict, path, events = fly(Leaving(3.0, [Reply.NO]))
    assert verdict.outcome is Outcome.SUCCESS, verdict
    assert np.linalg.norm(path[-1] - (1.5, 2.0, 1.2)) < 0.7
    assert not in_cloud(path)
    assert "link" in kinds(events)


def test_nobody_there_from_the_beginning_is_silence() -> None:
    verdict, path, _ = fly(Leaving(0.0, []))
    assert verdict.outcome is Outcome.SUCCESS, verdict
    assert not in_cloud(path)


def test_one_of_two_operators_may_leave() -> None:
    verdict, path, _ = fly(Leaving(0.0, []), RecordedOperator([Reply.YES]), toxic=False)
    assert verdict.outcome is Outcome.SUCCESS
    assert in_cloud(path)


def test_a_late_no_stops_what_a_yes_has_permitted() -> None:
    """The second operator contradicts the first one while the drone is on its way into the smoke."""
    hasty = RecordedOperator([Reply.YES])
    sure = RecordedOperator([Answer(reply=Reply.NO, latency_s=2.0, text="no, it is toxic")])
    sure.withdraw = lambda question, why: None  # type: ignore[method-assign]  # it has not seen that it was answered
    verdict, path, events = fly(hasty, sure, toxic=True)
    assert verdict.outcome is Outcome.SUCCESS, verdict
    assert not in_cloud(path)
    assert "late-answer" in kinds(events)


def test_a_late_yes_opens_nothing() -> None:
    sure = RecordedOperator([Reply.NO])
    hasty = RecordedOperator([Answer(reply=Reply.YES, latency_s=1.0, text="yes")])
    hasty.withdraw = lambda question, why: None  # type: ignore[method-assign]
    verdict, path, events = fly(sure, hasty, toxic=True)
    assert verdict.outcome is Outcome.SUCCESS
    assert not in_cloud(path)
    assert "late-answer" in kinds(events)
