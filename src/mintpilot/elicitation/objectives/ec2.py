"""Equivalence class edge cutting: near-optimal where the decision, not the hypothesis, is what counts."""

from __future__ import annotations

import numpy as np

from mintpilot.core.geometry import Floats
from mintpilot.core.ports import QueryObjective, QuerySituation
from mintpilot.elicitation.objectives.channel import class_masses

NOTHING = 1e-12


class Ec2(QueryObjective):
    """Expected weight of the edges that the answer cuts, as a share of all edges.

    Two joint hypotheses of different plan classes are joined by an edge that weighs the product of their probabilities
    (Golovin, Krause and Ray 2010). With answer error e, an answer discounts the hypotheses that disagree by e / (1 - e)
    instead of removing them, less what an answer that tells nothing would discount (Chen, Hassani and Krause 2017).
    """

    def scores(self, situation: QuerySituation) -> Floats:
        """Shares (q,), each from 0 to 1; 0 where all hypotheses are of one class."""
        if not len(situation.yes):
            return np.zeros(0)
        error = situation.settings.answer_error
        discount = error / (1 - error)
        yes, no = class_masses(situation)
        total: Floats = np.asarray(np.bincount(situation.class_of, weights=situation.probability), float)
        edges = _edges(total[None, :])
        if edges[0] <= NOTHING:
            return np.zeros(len(yes))
        says_yes = (1 - error) * yes.sum(axis=1) + error * no.sum(axis=1)
        cut = says_yes * self._cut(yes, no, edges, discount) + (1 - says_yes) * self._cut(no, yes, edges, discount)
        share: Floats = np.clip(cut / edges, 0.0, 1.0)
        share[share <= NOTHING] = 0.0
        return share

    @staticmethod
    def _cut(agree: Floats, disagree: Floats, edges: Floats, discount: float) -> Floats:
        """Weight (q,) that one answer cuts, beyond what it would cut if it told nothing."""
        highest = np.where(agree.sum(axis=1) > NOTHING, 1.0, discount)
        return highest**2 * edges - _edges(agree + discount * disagree)


def _edges(mass: Floats) -> Floats:
    """Weight of all edges between classes with these masses (q, m): half of (sum)^2 - sum of squares."""
    weight: Floats = (mass.sum(axis=1) ** 2 - (mass**2).sum(axis=1)) / 2
    return weight
