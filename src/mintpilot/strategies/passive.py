"""Methods that never ask: the paper's passive baselines."""

from __future__ import annotations

from enum import StrEnum

import numpy as np

from mintpilot.core.gap import ABSENT, PASSABLE, PRESENT, Assumptions, GapKind, KnowledgeGap
from mintpilot.core.plan import Plan
from mintpilot.core.ports import Decision, Situation, Strategy
from mintpilot.core.tree import StopReason
from mintpilot.strategies.flying import fly, tree_of


class Stance(StrEnum):
    """What a passive planner makes of uncertain regions."""

    CONSERVATIVE = "conservative"
    """They are obstacles."""
    RISKY = "risky"
    """They are free space."""


class ConservativeStrategy(Strategy):
    """Keeps out of every open region; skips a closed room unless somebody is likelier there than not; guesses targets.

    A target that is not clear is the likeliest candidate, the first one among equals.
    """

    def decide(self, situation: Situation) -> Decision:
        """Flies."""
        return _fly(situation, Stance.CONSERVATIVE, None)


class RiskyStrategy(Strategy):
    """Flies through every open region as if it were free, skips rooms and guesses targets like the conservative one."""

    def decide(self, situation: Situation) -> Decision:
        """Flies; the plan is marked unsafe where it enters regions that are not known to be passable."""
        return _fly(situation, Stance.RISKY, None)


class PassiveMixtureStrategy(Strategy):
    """A mixture of the two passive stances, drawn by a coin. It stands beside the paper's row 'Pure LLM'.

    The paper's passive planner has a description and asks nothing; which stance it takes is not stated. For each
    decision this one draws whether uncertain regions are obstacles or free space, and picks at random among the
    candidates of an unclear target and between looking into a room and not, by their probabilities.

    Args:
        seed: of the draws. Same seed, same flights.
    """

    def __init__(self, seed: int = 0) -> None:
        self._rng = np.random.default_rng(seed)

    def decide(self, situation: Situation) -> Decision:
        """Flies."""
        stance = (Stance.CONSERVATIVE, Stance.RISKY)[int(self._rng.integers(2))]
        return _fly(situation, stance, self._rng)


def _fly(situation: Situation, stance: Stance, rng: np.random.Generator | None) -> Decision:
    mint = tree_of(situation)
    plan = _plan(situation, stance, rng)
    open_regions = {g.id for g in situation.belief.gaps if g.kind is GapKind.OBSTACLE}
    unsafe = plan is not None and stance is Stance.RISKY and bool(plan.enters & open_regions)
    return fly(situation, mint, plan, StopReason.NEVER_ASKS, unsafe=unsafe)


def _plan(situation: Situation, stance: Stance, rng: np.random.Generator | None) -> Plan | None:
    assumed = {}
    for gap in situation.belief.gaps:
        if gap.kind is GapKind.OBSTACLE:
            if stance is Stance.RISKY:
                assumed[gap.id] = PASSABLE
        else:
            assumed[gap.id] = _guess(gap, situation, rng)
    given = Assumptions.exactly(assumed)
    return situation.space.cautious(given) if stance is Stance.CONSERVATIVE else situation.space.optimistic(given)


def _guess(gap: KnowledgeGap, situation: Situation, rng: np.random.Generator | None) -> str:
    p = situation.belief.marginal(gap.id)
    if rng is not None:
        return gap.values[int(rng.choice(len(p), p=p / p.sum()))]
    if gap.kind is GapKind.PRESENCE:
        return PRESENT if situation.belief.probability_of(gap.id, PRESENT) > 0.5 else ABSENT
    return gap.values[int(np.argmax(p))]
