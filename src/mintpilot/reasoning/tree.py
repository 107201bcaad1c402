"""Building the Minimal Information Neuro-Symbolic Tree (method, section 3).

Which gap of `Plan.relies_on` a node branches on: target gaps first (they move the goal, so all else hangs on them),
then presence gaps (they add a stop), then the others; among equals the one with the most entropy, then by id. This
looks at beliefs and ids only, never at the order in which the gaps were given.

Nodes are expanded likeliest first, so that a bound on nodes cuts off the least mass. Tables grow with the gaps that the
tree branches on, never with all gaps: of thirty, those on which no plan relies cost nothing.
"""

from __future__ import annotations

import heapq
from collections.abc import Mapping
from dataclasses import dataclass, field

from mintpilot.core.errors import MissionError
from mintpilot.core.gap import Assumptions, Belief, GapKind, KnowledgeGap
from mintpilot.core.mission import AskingSettings, CriticalityRule
from mintpilot.core.plan import Plan
from mintpilot.core.ports import ImpactMetric, PlanMetric, PlanSpace
from mintpilot.core.tolerances import DECIMALS, TOLERANCE
from mintpilot.core.tree import LeafReason, Mint
from mintpilot.reasoning.classes import NodeDraft, finish, least_cost_s
from mintpilot.reasoning.entropy import entropy_bits
from mintpilot.reasoning.support import clear_targets, conditional, narrow

_RANK = {GapKind.TARGET: 0, GapKind.PRESENCE: 1, GapKind.OBSTACLE: 2, GapKind.VALUE: 3}


def build_tree(space: PlanSpace, belief: Belief, settings: AskingSettings, metric: ImpactMetric) -> Mint:
    """The tree for a belief, with its leaves sorted into plan classes.

    The root assumes what the belief leaves possible: values above ``settings.floor``. A prior of 0 or 1 therefore never
    branches. Every node costs one optimistic and at most one cautious plan. A leaf that `AskingSettings.max_nodes` or
    ``max_joint`` cuts off is `LeafReason.NOT_EXPANDED` and holds the cautious plan.

    Args:
        space: the plans of the problem.
        belief: over all open gaps of the problem.
        settings: rule, thresholds and bounds.
        metric: distance between paths; a `PlanMetric` (for the problem of these plans) also says what following the
            cautious plan loses, in place of the plans' costs.

    Raises:
        MissionError: a plan relies on a gap of which the belief says nothing.
    """
    return _Growth(space=space, belief=belief, settings=settings, metric=metric).run()


