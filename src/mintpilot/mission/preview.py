"""Deliberation without a flight: what would be asked, and how many questions are to be expected."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, replace

from mintpilot.core.errors import InfeasibleError
from mintpilot.core.ports import Ask
from mintpilot.core.query import answer_for
from mintpilot.core.semantic_map import SemanticMap
from mintpilot.mission.deliberation import Deliberation, DeliberationParts
from mintpilot.mission.rehearsal import Rehearsal, begin

NEGLIGIBLE = 1e-3
"""Histories of answers less likely than this are counted as if they ended there."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Preview:
    """What asking would come to."""

    first: Deliberation
    """The deliberation that happens now."""
    expected_questions: float
    """Mean number of questions over the answers, weighted by the belief."""
    complete: bool
    """False when unlikely or very many histories of answers were cut off: the mean is then a lower bound."""


def preview(
    map: SemanticMap,
    parts: DeliberationParts,
    *,
    max_deliberations: int = 200,
    patience_s: float = 20.0,
    clock: Callable[[], float] = time.perf_counter,
) -> Preview:
    """Deliberates once, and then through every history of answers.

    Args:
        map: what is known.
        parts: what deliberation is done with.
        max_deliberations: bound on the work.
        patience_s: no further history of answers is begun after so many seconds.
        clock: tells them.

    Raises:
        InfeasibleError: nothing can be flown, whatever the answers are.
    """
    begun_s = clock()
    alone = replace(parts, proposer=None)  # only what would be asked now is worth a language model's time
    left = [max_deliberations]
    complete = [True]

    def expected(here: Rehearsal, weight: float, found: Deliberation | None = None) -> float:
        if found is None:
            if left[0] <= 0 or weight < NEGLIGIBLE or clock() - begun_s > patience_s:
                complete[0] = False
                return 0.0
            left[0] -= 1
            try:
                found = here.deliberated(alone)
            except InfeasibleError:
                return 0.0
        if not isinstance(found.decision, Ask):
            return 0.0
        scored, asked = found.decision.scored, here.asked(found)
        total = 1.0
        for part, share in enumerate(scored.reply_probabilities):
            if share > 0:
                total += share * expected(asked.answered(answer_for(scored.query, part)), weight * share)
        return total

    start = begin(parts, map)
    first = start.deliberated()
    return Preview(first=first, expected_questions=expected(start, 1.0, first), complete=complete[0])
