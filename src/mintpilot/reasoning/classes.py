"""Leaves into plan classes: the finished tree (method, sections 1 and 3)."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator
from dataclasses import dataclass, field

import numpy as np

from mintpilot.core.gap import ABSENT, PASSABLE, Assumptions, Belief, GapKind, Joint
from mintpilot.core.geometry import Floats, Ints
from mintpilot.core.mission import AskingSettings
from mintpilot.core.plan import Plan
from mintpilot.core.tolerances import DECIMALS
from mintpilot.core.tree import LeafReason, Mint, Node, PlanClass
from mintpilot.reasoning.entropy import entropy_bits
from mintpilot.reasoning.tables import box, joint_over, mask_of


@dataclass(slots=True, kw_only=True, eq=False)
class NodeDraft:
    """A node that is still being worked on; the fields are those of `Node`."""

    given: Assumptions
    probability: float
    optimistic: Plan | None = None
    cautious: Plan | None = None
    divergence_m: float | None = None
    entropy_bits: float | None = None
    branch_on: str = ""
    children: list[NodeDraft] = field(default_factory=list)
    leaf: LeafReason | None = None
    plan: Plan | None = None


def finish(root: NodeDraft, belief: Belief, axes: Collection[str], nodes: int, settings: AskingSettings) -> Mint:
    """The tree as a value, its leaves sorted into classes, probabilities normalised over what was planned for."""
    leaves = [d for d in _drafts(root) if d.leaf is not None]
    joint = joint_over(belief, _with_demanded(root, leaves, belief, axes, settings), settings.max_joint)
    leaf_of = np.full(joint.probability.shape, -1)
    for index, leaf in enumerate(leaves):
        leaf_of[np.ix_(*box(joint, leaf.given))] = index
    mass = np.where(leaf_of >= 0, joint.probability, 0.0)
    joint = Joint(gaps=joint.gaps, probability=mass / mass.sum())
    classes, class_of_leaf = _classes([_mass(joint, d) for d in leaves], leaves)
    class_of = np.where(leaf_of >= 0, class_of_leaf[leaf_of], -1)
    return Mint(
        root=_frozen(root, joint),
        belief=joint,
        classes=classes,
        class_of=class_of,
        nodes=nodes,
        not_expanded=sum(d.leaf is LeafReason.NOT_EXPANDED for d in leaves),
    )


def leaves_of(node: Node) -> Iterator[Node]:
    """All leaves under a node, in order."""
    if not node.children:
        yield node
    for child in node.children:
        yield from leaves_of(child)


def nodes_of(node: Node) -> Iterator[Node]:
    """A node and all under it, parents first."""
    yield node
    for child in node.children:
        yield from nodes_of(child)


def class_probabilities(mint: Mint) -> Floats:
    """Probability of each plan class (m,)."""
    return np.array([c.probability for c in mint.classes])


def class_entropy_bits(mint: Mint) -> float:
    """Entropy of the plan-class distribution [H(T)], bits (method, section 4)."""
    return entropy_bits(class_probabilities(mint))


def cheapest_under(mint: Mint) -> Floats:
    """For each joint hypothesis, seconds that no plan can undercut; infinite where nothing can be flown.

    The shape is that of ``mint.belief.probability``. It is the cost of the optimistic plan of the hypothesis' leaf:
    exact where that plan relies on nothing, and a lower bound elsewhere.
    """
    lowest = np.full(mint.belief.probability.shape, np.inf)
    for leaf in leaves_of(mint.root):
        if leaf.optimistic is not None:
            cells = np.ix_(*box(mint.belief, leaf.given))
            lowest[cells] = cost_under(leaf.optimistic, mint, surely=True)[cells]
    return lowest


def cost_under(plan: Plan, mint: Mint, *, surely: bool = False) -> Floats:
    """Seconds of flight and prices of what a plan leaves undone (method, section 9), under each joint hypothesis.

    The shape is that of ``mint.belief.probability``. Rooms of which the tree's axes say nothing count where the tree
    takes somebody to be there for certain; elsewhere no plan of the tree differs in them.

    Args:
        plan: need not succeed; where it does not, its cost is another matter.
        mint: the tree.
        surely: leaves out the rooms that the plan takes for empty: no plan can undercut what is left.
    """
    given = dict(mint.root.given.items)
    axes = {gap.id for gap in mint.belief.gaps}
    cost = np.full(mint.belief.probability.shape, plan.cost_s + plan.undone_s)
    for gap, value, price_s in plan.stakes:
        if surely and gap in plan.skips:
            continue
        if gap in axes:
            cost += price_s * mask_of(mint.belief, {gap: (value,)})
        elif given.get(gap) == frozenset({value}):
            cost += price_s
    return cost


def least_cost_s(plan: Plan, given: Assumptions) -> float:
    """Flight and prices of a plan where all that is open turns out well, seconds."""
    possible = dict(given.items)
    stakes = (price for gap, value, price in plan.stakes if possible.get(gap) == frozenset({value}))
    return plan.cost_s + plan.undone_s + sum(stakes)


def demands(plan: Plan) -> dict[str, str]:
    """What must hold for the plan to be flown as it is meant: gap id → the value that it needs.

    A room that it skips is none of this: somebody who is there after all costs the price of the stop.
    """
    return {**dict.fromkeys(plan.enters, PASSABLE), **dict(plan.binds)}


def assumes(plan: Plan) -> dict[str, str]:
    """All that the plan takes for granted: what it demands, and that the rooms which it skips are empty."""
    return {**demands(plan), **dict.fromkeys(plan.skips, ABSENT)}


def _with_demanded(
    root: NodeDraft, leaves: list[NodeDraft], belief: Belief, axes: Collection[str], settings: AskingSettings
) -> set[str]:
    """The axes and, as far as there is room, the other open gaps that leaf plans depend on.

    A plan may rest on a gap that its branch did not ask for: correlated with one that was. Elsewhere it may be closed.
    Target gaps that are clear enough are taken for granted and stay out.
    """
    chosen, gaps = set(axes), {g.id: g for g in belief.gaps}
    cells = math.prod(len(gaps[name].values) for name in chosen)
    for name in sorted({d for leaf in leaves if leaf.plan for d in assumes(leaf.plan)} & set(gaps) - chosen):
        gap = gaps[name]
        if gap.kind is not GapKind.TARGET and root.given.is_open(gap) and cells * len(gap.values) <= settings.max_joint:
            chosen.add(name)
            cells *= len(gap.values)
    return chosen


def _classes(mass: list[float], leaves: list[NodeDraft]) -> tuple[tuple[PlanClass, ...], Ints]:
    """Classes in their order, and the class of each leaf."""
    members: dict[str, list[int]] = {}
    for index, leaf in enumerate(leaves):
        members.setdefault(leaf.plan.signature if leaf.plan else "", []).append(index)
    made = []
    for key, indices in members.items():
        # Leaves that fly the same way may differ in what they leave undone: nothing of it is to be forgotten.
        plan = max((leaves[i].plan for i in indices), key=lambda p: len(p.leaves_undone) if p else 0)
        probability = float(sum(mass[i] for i in indices))
        given = tuple(leaves[i].given for i in indices)
        cost = plan.cost_s + plan.undone_s if plan else float("inf")
        # Rounding must not decide the order of equally likely classes.
        made.append(
            (-round(probability, DECIMALS), cost, key, PlanClass(plan=plan, probability=probability, given=given))
        )
    made.sort(key=lambda item: item[:3])
    class_of_leaf = np.zeros(len(leaves), np.int64)
    for number, (_, _, key, _) in enumerate(made):
        class_of_leaf[members[key]] = number
    return tuple(item[3] for item in made), class_of_leaf


def _drafts(draft: NodeDraft) -> Iterator[NodeDraft]:
    yield draft
    for child in draft.children:
        yield from _drafts(child)


def _mass(joint: Joint, draft: NodeDraft) -> float:
    return float(joint.probability[np.ix_(*box(joint, draft.given))].sum())


def _frozen(draft: NodeDraft, joint: Joint) -> Node:
    return Node(
        given=draft.given,
        probability=_mass(joint, draft),
        optimistic=draft.optimistic,
        cautious=draft.cautious,
        divergence_m=draft.divergence_m,
        entropy_bits=draft.entropy_bits,
        branch_on=draft.branch_on,
        children=tuple(_frozen(child, joint) for child in draft.children),
        leaf=draft.leaf,
        plan=draft.plan,
    )
