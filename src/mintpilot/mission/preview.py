"""Deliberation without a flight: what would be asked, and how many questions are to be expected."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from mintpilot.core.errors import InfeasibleError
from mintpilot.core.ports import Ask
from mintpilot.core.query import answer_for
from mintpilot.core.semantic_map import SemanticMap
from mintpilot.mission.deliberation import Deliberation, DeliberationParts
from mintpilot.mission.rehearsal import Rehearsal, begin

SEED = 0
"""Of the histories that are drawn where there are too many to follow: the same mission gives the same figure."""
MAX_QUESTIONS = 1000
"""Bound on the length of one history that is drawn."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Preview:
    """What asking would come to."""

    first: Deliberation
    """The deliberation that happens now."""
    expected_questions: float
    """Mean number of questions over the answers, weighted by the belief."""
    complete: bool
    """True: exact, every history of answers was followed. False: an estimate from histories that were drawn."""
    histories: int = 0
    """How many histories were drawn for an estimate; 0 where it is exact."""
    standard_error: float = 0.0
    """Of the estimate; 0 where it is exact."""


class _TooMany(Exception):
    """There are more histories of answers than may be followed."""


def preview(
    map: SemanticMap, parts: DeliberationParts, *, max_deliberations: int = 200, histories: int = 40
) -> Preview:
    """Deliberates once, and then through every history of answers; where those are too many, through drawn ones.

    All bounds count work, never wall time: the same mission gives the same figure on any machine.

    Args:
        map: what is known.
        parts: what deliberation is done with.
        max_deliberations: bound on following every history.
        histories: how many are drawn, each answer as likely as it is expected, where that bound is met.

    Raises:
        InfeasibleError: nothing can be flown, whatever the answers are.
    """
    alone = replace(parts, proposer=None)  # only what would be asked now is worth a language model's time
    start = begin(parts, map)
    first = start.deliberated()
    try:
        return Preview(
            first=first, expected_questions=_followed(start, first, alone, [max_deliberations]), complete=True
        )
    except _TooMany:
        rng = np.random.default_rng(SEED)
        counts = np.array([_drawn(start, first, alone, rng) for _ in range(max(2, histories))], float)
        error = float(counts.std(ddof=1) / np.sqrt(len(counts)))
        return Preview(
            first=first,
            expected_questions=float(counts.mean()),
            complete=False,
            histories=len(counts),
            standard_error=error,
        )


def _followed(here: Rehearsal, found: Deliberation | None, parts: DeliberationParts, left: list[int]) -> float:
    """The exact mean number of questions from here on; ``left`` counts deliberations down."""
    if found is None:
        if left[0] <= 0:
            raise _TooMany
        left[0] -= 1
        found = _deliberated(here, parts)
    if found is None or not isinstance(found.decision, Ask):
        return 0.0
    scored, asked = found.decision.scored, here.asked(found)
    below = (
        share * _followed(asked.answered(answer_for(scored.query, part)), None, parts, left)
        for part, share in enumerate(scored.reply_probabilities)
        if share > 0
    )
    return 1.0 + sum(below)


def _drawn(start: Rehearsal, first: Deliberation, parts: DeliberationParts, rng: np.random.Generator) -> int:
    """How many questions are asked when each answer is drawn with the probability with which it is expected."""
    here, found = start, first
    for count in range(MAX_QUESTIONS):
        if not isinstance(found.decision, Ask):
            return count
        scored = found.decision.scored
        shares = np.asarray(scored.reply_probabilities, float)
        part = int(rng.choice(len(shares), p=shares / shares.sum()))
        here = here.asked(found).answered(answer_for(scored.query, part))
        again = _deliberated(here, parts)
        if again is None:
            return count + 1
        found = again
    return MAX_QUESTIONS


def _deliberated(here: Rehearsal, parts: DeliberationParts) -> Deliberation | None:
    """None where nothing can be flown."""
    try:
        return here.deliberated(parts)
    except InfeasibleError:
        return None
