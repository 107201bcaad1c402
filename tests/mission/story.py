"""Missions told as stories: everything around `step` is played here, and what happens is told in short lines.

The deliberations are the shipped ones. A decision is worked out once for all moments that differ in time, battery and
track only, so that many stories cost little.
"""

from __future__ import annotations

import hashlib
from copy import copy
from dataclasses import dataclass, field, replace
from functools import cache

import numpy as np

from kept import plain
from mintpilot.assembly.briefing import briefing_of
from mintpilot.assembly.components import Choices, DeliberationParts, deliberation_parts
from mintpilot.conformance.sample import sample_world
from mintpilot.core.digest import digest
from mintpilot.core.events import Event
from mintpilot.core.inputs import (
    Answered,
    DeliberationEnded,
    Input,
    MapObserved,
    MissionBegun,
    MotionEnded,
    Ticked,
)
from mintpilot.core.message import NOTHING, Message
from mintpilot.core.mission import AskingSettings, Mission
from mintpilot.core.motion import FollowTrajectory, Motion, MotionEnd
from mintpilot.core.observation import RegionKind
from mintpilot.core.query import Answer, Reply
from mintpilot.core.semantic_map import Cell, Region, SemanticMap
from mintpilot.core.trajectory import FlightEnd, FlightLog, VehicleState
from mintpilot.mission.directives import Brake, Deliberate, Directive, Move, Observe
from mintpilot.mission.journal import Journal
from mintpilot.mission.requests import Request
from mintpilot.mission.state import Activity, MissionState, Setup
from mintpilot.mission.step import initial_state, step
from mintpilot.mission.worker import worked_out

