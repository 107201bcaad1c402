"""What an answer says beyond its question (method, section 5): ``not the red one, the blue one``."""

from __future__ import annotations

from mintpilot.core.gap import Belief
from mintpilot.core.mission import AskingSettings
from mintpilot.core.query import Answer, Query, Reply
from mintpilot.reasoning.belief import condition


def with_extra_evidence(
    before: Belief, after: Belief, query: Query, answer: Answer, settings: AskingSettings
) -> tuple[Belief, bool]:
    """The belief with what an answer says beyond the question, and whether that was refused as a contradiction.

    Words that settle the question by themselves (``the blue one``) are one piece of evidence, not two: only they count
    then, since an answer may be wrong as a whole. Nothing of it is an explicit yes that opens a region.

    Args:
        before: what was believed before the answer.
        after: the same with the answer to the question itself.
        query: what was asked.
        answer: Yes or No, with what was said besides; cuts about gaps that are not open are left out.
        settings: the answer error.
    """
    known = {gap.id for gap in before.gaps}
    also = [(cut, yes) for cut, yes in answer.also if set(cut.gap_ids) <= known]
    belief = after
    for cut, yes in also:
        whole = len(also) == 1 and _settles(cut, yes, query, answer, before)
        update = condition(before if whole else belief, cut, Reply.YES if yes else Reply.NO, settings.answer_error)
        if update.contradiction:
            return after, True
        belief = update.belief
    return belief, False


def _settles(cut: Query, yes: bool, query: Query, answer: Answer, belief: Belief) -> bool:
    """Whether that answer to the one cut leaves no other answer to the query; both about one and the same gap."""
    if len(cut.gap_ids) != 1 or cut.gap_ids != query.gap_ids:
        return False
    (name,) = cut.gap_ids
    (gap,) = (g for g in belief.gaps if g.id == name)
    left = [v for v in gap.values if cut.holds({name: v}) == yes]
    return bool(left) and all(query.holds({name: v}) == (answer.reply is Reply.YES) for v in left)
