"""From a query to a question with words and consequences. Words never decide meaning (method, section 4)."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from mintpilot.core.gap import NO_THING, PASSABLE, GapKind, KnowledgeGap
from mintpilot.core.geometry import Bools
from mintpilot.core.plan import Plan
from mintpilot.core.query import NO_PART, YES_PART, Query, Question
from mintpilot.core.threshold import ValueKind
from mintpilot.core.tolerances import TOLERANCE
from mintpilot.core.tree import Mint
from mintpilot.elicitation.phrases import joined, subject_of, thing_called
from mintpilot.elicitation.sentences import sentence

MOST_NAMED = 2
"""So many candidates that are left are named; more are counted."""
NOT_SEEN = "I take it that it was not seen"
"""What follows when a phrase means none of the things that were seen."""
NO_FURTHER = "I look no further for it"
"""What follows when what is sought is in none of the zones that were not seen."""


def word_question(query: Query, gaps: Sequence[KnowledgeGap], mint: Mint | None, *, attempt: int = 1) -> Question:
    """The question for a query, by template: at most 20 words, never negated, with what each answer does to the flight.

    Args:
        query: what is asked.
        gaps: at least the gaps that it speaks of.
        mint: the tree that it was chosen on, for the consequences; None gives general ones.
        attempt: from 2 on the same query is put in other words.

    Raises:
        KeyError: a gap of the query is not among ``gaps``.
    """
    known = {g.id: g for g in gaps}
    about = tuple(known[name] for name in query.gap_ids)
    means = _consequences(query, about, mint)
    return Question(
        query=query,
        text=sentence(query, known, attempt),
        yes_means="" if query.is_choice else means[YES_PART],
        no_means="" if query.is_choice else means[NO_PART],
        option_means=means if query.is_choice else (),
        gaps=about,
        attempt=attempt,
    )


def _consequences(query: Query, about: tuple[KnowledgeGap, ...], mint: Mint | None) -> tuple[str, ...]:
    """What follows from each answer for the flight: the likeliest plan."""
    if mint is None or not set(query.gap_ids) <= {g.id for g in mint.belief.gaps}:
        return tuple(_general(query, about, part) for part in range(query.part_count))
    table = query.part_table(mint.belief)
    plans = [_likeliest(mint, table == part) for part in range(query.part_count)]
    texts = []
    for part, (plan, sure) in enumerate(plans):
        text = _flight(plan, sure, about, _left(query, about, part, mint))
        others = [other for i, (other, _) in enumerate(plans) if i != part]
        costs = [other.cost_s for other in others if other is not None]
        longer = plan.cost_s - min(costs) if plan is not None and costs else 0.0
        settled = all(other_sure for _, other_sure in plans)
        texts.append(f"{text}, {longer:.0f} s longer" if settled and longer >= 1 else text)
    # The likeliest flight may be the same after both answers: then it is told what else an answer makes possible.
    return tuple(
        _may_enter(mint, table == part, about) or f"{text}, {_share(mint, table == part, plans[part][0]):.0%} likely"
        if texts.count(text) > 1
        else text
        for part, text in enumerate(texts)
    )


def _may_enter(mint: Mint, agrees: Bools, about: tuple[KnowledgeGap, ...]) -> str:
    """That regions may be flown through after an answer; empty where no plan that is left does so."""
    if {gap.kind for gap in about} != {GapKind.OBSTACLE}:
        return ""
    left = set(mint.class_of[agrees & (mint.belief.probability > 0)].ravel().tolist())
    entered = {gap for n in left if n >= 0 and (plan := mint.classes[n].plan) is not None for gap in plan.enters}
    return f"I may fly through {'it' if len(about) == 1 else 'them'}" if entered & {g.id for g in about} else ""


def _share(mint: Mint, agrees: Bools, plan: Plan | None) -> float:
    """Probability, after an answer, of the plan class with that plan."""
    held = np.where(agrees, mint.belief.probability, 0.0)
    number = next(n for n, one in enumerate(mint.classes) if one.plan is plan)
    return float(held[mint.class_of == number].sum() / max(held.sum(), TOLERANCE))


def _left(query: Query, about: tuple[KnowledgeGap, ...], part: int, mint: Mint) -> str:
    """Of a query about one referent: which candidates an answer leaves, and that it is asked further."""
    if len(about) != 1 or about[0].kind is not GapKind.TARGET:
        return ""
    gap = about[0]
    chances = mint.belief.marginal(gap.id)
    left = [v for v, p in zip(gap.values, chances, strict=True) if p > 0 and query.part_of({gap.id: v}) == part]
    things = [value for value in left if value not in NO_THING]
    if left and not things:
        return NO_FURTHER if gap.is_search else NOT_SEEN
    if len(things) == 1 and len(left) > 1:
        return f"I ask further: {thing_called(gap, things[0])}"
    left = things
    if len(left) == 1:
        return f"I probably fly to {thing_called(gap, left[0])}"
    if len(left) <= MOST_NAMED:
        return f"I ask further: {joined([thing_called(gap, value) for value in left], 'or')}"
    return f"I ask further: {len(left)} {'of them' if part == YES_PART else 'others'} are left"


def _likeliest(mint: Mint, agrees: Bools) -> tuple[Plan | None, bool]:
    """The plan that an answer makes likeliest, and whether no other plan is left then."""
    held = np.where(agrees & (mint.class_of >= 0), mint.belief.probability, 0.0)
    mass = np.bincount(np.maximum(mint.class_of, 0).ravel(), weights=held.ravel(), minlength=len(mint.classes))
    best = int(np.argmax(mass))
    return mint.classes[best].plan, bool(np.count_nonzero(mass) <= 1)


def _flight(plan: Plan | None, sure: bool, about: tuple[KnowledgeGap, ...], left: str) -> str:
    if left in (NOT_SEEN, NO_FURTHER):
        return left
    if plan is None:
        return "I find no safe way" if sure else "I may find no safe way"
    i = "I" if sure else "I probably"
    kinds = {g.kind for g in about}
    if kinds == {GapKind.OBSTACLE}:
        entered = [g for g in about if g.id in plan.enters]
        value = about[0].threshold
        if value is not None and {g.threshold.of if g.threshold else "" for g in about} == {value.of}:
            through = "through" if value.kind is ValueKind.CLEARANCE else "under"
            return f"{i} fly {through if entered else 'around'} it"
        if not entered:
            return f"{i} fly around {'it' if len(about) == 1 else 'them'}"
        return f"{i} fly through {'it' if len(about) == 1 else joined([subject_of(g) for g in entered], 'and')}"
    if kinds == {GapKind.PRESENCE}:
        undone = {one.stop.gap for one in plan.leaves_undone}
        visited = [g for g in about if g.id not in plan.skips | undone]
        if len(about) == 1 and about[0].id in undone:
            return f"{i} cannot reach it, and do what else I can"
        if about[0].is_thing and visited:
            return f"{i} fly to {'it' if len(about) == 1 else joined([subject_of(g) for g in visited], 'and')}"
        if not visited:
            return f"{i} fly past it" if len(about) == 1 else f"{i} fly past them"
        if len(about) == 1:
            return f"{i} look inside"
        return f"{i} look into {joined([subject_of(g) for g in visited], 'and')}"
    bound = dict(plan.binds)
    if len(about) == 1 and about[0].id in bound:
        if not sure:
            return left
        return f"I fly to {thing_called(about[0], bound[about[0].id])}"
    return f"{i} fly for {plan.cost_s:.0f} s"


def _general(query: Query, about: tuple[KnowledgeGap, ...], part: int) -> str:
    """Consequences where there is no tree to take them from."""
    if query.is_choice:
        return "I plan with this"
    yes = part == YES_PART
    it = "it" if len(about) == 1 else "them"
    kinds = {g.kind for g in about}
    if kinds == {GapKind.OBSTACLE} and all(PASSABLE in g.values for g in about):
        return f"I may fly through {it}" if yes else f"I fly around {it}"
    if kinds == {GapKind.PRESENCE}:
        there = f"I fly to {it}" if about[0].is_thing else "I look inside"
        return there if yes else f"I fly past {it}"
    if kinds == {GapKind.TARGET}:
        return "I take it that you mean that" if yes else "I take it that you mean another"
    return "I plan with this" if yes else "I plan with the opposite"
