"""The loop with real parts: kinematic drone, grid planner, tree, templates, scripted operators."""

from __future__ import annotations

import numpy as np
import pytest
from tests.mission.scenes import hall, wall

from mintpilot.assembly.api import run_mission
from mintpilot.assembly.components import Choices, components_for
from mintpilot.assembly.worlds import build_world
from mintpilot.core.events import Event, LegFlown, PlanChosen
from mintpilot.core.mission import Outcome
from mintpilot.core.query import Answer, Order, Reply
from mintpilot.core.trajectory import FlightEnd
from mintpilot.core.tree import StopReason
from mintpilot.interaction.scripted import FunctionOperator, RecordedOperator
from mintpilot.mission.loop import fly_mission
from mintpilot.mission_file.schema import MissionFile
from mintpilot.recording.recorders import MemoryRecorder


def fly(file: MissionFile, operator: object = "scripted", strategy: str = "mint"):
    events: list[Event] = []
    record = run_mission(file, operator=operator, vehicle="kinematic", strategy=strategy, progress=events.append)
    flown = [e.log.position_m for e in events if isinstance(e, LegFlown)]
    return record, np.vstack(flown) if flown else np.zeros((0, 3)), events


def enters_cloud(path: np.ndarray) -> bool:
    inside = (path[:, 0] > 5.2) & (path[:, 0] < 7.0) & (path[:, 1] > 0.2) & (path[:, 1] < 3.6)
    return bool(inside.any())


@pytest.mark.parametrize("toxic", [True, False])
def test_asks_about_the_smoke_and_flies_accordingly(toxic: bool) -> None:
    record, path, _ = fly(hall(toxic=toxic))
    assert record.outcome is Outcome.SUCCESS
    assert [q.reply for q in record.questions] == [Reply.NO if toxic else Reply.YES]
    assert enters_cloud(path) is not toxic


def test_silence_means_the_cautious_way() -> None:
    record, path, _ = fly(hall(toxic=False, asking={"while_waiting": "hold"}), RecordedOperator([]))
    assert record.outcome is Outcome.SUCCESS
    assert not enters_cloud(path)
    assert record.certificate is not None
    assert record.certificate.reason is StopReason.SILENCE
    assert any(n.kind == "silence" for n in record.notices)
    assert len(record.questions) == 1


def test_silence_without_a_cautious_way_stays_safe() -> None:
    record, path, _ = fly(hall(toxic=False, detour=False), RecordedOperator([]))
    assert record.outcome is Outcome.NO_SAFE_PLAN
    assert not enters_cloud(path)


@pytest.mark.parametrize("order", [Order.ABORT, Order.LAND, Order.RETURN])
def test_an_order_instead_of_an_answer_is_obeyed_at_once(order: Order) -> None:
    operator = RecordedOperator([order])
    record, path, _ = fly(hall(), operator)
    assert record.outcome is Outcome.ABORTED
    assert len(operator.questions) == 1
    assert record.questions == ()
    assert [o.order for o in record.orders] == [order]
    assert operator.told[0] == record.orders[0].answer
    assert len(path) == 0 or np.ptp(path[:, 0]) < 1.0


@pytest.mark.parametrize("order", [Order.ABORT, Order.LAND, Order.RETURN])
@pytest.mark.parametrize("at_s", [1.3, 4.0, 7.7])
def test_an_order_in_flight_decides_the_next_motion(order: Order, at_s: float) -> None:
    operator = RecordedOperator([Reply.NO], orders=[(at_s, order)])
    record, _, events = fly(hall(), operator)
    assert record.outcome is Outcome.ABORTED, record.reason
    legs = [e for e in events if isinstance(e, LegFlown)]
    assert legs[0].log.end is FlightEnd.INTERRUPTED
    ordered_s = record.orders[0].time_s
    assert ordered_s - at_s <= 0.5, "within one camera period"
    assert legs[0].log.time_s[-1] - ordered_s < 2.5, "it brakes at once"
    here = legs[0].log.position_m[-1]
    if order is Order.RETURN:
        assert np.linalg.norm(legs[-1].log.position_m[-1] - (1.5, 2.0, 1.2)) < 0.6
    else:
        assert "stands on the ground" in record.reason
        assert np.linalg.norm(here[:2] - legs[-1].log.position_m[-1][:2]) < 0.1


def test_hold_is_a_hold_and_continue_goes_on() -> None:
    operator = RecordedOperator([Reply.NO], orders=[(2.0, Order.HOLD), (30.0, Order.CONTINUE)])
    record, path, events = fly(hall(), operator)
    assert record.outcome is Outcome.SUCCESS, record.reason
    assert not enters_cloud(path)
    times = np.concatenate([e.log.time_s for e in events if isinstance(e, LegFlown)])
    assert np.diff(times).max() > 20, "nothing moved meanwhile"
    assert len(record.questions) == 1, "what was answered is not asked again"
    assert "continue" in operator.told[0]


def test_holding_counts_the_battery_and_ends_in_time_to_return() -> None:
    operator = RecordedOperator([Reply.NO], orders=[(3.0, Order.HOLD)])
    record, _, events = fly(hall(endurance_s=60.0), operator)
    assert record.outcome is Outcome.ABORTED, record.reason
    assert "battery" in record.reason
    assert "back at the start" in record.reason
    last = [e for e in events if isinstance(e, LegFlown)][-1]
    assert last.phase == "return"
    assert 20 < last.log.time_s[-1] < 60


