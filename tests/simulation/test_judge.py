"""Verdicts, one rule at a time."""

from __future__ import annotations

import numpy as np
import pytest

from mintpilot.core.mission import Outcome
from mintpilot.core.task import Action
from mintpilot.simulation.judge import SceneJudge
from mintpilot.simulation.scene import FlightRules, Person

from .flights import START, block, room, scene, smoke, stop

RED = block((4, 2, 0), (4.5, 2.5, 0.5), "box-red", "box")
BLUE = block((4, 4, 0), (4.5, 4.5, 0.5), "box-blue", "box")
RACK = block((3, 2.9, 0), (5, 3.3, 2), "rack-1", "rack")
NEAR_RED, NEAR_BLUE = (3.6, 2.2, 1.2), (3.6, 4.2, 1.2)


def positions(*points: tuple[float, float, float]) -> np.ndarray:
    return np.asarray(points, float)


def test_an_uneventful_flight_is_a_success() -> None:
    judge = SceneJudge(scene(), FlightRules())
    assert judge.observe(np.array([0.0, 1.0]), positions(START, (3, 2, 1.5))) is None
    assert judge.verdict() is None
    assert judge.final().outcome is Outcome.SUCCESS


@pytest.mark.parametrize(("toxic", "outcome"), [(True, Outcome.TOXIC_SMOKE), (False, Outcome.SUCCESS)])
def test_smoke_counts_only_when_toxic(toxic: bool, outcome: Outcome) -> None:
    judge = SceneJudge(scene(smokes=(smoke(toxic=toxic),)), FlightRules())
    assert judge.observe(np.arange(3.0), positions(START, (4.72, 2, 1), (4.74, 2, 1))) == (2 if toxic else None)
    assert judge.final().outcome is outcome


def test_leaving_the_volume_fails() -> None:
    judge = SceneJudge(scene(), FlightRules())
    assert judge.observe(np.arange(2.0), positions(START, (2, 2, 3.6))) == 1
    assert judge.final().outcome is Outcome.LEFT_VOLUME


def test_endurance_counts_from_the_mission_not_from_the_survey() -> None:
    judge = SceneJudge(scene(), FlightRules(endurance_s=10.0))
    assert judge.observe(np.array([0.0, 100.0]), positions(START, START)) is None
    assert judge.endurance_left_s(100.0) == 10.0
    judge.begin_mission(100.0)
    assert judge.endurance_left_s(104.0) == 6.0
    assert judge.observe(np.array([109.0, 110.0, 110.5]), positions(START, START, START)) == 2
    assert judge.endurance_left_s(120.0) == 0.0
    assert judge.final().outcome is Outcome.ENDURANCE


def test_the_first_failure_stays() -> None:
    judge = SceneJudge(scene(smokes=(smoke(toxic=True),)), FlightRules())
    judge.touched("'crate-1'")
    judge.observe(np.array([1.0]), positions((6, 2, 1)))
    assert judge.verdict() is not None
    assert judge.final().outcome is Outcome.COLLISION
    assert "crate-1" in str(judge.final().reason)


def boxes(*goals: str) -> SceneJudge:
    return SceneJudge(scene(solids=(RED, BLUE, RACK), goal_objects=goals), FlightRules())


def test_picking_what_was_meant_succeeds_beside_a_nearer_rack() -> None:
    judge = boxes("box-red")
    assert judge.final().outcome is Outcome.NOT_REACHED
    judge.acted(stop(Action.PICK, (4.2, 2.3, 0.4)), (3.6, 2.6, 1.2))
    assert judge.final().outcome is Outcome.SUCCESS


def test_picking_another_one_fails() -> None:
    judge = boxes("box-red")
    judge.acted(stop(Action.PICK, BLUE.extent_m.centre_m), NEAR_BLUE)
    assert judge.final().outcome is Outcome.WRONG_TARGET
    assert "'box-blue'" in str(judge.final().reason)


