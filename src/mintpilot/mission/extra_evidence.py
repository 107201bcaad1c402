"""What an answer says beyond its question (method, section 5): ``not the red one, the blue one``."""

from __future__ import annotations

from mintpilot.core.gap import Belief
from mintpilot.core.mission import AskingSettings
from mintpilot.core.query import Answer, Evidence, Query
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
        answer: one that names a part, with what was said besides; what is about gaps that are not open is left out.
        settings: the answer error.
    """
    known = {gap.id for gap in before.gaps}
    also = [one for one in answer.also if set(one.query.gap_ids) <= known]
    belief, error, most = after, settings.answer_error, settings.max_joint
    for one in also:
        whole = len(also) == 1 and _settles(one, query, answer, before)
        update = condition(before if whole else belief, one.query, one.part, error, max_joint=most)
        if update.contradiction:
            return after, True
        belief = update.belief
    return belief, False


def _settles(one: Evidence, query: Query, answer: Answer, belief: Belief) -> bool:
    """Whether that evidence leaves no other answer to the query; both about one and the same gap."""
    if len(one.query.gap_ids) != 1 or one.query.gap_ids != query.gap_ids:
        return False
    (name,) = query.gap_ids
    (gap,) = (g for g in belief.gaps if g.id == name)
    left = [v for v in gap.values if one.query.part_of({name: v}) == one.part]
    return bool(left) and all(query.part_of({name: v}) == answer.part for v in left)
