"""Asks what matters, but in random order: what a good objective is worth is the distance to this."""

from __future__ import annotations

from mintpilot.core.ports import Decision, Situation, Strategy
from mintpilot.elicitation.objectives.random import Random
from mintpilot.strategies.mint import MintStrategy


class RandomQueryStrategy(Strategy):
    """MINT with queries drawn at random among those with information gain.

    Args:
        seed: of the draws. Same seed, same questions.
    """

    def __init__(self, seed: int = 0) -> None:
        self._mint = MintStrategy(objective=Random(seed))

    def decide(self, situation: Situation) -> Decision:
        """Asks a random useful query, or flies, for the reasons of `MintStrategy`."""
        return self._mint.decide(situation)
