"""How queries divide the joint hypotheses; remembered for small tables, since queries recur after every answer."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from mintpilot.core.gap import Joint
from mintpilot.core.geometry import SmallInts, frozen
from mintpilot.core.query import MAX_PARTS, Domain, Query

SMALL = 256
"""Tables with more joint hypotheses are not remembered."""


def part_row(query: Query, joint: Joint) -> SmallInts:
    """The part of the query that holds each joint hypothesis, flattened (n,). Read-only."""
    if joint.probability.size > SMALL:
        return query.part_table(joint).ravel()
    return _remembered(query, tuple((g.id, g.values) for g in joint.gaps))


def partition_keys(parts: SmallInts) -> NDArray[np.uint8]:
    """One row of bytes (q, ·) for each row of parts (q, n): equal rows divide the hypotheses alike.

    Which part is called which does not count: a query and its opposite have one key. A row that does not divide at all
    is all zero. Keys of several tables are comparable only where each was made of one row.
    """
    labels = _by_appearance(parts)
    bits = [np.packbits(labels & 1, axis=1)]
    if labels.max(initial=0) > 1:
        bits.append(np.packbits(labels >> 1, axis=1))
    return np.hstack(bits)


def _by_appearance(parts: SmallInts) -> SmallInts:
    """The parts numbered in the order in which each row first has them."""
    if parts.max(initial=0) <= 1:
        return parts ^ parts[:, :1]
    present = parts[:, None, :] == np.arange(MAX_PARTS, dtype=np.int8)[:, None]
    first = np.where(present.any(axis=2), present.argmax(axis=2), parts.shape[1])
    labels: SmallInts = np.argsort(np.argsort(first, axis=1, kind="stable"), axis=1).astype(np.int8)
    return np.take_along_axis(labels, parts.astype(np.intp), axis=1)


@lru_cache(maxsize=1 << 15)
def _remembered(query: Query, domain: Domain) -> SmallInts:
    row: SmallInts = query.parts_over(domain).ravel()
    frozen(row)
    return row
