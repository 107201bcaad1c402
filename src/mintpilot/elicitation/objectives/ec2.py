"""Equivalence class edge cutting: near-optimal where the decision, not the hypothesis, is what counts."""

from __future__ import annotations

import numpy as np

from mintpilot.core.geometry import Floats
from mintpilot.core.ports import QueryObjective, QuerySituation
from mintpilot.core.tolerances import ROUNDING
from mintpilot.elicitation.objectives.channel import class_masses, heard


class Ec2(QueryObjective):
    """Expected weight of the edges that the answer cuts, as a share of all edges.

    Two joint hypotheses of different plan classes are joined by an edge that weighs the product of their probabilities
    (Golovin, Krause and Ray 2010). An answer discounts the hypotheses that disagree with it by the ratio of the
    probabilities of a wrong answer and of the right one, e / (1 - e) for a yes or no, instead of removing them, less
    what an answer without information would discount (Chen, Hassani and Krause 2017).
    """

    def scores(self, situation: QuerySituation) -> Floats:
        """Shares (q,), each from 0 to 1, over the effort of an answer; 0 where all hypotheses are of one class."""
        if not len(situation.parts):
            return np.zeros(0)
        total: Floats = np.asarray(np.bincount(situation.class_of, weights=situation.probability), float)
        edges = float(_edges(total))
        if edges <= ROUNDING:
            return np.zeros(len(situation.parts))
        masses = class_masses(situation)
        said = heard(masses.sum(axis=2, keepdims=True), situation)[:, :, 0]
        share: Floats = np.clip((said * self._cut(masses, edges, situation)).sum(axis=1) / edges, 0.0, 1.0)
        share[share <= ROUNDING] = 0.0
        return share / situation.effort

    @staticmethod
    def _cut(masses: Floats, edges: float, situation: QuerySituation) -> Floats:
        """Weight (q, r) that each answer cuts, beyond what an answer without information would cut."""
        error = situation.settings.answer_error
        discount = error / (1 - error) / (situation.part_count[:, None] - 1)
        highest = np.where(masses.sum(axis=2) > ROUNDING, 1.0, discount)
        left = masses + discount[:, :, None] * (masses.sum(axis=1, keepdims=True) - masses)
        cut: Floats = highest**2 * edges - _edges(left)
        return cut


def _edges(mass: Floats) -> Floats:
    """Weight of all edges between classes with these masses (…, m): half of (sum)^2 - sum of squares."""
    weight: Floats = (mass.sum(axis=-1) ** 2 - (mass**2).sum(axis=-1)) / 2
    return weight
