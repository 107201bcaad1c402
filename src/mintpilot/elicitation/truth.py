"""The true answers to a cut, remembered for small tables: the same cuts are looked at after every answer."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from mintpilot.core.gap import Joint
from mintpilot.core.geometry import Bools, frozen
from mintpilot.core.query import Combine, Query

SMALL = 256
"""Tables with more joint hypotheses are not remembered."""


def truth_row(query: Query, joint: Joint) -> Bools:
    """The true answer under each joint hypothesis, flattened (n,). Read-only."""
    if joint.probability.size > SMALL:
        return query.truths(joint).ravel()
    return _remembered(query, tuple((g.id, g.values) for g in joint.gaps))


@lru_cache(maxsize=1 << 15)
def _remembered(query: Query, domain: tuple[tuple[str, tuple[str, ...]], ...]) -> Bools:
    shape = tuple(len(values) for _, values in domain)
    every = query.combine is Combine.ALL
    table = np.full(shape, every)
    for literal in query.literals:
        axis = next(i for i, (name, _) in enumerate(domain) if name == literal.gap)
        true = np.array([v in literal.values for v in domain[axis][1]])
        true = true.reshape([-1 if i == axis else 1 for i in range(len(shape))])
        table = table & true if every else table | true
    row: Bools = table.ravel()
    frozen(row)
    return row
