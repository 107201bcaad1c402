"""Waiting for a person costs mission time and battery: deadlines follow the battery (method, section 10)."""

from __future__ import annotations

import pytest
from tests.mission.scenes import hall

from mintpilot.assembly.api import run_mission
from mintpilot.core.mission import Outcome
from mintpilot.core.query import Reply
from mintpilot.recording.record import MissionRecord

CAUTIOUS_S = 11.5
"""Round by the far side, the stay included, about, seconds."""
SHARE = 0.75
"""Of the battery that plans may use."""


def flown(*, think: float, spare_s: float | None = None, toxic: bool = True, **asking: object) -> MissionRecord:
    endurance_s = None if spare_s is None else (CAUTIOUS_S + spare_s) / SHARE
    settings = {"while_waiting": "hold", **asking}
    mission = hall(toxic=toxic, asking=settings, operator={"latency_s": think}, endurance_s=endurance_s)
    return run_mission(mission, vehicle="kinematic")


@pytest.mark.parametrize("toxic", [True, False])
def test_waiting_takes_mission_time(toxic: bool) -> None:
    at_once, later = (flown(think=seconds, toxic=toxic).achieved[-1].at_s for seconds in (0.0, 6.0))
    assert later - at_once == pytest.approx(6.0, abs=0.6)


def test_the_deadline_leaves_the_cautious_plan_its_battery() -> None:
    record = flown(think=25.0, spare_s=6.0)
    assert [q.reply for q in record.questions] == [Reply.TIMEOUT]
    assert record.questions[0].latency_s < 6.0
    assert record.outcome is Outcome.SUCCESS


def test_an_answer_within_the_battery_counts() -> None:
    record = flown(think=3.0, spare_s=6.0, toxic=False)
    assert [q.reply for q in record.questions] == [Reply.YES]
    assert record.outcome is Outcome.SUCCESS


def test_without_time_for_an_answer_nothing_is_asked() -> None:
    record = flown(think=3.0, spare_s=0.5)
    assert not record.questions
    assert record.certificate is not None
    assert record.certificate.reason == "waiting"
    assert record.outcome is Outcome.SUCCESS


def test_who_answers_at_once_may_be_asked_even_then() -> None:
    record = flown(think=0.0, spare_s=0.5, toxic=False, reply_s=0)
    assert [q.reply for q in record.questions] == [Reply.YES]
    assert record.outcome is Outcome.SUCCESS
