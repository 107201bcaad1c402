"""What a fact that was told does to what is believed, and taking it back (method, section 12)."""

from __future__ import annotations

from dataclasses import dataclass, replace

from mintpilot.core.gap import PASSABLE, Belief, GapKind, Joint, obstacle_id, presence_id
from mintpilot.core.message import Message, message
from mintpilot.core.mission import Mission
from mintpilot.core.observation import RegionKind
from mintpilot.core.predicate import Literal, Saying, SayingKind
from mintpilot.core.query import Answer, Query, Reply
from mintpilot.core.semantic_map import Knowledge, Region, Room, SemanticMap
from mintpilot.core.told import PREFIX, Fact, KeepOut, RegionBlocked, RegionPassable, RoomSearched, ThisOne
from mintpilot.mapping.drawn import drawn_cells
from mintpilot.mission.belief_state import BeliefState, Grant, update
from mintpilot.mission.grants import granted, without
from mintpilot.reasoning.belief import extend
from mintpilot.uncertainty.gaps import look_id, obstacle_gaps
from mintpilot.uncertainty.things import things_of


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Memory:
    """What was known of one gap before something was told of it."""

    gap: str
    passable: Knowledge
    """Of a region; ``OPEN`` for everything else."""
    factors: tuple[Joint, ...]
    """Of the belief, those that held the gap: one or none."""
    confirmed: bool
    grants: tuple[Grant, ...]
    asked: int
    """How often something was answered about it."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Applied:
    """What a fact made of the beliefs."""

    beliefs: BeliefState
    memory: Memory | None = None
    """Of the gap that it is about; None where it is about none."""


def apply(fact: Fact, beliefs: BeliefState, shown: SemanticMap, mission: Mission, now_s: float) -> Applied | Message:
    """The beliefs with a fact in them, or why it cannot be taken over.

    Args:
        fact: what was told; a drawn region changes the map only (`with_drawn`).
        beliefs: so far.
        shown: the map that the operator saw: a yes for a region covers the outline that it has there.
        mission: its settings and priors.
        now_s: mission clock.
    """
    match fact:
        case KeepOut():
            return Applied(beliefs=beliefs)
        case RegionBlocked():
            return _blocked(fact, beliefs)
        case RegionPassable():
            return _passable(fact, beliefs, shown, mission, now_s)
        case RoomSearched():
            return _searched(fact, beliefs)
        case ThisOne():
            return _this_one(fact, beliefs, mission)


def take_back(fact: Fact, beliefs: BeliefState, memory: Memory | None) -> BeliefState:
    """The beliefs without that fact.

    As they were before where nothing was learnt of its gap since; else what it permitted is open again, and what others
    have said stays.
    """
    if isinstance(fact, RoomSearched):
        beliefs = _not_searched(beliefs, fact.room)
    if memory is None:
        return beliefs
    since = sum(memory.gap in one.query.gap_ids for one in beliefs.asked)
    joined = {gap.id for factor in _factors(beliefs.belief, memory.gap) for gap in factor.gaps}
    then = {gap.id for factor in memory.factors for gap in factor.gaps} | {memory.gap}
    is_answer = isinstance(fact, RegionPassable | ThisOne)
    if since == memory.asked + is_answer and joined <= then:
        return _restored(beliefs, memory)
    return without(beliefs, frozenset({memory.gap})) if is_answer else beliefs


def with_drawn(map: SemanticMap, drawn: tuple[tuple[str, KeepOut], ...]) -> SemanticMap:
    """The map with exactly these drawn regions, by id, each known not to be passable."""
    regions = tuple(region for region in map.regions if not region.id.startswith(PREFIX))
    if not drawn and len(regions) == len(map.regions):
        return map
    added = tuple(
        Region(
            id=name,
            kind=RegionKind.AREA,
            cells=drawn_cells(map.frame, fact.corners_m),
            passable=Knowledge.NO,
            description="the region that was drawn",
        )
        for name, fact in drawn
    )
    return replace(map, regions=(*regions, *(region for region in added if region.cells.size)))


def with_searched(map: SemanticMap, rooms: frozenset[str], taken_back: frozenset[str]) -> SemanticMap:
    """The map with these rooms searched, and those not."""
    for room in map.rooms:
        if room.id in rooms | taken_back:
            map = map.with_room(room.id, searched=room.id in rooms)
    return map


def not_looked_into(rooms: frozenset[str], finished: frozenset[str]) -> frozenset[str]:
    """Those of these rooms that the drone has not looked into itself."""
    return frozenset(room for room in rooms if look_id(room) not in finished)


def words_for(fact: Fact, beliefs: BeliefState | None) -> str:
    """What a fact speaks of, as questions call it, or the map does; empty for a drawn region."""
    if isinstance(fact, KeepOut):
        return ""
    name = subject_of(fact)
    if beliefs is None:
        return name
    asked = {gap.subject: gap.description for gap in beliefs.belief.gaps if gap.kind is not GapKind.TARGET}
    if asked.get(name):
        return asked[name]
    map = beliefs.map
    places: tuple[Region | Room, ...] = (*map.regions, *map.rooms)
    known = {one.id: one.description for one in places} | {thing.id: thing.label for thing in map.objects}
    return known.get(name) or name


def subject_of(fact: Fact) -> str:
    """Id of what a fact speaks of; empty for a drawn region."""
    match fact:
        case RegionBlocked() | RegionPassable():
            return fact.region
        case RoomSearched():
            return fact.room
        case ThisOne():
            return fact.thing
        case KeepOut():
            return ""


def _blocked(fact: RegionBlocked, beliefs: BeliefState) -> Applied | Message:
    region = _region(beliefs.map, fact.region)
    if isinstance(region, Message):
        return region
    if region.passable is Knowledge.NO:
        return message("it is stayed out of already")
    gap = obstacle_id(region.id)
    after = replace(
        beliefs,
        map=beliefs.map.with_region(region.id, Knowledge.NO),
        confirmed=beliefs.confirmed - {gap},
        grants=tuple(grant for grant in beliefs.grants if grant.gap != gap),
    )
    return Applied(beliefs=after, memory=_memory(beliefs, gap))


def _passable(
    fact: RegionPassable, beliefs: BeliefState, shown: SemanticMap, mission: Mission, now_s: float
) -> Applied | Message:
    region = _region(beliefs.map, fact.region)
    if isinstance(region, Message):
        return region
    gap, memory = obstacle_id(region.id), _memory(beliefs, obstacle_id(region.id))
    if region.passable is not Knowledge.OPEN:
        if region.passable is Knowledge.YES:
            return message("it is known already")
        return message("it was said that it must not be entered")
    alone = replace(beliefs.map, regions=(region,))
    found = obstacle_gaps(alone, things_of(beliefs.map), prior_passable=mission.prior_passable)
    if gap not in {known.id for known in beliefs.belief.gaps}:
        wider = extend(beliefs.belief, (*beliefs.belief.gaps, *found), max_joint=mission.asking.max_joint)
        beliefs = replace(beliefs, belief=wider)
    after = _learnt(beliefs, gap, PASSABLE, mission)
    if isinstance(after, Message):
        return after
    return Applied(beliefs=granted(after, frozenset({gap}), shown, now_s), memory=memory)


def _searched(fact: RoomSearched, beliefs: BeliefState) -> Applied | Message:
    room = next((room for room in beliefs.map.rooms if room.id == fact.room), None)
    if room is None:
        return message("no such room is known")
    if room.searched or room.occupied is Knowledge.NO:
        return message("nobody needs to look into it any more")
    if room.occupied is Knowledge.YES:
        return message("it was said that somebody is inside")
    memory = _memory(beliefs, presence_id(room.id))
    return Applied(beliefs=replace(beliefs, map=beliefs.map.with_room(room.id, searched=True)), memory=memory)


def _this_one(fact: ThisOne, beliefs: BeliefState, mission: Mission) -> Applied | Message:
    gaps = [gap for gap in beliefs.belief.gaps if gap.kind is GapKind.TARGET and fact.thing in gap.values]
    if len(gaps) != 1:
        return message("more than one step may mean it") if gaps else message("nothing in the task may mean it")
    memory = _memory(beliefs, gaps[0].id)
    after = _learnt(beliefs, gaps[0].id, fact.thing, mission)
    return after if isinstance(after, Message) else Applied(beliefs=after, memory=memory)


def _region(map: SemanticMap, name: str) -> Region | Message:
    found = next((region for region in map.regions if region.id == name), None)
    if found is None:
        return message("no such region is known")
    return message("it was drawn: take that back instead") if name.startswith(PREFIX) else found


def _learnt(beliefs: BeliefState, gap: str, value: str, mission: Mission) -> BeliefState | Message:
    """As an answer that says so outright; it takes nothing off the budget of questions."""
    saying = Saying(kind=SayingKind.VALUE, value=value)
    query = Query(literals=(Literal(gap=gap, values=frozenset({value}), saying=saying),))
    result = update(beliefs, query, Answer(reply=Reply.YES, latency_s=0.0), mission.asking)
    if result.contradiction:
        return message("it goes against what was said before")
    return replace(result.state, attempts=beliefs.attempts, withdrawn=beliefs.withdrawn)


def _not_searched(beliefs: BeliefState, room: str) -> BeliefState:
    if not not_looked_into(frozenset({room}), beliefs.finished):
        return beliefs
    return replace(beliefs, map=beliefs.map.with_room(room, searched=False))


def _memory(beliefs: BeliefState, gap: str) -> Memory:
    regions = {obstacle_id(region.id): region.passable for region in beliefs.map.regions}
    return Memory(
        gap=gap,
        passable=regions.get(gap, Knowledge.OPEN),
        factors=_factors(beliefs.belief, gap),
        confirmed=gap in beliefs.confirmed,
        grants=tuple(grant for grant in beliefs.grants if grant.gap == gap),
        asked=sum(gap in one.query.gap_ids for one in beliefs.asked),
    )


def _restored(beliefs: BeliefState, memory: Memory) -> BeliefState:
    gap, map = memory.gap, beliefs.map
    for region in map.regions:
        if obstacle_id(region.id) == gap:
            map = map.with_region(region.id, memory.passable)
    kept = [one for one in beliefs.asked if gap in one.query.gap_ids][: memory.asked]
    others = tuple(f for f in beliefs.belief.factors if f not in _factors(beliefs.belief, gap))
    return replace(
        beliefs,
        map=map,
        belief=Belief(factors=tuple(sorted((*others, *memory.factors), key=lambda f: f.gaps[0].id))),
        confirmed=beliefs.confirmed | {gap} if memory.confirmed else beliefs.confirmed - {gap},
        grants=tuple(
            sorted((*(g for g in beliefs.grants if g.gap != gap), *memory.grants), key=lambda grant: grant.gap)
        ),
        asked=tuple(
            one for one in beliefs.asked if gap not in one.query.gap_ids or any(one is known for known in kept)
        ),
    )


def _factors(belief: Belief, gap: str) -> tuple[Joint, ...]:
    return tuple(factor for factor in belief.factors if any(known.id == gap for known in factor.gaps))
