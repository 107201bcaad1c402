"""Seconds of expected regret that the answer saves, less the price of a question."""

from __future__ import annotations

import numpy as np

from mintpilot.core.geometry import Floats
from mintpilot.core.ports import QueryObjective, QuerySituation

NOTHING = 1e-9


class ValueOfInformation(QueryObjective):
    """Expected regret now, less that after the answer, less ``settings.question_price_s``."""

    def scores(self, situation: QuerySituation) -> Floats:
        """Seconds (q,); 0 or less where the answer is not worth its price."""
        return regret_saved_s(situation) - situation.settings.question_price_s


def regret_saved_s(situation: QuerySituation) -> Floats:
    """Expected seconds of regret that each answer saves (q,), never below 0, if the best plan for it is then flown."""
    if not len(situation.yes) or not situation.regret_s.size:
        return np.zeros(len(situation.yes))
    error = situation.settings.answer_error
    loss = situation.regret_s * situation.probability
    total = loss.sum(axis=1)
    yes = situation.yes.astype(float) @ loss.T
    no = np.maximum(total - yes, 0.0)
    after = ((1 - error) * yes + error * no).min(axis=1) + ((1 - error) * no + error * yes).min(axis=1)
    saved: Floats = np.maximum(total.min() - after, 0.0)
    saved[saved <= NOTHING] = 0.0
    return saved
