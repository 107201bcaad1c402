"""Small algebra of joint distributions: products, marginals, slices. Axes are always sorted by gap id."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Mapping, Sequence

import numpy as np

from mintpilot.core.errors import LimitError
from mintpilot.core.gap import Assumptions, Belief, Joint, KnowledgeGap
from mintpilot.core.geometry import Bools, Floats


def product(factors: Sequence[Joint], max_joint: int) -> Joint:
    """The joint distribution of independent factors.

    Raises:
        LimitError: it would have more than ``max_joint`` cells.
    """
    cells = math.prod(f.probability.size for f in factors)
    if cells > max_joint:
        raise LimitError(f"{cells} joint hypotheses: more than max_joint = {max_joint}; ask about fewer gaps at once")
    gaps = [g for f in factors for g in f.gaps]
    probability: Floats = np.ones(())
    for factor in factors:
        probability = np.multiply.outer(probability, factor.probability)
    order = sorted(range(len(gaps)), key=lambda i: gaps[i].id)
    return Joint(gaps=tuple(gaps[i] for i in order), probability=probability.transpose(order).copy())


def marginalise(joint: Joint, keep: Collection[str]) -> Joint:
    """The joint distribution of some of the gaps only."""
    drop = tuple(i for i, g in enumerate(joint.gaps) if g.id not in keep)
    return Joint(
        gaps=tuple(g for g in joint.gaps if g.id in keep),
        probability=np.asarray(joint.probability.sum(axis=drop), float),
    )


def joint_over(belief: Belief, names: Collection[str], max_joint: int) -> Joint:
    """The joint distribution of the named gaps, all others summed out. Exact, correlations included.

    Raises:
        LimitError: it would have more than ``max_joint`` cells.
    """
    parts = [marginalise(f, names) for f in belief.factors if any(g.id in names for g in f.gaps)]
    return product(parts, max_joint)


def sliced(joint: Joint, gaps: Mapping[str, KnowledgeGap]) -> Joint:
    """The mass on the values that the new forms of the gaps still have, in their order; not normalised."""
    probability = joint.probability
    for axis, old in enumerate(joint.gaps):
        new = gaps[old.id]
        probability = probability.take([old.values.index(v) for v in new.values], axis=axis)
    return Joint(gaps=tuple(gaps[g.id] for g in joint.gaps), probability=probability.copy())


def split_certain(joint: Joint) -> list[Joint]:
    """The same distribution with every gap that has one value left as a factor of its own."""
    certain = [g.id for g in joint.gaps if np.count_nonzero(joint.marginal(g.id)) == 1]
    rest = [g.id for g in joint.gaps if g.id not in certain]
    parts = [marginalise(joint, [name]) for name in certain]
    return [*parts, marginalise(joint, rest)] if rest else parts


def box(joint: Joint, given: Assumptions) -> tuple[Sequence[int], ...]:
    """For each axis, the indices of the values that the assumptions leave."""
    return tuple([g.values.index(v) for v in given.possible(g)] for g in joint.gaps)


def mask_of(joint: Joint, allowed: Mapping[str, Iterable[str]]) -> Bools:
    """Which joint hypotheses have, for every named gap on an axis, one of its allowed values."""
    mask: Bools = np.ones(joint.probability.shape, bool)
    for axis, gap in enumerate(joint.gaps):
        if gap.id in allowed:
            values = set(allowed[gap.id])
            shape = [1] * mask.ndim
            shape[axis] = -1
            mask = mask & np.array([v in values for v in gap.values]).reshape(shape)
    return mask
