"""What operators tell of their own accord: read back where it takes caution away, undone by one word (section 12)."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

from mintpilot.core.inputs import FactConfirmed, FactTold, FactUndone
from mintpilot.core.message import Message, Named, message
from mintpilot.core.semantic_map import SemanticMap
from mintpilot.core.told import (
    PREFIX,
    Fact,
    KeepOut,
    RegionBlocked,
    RegionPassable,
    RoomSearched,
    Standing,
    ThisOne,
    ToldFact,
)
from mintpilot.mission import asking, facts
from mintpilot.mission.belief_state import BeliefState
from mintpilot.mission.permissions import enlarges
from mintpilot.mission.state import READ_BACK_S, Activity, MissionState, Telling
from mintpilot.mission.transition import Transition

MOST_TOLD: Final = 200
"""Facts of one mission; beyond it only those that add caution are taken, as long as fewer of these count."""
_FREEING: Final = (RegionPassable, RoomSearched, ThisOne)
"""Facts that are read back whatever is permitted already: said again, they count longer, or weigh more."""
_IN_FLIGHT: Final = (
    Activity.EXPLORE,
    Activity.SURVEY_BACK,
    Activity.LEG,
    Activity.MEANWHILE,
    Activity.HOMEWARD,
    Activity.TO_LANDING,
)
"""Flights that are broken off when something new is told: the way may lead elsewhere now."""


def told(t: Transition, event: FactTold) -> None:
    """Takes a fact over at once where it adds caution; else reads it back."""
    beliefs, mission = t.state.beliefs, t.state.setup.mission
    if _too_many(t.state, event.fact):
        t.tell(message("I cannot keep more of what is told in one mission."))
        return
    known = ToldFact(
        id=f"{PREFIX}{t.next_id()}",
        fact=event.fact,
        words=facts.words_for(event.fact, beliefs),
        operator=event.operator,
        told_s=t.state.clock_s,
        standing=Standing.COUNTS,
    )
    if beliefs is None:
        why = Message() if isinstance(event.fact, KeepOut) else message("there is no map yet")
        _keep(t, _refused(known, why) if why else Telling(known=known))
        return
    found = facts.apply(event.fact, beliefs, beliefs.map, mission, t.state.clock_s)
    if isinstance(found, Message):
        _keep(t, _refused(known, found))
    elif isinstance(event.fact, _FREEING) or enlarges(beliefs, found.beliefs, mission.asking):
        read_back = replace(known, standing=Standing.READ_BACK)
        _keep(t, Telling(known=read_back, shown=beliefs.map, read_back_s=t.state.clock_s))
    else:
        _keep(t, Telling(known=known, memory=found.memory, counts_s=t.state.clock_s))
        _take_over(t, found.beliefs)


def _too_many(state: MissionState, fact: Fact) -> bool:
    if len(state.told) < MOST_TOLD:
        return False
    cautious = sum(one.known.counts and not isinstance(one.known.fact, _FREEING) for one in state.told)
    return isinstance(fact, _FREEING) or cautious >= MOST_TOLD


def confirmed(t: Transition, event: FactConfirmed) -> None:
    """What was read back counts now, or does not any more."""
    telling = _find(t.state, event.told)
    if telling is None:
        return
    if telling.known.standing is Standing.UNDO_READ_BACK:
        _take_back(t, telling, event.operator)
    if telling.known.standing is not Standing.READ_BACK or telling.shown is None:
        return
    mission = t.state.setup.mission
    found = facts.apply(telling.known.fact, t.beliefs, telling.shown, mission, t.state.clock_s)
    if isinstance(found, Message):
        _replace(t, _refused(telling.known, found))
        return
    known = replace(telling.known, standing=Standing.COUNTS)
    _replace(t, Telling(known=known, memory=found.memory, counts_s=t.state.clock_s))
    _take_over(t, found.beliefs)


def undone(t: Transition, event: FactUndone) -> None:
    """Takes a fact back at once, where that takes no caution away; else reads that back. Denies what is read back."""
    telling = _find(t.state, event.told)
    if telling is None:
        return
    match telling.known.standing:
        case Standing.READ_BACK:
            _replace(t, Telling(known=replace(telling.known, standing=Standing.UNDONE)), by=event.operator)
        case Standing.UNDO_READ_BACK:
            _replace(t, _stands(telling), by=event.operator)
        case Standing.COUNTS if _guards(t, telling):
            known = replace(telling.known, standing=Standing.UNDO_READ_BACK)
            _replace(t, replace(telling, known=known, read_back_s=t.state.clock_s), by=event.operator)
        case Standing.COUNTS:
            _take_back(t, telling, event.operator)
        case _:
            pass


def _guards(t: Transition, telling: Telling) -> bool:
    """Whether something may be done without the fact that may not be done with it."""
    fact, beliefs = telling.known.fact, t.state.beliefs
    if not isinstance(fact, _FREEING) or beliefs is None:
        return not isinstance(fact, _FREEING)
    return enlarges(beliefs, facts.take_back(fact, beliefs, telling.memory), t.state.setup.mission.asking)


def _take_back(t: Transition, telling: Telling, by: str) -> None:
    """What was before the fact is so again."""
    _replace(t, Telling(known=replace(telling.known, standing=Standing.UNDONE)), by=by)
    if t.state.beliefs is not None:
        _take_over(t, facts.take_back(telling.known.fact, t.state.beliefs, telling.memory))


def _stands(telling: Telling) -> Telling:
    """It counts on: nobody confirmed that it is taken back."""
    return replace(telling, known=replace(telling.known, standing=Standing.COUNTS))


def on_map(map: SemanticMap, state: MissionState) -> SemanticMap:
    """A new map with what was told in it, and without what was taken back."""
    drawn: list[tuple[str, KeepOut]] = []
    searched, not_searched = set[str](), set[str]()
    finished = state.beliefs.finished if state.beliefs is not None else frozenset[str]()
    for telling in state.told:
        fact, counts = telling.known.fact, telling.known.counts
        if isinstance(fact, KeepOut) and counts:
            drawn.append((telling.known.id, fact))
        elif isinstance(fact, RoomSearched) and (counts or telling.known.standing is Standing.UNDONE):
            (searched if counts else not_searched).add(fact.room)
    rooms = frozenset(not_searched - searched)
    map = facts.with_searched(map, frozenset(searched), facts.not_looked_into(rooms, finished))
    return facts.with_drawn(map, tuple(drawn))


def lapse(t: Transition) -> None:
    """What was not confirmed in time stays as it was; a yes for a region ages, or somebody has said no since."""
    grants = {} if t.state.beliefs is None else {grant.gap: grant.given_s for grant in t.state.beliefs.grants}
    for telling in t.state.told:
        known = telling.known
        if known.read_back and t.state.clock_s >= telling.read_back_s + READ_BACK_S:
            is_new = known.standing is Standing.READ_BACK
            _replace(t, Telling(known=replace(known, standing=Standing.UNDONE)) if is_new else _stands(telling))
        elif isinstance(known.fact, RegionPassable) and telling.memory is not None:
            holds = grants.get(telling.memory.gap) == telling.counts_s
            standing = Standing.COUNTS if holds else Standing.LAPSED
            if known.standing in (Standing.COUNTS, Standing.LAPSED) and standing is not known.standing:
                _replace(t, replace(telling, known=replace(known, standing=standing)))


def _take_over(t: Transition, beliefs: BeliefState) -> None:
    """Goes on with other beliefs: whatever is thought, asked or flown without them ends."""
    t.set(beliefs=replace(beliefs, map=on_map(beliefs.map, t.state)))
    asking.check_permissions(t)
    if t.state.grounded:
        return
    t.withdraw(message("the operator has told something new"))
    # somebody attends to the mission: its patience with news begins anew
    t.set(request=None, fallback=None, drops=0, replans=0, hops=0, home_s=None, outdated=t.state.plan is not None)
    if t.state.activity in _IN_FLIGHT:
        t.brake()


def _keep(t: Transition, telling: Telling) -> None:
    t.set(told=(*t.state.told, telling))
    _note(t, telling, telling.known.operator)


def _replace(t: Transition, telling: Telling, *, by: str = "") -> None:
    before = _find(t.state, telling.known.id)
    t.set(told=tuple(telling if one.known.id == telling.known.id else one for one in t.state.told))
    if before is not None and before.known.standing is Standing.UNDO_READ_BACK and telling.known.counts:
        t.note("told", message("Stays: {what}.", what=_by(_in_words(telling.known), by)))
    else:
        _note(t, telling, by)


def _note(t: Transition, telling: Telling, by: str) -> None:
    known = telling.known
    what = _in_words(known)
    said = _by(what, by)
    match known.standing:
        case Standing.READ_BACK:
            t.note("told", message("Read back: {what}.", what=said))
        case Standing.COUNTS:
            t.note("told", message("Told: {what}.", what=said))
            t.tell(message("I take over: {what}.", what=what))
        case Standing.UNDO_READ_BACK:
            t.note("told", message("Read back: that it is taken back: {what}.", what=said))
        case Standing.UNDONE:
            t.note("told", message("Taken back: {what}.", what=said))
            t.tell(message("I take back: {what}.", what=what))
        case Standing.LAPSED:
            t.note("told", message("No longer counts: {what}.", what=what))
        case Standing.REFUSED:
            t.note("told", message("Not taken over: {what}: {why}.", what=said, why=known.why))
            t.tell(message("I do not take this over: {what}: {why}.", what=what, why=known.why))


def _by(what: Message, who: str) -> Message:
    return message("{what} ({who})", what=what, who=who) if who else what


def _in_words(known: ToldFact) -> Message:
    what = Named(known.words)
    match known.fact:
        case KeepOut():
            return message("a region was drawn to stay out of")
        case RegionBlocked():
            return message("{what} must not be entered", what=what)
        case RegionPassable():
            return message("{what} may be flown through", what=what)
        case RoomSearched():
            return message("{what} was searched", what=what)
        case ThisOne():
            return message("{what} is the one that is meant", what=what)


def _refused(known: ToldFact, why: Message) -> Telling:
    return Telling(known=replace(known, standing=Standing.REFUSED, why=why))


def _find(state: MissionState, name: str) -> Telling | None:
    return next((one for one in state.told if one.known.id == name), None)
