"""What an answer does to the mass of the joint hypotheses, answer error included."""

from __future__ import annotations

import numpy as np

from mintpilot.core.geometry import Floats
from mintpilot.core.ports import QuerySituation

SMALL = 1 << 14
"""Up to this many cells, one product of matrices is quicker than a loop over queries."""


def part_sums(situation: QuerySituation, weight: Floats) -> Floats:
    """Sums of weights (n, c) of the joint hypotheses over each part of each query: (q, r, c), r the most parts.

    Parts that a query does not have sum to 0.
    """
    most = int(situation.part_count.max(initial=2))
    sums: Floats = np.empty((len(situation.parts), most, weight.shape[1]))
    for part in range(most - 1):
        sums[:, part] = (situation.parts == part).astype(float) @ weight
    _close(sums, situation, weight.sum(axis=0))
    return sums


def class_masses(situation: QuerySituation) -> Floats:
    """Mass of each plan class in each part of each query: (q, r, m), r the most parts of a query."""
    p, class_of = situation.probability, situation.class_of
    classes = int(class_of.max()) + 1
    if classes * p.size <= SMALL:
        return part_sums(situation, p[:, None] * (class_of[:, None] == np.arange(classes)))
    most = int(situation.part_count.max(initial=2))
    masses: Floats = np.empty((len(situation.parts), most, classes))
    for row, parts in zip(masses, situation.parts, strict=True):
        for part in range(most - 1):
            inside = parts == part
            row[part] = np.bincount(class_of[inside], weights=p[inside], minlength=classes)
    _close(masses, situation, np.bincount(class_of, weights=p, minlength=classes).astype(float))
    return masses


def heard(sums: Floats, situation: QuerySituation) -> Floats:
    """The same sums (q, r, c) for the parts as named in answers: each wrong one has an equal share of the error."""
    error = situation.settings.answer_error
    count = situation.part_count[:, None, None]
    named: Floats = (1 - error) * sums + error / (count - 1) * (sums.sum(axis=1, keepdims=True) - sums)
    if count.max(initial=2) > 2:
        named[np.arange(sums.shape[1])[None, :] >= situation.part_count[:, None]] = 0.0
    return named


def plog2p(mass: Floats) -> Floats:
    """``mass * log2(mass)``, 0 at 0."""
    out: Floats = mass * np.log2(np.where(mass > 0, mass, 1.0))
    return out


def noise_bits(parts: int, error: float) -> float:
    """Entropy, bits, of an answer to a query with that many parts where the truth is known."""
    return float(-plog2p(np.array([1 - error, *[error / (parts - 1)] * (parts - 1)])).sum())


def _close(sums: Floats, situation: QuerySituation, total: Floats) -> None:
    """The sums of the last part, in place: what the others leave."""
    sums[:, -1] = np.maximum(total - sums[:, :-1].sum(axis=1), 0.0)
    sums[situation.part_count < sums.shape[1], -1] = 0.0
