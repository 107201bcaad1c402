"""What may be taken for granted when something is flown (method, section 6)."""

from __future__ import annotations

from collections.abc import Collection

import numpy as np

from mintpilot.core.gap import PASSABLE, Assumptions, Belief, GapKind
from mintpilot.core.mission import AskingSettings
from mintpilot.core.plan import Plan
from mintpilot.core.tolerances import ROUNDING
from mintpilot.reasoning.entropy import entropy_bits


def known_passable(gap_id: str, belief: Belief, confirmed: Collection[str], settings: AskingSettings) -> bool:
    """Whether a region is known to be passable: an explicit yes, and a posterior of at least ``1 - alpha_safe``."""
    return gap_id in confirmed and belief.probability_of(gap_id, PASSABLE) >= 1 - settings.alpha_safe - ROUNDING


def unknown_regions(
    plan: Plan, belief: Belief, confirmed: Collection[str], settings: AskingSettings
) -> tuple[str, ...]:
    """Obstacle gaps whose regions the plan enters though they are not known to be passable, sorted.

    A region without an open gap is known one way or the other: the planner never enters one that is blocked.
    """
    open_gaps = {g.id for g in belief.gaps}
    return tuple(sorted(g for g in plan.enters & open_gaps if not known_passable(g, belief, confirmed, settings)))


def taken_for_granted(belief: Belief, confirmed: Collection[str], settings: AskingSettings) -> Assumptions:
    """What a plan may rest on that is flown without further questions.

    Regions known to be passable; targets whose goal entropy is at or under the threshold, or that are at least
    ``1 - alpha`` sure; rooms that are at least ``1 - alpha`` sure to be empty or not; else all values above the floor.
    Regions that are not *known* passable stay open, however likely: a cautious plan keeps out of them.
    """
    possible: dict[str, tuple[str, ...]] = {}
    for gap in belief.gaps:
        p = belief.marginal(gap.id)
        likeliest = gap.values[int(np.argmax(p))]
        if gap.kind is GapKind.OBSTACLE:
            if known_passable(gap.id, belief, confirmed, settings):
                possible[gap.id] = (PASSABLE,)
        elif p.max() >= 1 - settings.alpha or (
            gap.kind is GapKind.TARGET and not gap.is_search and entropy_bits(p) <= settings.goal_entropy_bits
        ):
            possible[gap.id] = (likeliest,)
        else:
            possible[gap.id] = tuple(v for v, q in zip(gap.values, p, strict=True) if q > settings.floor)
    return Assumptions.of(possible)
