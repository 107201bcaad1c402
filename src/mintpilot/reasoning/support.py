"""What a belief leaves possible under assumptions. Works factor by factor: no large table is ever built."""

from __future__ import annotations

import numpy as np

from mintpilot.core.gap import Assumptions, Belief, GapKind, Joint, KnowledgeGap
from mintpilot.core.geometry import Floats
from mintpilot.reasoning.entropy import entropy_bits
from mintpilot.reasoning.tables import box


def conditional(factor: Joint, given: Assumptions, gap: KnowledgeGap) -> Floats:
    """Probability of each value of one gap under the assumptions, shape (number of values,); zeros for those excluded.

    Where the assumptions have no probability at all, the values that they leave count as equally likely.
    """
    axis = factor.axis(gap.id)
    cells = box(factor, given)
    inner = factor.probability[np.ix_(*cells)].sum(axis=tuple(i for i in range(len(cells)) if i != axis))
    total = inner.sum()
    probability = np.zeros(len(gap.values))
    probability[list(cells[axis])] = inner / total if total > 0 else 1 / len(inner)
    return probability


def narrow(belief: Belief, given: Assumptions, floor: float, changed: str = "") -> Assumptions:
    """The assumptions without the values that have, under them, no more probability than the floor.

    Only gaps that lose a value are named. The likeliest value of a gap always stays.

    Args:
        belief: what is believed of all gaps.
        given: what is assumed already.
        floor: probability at or below which a value is left out.
        changed: where just one gap was changed, its id: only gaps correlated with it are looked at.
    """
    possible = {name: set(values) for name, values in given.items}
    factors = [belief.factor(changed)] if changed else belief.factors
    for factor in factors:
        for gap in factor.gaps:
            probability = conditional(factor, given, gap)
            keep = {v for v, p in zip(gap.values, probability, strict=True) if p > floor}
            keep = keep or {gap.values[int(np.argmax(probability))]}
            if len(keep) < len(gap.values):
                possible[gap.id] = keep
    return Assumptions.of(possible)


def clear_targets(belief: Belief, given: Assumptions, threshold_bits: float) -> dict[str, tuple[str, float]]:
    """Open target gaps whose goal entropy does not pass the threshold: id → (likeliest value, entropy in bits).

    Where something unseen may be is never clear enough: how much it is worth to look there is a matter of prices.
    """
    clear: dict[str, tuple[str, float]] = {}
    for factor in belief.factors:
        for gap in factor.gaps:
            if gap.kind is GapKind.TARGET and not gap.is_search and given.is_open(gap):
                probability = conditional(factor, given, gap)
                bits = entropy_bits(probability)
                if bits <= threshold_bits:
                    clear[gap.id] = (gap.values[int(np.argmax(probability))], bits)
    return clear
