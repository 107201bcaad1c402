"""Seconds of expected regret that the answer saves, less the price of a question."""

from __future__ import annotations

import numpy as np

from mintpilot.core.geometry import Floats
from mintpilot.core.ports import QueryObjective, QuerySituation
from mintpilot.core.tolerances import TOLERANCE
from mintpilot.elicitation.objectives.channel import heard, part_sums


class ValueOfInformation(QueryObjective):
    """Expected regret now, less that after the answer, over its effort, less ``settings.question_price_s``.

    The price is that of a yes or no; what takes longer to answer costs more in proportion.
    """

    def scores(self, situation: QuerySituation) -> Floats:
        """Seconds (q,); 0 or less where the answer is not worth its price."""
        return regret_saved_s(situation) / situation.effort - situation.settings.question_price_s


def regret_saved_s(situation: QuerySituation) -> Floats:
    """Expected seconds of regret that each answer saves (q,), never below 0, if the best plan for it is then flown."""
    if not len(situation.parts) or not situation.regret_s.size:
        return np.zeros(len(situation.parts))
    loss = situation.regret_s * situation.probability
    after = heard(part_sums(situation, loss.T), situation).min(axis=2).sum(axis=1)
    saved: Floats = np.maximum(loss.sum(axis=1).min() - after, 0.0)
    saved[saved <= TOLERANCE] = 0.0
    return saved
