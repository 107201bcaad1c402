"""From words to gaps: the paper's two instructions, read by the rules, on small maps."""

from __future__ import annotations

from mintpilot.language import parse_instruction
from mintpilot.uncertainty import find_gaps

from .worlds import START_M, room, smoke, thing, world

BOXES = [
    thing("box-1", "box", (5, 3, 0.2), colour="red", size="small"),
    thing("box-2", "box", (9, 9, 0.2), colour="blue", size="large"),
]
PERSON = thing("person-1", "person", (15, 7, 0.2))


def test_the_medicine_mission_has_one_target_gap() -> None:
    task = parse_instruction("Pick up the medicine from the box and bring it to the injured person")
    findings = find_gaps(world([*BOXES, PERSON]), task, start_m=START_M)
    assert [gap.id for gap in findings.gaps] == ["target:1:box"]
    assert [(stop.id, len(stop.sites)) for stop in findings.stops] == [("pick:1", 2), ("deliver:2", 1)]


def test_a_map_that_knows_what_is_in_the_boxes_settles_it() -> None:
    task = parse_instruction("Pick up the medicine from the box and bring it to the injured person")
    known = thing("box-3", "box", (2, 2, 0.2), contents="medicine")
    findings = find_gaps(world([*BOXES, known, PERSON]), task, start_m=START_M)
    assert findings.gaps == ()
    assert findings.stops[0].sites[0].label == "box-3"


def test_the_fire_mission_has_an_obstacle_and_a_presence_gap() -> None:
    task = parse_instruction("Find the injured person in the burning warehouse and check whether anyone else is hurt")
    findings = find_gaps(world([PERSON], [smoke("smoke-1", 0)], [room("room-1", 6.0)]), task, start_m=START_M)
    assert [gap.id for gap in findings.gaps] == ["obstacle:smoke-1", "presence:room-1"]
    assert [stop.id for stop in findings.stops] == ["go:1:person-1", "look:room-1"]
    assert findings.problems == ()


def test_nobody_in_sight_is_no_problem_when_anybody_is_sought() -> None:
    findings = find_gaps(world(rooms=[room("room-1", 6.0)]), parse_instruction("find anyone hurt"), start_m=START_M)
    assert findings.problems == ()
    assert [stop.id for stop in findings.stops] == ["look:room-1"]
    missing = find_gaps(world(), parse_instruction("find the injured person"), start_m=START_M)
    assert tuple(map(str, missing.problems)) == ("Nothing on the map matches 'the injured person'. Seen was nothing.",)
