"""Assumptions, reasons and endings in plain words, in any language."""

from __future__ import annotations

from collections.abc import Iterable

from mintpilot.core.gap import BLOCKED, PASSABLE, PRESENT, Assumptions, GapKind, KnowledgeGap
from mintpilot.core.message import Message, Named, joined, message, verbatim
from mintpilot.core.mission import Outcome
from mintpilot.core.query import YES_PART, Combine, Evidence, Order, Query, Reply
from mintpilot.core.tree import LeafReason

LEAF_WORDS: dict[LeafReason, Message] = {
    LeafReason.RELIES_ON_NOTHING: message("depends on nothing unknown"),
    LeafReason.CAUTIOUS_IS_GOOD_ENOUGH: message("the safe way is good enough"),
    LeafReason.TARGET_IS_CLEAR_ENOUGH: message("the goal is clear enough"),
    LeafReason.INFEASIBLE: message("nothing safe can be flown"),
    LeafReason.NOT_EXPANDED: message("not worked out any further"),
}
"""Why a branch of the tree ends."""

OUTCOME_WORDS: dict[Outcome, Message] = {
    Outcome.SUCCESS: message("Mission accomplished"),
    Outcome.PARTIAL: message("Done in part: some stops were left undone"),
    Outcome.COLLISION: message("Failed: the drone touched something"),
    Outcome.TOXIC_SMOKE: message("Failed: the drone flew into toxic smoke"),
    Outcome.ENDURANCE: message("Failed: the flight time ran out"),
    Outcome.LEFT_VOLUME: message("Failed: the drone left its allowed space"),
    Outcome.WRONG_TARGET: message("Failed: the wrong thing was reached"),
    Outcome.PERSON_MISSED: message("Failed: somebody was not found"),
    Outcome.NO_SAFE_PLAN: message("Not flown: no safe way was known"),
    Outcome.ABORTED: message("Ended before it was finished"),
    Outcome.VEHICLE_FAILED: message("Failed: the vehicle or its link failed"),
    Outcome.RULE_BROKEN: message("Failed: a rule of the mission was broken"),
    Outcome.NOT_REACHED: message("Failed: not every goal was reached"),
}
"""How a mission ended."""

ORDER_WORDS: dict[Order, Message] = {
    Order.HOLD: message("hold"),
    Order.CONTINUE: message("continue"),
    Order.RETURN: message("return"),
    Order.LAND: message("land"),
    Order.ABORT: message("abort"),
}
"""Orders, as they are said."""

REPLY_WORDS: dict[Reply, Message] = {
    Reply.YES: message("Yes"),
    Reply.NO: message("No"),
    Reply.UNSURE: message("Don't know"),
    Reply.TIMEOUT: message("No answer"),
}
"""Replies that name no option, as a person would say them."""


def say(gap: KnowledgeGap, values: Iterable[str]) -> Message:
    """What it means that the gap has one of these values, as a clause without a full stop."""
    wanted = [value for value in gap.values if value in set(values)]
    what, sole = Named(gap.description), wanted[0] if len(wanted) == 1 else ""
    if gap.kind is GapKind.OBSTACLE and sole == PASSABLE:
        return message("{what} can be flown through", what=what)
    if gap.kind is GapKind.OBSTACLE and sole == BLOCKED:
        return message("{what} cannot be flown through", what=what)
    if gap.is_thing and sole:
        return message("{what} is a person", what=what) if sole == PRESENT else message("{what} is nobody", what=what)
    if gap.kind is GapKind.PRESENCE and sole:
        if sole == PRESENT:
            return message("somebody is in {what}", what=what)
        return message("nobody is in {what}", what=what)
    if gap.kind is GapKind.TARGET:
        return message("“{phrase}” means {what}", phrase=Named(gap.subject), what=_any_of(gap, wanted))
    return message("{what}: {values}", what=what, values=_any_of(gap, wanted))


def say_bare(gap_id: str, values: Iterable[str]) -> Message:
    """The same of a gap of which only the id is known."""
    return verbatim(f"{gap_id}: {' / '.join(sorted(values))}")


def say_assumptions(given: Assumptions, gaps: Iterable[KnowledgeGap]) -> Message:
    """All assumptions as one line; those about gaps that are not given are said by their ids."""
    known = {gap.id: gap for gap in gaps}
    clauses = [
        say(known[gap_id], values) if gap_id in known else say_bare(gap_id, values)
        for gap_id, values in given.items
        if gap_id not in known or len(values) < len(known[gap_id].values)
    ]
    return joined(clauses, "; ") or message("nothing assumed")


def say_query(query: Query, gaps: Iterable[KnowledgeGap]) -> Message:
    """What a Yes to the query says, or what a choice is among; gaps that are not given are named by their ids."""
    if query.is_choice:
        return message("which of: {parts}", parts=", ".join(query.part_words(n) for n in range(query.part_count)))
    known = {gap.id: gap for gap in gaps}
    said = [say(known[x.gap], x.values) if x.gap in known else say_bare(x.gap, x.values) for x in query.literals]
    whole = said[0]
    for one in said[1:]:
        every = message("{first} and {second}", first=whole, second=one)
        whole = every if query.combine is Combine.ALL else message("{first} or {second}", first=whole, second=one)
    return whole


def say_evidence(evidence: Evidence, gaps: Iterable[KnowledgeGap]) -> Message:
    """What was said of a query, in plain words."""
    if evidence.query.is_choice:
        return verbatim(evidence.query.part_words(evidence.part))
    said = say_query(evidence.query, gaps)
    return said if evidence.part == YES_PART else message("not: {what}", what=said)


_STAGES = {
    "survey": message("survey"),
    "perception": message("perception"),
    "mapping": message("mapping"),
    "deliberation": message("deliberation"),
    "wording": message("wording"),
    "answer": message("answer"),
    "planning": message("planning"),
    "navigation": message("navigation"),
    "flight": message("flight"),
}


def stage_words(stage: str) -> Message:
    """A stage of the work, by its name in the record."""
    return _STAGES.get(stage) or verbatim(stage)


def printable(text: str) -> str:
    """The text without control characters, which labels and answers from outside may carry."""
    return "".join(character if character.isprintable() else " " for character in text)


def _any_of(gap: KnowledgeGap, values: list[str]) -> Message:
    names = {c.id: c.description or c.id for c in gap.candidates}
    words: list[Named | Message] = [Named(names[v]) if v in names else _VALUES.get(v) or verbatim(v) for v in values]
    if not words:
        return message("nothing")
    if len(words) > 4:
        words = [*words[:3], message("{count} others", count=len(words) - 3)]
    if len(words) == 1:
        return joined(words)
    return message("{first} or {second}", first=joined(words[:-1], ", "), second=words[-1])


_VALUES = {
    "none of them": message("none of them"),
    "not yet seen": message("not yet seen"),
    "not here": message("not here"),
    "passable": message("free"),
    "blocked": message("blocked"),
    "present": message("somebody is there"),
    "absent": message("nobody is there"),
}
"""Values that are no candidates."""
