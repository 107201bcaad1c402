"""Assumptions, reasons and endings in plain words."""

from __future__ import annotations

from collections.abc import Iterable

from mintpilot.core.gap import BLOCKED, PASSABLE, PRESENT, Assumptions, GapKind, KnowledgeGap
from mintpilot.core.mission import Outcome
from mintpilot.core.query import YES_PART, Combine, Evidence, Query
from mintpilot.core.tree import LeafReason

LEAF_WORDS: dict[LeafReason, str] = {
    LeafReason.RELIES_ON_NOTHING: "depends on nothing unknown",
    LeafReason.CAUTIOUS_IS_GOOD_ENOUGH: "the safe way is good enough",
    LeafReason.TARGET_IS_CLEAR_ENOUGH: "the goal is clear enough",
    LeafReason.INFEASIBLE: "nothing safe can be flown",
    LeafReason.NOT_EXPANDED: "not worked out any further",
}
"""Why a branch of the tree ends."""

OUTCOME_WORDS: dict[Outcome, str] = {
    Outcome.SUCCESS: "Mission accomplished",
    Outcome.PARTIAL: "Done in part: some stops were left undone",
    Outcome.COLLISION: "Failed: the drone touched something",
    Outcome.TOXIC_SMOKE: "Failed: the drone flew into toxic smoke",
    Outcome.ENDURANCE: "Failed: the flight time ran out",
    Outcome.LEFT_VOLUME: "Failed: the drone left its allowed space",
    Outcome.WRONG_TARGET: "Failed: the wrong thing was reached",
    Outcome.PERSON_MISSED: "Failed: somebody was not found",
    Outcome.NO_SAFE_PLAN: "Not flown: no safe way was known",
    Outcome.ABORTED: "Ended before it was finished",
    Outcome.VEHICLE_FAILED: "Failed: the vehicle or its link failed",
    Outcome.RULE_BROKEN: "Failed: a rule of the mission was broken",
    Outcome.NOT_REACHED: "Failed: not every goal was reached",
}
"""How a mission ended."""


def say(gap: KnowledgeGap, values: Iterable[str]) -> str:
    """What it means that the gap has one of these values, as a clause without a full stop."""
    wanted = [value for value in gap.values if value in set(values)]
    if gap.kind is GapKind.OBSTACLE and len(wanted) == 1 and wanted[0] in (PASSABLE, BLOCKED):
        return f"{gap.description} {'can' if wanted[0] == PASSABLE else 'cannot'} be flown through"
    if gap.is_thing and len(wanted) == 1:
        return f"{gap.description} is {'a person' if wanted[0] == PRESENT else 'nobody'}"
    if gap.kind is GapKind.PRESENCE and len(wanted) == 1:
        return f"{'somebody' if wanted[0] == PRESENT else 'nobody'} is in {gap.description}"
    if gap.kind is GapKind.TARGET:
        return (
            f"\N{LEFT DOUBLE QUOTATION MARK}{gap.subject}\N{RIGHT DOUBLE QUOTATION MARK} means {_any_of(gap, wanted)}"
        )
    return f"{gap.description}: {_any_of(gap, wanted)}"


def say_assumptions(given: Assumptions, gaps: Iterable[KnowledgeGap]) -> str:
    """All assumptions as one line; those about gaps that are not given are said by their ids."""
    known = {gap.id: gap for gap in gaps}
    clauses = [
        say(known[gap_id], values) if gap_id in known else f"{gap_id}: {' or '.join(sorted(values))}"
        for gap_id, values in given.items
        if gap_id not in known or len(values) < len(known[gap_id].values)
    ]
    return "; ".join(clauses) or "nothing assumed"


def say_query(query: Query, gaps: Iterable[KnowledgeGap]) -> str:
    """What a Yes to the query says, or what a choice is among; gaps that are not given are named by their ids."""
    if query.is_choice:
        return f"which of: {', '.join(query.part_words(part) for part in range(query.part_count))}"
    known = {gap.id: gap for gap in gaps}
    clauses = [
        say(known[x.gap], x.values) if x.gap in known else f"{x.gap}: {' or '.join(sorted(x.values))}"
        for x in query.literals
    ]
    return (" and " if query.combine is Combine.ALL else " or ").join(clauses)


def say_evidence(evidence: Evidence, gaps: Iterable[KnowledgeGap]) -> str:
    """What was said of a query, in plain words."""
    if evidence.query.is_choice:
        return evidence.query.part_words(evidence.part)
    return f"{'' if evidence.part == YES_PART else 'not: '}{say_query(evidence.query, gaps)}"


def printable(text: str) -> str:
    """The text without control characters, which labels and answers from outside may carry."""
    return "".join(character if character.isprintable() else " " for character in text)


def _any_of(gap: KnowledgeGap, values: list[str]) -> str:
    names = {c.id: c.description or c.id for c in gap.candidates}
    words = [names.get(value, value) for value in values]
    if len(words) > 4:
        words = [*words[:3], f"{len(words) - 3} others"]
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} or {words[-1]}" if words else "nothing"
