"""Which states of an automaton are no harder to go on from than others: those need not be followed (section 14)."""

from __future__ import annotations

from collections.abc import Iterable
from functools import lru_cache

import numpy as np

from mintpilot.core.geometry import Bools
from mintpilot.core.rule import Automaton

MOST_COMPARED = 4_000_000
"""Pairs of states times letters; beyond, only equal states count as no harder, which costs time and nothing else."""


@lru_cache(maxsize=16)
def no_harder(automaton: Automaton) -> Bools:
    """(states, states) [p, q]: whatever keeps the rules from state p on keeps them from q on.

    The greatest relation under which an accepting p has an accepting q and every letter leads to such a pair again.
    """
    letters = np.unique(automaton.following, axis=1)
    if automaton.size**2 * letters.shape[1] > MOST_COMPARED:
        return np.eye(automaton.size, dtype=bool)
    found: Bools = ~automaton.accepting[:, None] | automaton.accepting[None, :]
    while True:
        finer: Bools = found & found[letters[:, None, :], letters[None, :, :]].all(axis=2)
        if (finer == found).all():
            return finer
        found = finer


def hardest(states: Iterable[int], order: Bools) -> frozenset[int]:
    """Those of the states that keeping the rules hangs on: whatever keeps them from these keeps them from all."""
    kept: list[int] = []
    for state in sorted(states):
        if not any(order[other, state] for other in kept):
            kept = [other for other in kept if not order[state, other]] + [state]
    return frozenset(kept)


def covers(harder: Iterable[int], states: Iterable[int], order: Bools) -> bool:
    """Whether whatever keeps the rules from all of the first states on keeps them from all of the second."""
    first = list(harder)
    return all(any(order[other, state] for other in first) for state in states)
