"""Queries from outside, e.g. of a language model: asked for where they can help, checked, scored like all others."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from mintpilot.core.geometry import Floats
from mintpilot.core.ports import QueryObjective, Situation
from mintpilot.core.query import Query, is_refused
from mintpilot.core.tree import Mint, ScoredQuery
from mintpilot.elicitation.candidates import candidate_queries, gap_literals
from mintpilot.elicitation.choose import choose, query_situation
from mintpilot.elicitation.objectives.channel import noise_bits
from mintpilot.elicitation.partitions import part_row, partition_keys
from mintpilot.elicitation.sentences import is_sayable
from mintpilot.reasoning.entropy import entropy_bits
from mintpilot.strategies.flying import answerable

MARGIN_BITS = 0.05
"""A query that is so near to the bound on gain leaves nothing worth waiting for."""
MOST_PROPOSALS = 20
"""Proposals looked at."""
EXACT_CLASSES = 12
"""Up to so many plan classes the bound on the gain of yes/no queries is the best division of their masses in two."""


def gain_bound_bits(situation: Situation, mint: Mint, regret_s: Floats, *, parts: int = 2) -> float:
    """What no query of that many parts can pass: log2 of them, or the entropy of the plan classes, less noise; bits.

    The gain is highest where each class answers as one. With up to `EXACT_CLASSES` classes it is therefore known how
    near to halves any yes/no query can come (of three equal classes: 0.92 bit), and the bound is that.

    Args:
        situation: for the settings.
        mint: the tree.
        regret_s: from `mintpilot.reasoning.situation.regret_matrix`.
        parts: most parts of the queries in question, 2 to 4; proposers know yes/no queries only.
    """
    seen = query_situation((), mint, regret_s, situation.settings)
    masses = np.bincount(seen.class_of, weights=seen.probability)
    masses = masses[masses > 0]
    error = situation.settings.answer_error
    share, most = 0.5, entropy_bits(masses)
    if parts > 2:
        return float(max(0.0, min(np.log2(parts) - noise_bits(parts, error), most)))
    if masses.size <= EXACT_CLASSES:
        sums = np.zeros(1)
        for mass in masses:
            sums = np.concatenate([sums, sums + mass])
        share = float(sums[np.argmin(np.abs(sums - 0.5))])
    heard = (1 - error) * share + error * (1 - share)
    gain = entropy_bits((heard, 1 - heard)) - noise_bits(2, error)
    return float(max(0.0, min(gain, most)))


def with_proposals(
    situation: Situation,
    mint: Mint,
    regret_s: Floats,
    objective: QueryObjective,
    own: tuple[ScoredQuery, ...],
    bound_bits: float,
) -> tuple[tuple[ScoredQuery, ...], tuple[ScoredQuery, ...]]:
    """All queries, best first, and those among them that the proposer brought.

    The proposer is asked only where the best own query falls short of the bound on gain by more than `MARGIN_BITS`:
    elsewhere nothing better exists, and no time is lost. All queries are then scored together by the same objective;
    the best by score wins, whoever proposed it.
    """
    proposer = situation.proposer
    best_bits = max((s.gain_bits for s in own), default=0.0)
    if proposer is None or best_bits >= bound_bits - MARGIN_BITS:
        return own, ()
    sound = sound_proposals(situation, mint, proposer.propose(mint))
    if not sound:
        return own, ()
    asked = {one.query.id for one in situation.asked}
    every = [*(s.query for s in own), *sound]
    scored = choose(every, mint, regret_s, objective, situation.settings, asked=asked)
    theirs = {query.id for query in sound}
    named = tuple(replace(s, proposed_by=proposer.name) if s.query.id in theirs else s for s in scored)
    return named, tuple(s for s in named if s.query.id in theirs)


def sound_proposals(situation: Situation, mint: Mint, proposed: Sequence[Query]) -> tuple[Query, ...]:
    """Those proposals that may be asked and are new.

    Each part must be in the predicate language for its gap, with the values that it says; the whole must be sayable in
    one short sentence and divide what the tree holds. What was asked or withdrawn, and what divides like a query
    of our own (asked, withdrawn or still to be asked), is left out.
    """
    gaps = {gap.id: gap for gap in mint.belief.gaps}
    start_m = situation.problem.start_m
    language = {name: set(gap_literals(gap, start_m)) for name, gap in gaps.items()}
    spent = {one.query.id for one in situation.asked}
    known = {_key(query, mint) for query in candidate_queries(mint, start_m=start_m, kinds=situation.settings.kinds)}
    sound: list[Query] = []
    for query in proposed[:MOST_PROPOSALS]:
        spoken = all(x.gap in gaps and x in language[x.gap] for x in query.every_literal)
        if not spoken or query.id in spent or is_refused(query, situation.withdrawn) or not is_sayable(query, gaps):
            continue
        key = _key(query, mint)
        if any(key) and key not in known:
            known.add(key)
            sound.append(query)
    return answerable(sound, situation)


def _key(query: Query, mint: Mint) -> bytes:
    """How a query divides what the tree holds: equal for those that divide alike; all zero where it does not divide."""
    return partition_keys(part_row(query, mint.belief)[None, mint.support]).tobytes()
