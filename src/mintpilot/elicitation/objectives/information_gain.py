"""The paper's objective: bits that the answer tells of the plan class."""

from __future__ import annotations

import numpy as np

from mintpilot.core.geometry import Floats
from mintpilot.core.ports import QueryObjective, QuerySituation
from mintpilot.elicitation.objectives.channel import class_masses, heard, plog2p

NOTHING = 1e-9
"""Gains up to this come from rounding."""
FALLBACK = 1e-3
"""Weight of gains about joint hypotheses where no cut tells anything of the class by itself."""


class InformationGain(QueryObjective):
    """Mutual information of answer and plan class: H(T) - E[H(T | y)], bits (method, section 4).

    Where classes differ but no single answer tells of them (one gap decides only together with another), cuts are
    ranked by a thousandth of what they tell of the joint hypothesis, so that asking goes on.
    """

    def scores(self, situation: QuerySituation) -> Floats:
        """Bits (q,), each from 0 to 1."""
        gain = class_gain_bits(situation)
        if len(gain) and gain.max() <= NOTHING and np.unique(situation.class_of).size > 1:
            apart = QuerySituation(
                probability=situation.probability,
                class_of=np.arange(situation.probability.size),
                regret_s=situation.regret_s,
                yes=situation.yes,
                settings=situation.settings,
            )
            return FALLBACK * class_gain_bits(apart)
        return gain


def class_gain_bits(situation: QuerySituation) -> Floats:
    """Mutual information of each cut's answer and the plan class (q,), bits."""
    if not len(situation.yes):
        return np.zeros(0)
    yes, no = heard(*class_masses(situation), situation.settings.answer_error)
    total: Floats = np.asarray(np.bincount(situation.class_of, weights=situation.probability), float)
    joint = plog2p(yes).sum(axis=1) + plog2p(no).sum(axis=1)
    gain = joint - plog2p(yes.sum(axis=1)) - plog2p(no.sum(axis=1)) - plog2p(total).sum()
    bits: Floats = np.clip(gain, 0.0, 1.0)
    bits[bits <= NOTHING] = 0.0
    return bits
