"""A yardstick: any query with information gain, at random."""

from __future__ import annotations

import numpy as np

from mintpilot.core.geometry import Floats
from mintpilot.core.ports import QueryObjective, QuerySituation
from mintpilot.elicitation.objectives.information_gain import InformationGain


class Random(QueryObjective):
    """Ranks the queries with information gain at random.

    Args:
        seed: of the draws. Same seed, same questions.
    """

    def __init__(self, seed: int = 0) -> None:
        self._rng = np.random.default_rng(seed)

    def scores(self, situation: QuerySituation) -> Floats:
        """Numbers (q,) above 0 for queries with gain, 0 for the others."""
        worth = InformationGain().scores(situation) > 0
        # 1 - random() is never 0: a query with gain is always worth more than nothing.
        drawn: Floats = np.where(worth, 1.0 - self._rng.random(len(worth)), 0.0)
        return drawn
