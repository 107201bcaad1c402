"""Rooms by name, counting, photographing, reporting, heights: from words to stops."""

from __future__ import annotations

import pytest

from mintpilot.core.geometry import Box
from mintpilot.core.semantic_map import Room
from mintpilot.core.task import Action
from mintpilot.language import parse_instruction
from mintpilot.uncertainty import Findings, find_gaps

from .worlds import START_M, thing, world

CONES = [thing(f"cone-{i}", "cone", (4 + 4 * i, 7, 0.2)) for i in (1, 2, 3)]


def room(name: str, x_m: float, description: str) -> Room:
    door = Box(lo_m=(x_m - 0.5, 13.0, 0.0), hi_m=(x_m + 0.5, 13.1, 2.0))
    return Room(id=name, door_m=door, viewpoint_m=(x_m, 11.8, 1.4), description=description)


ROOMS = [room("r1", 5, "the closed garage"), room("r2", 9, "the closed cellar"), room("r3", 13, "the storage room")]


def found(text: str, rooms: list[Room] = ROOMS, flat: bool = False) -> Findings:
    map = world([*CONES, thing("van-1", "van", (3, 3, 0.5))], rooms=rooms, flat=flat)
    return find_gaps(map, parse_instruction(text, home_m=START_M), start_m=START_M)


def places(findings: Findings) -> list[tuple[str, Action, str]]:
    return [(stop.id, stop.action, stop.sites[0].label) for stop in findings.stops]


@pytest.mark.parametrize(
    ("text", "label"),
    [("Look into the cellar", "r2"), ("Search the garage for the keys", "r1"), ("Look into the storage room", "r3")],
)
def test_a_room_that_is_called_by_its_name_needs_no_question(text: str, label: str) -> None:
    findings = found(text)
    assert (findings.gaps, findings.problems) == ((), ())
    assert [(action, place) for _, action, place in places(findings)] == [(Action.LOOK, label)]


def test_a_room_that_is_not_there_is_told_with_what_is() -> None:
    assert tuple(map(str, found("Go to the office", ROOMS[:1]).problems)) == (
        "Nothing on the map matches 'the office'. Seen was the closed garage.",
    )


def test_a_room_without_a_name_may_be_any() -> None:
    nameless = [room("r1", 5, "the closed room with the brown door"), room("r2", 9, "the closed room by the rack")]
    (gap,) = found("Look into the kitchen", nameless).gaps
    assert set(gap.values) == {"r1", "r2"}
    assert found("Look behind the brown door", nameless).gaps == ()


def test_every_thing_that_is_counted_or_photographed_has_its_stop() -> None:
    assert {place for _, _, place in places(found("Count the cones"))} == {"cone-1", "cone-2", "cone-3"}
    assert places(found("Photograph the van")) == [("photograph:1", Action.PHOTOGRAPH, "van-1")]
    (stop,) = found("Take a picture of the van at a height of 2 m").stops
    assert stop.sites[0].position_m == (3, 3, 2)


def test_what_is_counted_or_reported_in_a_room_is_seen_from_its_viewpoint() -> None:
    assert places(found("Count the people in the garage")) == [("count:1", Action.LOOK, "r1")]
    assert places(found("Report what you see in the cellar")) == [("report:1", Action.LOOK, "r2")]
    assert places(found("Go to the van and report what you see"))[1] == ("report:2", Action.REPORT, "van-1")


def test_a_height_that_the_map_does_not_have_is_told() -> None:
    told = str(found("Go to the van at 9 m").problems[0])
    assert "at a height of 9 m cannot be flown: the map has heights from 0 to 4 m" in told
    assert "one layer, at 0.25 m" in str(found("Go to the van at 2 m", flat=True).problems[0])
