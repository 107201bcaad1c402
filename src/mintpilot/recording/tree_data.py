"""The MINT tree and its plan classes as data for records and drawings."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from mintpilot.core.gap import Assumptions, KnowledgeGap
from mintpilot.core.message import Message, joined, message
from mintpilot.core.plan import Plan
from mintpilot.core.query import NO_PART, Combine, Evidence, Literal
from mintpilot.core.tree import Mint, Node, PlanClass
from mintpilot.recording.record import PlanClassRecord, TreeRecord
from mintpilot.recording.words import say, say_assumptions, say_bare
from mintpilot.wording.speech import IN_ENGLISH, Speech

MAX_NODES = 400
"""Nodes kept of one tree; the likeliest stay."""
MAX_CLASSES = 50
"""Plan classes kept; the likeliest stay."""
_MAX_WORDS = 6
"""Hypotheses of one class that are put into words."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Told:
    """What became of the tree, for marking it."""

    replies: tuple[Evidence, ...] = ()
    """Queries that were answered, with the answer."""
    asked: frozenset[str] = frozenset()
    """Ids of the gaps that were asked about."""
    flown: str = ""
    """Signature of the plan that was chosen in the end."""


def tree_record(
    mint: Mint, gaps: Iterable[KnowledgeGap] = (), told: Told | None = None, *, speech: Speech = IN_ENGLISH
) -> TreeRecord:
    """The tree as nested data, at most `MAX_NODES` nodes of it (those of highest probability).

    Args:
        mint: the tree.
        gaps: gaps that the tree's own belief does not hold, for their words.
        told: what was asked and answered since the tree was built.
        speech: the language of its words.
    """
    known = {gap.id: gap for gap in (*gaps, *mint.belief.gaps)}
    kept = _likeliest(mint.root, MAX_NODES)
    return _node(mint.root, Assumptions(), known, told or Told(), kept, speech)


def class_records(
    mint: Mint, gaps: Iterable[KnowledgeGap] = (), told: Told | None = None, *, speech: Speech = IN_ENGLISH
) -> tuple[PlanClassRecord, ...]:
    """The plan classes, the likeliest `MAX_CLASSES` of them."""
    known = {gap.id: gap for gap in (*gaps, *mint.belief.gaps)}
    flown = (told or Told()).flown
    return tuple(_class(plan_class, known, flown, speech) for plan_class in mint.classes[:MAX_CLASSES])


def _likeliest(root: Node, bound: int) -> frozenset[int]:
    """Identities of the nodes to keep: whole families, the likeliest first."""
    kept = {id(root)}
    frontier = [root]
    while frontier:
        frontier.sort(key=lambda node: node.probability)
        children = frontier.pop().children
        if children and len(kept) + len(children) <= bound:
            kept.update(map(id, children))
            frontier.extend(children)
    return frozenset(kept)


def _node(
    node: Node, above: Assumptions, gaps: Mapping[str, KnowledgeGap], told: Told, kept: frozenset[int], speech: Speech
) -> TreeRecord:
    children = tuple(_node(c, node.given, gaps, told, kept, speech) for c in node.children if id(c) in kept)
    branch = gaps.get(node.branch_on)
    plan = node.plan
    return TreeRecord(
        given={gap_id: tuple(sorted(values)) for gap_id, values in node.given.items},
        words=speech(_news(node.given, above, gaps)),
        probability=node.probability,
        optimistic_s=_cost(node.optimistic),
        cautious_s=_cost(node.cautious),
        divergence_m=node.divergence_m,
        entropy_bits=node.entropy_bits,
        branch_on=node.branch_on,
        branch_words=speech.thing(branch.description) if branch else node.branch_on,
        asked=node.branch_on in told.asked,
        ruled_out=any(_contradicts(reply, node.given) for reply in told.replies),
        leaf=node.leaf,
        cost_s=_cost(plan),
        plan=plan.signature if plan else "",
        flown=plan is not None and plan.signature == told.flown,
        left_out=0 if children or not node.children else _size(node) - 1,
        children=children,
    )


def _news(given: Assumptions, above: Assumptions, gaps: Mapping[str, KnowledgeGap]) -> Message:
    """What is assumed beyond the node above."""
    before = dict(above.items)
    news = [(gap_id, values) for gap_id, values in given.items if before.get(gap_id) != values]
    clauses = [say(gaps[g], v) if g in gaps else say_bare(g, v) for g, v in news]
    return joined(clauses, "; ") or message("nothing assumed yet")


def _contradicts(reply: Evidence, given: Assumptions) -> bool:
    """Whether the assumptions rule out the part of the query that was named."""
    query, part = reply.query, reply.part
    if not query.is_choice:
        return _truth(query.literals, query.combine, given) is (part == NO_PART)
    truths = [_truth(option.literals, option.combine, given) for option in query.options]
    return truths[part] is False if part < len(truths) else True in truths


def _truth(literals: Iterable[Literal], combine: Combine, given: Assumptions) -> bool | None:
    """Whether the literals hold under the assumptions; None where these leave it open."""
    possible = dict(given.items)
    truths: list[bool | None] = []
    for literal in literals:
        values = possible.get(literal.gap)
        if values is None or (values & literal.values and not values <= literal.values):
            truths.append(None)
        else:
            truths.append(values <= literal.values)
    decisive = combine is Combine.ANY
    if decisive in truths:
        return decisive
    return None if None in truths else not decisive


def _class(plan_class: PlanClass, gaps: Mapping[str, KnowledgeGap], flown: str, speech: Speech) -> PlanClassRecord:
    plan = plan_class.plan
    return PlanClassRecord(
        probability=plan_class.probability,
        cost_s=_cost(plan),
        length_m=plan.length_m if plan else None,
        plan=plan.signature if plan else "",
        words=tuple(speech(say_assumptions(given, gaps.values())) for given in plan_class.given[:_MAX_WORDS]),
        hypotheses=len(plan_class.given),
        enters=tuple(sorted(plan.enters)) if plan else (),
        skips=tuple(sorted(plan.skips)) if plan else (),
        flown=plan is not None and plan.signature == flown,
    )


def _cost(plan: Plan | None) -> float | None:
    return None if plan is None else plan.cost_s


def _size(node: Node) -> int:
    return 1 + sum(map(_size, node.children))
