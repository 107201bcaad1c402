"""Asking without stopping (method, section 10)."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from tests.mission.scenes import hall

from mintpilot.assembly.api import run_mission
from mintpilot.assembly.replaying import verify_run
from mintpilot.core.events import Event, LegFlown
from mintpilot.core.mission import Outcome
from mintpilot.core.query import Answer, Order, Reply
from mintpilot.interaction.scripted import RecordedOperator
from mintpilot.recording.record import MissionRecord


def flown(
    *, toxic: bool, think: float, moves: bool = True, out: Path | None = None
) -> tuple[MissionRecord, list[LegFlown]]:
    legs: list[LegFlown] = []

    def heard(event: Event) -> None:
        if isinstance(event, LegFlown):
            legs.append(event)

    mission = hall(toxic=toxic, asking={"while_waiting": "move" if moves else "hold"}, operator={"latency_s": think})
    return run_mission(mission, vehicle="kinematic", progress=heard, out=out), legs


def in_cloud(points_m: np.ndarray) -> bool:
    x, y = points_m[:, 0], points_m[:, 1]
    return bool(((x > 5.2) & (x < 7.0) & (y > 0.2) & (y < 3.6)).any())


BRAKING_S = 0.75
"""From cruise speed to rest."""


@pytest.mark.parametrize("think", [3.0, 8.0])
def test_moving_is_never_much_later_and_earlier_on_average(think: float) -> None:
    gained = []
    for toxic in (True, False):
        moved, legs = flown(toxic=toxic, think=think)
        held, _ = flown(toxic=toxic, think=think, moves=False)
        assert moved.outcome is held.outcome is Outcome.SUCCESS
        assert held.waiting is not None
        assert moved.waiting is not None
        assert held.waiting.hidden_s == pytest.approx(0.0, abs=1e-6)
        assert moved.waiting.delay_s == pytest.approx(think, abs=0.6)
        assert moved.waiting.hidden_s <= moved.waiting.delay_s
        meanwhile = [leg for leg in legs if leg.phase == "meanwhile"]
        assert meanwhile
        assert not any(in_cloud(leg.log.position_m) for leg in meanwhile), "nobody has said yet that the smoke is safe"
        gained.append(held.achieved[-1].at_s - moved.achieved[-1].at_s)
    assert min(gained) > -BRAKING_S - 0.3
    assert sum(gained) > 0


def test_who_answers_at_once_is_not_flown_away_from() -> None:
    _, legs = flown(toxic=True, think=0.0)
    assert [leg.phase for leg in legs] == ["mission"]


def test_an_order_ends_what_is_done_meanwhile() -> None:
    legs: list[LegFlown] = []
    operator = RecordedOperator([Answer(reply=Reply.NO, latency_s=20.0)], orders=[(2.0, Order.RETURN)])
    record = run_mission(
        hall(),
        vehicle="kinematic",
        operator=operator,
        progress=lambda event: legs.append(event) if isinstance(event, LegFlown) else None,
    )
    assert record.outcome is Outcome.ABORTED
    assert [leg.phase for leg in legs] == ["meanwhile", "return"]
    assert legs[0].log.time_s[-1] < 3.5


@pytest.mark.long
def test_a_mission_with_flights_meanwhile_is_thought_through_again_alike(tmp_path: Path) -> None:
    _, legs = flown(toxic=True, think=6.0, out=tmp_path / "run")
    assert any(leg.phase == "meanwhile" for leg in legs)
    found = verify_run(tmp_path / "run")
    assert found.verification.difference is None
    assert json.loads((tmp_path / "run" / "record.json").read_text())["waiting"]["hidden_s"] > 0