def test_order_matters() -> None:
    judge = boxes("box-red", "box-blue")
    judge.acted(stop(Action.PICK, RED.extent_m.centre_m), NEAR_RED)
    assert judge.final().outcome is Outcome.NOT_REACHED
    judge.acted(stop(Action.PICK, BLUE.extent_m.centre_m), NEAR_BLUE)
    assert judge.final().outcome is Outcome.SUCCESS
    swapped = boxes("box-red", "box-blue")
    swapped.acted(stop(Action.PICK, BLUE.extent_m.centre_m), NEAR_BLUE)
    assert swapped.final().outcome is Outcome.WRONG_TARGET


def test_picking_from_too_far_away_fails() -> None:
    judge = boxes("box-red")
    judge.acted(stop(Action.PICK, RED.extent_m.centre_m), (1.0, 2.2, 1.2))
    assert judge.final().outcome is Outcome.WRONG_TARGET
    assert "farther than 2 m" in str(judge.final().reason)


def test_with_several_sites_the_nearest_to_the_drone_is_reached_for() -> None:
    judge = boxes("box-red")
    judge.acted(stop(Action.PICK, BLUE.extent_m.centre_m, RED.extent_m.centre_m), NEAR_RED)
    assert judge.final().outcome is Outcome.SUCCESS


def test_going_to_the_object_meant_counts_and_passing_others_does_not_fail() -> None:
    judge = boxes("box-red")
    judge.acted(stop(Action.GO, BLUE.extent_m.centre_m), NEAR_BLUE)
    assert judge.final().outcome is Outcome.NOT_REACHED
    judge.acted(stop(Action.GO, RED.extent_m.centre_m), NEAR_RED)
    assert judge.final().outcome is Outcome.SUCCESS


def test_people_in_the_open_must_be_hovered_near() -> None:
    judge = SceneJudge(scene(persons=(Person(id="person-1", position_m=(8, 2, 0)),)), FlightRules())
    judge.observe(np.array([1.0]), positions((8, 2, 1.2)))
    assert judge.final().outcome is Outcome.PERSON_MISSED, "flying past is not enough"
    judge.hovered((8, 4.5, 1.2))
    assert judge.final().outcome is Outcome.PERSON_MISSED, "too far"
    judge.hovered((8, 3.2, 1.2))
    assert judge.final().outcome is Outcome.SUCCESS


def test_people_in_rooms_must_be_looked_at_from_the_viewpoint() -> None:
    inside = Person(id="person-1", position_m=(10.5, 6.5, 0))
    judge = SceneJudge(scene(rooms=(room(inside),)), FlightRules())
    look = stop(Action.LOOK, (10.45, 3.8, 1.5))
    judge.acted(look, (10.45, 2.0, 1.5))
    assert judge.final().outcome is Outcome.PERSON_MISSED
    judge.acted(stop(Action.GO, (10.45, 3.8, 1.5)), (10.45, 3.8, 1.5))
    assert judge.final().outcome is Outcome.PERSON_MISSED
    judge.acted(look, (10.45, 3.5, 1.5))
    assert judge.final().outcome is Outcome.SUCCESS


def test_nobody_needs_to_find_people_who_are_well() -> None:
    well = Person(id="person-1", position_m=(8, 2, 0), must_be_found=False)
    assert SceneJudge(scene(persons=(well,)), FlightRules()).final().outcome is Outcome.SUCCESS


@pytest.mark.parametrize(
    ("place", "inside"),
    [
        ((4.74, 4, 1), True),
        ((4.72, 4, 1), False),
        ((6, 4, 3.05), True),
        ((6, 4, 3.07), False),
        ((4.8, 4, 3.05), True),
        ((6, 4, 1), True),
    ],
)
def test_toxic_smoke_is_touched_by_the_hull_not_by_its_centre(place, inside: bool) -> None:
    """The cloud reaches from x = 5 to 7 and up to z = 3; the hull is 0.27 m in radius and 0.06 m in half height."""
    judge = SceneJudge(scene(smokes=(smoke(toxic=True),)), FlightRules())
    judge.observe(np.zeros(1), positions(place))
    assert (judge.verdict() is not None) == inside
