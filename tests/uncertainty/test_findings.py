"""Gaps and stops from map and task."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mintpilot.core.errors import InputError
from mintpilot.core.gap import ABSENT, BLOCKED, NOWHERE, PASSABLE, PRESENT, GapKind, KnowledgeGap
from mintpilot.core.observation import NameGuess, RegionKind
from mintpilot.core.plan import VehicleLimits
from mintpilot.core.rule import Rule
from mintpilot.core.semantic_map import Knowledge
from mintpilot.core.task import Action, Reference, SubGoal, Task
from mintpilot.uncertainty import find_gaps, frame_problem
from mintpilot.uncertainty.findings import Prices, told_apart

from .worlds import START_M, room, smoke, step, thing, world

RED = thing("box-1", "box", (5, 3, 0.2), colour="red", size="small")
BLUE = thing("box-2", "box", (9, 9, 0.2), colour="blue", size="large")
PERSON = thing("person-1", "person", (15, 7, 0.2))
RACK = thing("rack-1", "rack", (9, 11, 1.0), edge_m=1.0, colour="red")
MEDICINE = Task(
    instruction="Pick up the medicine from the box and bring it to the injured person",
    subgoals=(
        step(Action.PICK, "the box", "box"),
        step(Action.DELIVER, "the injured person", "person", condition="injured"),
    ),
)
EVERYBODY = SubGoal(action=Action.GO, reference=Reference(phrase="everybody", label="person", every=True))
SEARCH = Task(
    instruction="Find the injured person and check whether anyone else is hurt",
    subgoals=(step(Action.GO, "the injured person", "person"),),
    seeks_people=True,
)


def test_several_matches_are_a_target_gap_with_candidates_told_apart() -> None:
    findings = find_gaps(world([BLUE, RED, PERSON]), MEDICINE, start_m=START_M)
    (gap,) = findings.gaps
    assert (gap.id, gap.kind, gap.description) == ("target:1:box", GapKind.TARGET, "the box")
    assert gap.values == ("box-1", "box-2")
    assert gap.prior == (0.5, 0.5)
    assert [c.description for c in gap.candidates] == ["the small red box", "the large blue box"]
    pick, deliver = findings.stops
    assert (pick.id, pick.action, pick.gap) == ("pick:1", Action.PICK, gap.id)
    assert [site.value for site in pick.sites] == ["box-1", "box-2"]
    assert (deliver.id, deliver.gap, deliver.sites[0].label) == ("deliver:2", "", "person-1")
    assert deliver.sites[0].reach_m == pytest.approx(1.5)
    assert findings.problems == ()


@pytest.mark.parametrize("sure", [0.2, 0.5, 0.9])
def test_one_match_of_a_weak_name_is_asked_about_and_may_be_none_of_them(sure: float) -> None:
    weak = replace(RED, names=(NameGuess(label="box", probability=sure),))
    (gap,) = find_gaps(world([weak, PERSON]), MEDICINE, start_m=START_M).gaps
    assert gap.values == ("box-1", *NOWHERE)
    assert gap.prior == pytest.approx((0.9 * sure, 0.9 * (1 - sure), 0.1))
    assert [c.id for c in gap.candidates] == ["box-1"]


def test_a_sure_name_is_bound_and_among_several_the_weak_ones_leave_none_of_them() -> None:
    sure = replace(RED, names=(NameGuess(label="box", probability=0.97),))
    assert find_gaps(world([sure, PERSON]), MEDICINE, start_m=START_M).gaps == ()
    weak = replace(BLUE, names=(NameGuess(label="box", probability=0.4),))
    (gap,) = find_gaps(world([sure, weak, PERSON]), MEDICINE, start_m=START_M).gaps
    assert gap.values == ("box-1", "box-2", *NOWHERE)
    assert gap.prior[0] > gap.prior[1] > 0
    assert gap.prior[2] < 0.03


def test_a_doubtful_person_is_asked_about_by_who_seeks_people_and_visited_only_where_it_is_one() -> None:
    doubtful = replace(thing("object-1", "object", (8, 4, 0.4)), names=(NameGuess(label="person", probability=0.4),))
    hardly = replace(thing("object-2", "object", (9, 4, 0.4)), names=(NameGuess(label="person", probability=0.2),))
    map_ = world([doubtful, hardly, PERSON])
    findings = find_gaps(map_, replace(SEARCH, subgoals=(EVERYBODY,)), start_m=START_M)
    (gap,) = findings.gaps
    assert (gap.id, gap.kind, gap.is_thing) == ("presence:object-1", GapKind.PRESENCE, True)
    assert gap.prior == pytest.approx((0.4, 0.6))
    (look,) = [s for s in findings.stops if s.optional]
    assert (look.gap, look.sites[0].value, look.sites[0].label) == (gap.id, PRESENT, "object-1")
    assert "object-1" not in {s.sites[0].label for s in findings.stops if not s.optional}
    after = find_gaps(map_, replace(SEARCH, subgoals=(EVERYBODY,)), start_m=START_M, finished=frozenset({look.id}))
    assert after.gaps == ()
    assert not any(s.optional for s in after.stops)


def test_one_match_is_bound_without_a_gap() -> None:
    findings = find_gaps(world([RED, PERSON]), MEDICINE, start_m=START_M)
    assert findings.gaps == ()
    assert findings.stops[0].sites[0].position_m == pytest.approx((5, 3, 0.2))


def test_nothing_that_matches_is_told_with_what_was_seen() -> None:
    task = Task(instruction="go to the green box", subgoals=(step(Action.GO, "the green box", "box", colour="green"),))
    findings = find_gaps(world([RED, BLUE, PERSON]), task, start_m=START_M)
    assert findings.stops == ()
    (problem,) = findings.problems
    assert str(problem) == (
        "Nothing on the map matches 'the green box'. Seen was the large blue box, the small red box."
    )
    with pytest.raises(InputError, match="the green box"):
        frame_problem(world([RED]), task, findings, start_m=START_M, limits=VehicleLimits())


def test_an_empty_map_says_that_nothing_was_seen() -> None:
    findings = find_gaps(world(), MEDICINE, start_m=START_M)
    assert len(findings.problems) == 2
    assert all("Seen was nothing." in str(text) for text in findings.problems)


def test_an_open_region_is_an_obstacle_gap() -> None:
    regions = [
        smoke("smoke-1", 0, prior=0.7, words="the grey smoke near the gate"),
        smoke("smoke-2", 40),
        smoke("smoke-3", 80, passable=Knowledge.NO),
        smoke("smoke-4", 90, passable=Knowledge.YES),
    ]
    findings = find_gaps(world([RED, PERSON], regions), MEDICINE, start_m=START_M, prior_passable=0.2)
    first, second = findings.gaps
    assert (first.id, first.subject, first.values) == ("obstacle:smoke-1", "smoke-1", (PASSABLE, BLOCKED))
    assert first.prior == pytest.approx((0.7, 0.3))
    assert first.position_m == pytest.approx((1.0, 0.25, 0.25))
    assert first.description == "the grey smoke near the gate"
    assert (second.id, second.description) == ("obstacle:smoke-2", "the smoke")
    assert second.prior == pytest.approx((0.2, 0.8))


def test_an_explicit_prior_of_a_half_is_kept() -> None:
    findings = find_gaps(
        world([RED, PERSON], [smoke("smoke-1", 0, prior=0.5)]), MEDICINE, start_m=START_M, prior_passable=0.2
    )
    assert findings.gaps[0].prior == pytest.approx((0.5, 0.5))


def test_a_region_without_cells_opens_no_gap() -> None:
    empty = smoke("smoke-1", 0)
    hollow = type(empty)(id="smoke-2", kind=RegionKind.SMOKE, cells=np.zeros(0, np.int64))
    findings = find_gaps(world([RED, PERSON], [empty, hollow]), MEDICINE, start_m=START_M)
    assert [gap.id for gap in findings.gaps] == ["obstacle:smoke-1"]


def test_closed_rooms_are_presence_gaps_only_when_people_are_sought() -> None:
    rooms = [room("room-1", 6.0, prior_occupied=0.3), room("room-2", 12.0, searched=True)]
    assert find_gaps(world([RED, PERSON], rooms=rooms), MEDICINE, start_m=START_M).gaps == ()
    findings = find_gaps(world([PERSON], rooms=rooms), SEARCH, start_m=START_M)
    (gap,) = findings.gaps
    assert (gap.id, gap.kind, gap.values) == ("presence:room-1", GapKind.PRESENCE, (PRESENT, ABSENT))
    assert gap.prior == pytest.approx((0.3, 0.7))
    go, look = findings.stops
    assert (go.id, go.optional) == ("go:1:person-1", False)
    assert (look.id, look.action, look.gap, look.optional) == ("look:room-1", Action.LOOK, gap.id, True)
    assert look.sites[0].value == PRESENT
    assert look.sites[0].position_m == (6.0, 11.8, 1.4)


def test_a_room_known_to_be_occupied_must_be_looked_into_and_an_empty_one_not() -> None:
    rooms = [room("room-1", 6.0, occupied=Knowledge.YES), room("room-2", 12.0, occupied=Knowledge.NO)]
    findings = find_gaps(world([PERSON], rooms=rooms), SEARCH, start_m=START_M)
    (gap,) = findings.gaps
    assert (gap.values, gap.prior) == ((PRESENT,), (1.0,))
    assert [stop.id for stop in findings.stops] == ["go:1:person-1", "look:room-1"]


def test_who_looks_for_everybody_goes_to_each_person_in_sight_but_not_through_a_closed_door() -> None:
    inside = thing("person-2", "person", (6, 14, 0.2))
    outside = thing("person-3", "person", (4, 2, 0.2))
    map = world([PERSON, inside, outside], rooms=[room("room-1", 6.0, searched=True, occupied=Knowledge.YES)])
    findings = find_gaps(map, SEARCH, start_m=START_M)
    assert [stop.id for stop in findings.stops] == ["go:1:person-3", "go:1:person-1"]
    assert findings.gaps == ()


def test_finished_stops_and_the_gaps_of_them_are_left_out() -> None:
    map = world([RED, BLUE, PERSON], rooms=[room("room-1", 6.0)])
    findings = find_gaps(map, MEDICINE, start_m=START_M, finished=frozenset({"pick:1"}))
    assert [stop.id for stop in findings.stops] == ["deliver:2"]
    assert findings.gaps == ()
    done = frozenset({"go:1:person-1", "look:room-1"})
    assert find_gaps(map, SEARCH, start_m=START_M, finished=done).stops == ()


def test_the_same_phrase_twice_is_one_gap_and_a_pronoun_means_what_came_before() -> None:
    subgoals = (step(Action.GO, "the box", "box"), step(Action.PICK, "it"), step(Action.GO, "the box", "box"))
    findings = find_gaps(world([RED, BLUE]), Task(instruction="", subgoals=subgoals), start_m=START_M)
    assert [gap.id for gap in findings.gaps] == ["target:1:box"]
    assert [stop.gap for stop in findings.stops] == ["target:1:box"] * 3


def test_places_and_known_objects_are_not_searched_for() -> None:
    subgoals = (
        SubGoal(action=Action.GO, reference=Reference(phrase="3, 4", position_m=(3.0, 4.0, 1.5))),
        SubGoal(action=Action.GO, reference=Reference(phrase="box-2", object_id="box-2")),
        SubGoal(action=Action.GO, reference=Reference(phrase="box-9", object_id="box-9")),
    )
    findings = find_gaps(world([RED, BLUE]), Task(instruction="", subgoals=subgoals), start_m=START_M)
    assert [stop.sites[0].position_m for stop in findings.stops] == [(3.0, 4.0, 1.5), pytest.approx((9, 9, 0.2))]
    assert "box-9" in str(findings.problems[0])


def test_in_a_flat_map_every_place_is_on_its_layer() -> None:
    findings = find_gaps(world([RED, PERSON], flat=True), MEDICINE, start_m=START_M)
    assert {site.position_m[2] for stop in findings.stops for site in stop.sites} == {0.25}


def test_every_room_on_the_left_is_looked_into_nearest_first() -> None:
    left = Reference(
        phrase="every room on the left",
        label="room",
        attributes=step(Action.GO, "", side="left").reference.attributes,
        every=True,
    )
    task = Task(instruction="", subgoals=(SubGoal(action=Action.LOOK, reference=left),), seeks_people=True)
    rooms = [room("room-1", 14.0), room("room-2", 6.0)]
    findings = find_gaps(world([PERSON], rooms=rooms), task, start_m=START_M)
    assert [stop.id for stop in findings.stops] == ["look:1:room-2", "look:1:room-1"]
    assert not any(stop.optional for stop in findings.stops)
    assert findings.gaps == ()


def test_smoke_to_be_avoided_opens_no_gap_and_a_wish_can_be_given_up() -> None:
    map = world([RED, PERSON], [smoke("smoke-1", 0)])
    ruled = replace(MEDICINE, rules=(Rule(text="", formula="G !touches(smoke)"),))
    wished = replace(MEDICINE, avoid=(RegionKind.SMOKE,))
    for task, wishes in ((ruled, ()), (wished, ("smoke-1",))):
        findings = find_gaps(map, task, start_m=START_M)
        assert (findings.gaps, findings.wishes) == ((), wishes)
        again = find_gaps(map, task, start_m=START_M, honour_wishes=False)
        assert [gap.id for gap in again.gaps] == ["obstacle:smoke-1"]


def test_the_problem_holds_what_was_found() -> None:
    map = world([RED, BLUE, PERSON])
    findings = find_gaps(map, MEDICINE, start_m=START_M)
    limits = VehicleLimits()
    problem = frame_problem(map, MEDICINE, findings, start_m=START_M, limits=limits, finished=frozenset({"x"}))
    assert (problem.map, problem.start_m, problem.limits) == (map, START_M, limits)
    assert (problem.gaps, problem.finished, problem.home_m) == (findings.gaps, frozenset({"x"}), None)
    assert [stop.sites for stop in problem.stops] == [stop.sites for stop in findings.stops]
    assert [(stop.step, stop.text) for stop in problem.stops] == [(s.n, s.text) for s in MEDICINE.steps]


def test_stops_have_the_prices_of_their_steps_of_people_or_the_usual_one() -> None:
    first, second = MEDICINE.subgoals
    dear = replace(MEDICINE, subgoals=(replace(first, price_s=7.0), second))
    map = world([RED, BLUE, PERSON])
    findings = find_gaps(map, dear, start_m=START_M)
    for people_s, expected in ((None, [7.0, 50.0]), (900.0, [7.0, 900.0])):
        prices = Prices(usual_s=50.0, people_s=people_s)
        problem = frame_problem(map, dear, findings, start_m=START_M, limits=VehicleLimits(), prices=prices)
        assert [stop.price_s for stop in problem.stops] == expected


COLOURS = st.sampled_from(["red", "blue", "green", "grey"])
SIZES = st.sampled_from(["small", "large"])
OBJECTS = st.lists(
    st.tuples(st.sampled_from(["box", "person", "barrel"]), COLOURS, SIZES, st.integers(1, 19), st.integers(1, 12)),
    min_size=1,
    max_size=8,
)


@pytest.mark.long
@settings(deadline=None, max_examples=60)
@given(OBJECTS, st.randoms(use_true_random=False))
def test_the_order_of_things_in_the_map_never_matters(rows: list[tuple[str, str, str, int, int]], random) -> None:
    objects = [
        thing(f"{label}-{i}", label, (x, y, 0.2), colour=colour, size=size)
        for i, (label, colour, size, x, y) in enumerate(rows)
    ]
    regions, rooms = [smoke("smoke-1", 0), smoke("smoke-2", 99)], [room("room-1", 6.0), room("room-2", 12.0)]
    task = Task(instruction="", subgoals=(*MEDICINE.subgoals, *SEARCH.subgoals), seeks_people=True)
    expected = find_gaps(world(objects, regions, rooms), task, start_m=START_M)
    for part in (objects, regions, rooms):
        random.shuffle(part)
    shuffled = find_gaps(world(objects, regions, rooms), task, start_m=START_M)
    assert shuffled == expected
    assert [gap.id for gap in shuffled.gaps] == sorted({gap.id for gap in shuffled.gaps})
    for gap in shuffled.gaps:
        words = [c.description for c in gap.candidates]
        assert len(set(words)) == len(words)


@settings(deadline=None, max_examples=40)
@given(OBJECTS, st.integers(1, 19), st.integers(1, 12))
def test_ids_stay_when_something_unrelated_is_added(rows: list[tuple[str, str, str, int, int]], x: int, y: int) -> None:
    objects = [
        thing(f"{label}-{i}", label, (a, b, 0.2), colour=colour, size=size)
        for i, (label, colour, size, a, b) in enumerate(rows)
    ]
    before = find_gaps(world(objects, [smoke("smoke-1", 0)], [room("room-1", 6.0)]), MEDICINE, start_m=START_M)
    more = [thing("aaa", "ladder", (x, y, 1.0), colour="yellow"), *objects]
    after = find_gaps(
        world(more, [smoke("smoke-0", 200), smoke("smoke-1", 0)], [room("room-1", 6.0)]), MEDICINE, start_m=START_M
    )
    assert [stop.id for stop in after.stops] == [stop.id for stop in before.stops]
    assert {gap.id for gap in after.gaps} - {"obstacle:smoke-0"} == {gap.id for gap in before.gaps}
    kept = {gap.id: gap for gap in after.gaps}
    for gap in before.gaps:
        assert kept[gap.id].values == gap.values


def test_clouds_called_alike_are_told_apart_by_where_they_are():
    clouds = [
        KnowledgeGap(
            id=f"obstacle:s{i}",
            kind=GapKind.OBSTACLE,
            subject=f"s{i}",
            description="the smoke",
            values=(PASSABLE, BLOCKED),
            prior=(0.5, 0.5),
            position_m=place,
        )
        for i, place in enumerate([(5.0, 2.0, 1.0), (5.2, 2.1, 1.0), (1.0, 2.0, 1.0), (1.0, -3.0, 1.0)])
    ]
    words = [gap.description for gap in told_apart(clouds, (1.0, 2.0, 1.0))]
    assert len(set(words)) == 4
    assert words[2] == "the smoke at the map's south-west corner"
    assert words[3] == "the smoke 5 m south of the map's south-west corner"
    assert told_apart(clouds[:1], (0.0, 0.0, 0.0)) == clouds[:1]
