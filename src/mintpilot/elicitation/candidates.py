"""Which queries can be asked: a typed predicate language over the gaps that matter (method, section 4).

Every query can be said in one short sentence and is about gaps that the tree branches on. Of queries that divide the
joint hypotheses alike only the one of least phrasing cost stays.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator
from dataclasses import dataclass
from functools import lru_cache
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from mintpilot.core.gap import PASSABLE, PRESENT, GapKind, Joint, KnowledgeGap
from mintpilot.core.geometry import SmallInts, Vec3, frozen
from mintpilot.core.mission import QueryKinds
from mintpilot.core.query import Combine, Literal, Query, Saying, SayingKind, is_refused
from mintpilot.core.tree import Mint
from mintpilot.elicitation.choices import chains, choices_about
from mintpilot.elicitation.partitions import partition_keys
from mintpilot.elicitation.phrasing_cost import phrasing_cost
from mintpilot.elicitation.referents import referent_literals
from mintpilot.elicitation.sentences import is_sayable

MAX_TOGETHER = 3
"""Most gaps in one any-of or all-of query."""
MAX_QUERIES = 1000
"""Bound on the queries that are looked at, those of least phrasing cost first."""
MAX_CHOICES = 250
"""The same for choices."""
MAX_KEPT = 1 << 20
"""Tables of parts with more cells than this are made anew each time."""
MAX_CELLS = 1 << 21
"""Bound on queries times joint hypotheses."""


def gap_literals(gap: KnowledgeGap, start_m: Vec3 | None = None) -> tuple[Literal, ...]:
    """Everything that can be asked about one gap by itself, never negated: yes is the property that has a name.

    Args:
        gap: what is asked about.
        start_m: where the drone is, metres; with it, referents can also be told apart by nearness and side.
    """
    if gap.kind is GapKind.TARGET:
        return referent_literals(gap, start_m)
    if gap.kind is GapKind.VALUE:
        return tuple(
            Literal(
                gap=gap.id,
                values=frozenset(gap.values[i:]),
                saying=Saying(kind=SayingKind.THRESHOLD, name="at least", value=gap.values[i]),
            )
            for i in range(1, len(gap.values))
        )
    wanted = PASSABLE if gap.kind is GapKind.OBSTACLE else PRESENT
    if gap.threshold is not None and wanted in gap.values:
        return (passable_literal(gap),)
    saying = Saying(kind=SayingKind.VALUE, value=wanted)
    return (Literal(gap=gap.id, values=frozenset({wanted}), saying=saying),) if wanted in gap.values else ()


def passable_literal(gap: KnowledgeGap) -> Literal:
    """That a region may be flown through: said by its threshold where it has one."""
    saying = Saying(kind=SayingKind.VALUE, value=PASSABLE)
    if gap.threshold is not None:
        saying = Saying(kind=SayingKind.THRESHOLD, name=gap.threshold.of, value=gap.threshold.words)
    return Literal(gap=gap.id, values=frozenset({PASSABLE}), saying=saying)


def candidate_queries(
    mint: Mint,
    *,
    start_m: Vec3 | None = None,
    refused: Collection[str] = (),
    kinds: QueryKinds = QueryKinds.YES_NO,
) -> tuple[Query, ...]:
    """The queries that divide what the tree holds: yes/no ones, then choices; of least phrasing cost first, then by id.

    Args:
        mint: the tree; only gaps that it branches on are asked about.
        start_m: where the drone is, metres.
        refused: what is not to be asked (`mintpilot.core.query.is_refused`); nor are queries that divide the hypotheses
            like one that is refused itself.
        kinds: which kinds of query are made.
    """
    support = mint.support
    most = max(1, min(MAX_QUERIES, MAX_CELLS // max(1, support.size)))
    plain = _divisions(_language(mint.belief.gaps, start_m), mint, most, refused)
    if kinds is QueryKinds.YES_NO:
        return tuple(plain)
    choices = _divisions(_choices(mint.belief.gaps), mint, min(most, MAX_CHOICES), refused)
    # What a yes or no tells as well is not asked as a choice: that takes longer.
    told = {key.tobytes() for key in plain.values()}
    return (*plain, *(query for query, key in choices.items() if key.tobytes() not in told))


def _divisions(language: _Language, mint: Mint, most: int, refused: Collection[str]) -> dict[Query, NDArray[np.uint8]]:
    """The queries that divide what the tree holds, of those that divide alike one only; with how they do."""
    looked_at = language.queries[: 2 * most]
    rows = language.parts(mint.belief, len(looked_at))[:, mint.support]
    keys = partition_keys(rows)
    _, key_of = np.unique(keys, axis=0, return_inverse=True)
    kinds, divides = key_of.ravel(), np.any(keys, axis=1)
    taken = {kinds[i] for i, query in enumerate(looked_at) if refused and query.id in refused}
    kept: dict[Query, NDArray[np.uint8]] = {}
    for i, query in enumerate(looked_at):
        # Of those that divide alike the first one has the least phrasing cost.
        if len(kept) < most and divides[i] and kinds[i] not in taken and not is_refused(query, refused):
            taken.add(kinds[i])
            kept[query] = keys[i]
    return kept


@dataclass(frozen=True, eq=False)
class _Language:
    """Every query that can be asked about some gaps, by phrasing cost, and their parts where that is a small table."""

    queries: tuple[Query, ...]
    tables: dict[int, SmallInts]

    def parts(self, joint: Joint, count: int) -> SmallInts:
        """Parts of the first queries (count, n) that hold each joint hypothesis, flattened."""
        if count not in self.tables:
            table: SmallInts = np.zeros((count, joint.probability.size), np.int8)
            for row, query in zip(table, self.queries, strict=False):
                row[:] = query.part_table(joint).ravel()
            if table.size > MAX_KEPT:
                return table
            frozen(table)
            self.tables[count] = table
        return self.tables[count]


@lru_cache(maxsize=64)
def _language(gaps: tuple[KnowledgeGap, ...], start_m: Vec3 | None) -> _Language:
    literals = {g.id: gap_literals(g, start_m) for g in gaps}
    known = {g.id: g for g in gaps}
    ranked = sorted(set(_queries(literals, gaps)), key=phrasing_cost)
    sayable = tuple(q for q in ranked if len(q.literals) == 1 or is_sayable(q, known))
    return _Language(queries=sayable, tables={})


@lru_cache(maxsize=64)
def _choices(gaps: tuple[KnowledgeGap, ...]) -> _Language:
    known = {g.id: g for g in gaps}
    ranked = sorted(set(choices_about(gaps)), key=phrasing_cost)
    return _Language(queries=tuple(q for q in ranked if is_sayable(q, known)), tables={})


def _queries(literals: dict[str, tuple[Literal, ...]], gaps: Iterable[KnowledgeGap]) -> Iterator[Query]:
    known = {gap.id: gap for gap in gaps}
    for name, several in literals.items():
        if known[name].threshold is None:
            yield from (Query(literals=(literal,)) for literal in several)
    for chain in chains(gaps):
        # To be so high it must be free below, too: one yes says that of each part.
        said = [passable_literal(gap) for gap in chain]
        yield from (Query(literals=tuple(said[: n + 1]), combine=Combine.ALL) for n in range(len(said)))
    for gap in gaps:
        if gap.kind is GapKind.TARGET:
            yield from _pairs(literals[gap.id])
    for kind, of_things in ((GapKind.OBSTACLE, False), (GapKind.PRESENCE, False), (GapKind.PRESENCE, True)):
        same = [
            literals[g.id][0]
            for g in gaps
            if g.kind is kind and g.is_thing is of_things and literals[g.id] and g.threshold is None
        ]
        for count in range(2, MAX_TOGETHER + 1):
            for together in combinations(same, count):
                yield Query(literals=together, combine=Combine.ANY)
                yield Query(literals=together, combine=Combine.ALL)


def _pairs(literals: tuple[Literal, ...]) -> Iterator[Query]:
    """Two attributes of one referent, or two named referents; relations are long enough by themselves."""
    attributes = [x for x in literals if x.saying.kind is SayingKind.ATTRIBUTE]
    for one, other in combinations(attributes, 2):
        yield Query(literals=(one, other), combine=Combine.ANY)
        if one.saying.name != other.saying.name:
            yield Query(literals=(one, other), combine=Combine.ALL)
    named = [x for x in literals if x.saying.kind is SayingKind.VALUE]
    for one, other in combinations(named, 2):
        yield Query(literals=(one, other), combine=Combine.ANY)
