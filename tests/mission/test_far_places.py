"""Places far away, by the flight that they take, are flown to; and what is left is never called done."""

from __future__ import annotations

import pytest

from mintpilot.assembly.api import run_mission
from mintpilot.core.mission import Outcome
from mintpilot.mission_file.schema import MissionFile


def to_and_fro(**asking: object) -> MissionFile:
    """To the far end of a hall and back, 250 s each way."""
    return MissionFile.model_validate(
        {
            "mintpilot": 1,
            "name": "to-and-fro",
            "instruction": "Fly to and fro.",
            "world": {
                "scene": {"volume": {"lo_m": [0, 0, 0], "hi_m": [60, 8, 3]}, "start_m": [5.0, 4.0, 1.2]},
            },
            "goals": [
                {"action": "go", "position_m": [55.0, 4.0, 1.2]},
                {"action": "go", "position_m": [5.0, 4.0, 1.2]},
            ],
            "vehicle": {"cruise_mps": 0.05},
            "asking": asking,
        }
    )


@pytest.mark.long
def test_a_flight_longer_than_the_usual_price_of_failing_is_flown() -> None:
    record = run_mission(to_and_fro(), vehicle="kinematic")
    assert record.outcome is Outcome.SUCCESS
    assert [one.text for one in record.achieved] == ["go to the place at (55, 4)", "go to the place at (5, 4)"]
    assert record.achieved[-1].at_s > 2 * 45 / 0.05


def test_what_is_not_worth_its_flight_is_left_and_said() -> None:
    record = run_mission(to_and_fro(failure_price_s=600), vehicle="kinematic")
    assert record.outcome is Outcome.PARTIAL
    assert [(one.text, one.resource) for one in record.left] == [("go to the place at (55, 4)", "price")]
    assert record.certificate is not None
    assert "It leaves undone: go to the place at (55, 4) (the way there needs 19" in record.certificate.text


@pytest.mark.long
@pytest.mark.parametrize("price_s", [300.0, 5000.0])
def test_a_stated_price_stays_as_it_is(price_s: float) -> None:
    record = run_mission(to_and_fro(failure_price_s=price_s), vehicle="kinematic")
    assert (record.outcome is Outcome.SUCCESS) is (price_s > 2000)
