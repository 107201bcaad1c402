"""Where nothing can be flown every stop is named with what runs short for it."""

from __future__ import annotations

from mintpilot.assembly.api import run_mission
from mintpilot.mission_file.schema import MissionFile

from .scenes import hall


def short_of_battery(*, endurance_s: float) -> MissionFile:
    return hall(toxic=False, endurance_s=endurance_s)


def test_a_refusal_for_want_of_battery_names_it_with_both_figures():
    record = run_mission(short_of_battery(endurance_s=6.0), vehicle="kinematic")
    assert record.outcome.value == "no-safe-plan"
    (left,) = record.left
    assert left.resource == "battery"
    # A fifth is kept, and landing is: 6 s x 0.8 leave less than 5 s; the way through the cloud alone takes over 5 s.
    assert left.available <= 6.0 * 0.8 + 1e-9 < 5.0 < left.needed
    assert "the way there needs" in record.reason


def test_a_refusal_for_want_of_a_way_lists_the_stop_too():
    record = run_mission(hall(toxic=True, detour=False), vehicle="kinematic")
    assert record.outcome.value == "no-safe-plan"
    assert [(one.resource, one.text) for one in record.left] == [("way", "go to the injured person")]
