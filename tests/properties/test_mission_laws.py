"""The laws of a mission as a state machine: hostile and random event orders against the shipped `step`.

What is checked is checked from outside: by the directives alone, with a judge of flights that shares no code with
planning.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hypothesis import HealthCheck, Phase, note, settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, invariant, precondition, rule

from mintpilot.assembly.briefing import briefing_of
from mintpilot.assembly.components import Choices, deliberation_parts
from mintpilot.conformance.sample import sample_world
from mintpilot.core.digest import digest
from mintpilot.core.inputs import (
    Answered,
    DeliberationEnded,
    FactConfirmed,
    FactTold,
    FactUndone,
    Input,
    Link,
    LinkChanged,
    MapObserved,
    MissionBegun,
    MotionEnded,
    Ordered,
    QuestionReworded,
    QuestionShown,
    Ticked,
)
from mintpilot.core.message import NOTHING, verbatim
from mintpilot.core.mission import Outcome
from mintpilot.core.motion import FollowTrajectory, Land, Motion, MotionEnd
from mintpilot.core.observation import RegionKind
from mintpilot.core.query import Answer, Order, Reply
from mintpilot.core.semantic_map import Cell, Knowledge, Region, SemanticMap
from mintpilot.core.told import KeepOut, RegionBlocked, RegionPassable, RoomSearched, Standing, ThisOne
from mintpilot.core.trajectory import FlightEnd, FlightLog, VehicleState
from mintpilot.mission.directives import (
    Brake,
    Deliberate,
    Directive,
    Finish,
    Move,
    Observe,
    ShowQuestion,
    WithdrawQuestion,
)
from mintpilot.mission.requests import Request
from mintpilot.mission.state import Activity, MissionState, Setup
from mintpilot.mission.step import initial_state, step
from mintpilot.mission.worker import worked_out

BATTERY_S = 300.0
VALID_S = 60.0
"""How long a yes counts here, seconds: some run out while the mission is flown."""
OUTCOMES: Counter[Outcome] = Counter()


@cache
def parts():
    world = sample_world()
    limits = replace(world.mission.limits, endurance_s=BATTERY_S)
    asking = replace(world.mission.asking, answer_valid_s=VALID_S)
    changed = replace(world, mission=replace(world.mission, limits=limits, survey=None, asking=asking))
    return deliberation_parts(changed, Choices())


DECIDED: dict[str, DeliberationEnded] = {}


def decided(request: Request) -> DeliberationEnded:
    """Equal requests give equal decisions: they are worked out once for all examples."""
    key = digest(replace(request, id=0))
    if key not in DECIDED:
        DECIDED[key] = worked_out(parts(), request, 0.0)
    return DECIDED[key]


class Mission(RuleBasedStateMachine):
    """One mission, with everything around it played by the rules below."""

    @initialize(calm=st.sampled_from([False, False, True]), briefed=st.sampled_from([False, False, True]))
    def begin(self, calm: bool, briefed: bool) -> None:
        """A calm mission meets no orders, clouds, refusals and lost links: it gets far."""
        world = sample_world()
        self.calm = calm
        self.map: SemanticMap = world.map
        self.time_s, self.position = 0.0, world.mission.start_m
        self.go = not briefed
        briefing = briefing_of(parts(), self.map) if briefed else None
        self.state: MissionState = initial_state(Setup(mission=parts().mission, briefing=briefing), self.vehicle())
        self.moving: Motion | None = None
        self.braking = False
        self.looks = 0
        self.requests: list[Request] = []
        self.open: list[str] = []
        self.asked: list[str] = []
        self.ended = False
        self.holds = False
        self.clouds = 0
        self.shown: dict[str, dict[str, np.ndarray]] = {}
        self.allowed: dict[str, tuple[np.ndarray, float]] = {}
        self.told: dict[str, tuple[object, dict[str, np.ndarray]]] = {}
        self.feed(MissionBegun(time_s=0.0, vehicle=self.vehicle()))

    def vehicle(self) -> VehicleState:
        return VehicleState(
            time_s=self.time_s,
            position_m=self.position,
            velocity_mps=(0.0, 0.0, 0.0),
            yaw_rad=0.0,
            endurance_left_s=max(BATTERY_S - self.time_s, 0.0),
        )

    def feed(self, event: Input) -> None:
        """One step: the same twice, and its directives looked at from outside."""
        before = self.state
        if isinstance(event, Answered) and before.question is not None and self.open == [event.question]:
            query, part = before.question.question.query, event.answer.part
            for literal in query.asserted(part) if part is not None else ():
                region = literal.gap.partition(":")[2]
                if region in self.shown[event.question]:
                    self.allowed[region] = (self.shown[event.question][region], max(before.clock_s, event.time_s))
        if isinstance(event, Answered) and event.answer.reply is Reply.YES and self.open == [event.question]:
            self.go = True
        self.state, directives = step(before, event)
        again, same = step(before, event)
        assert digest(directives) == digest(same), "equal events give equal directives"
        assert digest(again) == digest(self.state)
        assert self.state.clock_s >= before.clock_s
        if self.ended:
            assert directives == (), "after the end there is nothing to do"
        for directive in directives:
            self.carry_out(directive)

    def carry_out(self, directive: Directive) -> None:
        match directive:
            case Move():
                assert self.go, "nothing moves before an explicit yes to the briefing"
                assert self.moving is None, "a motion replaces another one only at rest"
                assert not self.holds or isinstance(directive.motion, Land), "who holds does not move"
                self.moving, self.braking = directive.motion, False
                if isinstance(directive.motion, FollowTrajectory):
                    self.judge(directive)
            case Brake():
                self.braking = True
            case Observe():
                self.looks += 1
            case Deliberate():
                self.requests.append(directive.request)
            case ShowQuestion():
                name = directive.question.id
                assert not self.open or self.open == [name], "at most one question is open"
                if name not in self.open:
                    assert name not in self.asked, "ids are given once"
                    self.open, self.asked = [name], [*self.asked, name]
                    seen = self.state.beliefs.map.regions if self.state.beliefs is not None else ()
                    self.shown[name] = {r.id: r.cells for r in seen}
            case WithdrawQuestion():
                self.open = [name for name in self.open if name != directive.question]
            case Finish():
                assert not self.ended
                self.ended = True

    def judge(self, move: Move) -> None:
        """Every place that is flown lies in a cell that was seen free, outside every region not known passable."""
        motion = move.motion
        assert isinstance(motion, FollowTrajectory)
        assert self.state.beliefs is not None
        if self.state.activity is Activity.RETREAT:
            return  # back out of a place that was found doubtful only now, along the way it came
        known = self.state.beliefs.map
        open_ = np.zeros(known.cells.size, bool)
        for region in self.map.regions:
            cells, given_s = self.allowed.get(region.id, (np.zeros(0, int), -np.inf))
            covered = np.isin(region.cells, grown(cells, known.cells.shape)).all()
            if not covered or self.state.clock_s >= given_s + VALID_S:
                open_[region.cells] = True
        for region in known.regions:
            if region.passable is not Knowledge.YES:
                open_[region.cells] = True
        radius_m = parts().mission.limits.radius_m
        for x, y, z in motion.trajectory.position_m[::3]:
            for left, low, right, high in self.drawn():
                away = np.hypot(max(left - x, x - right, 0.0), max(low - y, y - high, 0.0))
                assert away >= radius_m, f"({x:.2f}, {y:.2f}) touches a drawn region"
            origin, edge = known.frame.origin_m, known.frame.resolution_m
            cell = tuple(int((p - o) // edge) for p, o in zip((z, y, x), origin[::-1], strict=True))
            flat = np.ravel_multi_index(cell, known.cells.shape)
            assert known.cells[cell] == Cell.FREE, f"{cell} was not seen free"
            assert not open_[flat], f"{cell} lies in a region that is not known to be passable"

    # --- what may happen ------------------------------------------------------------------------------------------

    @rule(seconds=st.floats(0.0, 20.0))
    def time_passes(self, seconds: float) -> None:
        self.time_s += seconds
        self.feed(Ticked(time_s=self.time_s, vehicle=self.vehicle()))

    @precondition(lambda self: self.moving is not None)
    @rule(end=st.sampled_from([MotionEnd.ARRIVED, MotionEnd.ARRIVED, MotionEnd.STOPPED]), share=st.floats(0.1, 0.9))
    def motion_ends(self, end: MotionEnd, share: float) -> None:
        self.finish_motion(end, share)

    def finish_motion(self, end: MotionEnd, share: float = 0.5) -> None:
        motion, log = self.moving, None
        assert motion is not None
        end = MotionEnd.STOPPED if self.braking else end
        if isinstance(motion, FollowTrajectory):
            way = motion.trajectory
            rows = len(way.time_s) if end is MotionEnd.ARRIVED else max(1, int(share * len(way.time_s)))
            flown = way.position_m[:rows]
            x, y, z = (float(v) for v in flown[-1])
            times = self.time_s + way.time_s[:rows]
            self.time_s, self.position = float(times[-1]), (x, y, z)
            ends = FlightEnd.ARRIVED if end is MotionEnd.ARRIVED else FlightEnd.INTERRUPTED
            log = FlightLog(end=ends, time_s=times, position_m=flown.copy(), reference_m=flown.copy())
        self.moving, self.braking = None, False
        vehicle = self.vehicle()
        self.feed(MotionEnded(time_s=self.time_s, motion=motion.id, end=end, vehicle=vehicle, log=log))

    @precondition(lambda self: self.moving is not None and not self.calm)
    @rule()
    def a_motion_is_refused(self) -> None:
        motion, self.moving, self.braking = self.moving, None, False
        assert motion is not None
        refused = MotionEnd.REFUSED
        self.feed(MotionEnded(time_s=self.time_s, motion=motion.id, end=refused, vehicle=self.vehicle(), reason="no"))

    @rule(number=st.integers(0, 400))
    def some_other_motion_ends(self, number: int) -> None:
        if self.moving is None or number != self.moving.id:
            self.feed(MotionEnded(time_s=self.time_s, motion=number, end=MotionEnd.ARRIVED, vehicle=self.vehicle()))

    @precondition(lambda self: self.looks > 0)
    @rule()
    def a_look_comes_back(self) -> None:
        self.looks -= 1
        self.feed(MapObserved(time_s=self.time_s, map=self.believed()))

    def believed(self) -> SemanticMap:
        """The map with what was answered carried over, as map sources do."""
        if self.state.beliefs is None:
            return self.map
        known = {region.id: region.passable for region in self.state.beliefs.map.regions}
        rooms = {room.id: room for room in self.state.beliefs.map.rooms}
        return replace(
            self.map,
            regions=tuple(replace(r, passable=known.get(r.id, r.passable)) for r in self.map.regions),
            rooms=tuple(rooms.get(r.id, r) for r in self.map.rooms),
        )

    @precondition(lambda self: self.state.beliefs is not None and self.clouds < 3 and not self.calm)
    @rule(data=st.data())
    def a_cloud_appears(self, data: st.DataObject) -> None:
        frame = self.map.frame
        centre = data.draw(st.integers(0, frame.size - 1))
        zyx = np.argwhere(self.map.cells == Cell.FREE)
        near = np.linalg.norm(zyx - np.unravel_index(centre, frame.shape), axis=1) <= 3
        cells = np.sort(np.ravel_multi_index(tuple(zyx[near].T), frame.shape))
        if cells.size:
            self.clouds += 1
            cloud = Region(id=f"new-{self.clouds}", kind=RegionKind.SMOKE, cells=cells)
            self.map = replace(self.map, regions=(*self.map.regions, cloud))
            obstruction = data.draw(st.sampled_from([NOTHING, verbatim("a cloud")]))
            self.feed(MapObserved(time_s=self.time_s, map=self.believed(), obstruction=obstruction))

    @precondition(lambda self: self.state.beliefs is not None and not self.calm)
    @rule(voxels=st.integers(1, 3))
    def a_region_grows(self, voxels: int) -> None:
        """All regions of the map; by more than one voxel, what was allowed is open again."""
        regions = list(self.map.regions)
        for i, region in enumerate(regions):
            cells = region.cells
            for _ in range(voxels):
                cells = grown(cells, self.map.cells.shape)
            regions[i] = replace(region, cells=cells)
        self.map = replace(self.map, regions=tuple(regions))
        self.feed(MapObserved(time_s=self.time_s, map=self.believed(), obstruction=verbatim("a cloud has grown")))

    @precondition(lambda self: bool(self.allowed) and not self.ended)
    @rule()
    def an_answer_gets_old(self) -> None:
        self.time_s += VALID_S
        self.feed(Ticked(time_s=self.time_s, vehicle=self.vehicle()))
        assert self.state.beliefs is not None
        assert not entered(self.state.beliefs.map), "an answer counts for a time only"
        assert not self.state.beliefs.confirmed

    @precondition(lambda self: bool(self.requests))
    @rule(data=st.data())
    def a_deliberation_comes_back(self, data: st.DataObject) -> None:
        """In any order, also those that were dropped, early or late."""
        index = data.draw(st.integers(0, len(self.requests) - 1))
        self.deliver(self.requests.pop(index))

    def deliver(self, request: Request) -> None:
        done = decided(request)
        self.feed(replace(done, time_s=self.time_s, request=request.id))

    @precondition(lambda self: bool(self.requests) and not self.calm)
    @rule(data=st.data())
    def a_deliberation_fails(self, data: st.DataObject) -> None:
        request = self.requests.pop(data.draw(st.integers(0, len(self.requests) - 1)))
        self.feed(DeliberationEnded(time_s=self.time_s, request=request.id, decision=None, reason="a fault"))

    @rule(number=st.integers(0, 400), reply=st.sampled_from([Reply.YES, Reply.NO, Reply.UNSURE, Reply.TIMEOUT]))
    def an_answer_to_any_question(self, number: int, reply: Reply) -> None:
        answer = Answer(reply=reply, latency_s=1.0, text=reply.value)
        self.feed(Answered(time_s=self.time_s, question=f"q{number}", answer=answer))

    @precondition(lambda self: bool(self.asked))
    @rule(data=st.data(), reply=st.sampled_from([Reply.YES, Reply.NO]))
    def an_answer(self, data: st.DataObject, reply: Reply) -> None:
        """To the open question, or late, or twice."""
        name = data.draw(st.sampled_from(self.asked))
        open_before = list(self.open)
        before = self.state.beliefs
        self.feed(Answered(time_s=self.time_s, question=name, answer=Answer(reply=reply, latency_s=1.0, text="x")))
        if name not in open_before and before is not None and self.state.beliefs is not None:
            grew = entered(self.state.beliefs.map) - entered(before.map)
            assert not grew, "a late answer never opens anything"
            assert self.state.beliefs.confirmed <= before.confirmed

    @precondition(lambda self: bool(self.open))
    @rule(shown=st.booleans())
    def a_question_is_shown_or_reworded(self, shown: bool) -> None:
        name = self.open[0]
        if shown:
            self.feed(QuestionShown(time_s=self.time_s, question=name))
        else:
            self.feed(QuestionReworded(time_s=self.time_s, question=name, text="Say?", worded_by="a model"))

    def drawn(self) -> list[tuple[float, float, float, float]]:
        """The rectangles that are to be kept out of: left, low, right, high."""
        counts = {one.known.id for one in self.state.told if one.known.counts}
        found = []
        for name, (fact, _) in self.told.items():
            if isinstance(fact, KeepOut) and name in counts:
                (left, low), (right, high) = fact.corners_m[0], fact.corners_m[2]
                found.append((left, low, right, high))
        return found

    @precondition(lambda self: not self.calm)
    @rule(data=st.data())
    def something_is_told(self, data: st.DataObject) -> None:
        names = [*(r.id for r in self.map.regions), "smoke-99"]
        left, low = data.draw(st.floats(0.0, 11.0)), data.draw(st.floats(0.0, 7.0))
        right, high = left + data.draw(st.floats(0.1, 2.0)), low + data.draw(st.floats(0.1, 2.0))
        kinds = {
            "draw": lambda: KeepOut(corners_m=((left, low), (right, low), (right, high), (left, high))),
            "block": lambda: RegionBlocked(region=data.draw(st.sampled_from(names))),
            "pass": lambda: RegionPassable(region=data.draw(st.sampled_from(names))),
            "search": lambda: RoomSearched(room=data.draw(st.sampled_from([*(r.id for r in self.map.rooms), "x"]))),
            "mean": lambda: ThisOne(thing=data.draw(st.sampled_from([*(o.id for o in self.map.objects), "x"]))),
        }
        fact = kinds[data.draw(st.sampled_from(sorted(kinds)))]()
        before = self.state.beliefs
        outlines = {r.id: r.cells for r in before.map.regions} if before is not None else {}
        self.feed(FactTold(time_s=self.time_s, fact=fact, operator="somebody"))
        if len(self.state.told) > len(self.told):
            self.told[self.state.told[-1].known.id] = (fact, outlines)
        if before is not None and self.state.beliefs is not None:
            after = self.state.beliefs
            assert entered(after.map) <= entered(before.map), "what is told never opens a region unconfirmed"
            assert after.confirmed <= before.confirmed
            assert searched(after.map) <= searched(before.map)
            assert after.belief is before.belief, "nothing is learnt before it is confirmed"

    @precondition(lambda self: bool(self.told))
    @rule(data=st.data())
    def something_told_is_confirmed(self, data: st.DataObject) -> None:
        name = data.draw(st.sampled_from(sorted(self.told)))
        fact, outlines = self.told[name]
        before = self.state
        self.feed(FactConfirmed(time_s=self.time_s, told=name))
        stood = next(one.known.standing for one in before.told if one.known.id == name)
        if stood is Standing.READ_BACK and isinstance(fact, RegionPassable) and not self.ended:
            self.allowed[fact.region] = (outlines[fact.region], before.clock_s)
        elif stood is not Standing.READ_BACK and before.beliefs is not None and self.state.beliefs is not None:
            restored = {f"obstacle:{fact.region}"} if isinstance(fact, RegionBlocked) else set()
            allowed = before.beliefs.confirmed | (restored if stood is Standing.UNDO_READ_BACK else set())
            assert self.state.beliefs.confirmed <= allowed, "only what is read back is confirmed"
        if stood is Standing.UNDO_READ_BACK and not self.ended and self.state.beliefs is not None:
            assert not any(region.id == name for region in self.state.beliefs.map.regions)

    @precondition(lambda self: bool(self.told))
    @rule(data=st.data())
    def something_told_is_undone(self, data: st.DataObject) -> None:
        name = data.draw(st.sampled_from(sorted(self.told)))
        fact, _ = self.told[name]
        before = self.state
        self.feed(FactUndone(time_s=self.time_s, told=name))
        beliefs = self.state.beliefs
        if self.ended or beliefs is None:
            return
        if before.beliefs is not None:
            kept_out = {r.id for r in before.beliefs.map.regions if r.passable is Knowledge.NO}
            assert kept_out <= {r.id for r in beliefs.map.regions if r.passable is Knowledge.NO}, "nothing unconfirmed"
            assert entered(beliefs.map) <= entered(before.beliefs.map)
        last = [f for n, (f, _) in self.told.items() if n == name or self.stands(n) is Standing.COUNTS]
        if isinstance(fact, RoomSearched) and self.stands(name) is Standing.UNDONE and last.count(fact) == 1:
            assert fact.room not in searched(beliefs.map) or f"look:{fact.room}" in beliefs.finished

    def stands(self, name: str) -> Standing:
        return next(one.known.standing for one in self.state.told if one.known.id == name)

    @precondition(lambda self: not self.calm)
    @rule(order=st.sampled_from(Order))
    def an_order(self, order: Order) -> None:
        before, grounded = self.moving, self.state.grounded and not self.ended
        self.feed(Ordered(time_s=self.time_s, order=order))
        self.holds = order is Order.HOLD and not self.ended and not grounded
        if grounded:
            assert self.ended == (order not in (Order.HOLD, Order.CONTINUE)), "on the ground it waits, or it is over"
        elif order is not Order.CONTINUE and not self.ended:
            goes_on = before is not None and self.moving is before
            assert not goes_on or self.braking, "an order decides the next motion: the present one ends"
            assert not self.open, "who orders is not asked"

    @precondition(lambda self: not self.calm)
    @rule(link=st.sampled_from([Link.OPERATOR, Link.CAMERA, Link.MODEL]), up=st.booleans())
    def a_link_changes(self, link: Link, up: bool) -> None:
        self.feed(LinkChanged(time_s=self.time_s, link=link, up=up))

    @invariant()
    def holding_lasts_no_longer_than_the_battery(self) -> None:
        if getattr(self, "holds", False) and self.state.goal.value != "hold":
            self.holds = False  # the battery or a link has ended it

    @rule(events=st.integers(1, 12))
    def all_goes_well_for_a_while(self, events: int) -> None:
        for _ in range(events):
            if not self.ended:
                self.go_well()

    def go_well(self) -> None:
        """What an undisturbed mission sees next; questions are answered by the truth."""
        question = self.state.question
        if question is not None:
            truth = sample_world().truth
            if self.state.grounded:
                go = Answer(reply=Reply.YES, latency_s=0.0)
                self.feed(Answered(time_s=self.time_s, question=question.question.id, answer=go))
                return
            values = {gap.id: truth.value_of(gap) for gap in question.question.gaps}
            known = all(value is not None for value in values.values())
            says = Reply.UNSURE if not known else Reply.YES if question.question.query.holds(values) else Reply.NO
            answer = Answer(reply=says, latency_s=0.0)
            self.feed(Answered(time_s=self.time_s, question=question.question.id, answer=answer))
        elif self.looks:
            self.looks -= 1
            self.feed(MapObserved(time_s=self.time_s, map=self.believed()))
        elif self.requests:
            self.deliver(self.requests.pop())
        elif self.moving is not None:
            note(f"flown: {type(self.moving).__name__}")
            self.finish_motion(MotionEnd.ARRIVED)
        else:
            self.time_s += 5.0
            self.feed(Ticked(time_s=self.time_s, vehicle=self.vehicle()))

    def teardown(self) -> None:
        """From here on all goes well: the mission ends."""
        if not hasattr(self, "state"):
            return
        self.holds = False
        for _ in range(600):
            if self.ended:
                OUTCOMES[self.state.verdict.outcome] += 1
                return
            self.go_well()
        raise AssertionError(f"the mission does not end: {self.state.goal}, {self.state.activity}")


def grown(cells: np.ndarray, shape: tuple[int, ...]) -> np.ndarray:
    """Flat indices of these cells and of all that touch them, be it at a corner."""
    zyx = np.stack(np.unravel_index(np.asarray(cells, int), shape), axis=1)
    steps = np.stack(np.meshgrid(*[[-1, 0, 1]] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    near = (zyx[:, None] + steps[None]).reshape(-1, 3)
    inside = ((near >= 0) & (near < shape)).all(axis=1)
    return np.unique(np.ravel_multi_index(tuple(near[inside].T), shape)) if len(near) else np.zeros(0, int)


def entered(map: SemanticMap) -> set[str]:
    """Ids of the regions that may be flown through."""
    return {region.id for region in map.regions if region.passable is Knowledge.YES}


def searched(map: SemanticMap) -> set[str]:
    """Ids of the rooms that nobody needs to look into."""
    return {room.id for room in map.rooms if room.searched}


Mission.TestCase.settings = settings(
    max_examples=40,
    stateful_step_count=40,
    deadline=None,
    suppress_health_check=list(HealthCheck),
    phases=(Phase.explicit, Phase.reuse, Phase.generate),  # shrinking a whole mission takes minutes
)


class TestMissionLaws(Mission.TestCase):
    """The laws; and that the missions went far enough to try them."""

    def runTest(self) -> None:  # noqa: N802  (unittest's own name)
        OUTCOMES.clear()
        super().runTest()
        assert OUTCOMES[Outcome.SUCCESS] >= 1, OUTCOMES
        assert OUTCOMES.total() > OUTCOMES[Outcome.SUCCESS], OUTCOMES


TestMissionLaws.pytestmark = [pytest.mark.long]  # type: ignore[attr-defined]
