"""What is left undone and why: exclusive stops, seen before supposed, deliveries, prices, many stops, the way home."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from mintpilot.core.errors import MissionError
from mintpilot.core.gap import ABSENT, PRESENT, Assumptions, GapKind, KnowledgeGap
from mintpilot.core.geometry import GridFrame
from mintpilot.core.plan import Plan, PlanningProblem, Shortage, Site, Stop, VehicleLimits
from mintpilot.core.semantic_map import Cell, SemanticMap
from mintpilot.core.task import Action
from mintpilot.planning.task_planner import GridPlanner

LIMITS = VehicleLimits(radius_m=0.01, margin_m=0.0, cruise_mps=1.0)
ROOM = KnowledgeGap(
    id="presence:room",
    kind=GapKind.PRESENCE,
    subject="room",
    description="the room",
    values=(PRESENT, ABSENT),
    prior=(0.5, 0.5),
    position_m=(0, 0, 0),
)


def at(name: str, x: float, *, action: Action = Action.GO, price_s: float = 600.0) -> Stop:
    """A stop in a corridor of 41 cells of a metre, the start being in the middle, x = 20.5 m."""
    site = Site(position_m=(x, 0.5, 0.5), reach_m=0.1)
    return Stop(id=name, action=action, sites=(site,), dwell_s=0.0, price_s=price_s)


def room(x: float, *, price_s: float = 600.0, chance: float = 1.0) -> Stop:
    stop = at("look", x, action=Action.LOOK, price_s=price_s)
    site = replace(stop.sites[0], value=PRESENT)
    return replace(stop, sites=(site,), gap=ROOM.id, optional=True, chance=chance)


def plan(*stops: Stop, battery_s: float = np.inf, gaps: tuple = (), home: bool = False, reserve_s: float = 0) -> Plan:
    made = _plan(*stops, battery_s=battery_s, gaps=gaps, home=home, reserve_s=reserve_s)
    assert made is not None
    return made


def _plan(*stops: Stop, battery_s: float, gaps: tuple = (), home: bool = False, reserve_s: float = 0) -> Plan | None:
    frame = GridFrame(origin_m=(0, 0, 0), resolution_m=1.0, shape=(1, 1, 41))
    start = (20.5, 0.5, 0.5)
    problem = PlanningProblem(
        map=SemanticMap(frame=frame, cells=np.full(frame.shape, Cell.FREE, np.uint8)),
        start_m=start,
        stops=stops,
        gaps=gaps,
        limits=replace(LIMITS, endurance_s=battery_s, reserve_s=reserve_s),
        home_m=start if home else None,
    )
    return GridPlanner().open(problem).cautious(Assumptions())


def done(made: Plan) -> list[str]:
    return [leg.stop.id for leg in made.legs]


def test_of_stops_that_exclude_each_other_the_dearer_is_done_and_the_other_named_with_figures() -> None:
    made = plan(at("west", 10.5, price_s=100), at("east", 35.5, price_s=200), battery_s=20)
    assert done(made) == ["east"]
    (left,) = made.leaves_undone
    assert (left.stop.id, left.resource, left.needed_s, left.available_s) == ("west", Shortage.BATTERY, 20.0, 5.0)
    assert str(left.reason) == "the way there needs 20 s, the battery gives 5 s"
    assert made.undone_s == 100


def test_where_both_fit_nothing_is_left() -> None:
    made = plan(at("west", 10.5), at("east", 35.5), battery_s=35)
    assert (done(made), made.leaves_undone, made.undone_s) == (["west", "east"], (), 0)


@pytest.mark.parametrize(("price_s", "first"), [(600.0, "seen"), (600.1, "look")])
def test_at_equal_prices_somebody_seen_goes_before_somebody_supposed_though_farther(price_s: float, first: str) -> None:
    made = plan(at("seen", 10.5), room(25.5, price_s=price_s), battery_s=12, gaps=(ROOM,))
    assert done(made) == [first]


def test_somebody_supposed_counts_by_expectation() -> None:
    made = plan(at("seen", 10.5, price_s=400), room(30.5, chance=0.5), battery_s=12, gaps=(ROOM,))
    assert done(made) == ["seen"]
    assert made.stakes == ((ROOM.id, PRESENT, 600.0),)
    assert made.undone_s == 0


def test_a_delivery_is_never_made_without_its_pick() -> None:
    pick, give = at("pick", 10.5, action=Action.PICK), at("give", 21.5, action=Action.DELIVER, price_s=5000)
    made = plan(pick, give, at("other", 25.5), battery_s=9)
    assert done(made) == ["other"]
    assert [one.resource for one in made.leaves_undone] == [Shortage.BATTERY, Shortage.THING]


def test_the_way_home_and_the_reserve_are_kept() -> None:
    far = at("far", 30.5)
    assert _plan(far, battery_s=19.9, home=True) is None
    assert _plan(far, battery_s=20.0, home=True) is not None
    assert _plan(far, battery_s=20.0, home=True, reserve_s=0.1) is None
    assert _plan(far, battery_s=10.0) is not None


def test_what_costs_more_than_leaving_it_undone_is_left_with_its_price() -> None:
    made = plan(at("near", 22.5, price_s=30), at("far", 40.5, price_s=10))
    assert done(made) == ["near"]
    assert [(one.resource, one.needed_s, one.available_s) for one in made.leaves_undone] == [(Shortage.PRICE, 18, 10)]


def test_forty_stops_are_done_as_far_as_the_battery_goes_and_a_note_says_that_the_choice_was_bounded() -> None:
    stops = [at(f"s{i}", i + 0.5) for i in range(40)]
    made = plan(*stops, battery_s=25)
    assert 12 <= len(made.legs) < 40
    assert made.cost_s <= 25
    assert done(made) == sorted(done(made), key=lambda name: int(name[1:]))
    assert len(done(made)) + len(made.leaves_undone) == 40
    everything = plan(*stops)
    assert (len(everything.legs), everything.leaves_undone) == (40, ())


def test_twelve_rooms_are_weighed_exactly() -> None:
    rooms = [replace(room(i + 15.5), id=f"look-{i}", gap="") for i in range(12)]
    made = plan(*rooms, battery_s=11.0)
    pairs = [(west, east) for west in range(6) for east in range(7) if west + east + min(west, east) <= 11]
    assert len(made.legs) == 1 + max(west + east for west, east in pairs)
    assert made.cost_s <= 11


@pytest.mark.parametrize("price_s", [-1.0, float("nan"), float("inf")])
def test_prices_are_finite_and_not_negative(price_s: float) -> None:
    with pytest.raises(MissionError, match="price_s"):
        at("x", 1.5, price_s=price_s)
