"""Deliberation without a flight: what would be asked, and how many questions are to be expected."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from mintpilot.core.errors import InfeasibleError, LimitError
from mintpilot.core.ports import Ask
from mintpilot.core.query import answer_for
from mintpilot.core.semantic_map import SemanticMap
from mintpilot.mission.deliberation import Deliberation, DeliberationParts
from mintpilot.mission.rehearsal import Rehearsal, begin

SAMPLES = 40
"""So many histories of answers are played where there are too many to go through them all."""
LONGEST = 60
"""A played history has at most so many questions."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Preview:
    """What asking would come to."""

    first: Deliberation
    """The deliberation that happens now."""
    expected_questions: float
    """Mean number of questions over the answers, weighted by the belief."""
    played: int = 0
    """0: exact, over all histories of answers. Else the mean over so many histories drawn from the belief."""
    error: float = 0.0
    """Standard error of a played mean."""


def preview(map: SemanticMap, parts: DeliberationParts, *, max_deliberations: int = 60) -> Preview:
    """Deliberates once, and then through the histories of answers: all of them, or drawn ones where they are too many.

    Args:
        map: what is known.
        parts: what deliberation is done with.
        max_deliberations: bound on going through all histories; beyond it `SAMPLES` of them are played.

    Raises:
        InfeasibleError: nothing can be flown, whatever the answers are.
    """
    start = begin(parts, map)
    first = start.deliberated()
    # Only what would be asked now is worth a language model's time.
    histories = _Histories(start, first, replace(parts, proposer=None))
    try:
        exact = histories.expected((), max_deliberations)
        return Preview(first=first, expected_questions=exact)
    except LimitError:
        counts = histories.played(SAMPLES)
        error = float(np.std(counts, ddof=1) / np.sqrt(len(counts)))
        return Preview(first=first, expected_questions=float(np.mean(counts)), played=len(counts), error=error)


class _Histories:
    """Deliberations by the answers that led to them, each worked out once."""

    def __init__(self, start: Rehearsal, first: Deliberation, parts: DeliberationParts) -> None:
        self._parts = parts
        self._known: dict[tuple[int, ...], tuple[Rehearsal, Deliberation] | None] = {(): (start, first)}

    def _after(self, answers: tuple[int, ...]) -> tuple[Rehearsal, Deliberation] | None:
        """What is deliberated after those answers; None: nothing can be flown any more."""
        if answers not in self._known:
            before = self._after(answers[:-1])
            assert before is not None
            here, found = before
            assert isinstance(found.decision, Ask)
            answered = here.asked(found).answered(answer_for(found.decision.scored.query, answers[-1]))
            try:
                self._known[answers] = (answered, answered.deliberated(self._parts))
            except InfeasibleError:
                self._known[answers] = None
        return self._known[answers]

    def expected(self, answers: tuple[int, ...], most: int) -> float:
        """Mean number of further questions, exactly. Raises `LimitError` beyond so many deliberations."""
        if len(self._known) > most:
            raise LimitError("too many histories of answers")
        reached = self._after(answers)
        if reached is None or not isinstance(reached[1].decision, Ask):
            return 0.0
        shares = reached[1].decision.scored.reply_probabilities
        return 1.0 + sum(
            share * self.expected((*answers, part), most) for part, share in enumerate(shares) if share > 0
        )

    def played(self, samples: int) -> list[int]:
        """Numbers of questions in histories drawn from the belief."""
        rng = np.random.default_rng(0)
        counts = []
        for _ in range(samples):
            answers: tuple[int, ...] = ()
            while len(answers) < LONGEST:
                reached = self._after(answers)
                if reached is None or not isinstance(reached[1].decision, Ask):
                    break
                shares = np.asarray(reached[1].decision.scored.reply_probabilities)
                answers = (*answers, int(rng.choice(len(shares), p=shares / shares.sum())))
            counts.append(len(answers))
        return counts