BATTERY_S = 300.0
BEGINS_S = 7.0
"""What the clock shows at first: not nothing, or half of all sums of times would be right by chance."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Kind:
    """What differs between missions."""

    asking: AskingSettings = AskingSettings(delta_c_s=0.5, answer_valid_s=60.0)  # noqa: RUF009  (a value)
    surveys: bool = False
    lands: bool = False
    briefed: bool = False
    endurance_s: float = BATTERY_S


@cache
def parts_of(kind: Kind) -> DeliberationParts:
    """What deliberations need."""
    world = sample_world()
    mission = replace(
        world.mission,
        limits=replace(world.mission.limits, endurance_s=kind.endurance_s),
        asking=kind.asking,
        survey=world.mission.survey if kind.surveys else None,
    )
    return deliberation_parts(replace(world, mission=mission), Choices())


_DECIDED: dict[tuple[Kind, str], DeliberationEnded] = {}


def decided(kind: Kind, request: Request) -> DeliberationEnded:
    """What is decided, whatever the time: the battery is taken as full."""
    vehicle = replace(request.vehicle, time_s=0.0, endurance_left_s=kind.endurance_s)
    still = replace(request, id=0, vehicle=vehicle, endurance_s=kind.endurance_s, track_m=request.track_m[-1:])
    key = kind, digest(still)
    if key not in _DECIDED:
        _DECIDED[key] = replace(worked_out(parts_of(kind), still, 0.0), seconds=0.2)
    return _DECIDED[key]


class Listener:
    """A recorder that keeps what it is told."""

    def __init__(self) -> None:
        self.heard: list[Event] = []

    def record(self, event: Event) -> None:
        """Keeps it."""
        self.heard.append(event)

    def close(self) -> None:
        """Nothing to do."""


@dataclass
class Story:
    """One mission in the making."""

    kind: Kind
    state: MissionState
    map: SemanticMap
    time_s: float = BEGINS_S
    position: tuple[float, float, float] = (0.0, 0.0, 0.0)
    moving: Motion | None = None
    braking: bool = False
    looks: int = 0
    requests: tuple[Request, ...] = ()
    lines: tuple[str, ...] = ()
    """What was given at each step, in short."""
    facts: tuple[str, ...] = field(default=(), repr=False)
    """Everything that each step said and changed, as digests."""

    def copy(self) -> Story:
        """The same moment, to be gone on from in another way."""
        return copy(self)

    def vehicle(self) -> VehicleState:
        """As it reports itself: at rest."""
        left_s = max(self.kind.endurance_s - (self.time_s - BEGINS_S), 0.0)
        return VehicleState(
            time_s=self.time_s,
            position_m=self.position,
            velocity_mps=(0.0, 0.0, 0.0),
            yaw_rad=0.0,
            endurance_left_s=left_s,
        )

    def feed(self, event: Input) -> None:
        """One step, and what the recorder is told of it."""
        before, listener = self.state, Listener()
        self.state, directives = step(before, event)
        Journal(listener).keep(before, event, self.state, directives)
        for directive in directives:
            self._carry_out(directive)
        self.lines = (*self.lines, " ".join(map(_short, directives)) or "-")
        told = [*plain(directives), *plain(tuple(listener.heard[1:])), *plain(self.state)]
        self.facts = (*self.facts, hashlib.sha256("\n".join(told).encode()).hexdigest()[:8])

    def _carry_out(self, directive: Directive) -> None:
        match directive:
            case Move():
                self.moving, self.braking = directive.motion, False
            case Brake():
                self.braking = True
            case Observe():
                self.looks += 1
            case Deliberate():
                self.requests = (*self.requests, directive.request)
            case _:
                pass

    def tick(self, seconds: float = 0.0) -> None:
        """Time passes."""
        self.time_s += seconds
        self.feed(Ticked(time_s=self.time_s, vehicle=self.vehicle()))

    def look(self, *, obstruction: Message = NOTHING) -> None:
        """A new map, with what was answered carried over as map sources do."""
        self.feed(MapObserved(time_s=self.time_s, map=self._believed(), obstruction=obstruction))

    def _believed(self) -> SemanticMap:
        beliefs = self.state.beliefs
        if beliefs is None:
            return self.map
        known = {region.id: region.passable for region in beliefs.map.regions}
        rooms = {room.id: room for room in beliefs.map.rooms}
        return replace(
            self.map,
            regions=tuple(replace(r, passable=known.get(r.id, r.passable)) for r in self.map.regions),
            rooms=tuple(rooms.get(r.id, r) for r in self.map.rooms),
        )

    def cloud(self, name: str = "new") -> None:
        """Smoke appears in a corner, off all ways."""
        cells = np.zeros(self.map.cells.shape, bool)
        cells[:, -6:, :6] = True
        where = np.flatnonzero(cells & (self.map.cells == Cell.FREE))
        self.map = replace(self.map, regions=(*self.map.regions, Region(id=name, kind=RegionKind.SMOKE, cells=where)))

    def end_motion(self, end: MotionEnd = MotionEnd.ARRIVED, *, by_hand: str = "", share: float = 0.5) -> None:
        """The vehicle is at rest: where it was to go, or part of the way there."""
        motion, log = self.moving, None
        assert motion is not None
        end = MotionEnd.STOPPED if self.braking and end is MotionEnd.ARRIVED else end
        flies = isinstance(motion, FollowTrajectory) and end in (MotionEnd.ARRIVED, MotionEnd.STOPPED)
        if isinstance(motion, FollowTrajectory) and flies:
            way = motion.trajectory
            rows = len(way.time_s) if end is MotionEnd.ARRIVED else max(1, int(share * len(way.time_s)))
            flown, times = way.position_m[:rows], self.time_s + way.time_s[:rows]
            self.time_s, self.position = float(times[-1]), tuple(float(v) for v in flown[-1])  # type: ignore[assignment]
            ends = FlightEnd.ARRIVED if end is MotionEnd.ARRIVED else FlightEnd.INTERRUPTED
            log = FlightLog(end=ends, time_s=times, position_m=flown.copy(), reference_m=flown.copy())
        self.moving, self.braking = None, False
        self.feed(
            MotionEnded(
                time_s=self.time_s,
                motion=motion.id,
                end=end,
                vehicle=self.vehicle(),
                log=log,
                reason="" if flies else "a fault",
                by_hand=by_hand,
            )
        )

    def deliver(self) -> None:
        """The newest deliberation comes back."""
        *rest, request = self.requests
        self.requests = tuple(rest)
        self.feed(replace(decided(self.kind, request), time_s=self.time_s, request=request.id))

    def fail(self) -> None:
        """The newest deliberation fails."""
        *rest, request = self.requests
        self.requests = tuple(rest)
        self.feed(DeliberationEnded(time_s=self.time_s, request=request.id, decision=None, reason="a fault"))

    def answer(self, reply: Reply, **more: object) -> None:
        """Somebody answers the open question."""
        open_ = self.state.question
        assert open_ is not None
        answer = replace(Answer(reply=reply, latency_s=1.0, text="well"), **more)  # type: ignore[arg-type]
        self.feed(Answered(time_s=self.time_s, question=open_.question.id, answer=answer, operator="ann"))

    def truth(self) -> Reply:
        """What somebody who knows would say to the open question."""
        assert self.state.question is not None
        question, truth = self.state.question.question, sample_world().make_truth()
        values = {gap.id: truth.value_of(gap) for gap in question.gaps}
        if any(value is None for value in values.values()):
            return Reply.UNSURE
        return Reply.YES if question.query.holds(values) else Reply.NO  # type: ignore[arg-type]

    def go_well(self) -> None:
        """What an undisturbed mission sees next."""
        if self.state.question is not None and self.moving is None:
            self.answer(Reply.YES if self.state.grounded else self.truth())
        elif self.looks:
            self.looks -= 1
            self.look()
        elif self.requests:
            self.deliver()
        elif self.moving is not None:
            self.end_motion()
        else:
            self.tick(5.0)

    def until(self, *activities: Activity, times: int = 1) -> Story:
        """Goes on undisturbed until one of these is begun; or until there is a question, where none is named."""
        for _ in range(60):
            before = self.state
            self.go_well()
            begun = self.state.activity in activities and self.state.motion is not before.motion
            asked = not activities and self.state.question is not None and before.question is None
            times -= begun or asked
            if not times:
                return self
        raise AssertionError(f"none of {activities} within reach")

    def told(self, since: int) -> str:
        """What was given from some step on, and a digest of all that was said and changed."""
        verdict = self.state.verdict
        end = f"{self.state.goal}" if verdict is None else f"{verdict.outcome}"
        mark = hashlib.sha256("".join(self.facts[since:]).encode()).hexdigest()[:8]
        return f"{' | '.join(self.lines[since:])} => {end} {mark}"


def begun(kind: Kind) -> Story:
    """A mission at its first step."""
    world, parts = sample_world(), parts_of(kind)
    mission: Mission = parts.mission
    briefing = briefing_of(parts, world.map) if kind.briefed else None
    setup = Setup(mission=mission, task=parts.task, surveys=kind.surveys, lands=kind.lands, briefing=briefing)
    vehicle = VehicleState(
        time_s=BEGINS_S,
        position_m=mission.start_m,
        velocity_mps=(0.0, 0.0, 0.0),
        yaw_rad=0.0,
        endurance_left_s=kind.endurance_s,
    )
    story = Story(kind=kind, state=initial_state(setup, vehicle), map=world.map, position=mission.start_m)
    story.feed(MissionBegun(time_s=BEGINS_S, vehicle=vehicle))
    return story


def _short(directive: Directive) -> str:
    name = type(directive).__name__
    match directive:
        case Move():
            return type(directive.motion).__name__
        case Deliberate():
            return f"Deliberate({directive.request.purpose})"
        case _:
            return name
