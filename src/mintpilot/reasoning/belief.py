"""What is believed of the gaps: priors, Bayes' rule, and gaps that come and go (method, sections 1 and 5).

A belief is held in independent factors, so thirty gaps are thirty small tables. A correlation group is one factor from
the start. An answer about several gaps joins their factors; gaps that become certain are split off again.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from mintpilot.core.errors import LimitError, MissionError
from mintpilot.core.gap import Belief, CorrelationGroup, Joint, KnowledgeGap
from mintpilot.core.geometry import Floats
from mintpilot.core.query import Query
from mintpilot.core.tolerances import ROUNDING, SUM_TOLERANCE
from mintpilot.reasoning.tables import marginalise, product, sliced, split_certain

MAX_JOINT = 65536
"""Default bound on the cells of one factor."""
SURPRISE = 0.05
"""With a positive answer error, an answer that was expected with less probability than this is a contradiction."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Posterior:
    """What an answer made of a belief."""

    belief: Belief
    """After the answer; after a contradiction, the belief as it was: the answer is not taken in."""
    contradiction: bool
    """The answer has no probability left (answer error 0), or far less than the answer error explains."""
    expected: float
    """Probability with which this reply was expected, 0 to 1; 1 for replies without information."""


def prior_belief(
    gaps: Iterable[KnowledgeGap], groups: Sequence[CorrelationGroup] = (), *, max_joint: int = MAX_JOINT
) -> Belief:
    """The belief before any answer: priors multiply, except inside a correlation group (method, section 1).

    A group of which only some gaps are open counts by its marginal over those.

    Raises:
        MissionError: a group names values that its gaps do not have, overlaps another group, or does not sum to one.
        LimitError: a group has more than ``max_joint`` joint values.
    """
    known = {gap.id: gap for gap in gaps}
    factors: list[Joint] = []
    grouped: set[str] = set()
    for group in groups:
        if grouped & set(group.gaps):
            raise MissionError(
                f"correlation groups share gaps {sorted(grouped & set(group.gaps))}: a gap may be in one"
            )
        grouped |= set(group.gaps)
        if any(name in known for name in group.gaps):
            factors.append(_group_factor(group, known, max_joint))
    for gap in known.values():
        if gap.id not in grouped:
            factors.append(Joint(gaps=(gap,), probability=_normalised(np.array(gap.prior, float))))
    return _belief(factors)


def condition(
    belief: Belief, query: Query, part: int | None, answer_error: float, *, max_joint: int = MAX_JOINT
) -> Posterior:
    """The belief after an answer: P(h | y) proportional to P(y | q, h) P(h); with ``answer_error`` 0 this is pruning.

    The answer names the right part of the query with probability ``1 - answer_error``, and each other one with an equal
    share of ``answer_error``. A contradiction is a value, not an error (method, section 5). A query about gaps that the
    belief does not hold changes nothing.

    Args:
        belief: before the answer.
        query: what was asked.
        part: which of its parts the answer names (`Answer.part`); None: it names none and has no information.
        answer_error: probability of a wrong answer [e].
        max_joint: bound on the cells of one factor.

    Raises:
        LimitError: the answer couples factors into more than ``max_joint`` joint values; ask about fewer gaps at once.
    """
    names = set(query.gap_ids)
    if part is None or not names <= {g.id for g in belief.gaps}:
        return Posterior(belief=belief, contradiction=False, expected=1.0)
    touched = [f for f in belief.factors if any(g.id in names for g in f.gaps)]
    joint = product(touched, max_joint)
    wrong = answer_error / (query.part_count - 1)
    mass = joint.probability * np.where(query.part_table(joint) == part, 1 - answer_error, wrong)
    expected = min(float(mass.sum()), 1.0)
    if expected <= ROUNDING or (answer_error > 0 and expected < SURPRISE):
        return Posterior(belief=belief, contradiction=True, expected=expected)
    after = Joint(gaps=joint.gaps, probability=_normalised(mass))
    rest = [f for f in belief.factors if f not in touched]
    return Posterior(belief=_belief([*rest, *split_certain(after)]), contradiction=False, expected=expected)


def extend(
    belief: Belief,
    gaps: Iterable[KnowledgeGap],
    groups: Sequence[CorrelationGroup] = (),
    *,
    max_joint: int = MAX_JOINT,
) -> Belief:
    """The belief over exactly these gaps: old ones keep what is known, new ones get their priors, others drop out.

    A gap that kept its id keeps what is believed of the values that it still has; where its values changed so that
    nothing of that is left, or new values came, it starts from its prior. A correlation group counts when all its gaps
    are new; otherwise newcomers get their own priors.
    """
    wanted = {gap.id: gap for gap in gaps}
    kept: list[Joint] = []
    for factor in belief.factors:
        carried = _carried(factor, wanted)
        if carried is not None:
            kept.append(carried)
    old = {g.id for f in kept for g in f.gaps}
    fresh = [gap for name, gap in wanted.items() if name not in old]
    whole = [group for group in groups if not old & set(group.gaps)]
    return _belief([*kept, *prior_belief(fresh, whole, max_joint=max_joint).factors])


def _carried(factor: Joint, wanted: dict[str, KnowledgeGap]) -> Joint | None:
    """What an old factor says of the gaps that are still wanted; None where that is nothing."""
    stay = [g.id for g in factor.gaps if g.id in wanted and set(wanted[g.id].values) <= set(g.values)]
    if not stay:
        return None
    carried = sliced(marginalise(factor, stay), {name: wanted[name] for name in stay})
    total = float(carried.probability.sum())
    if total <= ROUNDING:
        return None
    return Joint(gaps=carried.gaps, probability=carried.probability / total)


def _group_factor(group: CorrelationGroup, known: dict[str, KnowledgeGap], max_joint: int) -> Joint:
    """The table of a correlation group over those of its gaps that are open."""
    table: dict[tuple[str, ...], float] = {}
    present = [i for i, name in enumerate(group.gaps) if name in known]
    ordered = sorted(present, key=lambda i: group.gaps[i])
    gaps = tuple(known[group.gaps[i]] for i in ordered)
    if math.prod(len(g.values) for g in gaps) > max_joint:
        raise LimitError(f"correlation group {group.gaps} has more than {max_joint} joint values; make it smaller")
    if not math.isclose(sum(p for _, p in group.joint), 1, abs_tol=SUM_TOLERANCE) or any(p < 0 for _, p in group.joint):
        raise MissionError(f"correlation group {group.gaps}: probabilities must not be below 0 and must sum to 1")
    for values, p in group.joint:
        if len(values) != len(group.gaps):
            raise MissionError(f"correlation group {group.gaps}: '{values}' must name one value for each of its gaps")
        key = tuple(values[i] for i in ordered)
        table[key] = table.get(key, 0.0) + p
    probability = np.zeros([len(g.values) for g in gaps])
    for key, p in table.items():
        for gap, value in zip(gaps, key, strict=True):
            if value not in gap.values:
                raise MissionError(f"correlation group: gap '{gap.id}' has no value '{value}'; known: {gap.values}")
        probability[tuple(g.values.index(v) for g, v in zip(gaps, key, strict=True))] += p
    return Joint(gaps=gaps, probability=_normalised(probability))


def _belief(factors: Iterable[Joint]) -> Belief:
    return Belief(factors=tuple(sorted(factors, key=lambda f: f.gaps[0].id)))


def _normalised(mass: Floats) -> Floats:
    probability: Floats = mass / mass.sum()
    return probability
