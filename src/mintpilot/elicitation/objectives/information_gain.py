"""The paper's objective: information gain on the plan class, bits."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from mintpilot.core.geometry import Floats
from mintpilot.core.ports import QueryObjective, QuerySituation
from mintpilot.core.tolerances import TOLERANCE
from mintpilot.elicitation.objectives.channel import class_masses, heard, plog2p

FALLBACK = 1e-3
"""Weight of gains about joint hypotheses where no query has a gain on the class by itself."""


class InformationGain(QueryObjective):
    """Mutual information of answer and plan class: H(T) - E[H(T | y)], bits (method, section 4).

    Where classes differ but no single query has a gain on them (one gap decides only together with another), queries
    are ranked by a thousandth of their gain on the joint hypothesis, so that asking goes on.
    """

    def scores(self, situation: QuerySituation) -> Floats:
        """Bits (q,), each from 0 to log2 of the number of parts, over the effort that an answer takes."""
        gain = class_gain_bits(situation) / situation.effort
        if len(gain) and gain.max() <= TOLERANCE and np.unique(situation.class_of).size > 1:
            single = replace(situation, class_of=np.arange(situation.probability.size))
            return FALLBACK * class_gain_bits(single) / situation.effort
        return gain


def class_gain_bits(situation: QuerySituation) -> Floats:
    """Mutual information of each query's answer and the plan class (q,), bits."""
    if not len(situation.parts):
        return np.zeros(0)
    named = heard(class_masses(situation), situation)
    total: Floats = np.asarray(np.bincount(situation.class_of, weights=situation.probability), float)
    joint = plog2p(named).sum(axis=(1, 2))
    gain = joint - plog2p(named.sum(axis=2)).sum(axis=1) - plog2p(total).sum()
    bits: Floats = np.clip(gain, 0.0, np.log2(situation.part_count.astype(float)))
    bits[bits <= TOLERANCE] = 0.0
    return bits
