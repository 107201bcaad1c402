"""For every gap: asked or not, and why, in figures."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from mintpilot.core.gap import Assumptions, Belief, GapKind, KnowledgeGap
from mintpilot.core.geometry import Floats
from mintpilot.core.message import Message, message
from mintpilot.core.mission import AskingSettings, CriticalityRule
from mintpilot.core.plan import Plan
from mintpilot.core.ports import ImpactMetric, PlanSpace
from mintpilot.core.tolerances import DECIMALS, TOLERANCE
from mintpilot.core.tree import GapExplanation, Mint, Node
from mintpilot.reasoning.classes import class_entropy_bits, least_cost_s, nodes_of
from mintpilot.reasoning.entropy import entropy_bits
from mintpilot.reasoning.metrics import expected_regret_s
from mintpilot.reasoning.situation import regret_matrix


def explain_gaps(
    space: PlanSpace,
    belief: Belief,
    mint: Mint,
    settings: AskingSettings,
    metric: ImpactMetric,
) -> tuple[GapExplanation, ...]:
    """The explanation of every gap of the belief, by id, while it is not decided yet whether it is asked about.

    Costs compare the best plans under the gap's best and worst value, all else as at the likeliest node of the tree
    that branches on it (at the root for gaps that no node branches on).

    Args:
        space: the plans of the problem of the first deliberation.
        belief: of the first deliberation.
        mint: its tree.
        settings: thresholds.
        metric: distance between paths.
    """
    regret = regret_matrix(mint, settings)
    made = []
    for gap in belief.gaps:
        node = _branching_node(mint.root, gap.id)
        best, worst = _extremes(space, (node or mint.root).given, gap)
        divergence = metric.divergence(best.path_m, worst.path_m) if best and worst else None
        gain, saved = _worth(mint, regret, gap.id)
        bits = entropy_bits(belief.marginal(gap.id))
        relevant, figures = node is not None, _figures(gap, best, worst, divergence, bits)
        set_aside = _set_aside(best, worst, settings)
        why = (
            message("Matters: {figures}.", figures=figures)
            if relevant
            else message("Does not matter: {figures}{set_aside}.", figures=figures, set_aside=set_aside)
        )
        made.append(
            GapExplanation(
                gap_id=gap.id,
                description=gap.description,
                kind=gap.kind.value,
                asked=False,
                relevant=relevant,
                why=why if figures else message("Nothing can be flown, whatever it is."),
                figures=figures,
                set_aside=set_aside,
                cost_if_favourable_s=best.cost_s if best else None,
                cost_if_unfavourable_s=worst.cost_s if worst else None,
                divergence_m=divergence,
                entropy_bits=bits,
                gain_bits=gain,
                regret_saved_s=saved,
            )
        )
    return tuple(made)


def _branching_node(root: Node, gap_id: str) -> Node | None:
    """The likeliest node that branches on that gap; the first one among equals."""
    found = [n for n in nodes_of(root) if n.branch_on == gap_id]
    return max(found, key=lambda n: round(n.probability, DECIMALS), default=None)


def _extremes(space: PlanSpace, given: Assumptions, gap: KnowledgeGap) -> tuple[Plan | None, Plan | None]:
    """The plans under the gap's best and worst possible value; None where that value leaves nothing to fly."""
    cases = [given.assume(gap.id, (value,)) for value in given.possible(gap)]
    made = [(space.optimistic(case), case) for case in cases]
    found = [(least_cost_s(plan, case), plan.signature, plan) for plan, case in made if plan is not None]
    if not found:
        return None, None
    found.sort(key=lambda item: item[:2])
    return found[0][2], found[-1][2] if len(found) == len(cases) else None