@dataclass(slots=True, kw_only=True)
class _Growth:
    """One tree while it grows."""

    space: PlanSpace
    belief: Belief
    settings: AskingSettings
    metric: ImpactMetric
    gaps: dict[str, KnowledgeGap] = field(init=False)
    axes: set[str] = field(init=False, default_factory=set)
    cells: int = field(init=False, default=1)
    nodes: int = field(init=False, default=1)
    distances: dict[tuple[str, str], float] = field(init=False, default_factory=dict)

    def __post_init__(self) -> None:
        self.gaps = {g.id: g for g in self.belief.gaps}

    def run(self) -> Mint:
        root = NodeDraft(given=narrow(self.belief, Assumptions(), self.settings.floor), probability=1.0)
        queue: list[tuple[float, int, NodeDraft]] = [(-1.0, 0, root)]
        pushed = 0
        while queue:
            _, _, node = heapq.heappop(queue)
            for child in self.expand(node):
                pushed += 1
                heapq.heappush(queue, (-child.probability, pushed, child))
        return finish(root, self.belief, self.axes, self.nodes, self.settings)

    def expand(self, node: NodeDraft) -> list[NodeDraft]:
        """Plans at a node and makes it a leaf, or gives its children (steps 1 to 4)."""
        clear = clear_targets(self.belief, node.given, self.settings.goal_entropy_bits)
        given = node.given
        for name, (value, _) in clear.items():
            given = given.assume(name, (value,))
        best = node.optimistic = self.space.optimistic(given)
        if best is None:
            return _leaf(node, LeafReason.INFEASIBLE, None)
        assumed = [name for name, _ in best.binds if name in clear]
        if assumed:
            node.entropy_bits = max(clear[name][1] for name in assumed)
        if not best.relies_on:
            return _leaf(node, LeafReason.TARGET_IS_CLEAR_ENOUGH if assumed else LeafReason.RELIES_ON_NOTHING, best)
        sure = node.cautious = self.space.cautious(given)
        if sure is not None and self.good_enough(node, best, sure):
            return _leaf(node, LeafReason.CAUTIOUS_IS_GOOD_ENOUGH, sure)
        return self.branch(node, best)

    def good_enough(self, node: NodeDraft, best: Plan, sure: Plan) -> bool:
        """Whether the plan that always succeeds is within the tolerances of the rule (step 2)."""
        pair = (best.signature, sure.signature)
        if pair not in self.distances:
            self.distances[pair] = self.metric.divergence(best.path_m, sure.path_m)
        node.divergence_m = self.distances[pair]
        loss_s = _dearest_s(sure, node.given, self.gaps) - least_cost_s(best, node.given)
        if isinstance(self.metric, PlanMetric):
            loss_s += self.metric.loss_s(best, sure, node.given) - (sure.cost_s - best.cost_s)
        if loss_s > self.settings.delta_c_s + TOLERANCE:
            return False
        if self.settings.rule is CriticalityRule.REGRET:
            return True
        return node.divergence_m <= self.settings.delta_d_m + TOLERANCE

    def branch(self, node: NodeDraft, best: Plan) -> list[NodeDraft]:
        """One child per value that is possible, on the first gap in order that the bounds have room for (step 4)."""
        for gap, bits in self.critical(node, best):
            if node.entropy_bits is None and gap.kind is GapKind.TARGET:
                node.entropy_bits = bits
            cells = self.cells if gap.id in self.axes else self.cells * len(gap.values)
            children = self.children(node, gap)
            if cells > self.settings.max_joint or self.nodes + len(children) > self.settings.max_nodes:
                continue
            self.axes.add(gap.id)
            self.cells, self.nodes = cells, self.nodes + len(children)
            node.branch_on, node.children = gap.id, children
            return children
        return _leaf(node, LeafReason.NOT_EXPANDED, node.cautious)

    def critical(self, node: NodeDraft, best: Plan) -> list[tuple[KnowledgeGap, float]]:
        """The gaps that the plan relies on with their entropies, in the order in which branching prefers them."""
        found = []
        for name in sorted(best.relies_on):
            if name not in self.gaps:
                raise MissionError(f"a plan relies on gap '{name}', of which nothing is believed; extend the belief")
            gap = self.gaps[name]
            found.append((gap, entropy_bits(conditional(self.belief.factor(name), node.given, gap))))
        # Entropies that differ by rounding only must not decide.
        return sorted(found, key=lambda item: (_RANK[item[0].kind], -round(item[1], DECIMALS), item[0].id))

    def children(self, node: NodeDraft, gap: KnowledgeGap) -> list[NodeDraft]:
        """A draft for each value of the gap that is still possible."""
        probability = conditional(self.belief.factor(gap.id), node.given, gap)
        made = []
        for value in node.given.possible(gap):
            given = narrow(self.belief, node.given.assume(gap.id, (value,)), self.settings.floor, changed=gap.id)
            share = float(probability[gap.values.index(value)])
            made.append(NodeDraft(given=given, probability=node.probability * share))
        return made


def _leaf(node: NodeDraft, reason: LeafReason, plan: Plan | None) -> list[NodeDraft]:
    node.leaf, node.plan = reason, plan
    return []


def _dearest_s(plan: Plan, given: Assumptions, gaps: Mapping[str, KnowledgeGap]) -> float:
    """Cost of a plan where all that is open turns out badly: flight, and all that it may leave undone, seconds."""
    stakes = (p for gap, value, p in plan.stakes if gap not in gaps or value in given.possible(gaps[gap]))
    return plan.cost_s + plan.undone_s + sum(stakes)
