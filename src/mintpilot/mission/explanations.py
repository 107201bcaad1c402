"""Why every gap of a mission was asked about or not, in figures."""

from __future__ import annotations

from mintpilot.core.errors import LimitError
from mintpilot.core.ports import Situation
from mintpilot.core.tree import GapExplanation, Mint
from mintpilot.reasoning.explain import explain_gaps
from mintpilot.reasoning.tree import build_tree


def explanations(situation: Situation, mint: Mint | None) -> tuple[GapExplanation, ...]:
    """What each open gap is worth now, by id; whether it is asked about is not decided yet.

    None where a bound on the work is met.

    Args:
        situation: what the strategy decided on.
        mint: its tree; None: it is built here.
    """
    try:
        tree = mint or build_tree(situation.space, situation.belief, situation.settings, situation.metric)
        return explain_gaps(situation.space, situation.belief, tree, situation.settings, situation.metric)
    except LimitError:  # a bound on the work: the mission goes on without the figures
        return ()