def _worth(mint: Mint, regret_s: Floats, gap_id: str) -> tuple[float, float]:
    """Gain, bits, of the best query 'gap = value', and seconds of regret that knowing the value saves."""
    if all(g.id != gap_id for g in mint.belief.gaps):
        return 0.0, 0.0
    axis, support = mint.belief.axis(gap_id), mint.support
    value = np.indices(mint.belief.probability.shape)[axis].ravel()[support]
    p = mint.belief.probability.ravel()[support]
    class_of = mint.class_of.ravel()[support]
    gain = after = 0.0
    for v in np.unique(value):
        mass = np.where(value == v, p, 0.0)
        after += expected_regret_s(regret_s, mass)
        left = sum(part.sum() * entropy_bits(np.bincount(class_of, weights=part)) for part in (mass, p - mass))
        gain = max(gain, class_entropy_bits(mint) - float(left))
    return gain, max(0.0, expected_regret_s(regret_s, p) - after)


def decided(explanation: GapExplanation, asked: bool, looked: bool = False) -> GapExplanation:
    """The explanation once it is known whether the gap was asked about, or looked at."""
    if not explanation.figures:
        return replace(explanation, asked=asked)
    figures = explanation.figures
    if asked and looked:
        why = message("Looked at, and asked: {figures}.", figures=figures)
    elif asked:
        why = message("Asked: {figures}.", figures=figures)
    elif looked:
        why = message("Looked at: {figures}.", figures=figures)
    elif explanation.relevant:
        why = message("Not asked: {figures}, but other answers settled the plan.", figures=figures)
    else:
        why = message("Not asked: {figures}{set_aside}.", figures=figures, set_aside=explanation.set_aside)
    return replace(explanation, asked=asked, why=why)


def _figures(
    gap: KnowledgeGap, best: Plan | None, worst: Plan | None, divergence_m: float | None, bits: float
) -> Message:
    """What hangs on the gap, in figures; empty where nothing can be flown whatever it is."""
    if best is None:
        return Message()
    figures = _difference(best, worst, divergence_m)
    if gap.kind is GapKind.TARGET:
        return message("{figures}; {bits:.2f} bits are not known", figures=figures, bits=bits)
    return figures


def _difference(best: Plan, worst: Plan | None, divergence_m: float | None) -> Message:
    best_s = best.cost_s
    if worst is None:
        return message("the best plan takes {best_s:.1f} s one way, and there is none the other way", best_s=best_s)
    more = len(worst.leaves_undone) - len(best.leaves_undone)
    if more == 1:
        return message(
            "the best plan takes {best_s:.1f} s one way; the other way it leaves a stop more undone", best_s=best_s
        )
    if more > 1:
        return message(
            "the best plan takes {best_s:.1f} s one way; the other way it leaves {more} stops more undone",
            best_s=best_s,
            more=more,
        )
    worst_s, extra_s = worst.cost_s, worst.cost_s - best.cost_s
    if divergence_m is None:
        return message(
            "the best plan takes {best_s:.1f} s or {worst_s:.1f} s ({extra_s:.1f} s more)",
            best_s=best_s,
            worst_s=worst_s,
            extra_s=extra_s,
        )
    return message(
        "the best plan takes {best_s:.1f} s or {worst_s:.1f} s ({extra_s:.1f} s more, {apart_m:.1f} m apart)",
        best_s=best_s,
        worst_s=worst_s,
        extra_s=extra_s,
        apart_m=divergence_m,
    )


def _set_aside(best: Plan | None, worst: Plan | None, settings: AskingSettings) -> Message:
    """Why a gap that no plan depends on is left alone; follows the figures."""
    if best is None or (worst is not None and worst.cost_s - best.cost_s > settings.delta_c_s + TOLERANCE):
        return message(", but it is as good as known")
    if settings.rule is CriticalityRule.PAPER:
        return message(
            "; differences up to {delta_c_s:.1f} s and {delta_d_m:.1f} m are not worth a question",
            delta_c_s=settings.delta_c_s,
            delta_d_m=settings.delta_d_m,
        )
    return message("; differences up to {delta_c_s:.1f} s are not worth a question", delta_c_s=settings.delta_c_s)