def test_hold_during_a_question_withdraws_it_and_it_is_asked_again() -> None:
    patient = Answer(reply=Reply.NO, latency_s=10.0, text="no")
    operator = RecordedOperator([patient, Reply.NO], orders=[(2.0, Order.HOLD), (5.0, Order.CONTINUE)])
    record, path, _ = fly(hall(), operator)
    assert record.outcome is Outcome.SUCCESS
    assert len(operator.questions) == 2
    assert len(record.questions) == 1
    assert any(n.kind == "withdrawn" for n in record.notices)
    assert not enters_cloud(path)


def test_the_first_of_several_operators_counts() -> None:
    quick, slow = RecordedOperator([Reply.NO]), RecordedOperator([Answer(reply=Reply.YES, latency_s=1.0, text="yes")])
    record, path, _ = fly(hall(toxic=True), (slow, quick))
    assert record.outcome is Outcome.SUCCESS
    assert [q.reply for q in record.questions] == [Reply.NO]
    assert not enters_cloud(path)


def test_waiting_for_an_answer_takes_mission_time() -> None:
    def seconds(latency_s: float) -> float:
        operator = RecordedOperator([Answer(reply=Reply.NO, latency_s=latency_s, text="no")])
        _, _, events = fly(hall(asking={"while_waiting": "hold"}), operator)
        return float([e for e in events if isinstance(e, LegFlown)][-1].log.time_s[-1])

    assert seconds(10.0) - seconds(0.0) == pytest.approx(10.0, abs=0.6)


def test_unsure_withdraws_the_question_and_the_safe_way_is_flown() -> None:
    record, path, _ = fly(hall(toxic=False), FunctionOperator(lambda question, patience: Reply.UNSURE))
    assert record.outcome is Outcome.SUCCESS
    assert not enters_cloud(path)
    assert len({q.query for q in record.questions}) == len(record.questions)


def test_one_yes_is_not_enough_when_answers_may_be_wrong() -> None:
    operator = RecordedOperator([Reply.YES] * 9)
    record, path, _ = fly(hall(toxic=False, asking={"answer_error": 0.1}), operator)
    yes = sum(q.reply is Reply.YES for q in record.questions)
    assert record.outcome is Outcome.SUCCESS
    assert yes >= 2 or not enters_cloud(path)


@pytest.mark.long
@pytest.mark.parametrize("error", [0.0, 0.02, 0.3])
@pytest.mark.parametrize("budget", [0, 1, 3, 5])
def test_the_number_of_questions_stays_within_the_budget(error: float, budget: int) -> None:
    flip = iter([Reply.YES, Reply.NO] * 50)
    operator = FunctionOperator(lambda question, patience: next(flip))
    toxic = hall(asking={"answer_error": error, "max_questions": budget, "alpha_safe": 1e-9})
    record, path, _ = fly(toxic, operator)
    assert len(record.questions) <= budget
    if error == 0.0 and budget:
        return  # answers are believed: a wrong yes is flown
    assert not enters_cloud(path)


def test_something_that_falls_into_the_way_makes_it_think_again() -> None:
    fallen = wall("fallen", 8.0, (0.5, 6.0), appears_s=2.0)
    record, path, events = fly(hall(toxic=False, solids=[fallen]))
    assert record.outcome is Outcome.SUCCESS, record.reason
    assert any(n.kind == "news" for n in record.notices)
    assert len([e for e in events if isinstance(e, PlanChosen)]) >= 2
    assert path[:, 1].max() > 5.5


def test_a_battery_that_allows_no_detour_and_toxic_smoke_leave_no_plan() -> None:
    record, path, _ = fly(hall(toxic=True, endurance_s=11.0))
    assert record.outcome is Outcome.NO_SAFE_PLAN
    assert not enters_cloud(path)


def test_the_risky_baseline_is_judged_by_the_simulator() -> None:
    record, _, _ = fly(hall(toxic=True), strategy="passive-risky")
    assert record.outcome is Outcome.TOXIC_SMOKE
    assert record.questions == ()


def test_an_interrupt_leaves_the_vehicle_holding_and_a_verdict() -> None:
    def interrupt(question: object, patience: float) -> Reply:
        raise KeyboardInterrupt

    world = build_world(hall(), base=None, seed=0)
    recorder = MemoryRecorder()
    choices = Choices(vehicle="kinematic")
    people = (FunctionOperator(interrupt),)
    with components_for(world, choices, operators=people, recorder=recorder) as made:
        with pytest.raises(KeyboardInterrupt):
            fly_mission(made)
        assert np.linalg.norm(made.vehicle.state().velocity_mps) < 1e-6
    assert recorder.events[-1].verdict.outcome is Outcome.ABORTED


def test_same_seed_same_record() -> None:
    def stable(record):
        return record.model_dump(exclude={"timings_s", "rounds", "questions"}), [q.text for q in record.questions]

    assert stable(fly(hall())[0]) == stable(fly(hall())[0])
