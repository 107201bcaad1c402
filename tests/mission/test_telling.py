"""What operators tell of their own accord: what it opens, what it closes, and that undoing it restores."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.mission.scenes import hall

from mintpilot.assembly.api import run_mission
from mintpilot.assembly.components import Choices, deliberation_parts
from mintpilot.assembly.replaying import verify_run
from mintpilot.conformance.sample import sample_world
from mintpilot.core.digest import digest
from mintpilot.core.errors import InputError
from mintpilot.core.events import Event, FactsChanged, LegFlown
from mintpilot.core.geometry import GridFrame
from mintpilot.core.inputs import (
    DeliberationEnded,
    FactConfirmed,
    FactTold,
    FactUndone,
    MapObserved,
    MissionBegun,
    MotionEnded,
    OperatorInput,
    Ticked,
)
from mintpilot.core.mission import Outcome
from mintpilot.core.motion import MotionEnd
from mintpilot.core.query import Question
from mintpilot.core.semantic_map import Knowledge
from mintpilot.core.told import Fact, KeepOut, RegionBlocked, RegionPassable, RoomSearched, Standing, ThisOne
from mintpilot.core.trajectory import VehicleState
from mintpilot.mapping.drawn import drawn_cells
from mintpilot.mission.belief_state import BeliefState
from mintpilot.mission.deliberation import DeliberationParts
from mintpilot.mission.directives import Brake, Deliberate, Directive, Move, Observe, WithdrawQuestion
from mintpilot.mission.state import READ_BACK_S, MissionState, Setup
from mintpilot.mission.step import initial_state, step
from mintpilot.mission.telling import MOST_TOLD
from mintpilot.mission.worker import worked_out


@cache
def parts() -> DeliberationParts:
    world = sample_world()
    return deliberation_parts(replace(world, mission=replace(world.mission, survey=None)), Choices())


@cache
def asking() -> MissionState:
    """The sample mission, undisturbed until its first question."""
    scene = Scene(initial_state(Setup(mission=parts().mission), vehicle()))
    waiting = list(scene.feed(MissionBegun(time_s=0.0, vehicle=vehicle())))
    while scene.state.question is None:
        waiting += scene.feed(Ticked(time_s=0.0, vehicle=vehicle()))
        match waiting.pop(0):
            case Move(motion=motion):
                ended = MotionEnded(time_s=0.0, motion=motion.id, end=MotionEnd.ARRIVED, vehicle=vehicle())
                waiting += scene.feed(ended)
            case Observe():
                waiting += scene.feed(MapObserved(time_s=0.0, map=sample_world().map))
            case Deliberate(request=request):
                waiting += scene.feed(worked_out(parts(), request, 0.0))
            case _:
                pass
    return scene.state


def vehicle() -> VehicleState:
    return VehicleState(
        time_s=0.0,
        position_m=sample_world().mission.start_m,
        velocity_mps=(0.0, 0.0, 0.0),
        yaw_rad=0.0,
        endurance_left_s=300.0,
    )


@dataclass
class Scene:
    """A mission that is told things."""

    state: MissionState = field(default_factory=asking)
    time_s: float = 0.0

    def feed(self, event: object) -> tuple[Directive, ...]:
        self.state, directives = step(self.state, event)  # type: ignore[arg-type]
        return directives

    def tell(self, fact: Fact) -> tuple[Directive, ...]:
        return self.feed(FactTold(time_s=self.time_s, fact=fact, operator="somebody"))

    @property
    def last(self) -> str:
        return self.state.told[-1].known.id

    @property
    def standing(self) -> Standing:
        return self.state.told[-1].known.standing

    @property
    def beliefs(self) -> BeliefState:
        assert self.state.beliefs is not None
        return self.state.beliefs


SQUARE = KeepOut(corners_m=((8.0, 5.0), (9.0, 5.0), (9.0, 6.0), (8.0, 6.0)))
AT_ONCE = [SQUARE, RegionBlocked(region="cloud")]
READ_BACK = [RegionPassable(region="cloud"), RoomSearched(room="room"), ThisOne(thing="red")]


@pytest.mark.parametrize("fact", AT_ONCE)
def test_what_adds_caution_counts_at_once_and_is_thought_of(fact: Fact) -> None:
    scene = Scene()
    directives = scene.tell(fact)
    assert scene.standing is Standing.COUNTS
    kinds = [type(directive) for directive in directives]
    assert WithdrawQuestion in kinds
    assert Deliberate in kinds
    blocked = {region.id for region in scene.beliefs.map.regions if region.passable is Knowledge.NO}
    assert blocked == ({"cloud"} if isinstance(fact, RegionBlocked) else {scene.last})


def test_whoever_tells_without_end_uses_up_no_caution() -> None:
    scene = Scene()
    for _ in range(MOST_TOLD):
        scene.tell(RegionPassable(region="there is none"))
    scene.tell(RegionPassable(region="cloud"))
    assert len(scene.state.told) == MOST_TOLD, "it is not even kept"
    scene.tell(RegionBlocked(region="cloud"))
    assert scene.standing is Standing.COUNTS
    assert next(r for r in scene.beliefs.map.regions if r.id == "cloud").passable is Knowledge.NO


@pytest.mark.parametrize("fact", READ_BACK)
def test_what_takes_caution_away_is_read_back_and_counts_once_confirmed(fact: Fact) -> None:
    scene = Scene()
    before = digest(scene.beliefs)
    directives = scene.tell(fact)
    assert scene.standing is Standing.READ_BACK
    assert digest(scene.beliefs) == before
    assert not any(isinstance(directive, WithdrawQuestion) for directive in directives)
    scene.feed(FactConfirmed(time_s=1.0, told=scene.last, operator="somebody"))
    assert scene.standing is Standing.COUNTS
    assert digest(scene.beliefs) != before
    if isinstance(fact, RegionPassable):
        assert "obstacle:cloud" in scene.beliefs.confirmed
        assert [grant.gap for grant in scene.beliefs.grants] == ["obstacle:cloud"]


def test_a_confirmed_region_is_flown_through_after_a_deliberation() -> None:
    scene = Scene()
    scene.tell(RegionPassable(region="cloud"))
    directives = scene.feed(FactConfirmed(time_s=1.0, told=scene.last))
    request = next(d.request for d in directives if isinstance(d, Deliberate))
    ended = worked_out(parts(), request, 1.0)
    scene.feed(ended)
    assert isinstance(ended, DeliberationEnded)
    assert {r.id: r.passable for r in scene.beliefs.map.regions}["cloud"] is Knowledge.YES


@given(
    fact=st.sampled_from([*AT_ONCE, *READ_BACK]),
    others=st.lists(st.sampled_from([*AT_ONCE, *READ_BACK]), max_size=3, unique=True),
    looks=st.integers(0, 2),
)
@settings(max_examples=60, deadline=None)
def test_undoing_restores_exactly_what_was(fact: Fact, others: list[Fact], looks: int) -> None:
    """In a stack: what was told last is undone first."""
    scene = Scene()
    marks: list[tuple[str, str]] = []
    for one in [*(o for o in others if o != fact), fact]:
        marks.append((digest(scene.beliefs), one.__class__.__name__))
        scene.tell(one)
        scene.feed(FactConfirmed(time_s=0.0, told=scene.last))
    for _ in range(looks):
        scene.feed(MapObserved(time_s=0.0, map=scene.beliefs.map))
    for (before, name), telling in zip(reversed(marks), reversed(scene.state.told), strict=True):
        if telling.known.standing is Standing.REFUSED:
            assert digest(scene.beliefs) == before
            continue
        with_it = digest(scene.beliefs)
        scene.feed(FactUndone(time_s=0.0, told=telling.known.id))
        if isinstance(telling.known.fact, KeepOut | RegionBlocked):
            assert digest(scene.beliefs) == with_it, "caution is taken away by a confirmed act only"
            scene.feed(FactConfirmed(time_s=0.0, told=telling.known.id))
        assert digest(scene.beliefs) == before, name


@pytest.mark.parametrize("fact", AT_ONCE)
@pytest.mark.parametrize("ends", ["denied", "not in time", "confirmed"])
def test_taking_caution_back_is_read_back(fact: Fact, ends: str) -> None:
    scene = Scene()
    before = digest(scene.beliefs)
    scene.tell(fact)
    told, with_it = scene.last, digest(scene.beliefs)
    directives = scene.feed(FactUndone(time_s=40.0, told=told, operator="somebody"))
    assert scene.standing is Standing.UNDO_READ_BACK
    assert not any(isinstance(one, WithdrawQuestion | Deliberate | Brake) for one in directives)
    scene.feed(MapObserved(time_s=40.0, map=sample_world().map))
    assert {r.id for r in scene.beliefs.map.regions if r.passable is Knowledge.NO} <= {"cloud", told}
    end = {
        "denied": FactUndone(time_s=41.0, told=told, operator="another"),
        "not in time": Ticked(time_s=40.0 + READ_BACK_S),
        "confirmed": FactConfirmed(time_s=41.0, told=told, operator="another"),
    }[ends]
    assert scene.state.next_deadline_s() <= 40.0 + READ_BACK_S
    scene.feed(end)
    assert scene.standing is (Standing.UNDONE if ends == "confirmed" else Standing.COUNTS)
    if isinstance(fact, KeepOut):
        assert digest(scene.beliefs) == (before if ends == "confirmed" else with_it)
    scene.feed(FactConfirmed(time_s=80.0, told=told))
    assert scene.standing is (Standing.UNDONE if ends == "confirmed" else Standing.COUNTS), "late is never"


def test_what_is_drawn_before_the_first_map_is_not_taken_back_by_one_click() -> None:
    scene = Scene(initial_state(Setup(mission=parts().mission), vehicle()))
    scene.tell(SQUARE)
    scene.feed(FactUndone(time_s=0.0, told=scene.last))
    scene.feed(MapObserved(time_s=0.0, map=sample_world().map))
    assert [r.passable for r in scene.beliefs.map.regions if r.id == scene.last] == [Knowledge.NO]
    scene.feed(FactConfirmed(time_s=1.0, told=scene.last))
    assert scene.standing is Standing.UNDONE
    assert not [r for r in scene.beliefs.map.regions if r.id == scene.last]


def test_a_read_back_is_confirmed_in_time_or_not_at_all() -> None:
    scene = Scene()
    scene.tell(READ_BACK[0])
    scene.feed(Ticked(time_s=READ_BACK_S + 0.1))
    assert scene.standing is Standing.UNDONE
    scene.feed(FactConfirmed(time_s=READ_BACK_S + 0.2, told=scene.last))
    assert not scene.beliefs.confirmed


def test_what_is_permitted_already_is_read_back_all_the_same() -> None:
    """Said again, a yes would count longer."""
    scene = Scene()
    for _ in range(2):
        before = scene.beliefs
        scene.tell(READ_BACK[0])
        assert scene.standing is Standing.READ_BACK
        assert (scene.beliefs.belief, scene.beliefs.grants) == (before.belief, before.grants)
        scene.feed(FactConfirmed(time_s=0.0, told=scene.last))


def test_a_yes_gets_old_and_says_so() -> None:
    scene = Scene()
    scene.tell(READ_BACK[0])
    scene.feed(FactConfirmed(time_s=0.0, told=scene.last))
    scene.feed(Ticked(time_s=scene.state.setup.mission.asking.answer_valid_s))
    assert scene.standing is Standing.LAPSED
    assert not scene.beliefs.confirmed


@pytest.mark.parametrize("fact", [RegionPassable(region="x"), RoomSearched(room="x"), ThisOne(thing="hurt")])
def test_what_is_not_known_is_refused(fact: Fact) -> None:
    scene = Scene()
    scene.tell(fact)
    assert scene.standing is Standing.REFUSED
    assert scene.state.told[-1].known.why


def test_who_said_no_is_not_overruled_by_a_click() -> None:
    scene = Scene()
    scene.tell(RegionBlocked(region="cloud"))
    scene.tell(RegionPassable(region="cloud"))
    assert scene.standing is Standing.REFUSED


def test_a_drawn_region_needs_an_outline() -> None:
    with pytest.raises(InputError, match="corners"):
        KeepOut(corners_m=((0.0, 0.0), (1.0, 1.0)))
    with pytest.raises(InputError, match="no number"):
        KeepOut(corners_m=((0.0, 0.0), (1.0, float("nan")), (0.0, 1.0)))


PLACES = st.tuples(st.floats(-1.0, 5.0), st.floats(-1.0, 4.0))


@given(corners=st.lists(PLACES, min_size=3, max_size=3), seed=st.integers(0, 999))
@settings(deadline=None)
def test_drawn_cells_hold_all_of_a_triangle_and_nothing_far_from_it(
    corners: list[tuple[float, float]], seed: int
) -> None:
    frame = GridFrame(origin_m=(0.0, 0.0, 0.0), resolution_m=0.5, shape=(2, 6, 8))
    cells = set(drawn_cells(frame, corners).tolist())
    a, b, c = (np.asarray(corner) for corner in corners)
    for first, second in np.random.default_rng(seed).random((200, 2)):
        u, v = (first, second) if first + second <= 1 else (1 - first, 1 - second)
        x, y = a + u * (b - a) + v * (c - a)
        if 0 <= x < 4.0 and 0 <= y < 3.0:
            assert int(y / 0.5) * 8 + int(x / 0.5) in cells
    lo, hi = np.min([a, b, c], axis=0) - 0.5, np.max([a, b, c], axis=0) + 0.5
    for flat in cells:
        y, x = divmod(flat % 48, 8)
        assert lo[0] - 1e-9 <= x * 0.5 + 0.25 <= hi[0] + 1e-9
        assert lo[1] - 1e-9 <= y * 0.5 + 0.25 <= hi[1] + 1e-9


class Tells:
    """Tells things at given times, confirms whatever is read back, and answers nothing."""

    attended, hears_once = False, True

    def __init__(self, facts: list[tuple[float, Callable[[list[str]], OperatorInput]]]) -> None:
        self.facts, self.known = list(facts), []

    def show(self, question: Question, patience_s: float) -> None: ...

    def withdraw(self, question: str, why: str) -> None: ...

    def tell(self, text: str) -> None: ...

    def poll(self, time_s: float) -> tuple[OperatorInput, ...]:
        due = [make for at_s, make in self.facts if time_s >= at_s]
        self.facts = self.facts[len(due) :]
        return tuple(replace(make(self.known), time_s=time_s) for make in due)


@pytest.mark.long
def test_a_drawn_region_is_not_entered_afterwards_and_the_flight_replays(tmp_path: Path) -> None:
    """Drawn across the way that is being flown, beside the one that is left; then a second one."""
    drawn = [
        (5.0, KeepOut(corners_m=((8.0, 0.0), (9.0, 0.0), (9.0, 5.6), (8.0, 5.6)))),
        (8.0, KeepOut(corners_m=((9.8, 3.0), (10.6, 3.0), (10.6, 4.5), (9.8, 4.5)))),
    ]
    operator = Tells(
        [(at_s, lambda _, fact=fact: FactTold(time_s=0.0, fact=fact, operator="me")) for at_s, fact in drawn]
    )
    events: list[Event] = []

    def note(event: Event) -> None:
        events.append(event)

    record = run_mission(
        hall(asking={"patience_s": 2.0}), operator=operator, vehicle="kinematic", progress=note, out=tmp_path / "run"
    )
    assert record.outcome is Outcome.SUCCESS
    told = [event for event in events if isinstance(event, FactsChanged)]
    assert [known.operator for known in told[-1].told] == ["me", "me"]
    flights = [event.log for event in events if isinstance(event, LegFlown)]
    radius_m = 0.2
    for at_s, fact in drawn:
        (left, low), (right, high) = fact.corners_m[0], fact.corners_m[2]
        for log in flights:
            later = log.position_m[log.time_s >= at_s + 1.5]
            away = np.hypot(
                np.maximum(np.maximum(left - later[:, 0], later[:, 0] - right), 0),
                np.maximum(np.maximum(low - later[:, 1], later[:, 1] - high), 0),
            )
            assert not len(away) or away.min() >= radius_m
    assert any(notice.kind == "told" for notice in record.notices)
    done = verify_run(tmp_path / "run")
    assert done.verification.difference is None
