"""What an answer does to the mass of the plan classes, answer error included."""

from __future__ import annotations

import numpy as np

from mintpilot.core.geometry import Floats
from mintpilot.core.ports import QuerySituation

SMALL = 1 << 14
"""Up to this many cells, one product of matrices is quicker than a loop over cuts."""


def class_masses(situation: QuerySituation, *, weight: Floats | None = None) -> tuple[Floats, Floats]:
    """Mass of each plan class together with the true answer Yes, and together with No; both of shape (q, m).

    Args:
        situation: hypotheses, classes and cuts.
        weight: (n,) instead of the probabilities.
    """
    p = situation.probability if weight is None else weight
    classes = int(situation.class_of.max()) + 1
    if classes * p.size <= SMALL:
        yes: Floats = situation.yes.astype(float) @ (p[:, None] * (situation.class_of[:, None] == np.arange(classes)))
    else:
        yes = np.empty((len(situation.yes), classes))
        for row, cut in zip(yes, situation.yes, strict=True):
            row[:] = np.bincount(situation.class_of[cut], weights=p[cut], minlength=classes)
    total = np.bincount(situation.class_of, weights=p, minlength=classes)
    no: Floats = np.maximum(total - yes, 0.0)
    return yes, no


def heard(yes: Floats, no: Floats, error: float) -> tuple[Floats, Floats]:
    """The same masses for the answers as heard: each is the opposite of the truth with probability ``error``."""
    return (1 - error) * yes + error * no, (1 - error) * no + error * yes


def plog2p(mass: Floats) -> Floats:
    """``mass * log2(mass)``, 0 at 0."""
    out: Floats = mass * np.log2(np.where(mass > 0, mass, 1.0))
    return out
