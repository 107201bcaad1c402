"""What the drone may do only because somebody said so (method, section 12)."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from mintpilot.core.gap import ABSENT, BLOCKED, PASSABLE, PRESENT, Belief, GapKind
from mintpilot.core.mission import AskingSettings
from mintpilot.core.query import Query, Reply
from mintpilot.core.semantic_map import Knowledge, SemanticMap
from mintpilot.mapping.knowledge import region_gap_id, room_gap_id
from mintpilot.mission.belief_state import BeliefState


@dataclass(frozen=True, slots=True, kw_only=True)
class Permissions:
    """What may be done because of answers. Compared before and after an update, whatever caused it."""

    enter: frozenset[str] = frozenset()
    """Obstacle gaps whose regions may be flown through."""
    leave_out: frozenset[str] = frozenset()
    """Presence gaps whose rooms need no look."""
    pick: frozenset[tuple[str, str]] = frozenset()
    """(target gap, value): things that a phrase is taken to mean."""


def permissions(state: BeliefState, settings: AskingSettings) -> Permissions:
    """What the answers so far permit."""
    belief = state.belief
    enter = {region_gap_id(r.id) for r in state.map.regions if r.passable is Knowledge.YES} | set(state.confirmed)
    leave_out = {room_gap_id(r.id) for r in state.map.rooms if r.occupied is Knowledge.NO}
    pick: set[tuple[str, str]] = set()
    for gap in belief.gaps:
        may_be_absent = gap.kind is GapKind.PRESENCE and ABSENT in gap.values
        if may_be_absent and belief.probability_of(gap.id, ABSENT) >= 1 - settings.alpha:
            leave_out.add(gap.id)
        if gap.kind is GapKind.TARGET and len(gap.values) > 1:
            p = belief.marginal(gap.id)
            if float(p.max()) >= 1 - settings.alpha:
                pick.add((gap.id, gap.values[int(np.argmax(p))]))
    return Permissions(enter=frozenset(enter), leave_out=frozenset(leave_out), pick=frozenset(pick))


def enlarges(before: BeliefState, after: BeliefState, settings: AskingSettings) -> bool:
    """Whether an update permits anything that was not permitted before."""
    old, new = permissions(before, settings), permissions(after, settings)
    return not (new.enter <= old.enter and new.leave_out <= old.leave_out and new.pick <= old.pick)


def revoke(state: BeliefState, query: Query, reply: Reply) -> BeliefState:
    """The state after an answer to an earlier question was taken back.

    A single region or room gets the opposite value at once; where the query spoke of more, everything that it spoke of
    is open again. Nothing becomes permitted by it.
    """
    gaps = frozenset(query.gap_ids)
    map, single = state.map, len(query.literals) == 1
    for region in map.regions:
        name = region_gap_id(region.id)
        if name in gaps and region.passable is Knowledge.YES:
            says = _value(query, reply, PASSABLE, BLOCKED)
            map = map.with_region(region.id, Knowledge.NO if single and says == BLOCKED else Knowledge.OPEN)
    map = _reopen_rooms(map, query, reply, single)
    belief = Belief(factors=tuple(f for f in state.belief.factors if not any(g.id in gaps for g in f.gaps)))
    return replace(
        state,
        map=map,
        belief=belief,
        confirmed=state.confirmed - gaps,
        asked=tuple((q, yes) for q, yes in state.asked if not gaps & set(q.gap_ids)),
    )


def _reopen_rooms(map: SemanticMap, query: Query, reply: Reply, single: bool) -> SemanticMap:
    for room in map.rooms:
        if room_gap_id(room.id) in query.gap_ids and room.occupied is Knowledge.NO:
            says = _value(query, reply, PRESENT, ABSENT)
            map = map.with_room(room.id, occupied=Knowledge.YES if single and says == PRESENT else Knowledge.OPEN)
    return map


def _value(query: Query, reply: Reply, first: str, second: str) -> str:
    """Which of two values a reply to a query about one gap says."""
    named = first if first in query.literals[0].values else second
    other = second if named == first else first
    return named if reply is Reply.YES else other
