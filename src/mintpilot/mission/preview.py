"""Deliberation without a flight: what would be asked, and how many questions are to be expected."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, replace

from mintpilot.core.errors import InfeasibleError
from mintpilot.core.geometry import Vec3
from mintpilot.core.ports import Ask
from mintpilot.core.query import answer_for
from mintpilot.mission.mind import Mind, Thinking, Thought, learn, think

NEGLIGIBLE = 1e-3
"""Histories of answers less likely than this are counted as if they ended there."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Preview:
    """What asking would come to."""

    first: Thought
    """The deliberation that happens now."""
    expected_questions: float
    """Mean number of questions over the answers, weighted by the belief."""
    complete: bool
    """False when unlikely or very many histories of answers were cut off: the mean is then a lower bound."""


def preview(
    mind: Mind,
    parts: Thinking,
    *,
    start_m: Vec3,
    endurance_s: float,
    max_deliberations: int = 200,
    patience_s: float = 20.0,
    clock: Callable[[], float] = time.perf_counter,
) -> Preview:
    """Thinks once, and then through every history of answers.

    Args:
        mind: what is known.
        parts: what thinking is done with.
        start_m: where the drone is, metres.
        endurance_s: flight time that a plan may use, seconds.
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

    def expected(here: Mind, weight: float, thought: Thought | None = None) -> float:
        if thought is None:
            if left[0] <= 0 or weight < NEGLIGIBLE or clock() - begun_s > patience_s:
                complete[0] = False
                return 0.0
            left[0] -= 1
            try:
                thought = think(here, alone, start_m=start_m, endurance_s=endurance_s)
            except InfeasibleError:
                return 0.0
        if not isinstance(thought.decision, Ask):
            return 0.0
        scored = thought.decision.scored
        total = 1.0
        for part, share in enumerate(scored.reply_probabilities):
            if share > 0:
                lesson = learn(thought.mind, scored.query, answer_for(scored.query, part), parts.settings)
                total += share * expected(lesson.mind, weight * share)
        return total

    first = think(mind, parts, start_m=start_m, endurance_s=endurance_s)
    return Preview(first=first, expected_questions=expected(mind, 1.0, first), complete=complete[0])
