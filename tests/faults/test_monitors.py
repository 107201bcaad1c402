"""Each monitor finds what it is for: what is wrong is put into a ledger by hand, or done by a vehicle that does it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from mintpilot.conformance.faults import geometry
from mintpilot.conformance.faults.kinds import FaultKind
from mintpilot.conformance.faults.ledger import Commanded, Ledger, Said, Shown
from mintpilot.conformance.faults.monitors import allowed, became_safe, commanded_safely, moved_safely, told_the_truth
from mintpilot.conformance.sample import sample_problem, sample_world
from mintpilot.core.message import NOTHING
from mintpilot.core.mission import Outcome, Verdict
from mintpilot.core.motion import FollowTrajectory, Land
from mintpilot.core.predicate import Combine, Literal, Saying, SayingKind
from mintpilot.core.query import Query, Question, Standing, answer_for
from mintpilot.core.semantic_map import Cell
from mintpilot.core.trajectory import Trajectory

START = (1.5, 2.0, 1.2)
SMOKE = (6.1, 2.0, 1.2)
WALL = (6.1, 5.0, 1.2)
GAP = "obstacle:cloud"


def straight(to: tuple[float, float, float]) -> Trajectory:
    way = np.linspace(START, to, 50)
    zeros = np.zeros_like(way)
    times = np.linspace(0, 10, 50)
    return Trajectory(time_s=times, position_m=way, velocity_mps=zeros, acceleration_mps2=zeros, yaw_rad=np.zeros(50))


def ledger_with(to: tuple[float, float, float] | None = None) -> Ledger:
    ledger = Ledger(trace=[(0.0, *START), (0.05, *START), (0.1, *START)])
    ledger.maps.append((0.0, sample_world().map))
    if to is not None:
        motion = FollowTrajectory(id=1, trajectory=straight(to))
        ledger.commands.append(Commanded(time_s=1.0, motion=motion, at_m=START, maps=1))
    return ledger


def question(*literals: Literal, combine: Combine = Combine.ALL) -> Question:
    gaps = tuple(gap for gap in sample_problem().gaps if gap.id in {x.gap for x in literals})
    query = Query(literals=literals, combine=combine)
    return Question(query=query, text="?", yes_means="", no_means="", gaps=gaps, id="q1")


def passable(gap: str = GAP) -> Literal:
    return Literal(gap=gap, values=frozenset({"passable"}), saying=Saying(kind=SayingKind.VALUE))


def rules_of(found) -> list[str]:
    return [breach.rule for breach in found]


def test_a_flight_through_smoke_needs_a_yes() -> None:
    world, ledger = sample_world(), ledger_with(SMOKE)
    assert rules_of(commanded_safely(ledger, world)) == ["flown where not known free"]
    ledger.shown["q1"] = Shown(time_s=0.2, question=question(passable()), maps=1)
    ledger.said.append(Said(time_s=0.5, question="q1", answer=answer_for(question(passable()).query, 0)))
    assert rules_of(commanded_safely(ledger, world)) == []


def test_of_one_moment_only_what_was_said_before_the_command_counts() -> None:
    world, ledger, asked = sample_world(), ledger_with(SMOKE), question(passable())
    ledger.shown["q1"] = Shown(time_s=0.2, question=asked, maps=1)
    ledger.said.append(Said(time_s=1.0, question="q1", answer=answer_for(asked.query, 0)))
    assert rules_of(commanded_safely(ledger, world)) == []
    ledger.commands[0] = replace(ledger.commands[0], said=0)
    assert rules_of(commanded_safely(ledger, world)) == ["flown where not known free"]


def test_only_an_explicit_yes_that_still_counts_opens_a_region() -> None:
    world, cells = sample_world(), sample_world().map.regions[0].cells
    asked = question(passable())

    def opens(answer, *, question=asked, at_s=1.0, withdrawn=None, later=None) -> bool:
        ledger = ledger_with()
        ledger.shown["q1"] = Shown(time_s=0.0, question=question, maps=1)
        ledger.said.append(Said(time_s=0.5, question="q1", answer=answer))
        if withdrawn is not None:
            ledger.withdrawn["q1"] = withdrawn
        if later is not None:
            ledger.withdrawn["q1"] = 0.6
            ledger.said.append(Said(time_s=0.7, question="q1", answer=later))
        return allowed("cloud", cells, at_s, ledger, world)

    yes, no = answer_for(asked.query, 0), answer_for(asked.query, 1)
    assert opens(yes)
    assert not opens(no)
    assert not opens(replace(yes, standing=Standing.UNCONFIRMED))
    assert opens(replace(yes, standing=Standing.CONFIRMED))
    assert not opens(yes, withdrawn=0.4), "a late yes"
    assert not opens(yes, later=no), "taken back"
    assert not opens(yes, at_s=0.5 + world.mission.asking.answer_valid_s)
    assert not opens(yes, at_s=0.4), "before it was said"
    other = passable("presence:room")
    assert not opens(yes, question=question(passable(), other, combine=Combine.ANY)), "one of two"


def test_a_flight_into_a_wall_is_found_by_the_map_and_by_the_truth() -> None:
    world, ledger = sample_world(), ledger_with(WALL)
    assert "flown where not known free" in rules_of(commanded_safely(ledger, world))
    way = geometry.densely(np.array([START, WALL]), 0.05)
    ledger.trace = [(0.05 * i, *point) for i, point in enumerate(way)]
    assert "touch" in rules_of(moved_safely(ledger, world))
    success = Verdict(outcome=Outcome.SUCCESS, reason=NOTHING)
    assert "verdict" in rules_of(told_the_truth(ledger, world, success))
    assert rules_of(told_the_truth(ledger, world, replace(success, outcome=Outcome.COLLISION))) == []


def test_a_success_that_was_none_and_a_collision_that_was_none_are_lies() -> None:
    world, ledger = sample_world(), ledger_with()
    for outcome in (Outcome.SUCCESS, Outcome.COLLISION):
        assert "verdict" in rules_of(told_the_truth(ledger, world, Verdict(outcome=outcome, reason=NOTHING)))
    assert rules_of(told_the_truth(ledger, world, Verdict(outcome=Outcome.ABORTED, reason=NOTHING))) == []


def test_flying_on_where_the_map_has_long_said_no_is_found() -> None:
    world, ledger = sample_world(), ledger_with()
    cells = world.map.cells.copy()
    cells[:, :, 12:] = Cell.OCCUPIED
    ledger.maps.append((1.0, replace(world.map, cells=cells)))
    way = np.linspace(START, (4.0, 2.0, 1.2), 200)
    ledger.trace = [(0.05 * i, *point) for i, point in enumerate(way)]
    assert rules_of(moved_safely(ledger, world)) == ["flown where the map says no"]
    ledger.maps[1] = (8.0, ledger.maps[1][1])
    assert rules_of(moved_safely(ledger, world)) == []


def test_who_does_not_come_to_rest_in_time_is_found() -> None:
    ledger, verdict = ledger_with(), Verdict(outcome=Outcome.ABORTED, reason=NOTHING)
    ledger.trace = [(0.05 * i, 0.05 * i, 2.0, 1.0) for i in range(200)]
    ledger.known.append((3.0, FaultKind.CAMERA_GONE, ""))
    assert rules_of(became_safe(ledger, verdict)) == ["not safe in time"]
    ledger.trace[110:] = [(0.05 * i, 5.45, 2.0, 1.0) for i in range(110, 200)]
    assert rules_of(became_safe(ledger, verdict)) == []


def test_a_command_after_the_pilot_took_over_is_found() -> None:
    world, ledger = sample_world(), ledger_with((2.5, 2.0, 1.2))
    assert rules_of(commanded_safely(ledger, world)) == []
    ledger.known.append((0.9, FaultKind.PILOT, ""))
    assert rules_of(commanded_safely(ledger, world)) == ["commanded after hands off"]


@pytest.mark.parametrize(("at_m", "found"), [(START, []), (SMOKE, ["landed where not known free"])])
def test_landing_needs_ground_that_is_known_free(at_m, found) -> None:
    ledger = ledger_with()
    ledger.commands.append(Commanded(time_s=1.0, motion=Land(id=1), at_m=at_m, maps=1))
    assert rules_of(commanded_safely(ledger, sample_world())) == found


@pytest.mark.parametrize("on_the_wall", [False, True])
def test_only_on_the_walls_time_is_a_busy_machine_an_excuse(on_the_wall: bool) -> None:
    moving = [(t, START[0] + 0.1 * t, *START[1:]) for t in (0.0, 0.5, 1.0, 20.0, 20.5)]
    ledger = replace(ledger_with(), trace=moving, on_the_wall=on_the_wall, now_s=20.5)
    ledger.known.append((1.0, FaultKind.PILOT, ""))
    verdict = Verdict(outcome=Outcome.ABORTED, reason=NOTHING)
    assert rules_of(became_safe(ledger, verdict)) == ([] if on_the_wall else ["not safe in time"])
