"""What the drone may do only because somebody said so (method, section 12)."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from mintpilot.core.gap import ABSENT, BLOCKED, NOWHERE, PASSABLE, PRESENT, Belief, GapKind, obstacle_id, presence_id
from mintpilot.core.mission import AskingSettings
from mintpilot.core.query import YES_PART, Query
from mintpilot.core.semantic_map import Knowledge, SemanticMap
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
    enter = {obstacle_id(r.id) for r in state.map.regions if r.passable is Knowledge.YES} | set(state.confirmed)
    leave_out = {presence_id(r.id) for r in state.map.rooms if r.occupied is Knowledge.NO}
    pick: set[tuple[str, str]] = set()
    for gap in belief.gaps:
        may_be_absent = gap.kind is GapKind.PRESENCE and ABSENT in gap.values
        if may_be_absent and belief.probability_of(gap.id, ABSENT) >= 1 - settings.alpha:
            leave_out.add(gap.id)
        if gap.kind is GapKind.TARGET and len(gap.values) > 1 and not gap.is_search:
            p = belief.marginal(gap.id)
            if float(p.max()) >= 1 - settings.alpha and gap.values[int(np.argmax(p))] not in NOWHERE:
                pick.add((gap.id, gap.values[int(np.argmax(p))]))
    return Permissions(enter=frozenset(enter), leave_out=frozenset(leave_out), pick=frozenset(pick))


def enlarges(before: BeliefState, after: BeliefState, settings: AskingSettings) -> bool:
    """Whether an update permits anything that was not permitted before."""
    old, new = permissions(before, settings), permissions(after, settings)
    return not (new.enter <= old.enter and new.leave_out <= old.leave_out and new.pick <= old.pick)


def revoke(state: BeliefState, query: Query, part: int) -> BeliefState:
    """The state after an answer to an earlier question was taken back.

    A single region or room gets the opposite value at once; where the query spoke of more, everything that it spoke of
    is open again. Nothing becomes permitted by it.
    """
    gaps = frozenset(query.gap_ids)
    map, single = state.map, len(query.literals) == 1
    for region in map.regions:
        name = obstacle_id(region.id)
        if name in gaps and region.passable is Knowledge.YES:
            blocked = single and _value(query, part, PASSABLE, BLOCKED) == BLOCKED
            map = map.with_region(region.id, Knowledge.NO if blocked else Knowledge.OPEN)
    map = _reopen_rooms(map, query, part, single)
    belief = Belief(factors=tuple(f for f in state.belief.factors if not any(g.id in gaps for g in f.gaps)))
    return replace(
        state,
        map=map,
        belief=belief,
        confirmed=state.confirmed - gaps,
        grants=tuple(grant for grant in state.grants if grant.gap not in gaps),
        asked=tuple(one for one in state.asked if not gaps & set(one.query.gap_ids)),
    )


def _reopen_rooms(map: SemanticMap, query: Query, part: int, single: bool) -> SemanticMap:
    for room in map.rooms:
        if presence_id(room.id) in query.gap_ids and room.occupied is Knowledge.NO:
            present = single and _value(query, part, PRESENT, ABSENT) == PRESENT
            map = map.with_room(room.id, occupied=Knowledge.YES if present else Knowledge.OPEN)
    return map


def _value(query: Query, part: int, first: str, second: str) -> str:
    """Which of two values an answer to a yes/no query about one gap says."""
    named = first if first in query.literals[0].values else second
    other = second if named == first else first
    return named if part == YES_PART else other
