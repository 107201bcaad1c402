"""Why every gap of a mission was asked about or not, in figures."""

from __future__ import annotations

from mintpilot.core.ports import Situation
from mintpilot.core.tree import GapAccount, Mint
from mintpilot.reasoning.explain import gap_accounts
from mintpilot.reasoning.tree import build_tree


def explanations(situation: Situation, mint: Mint | None) -> tuple[GapAccount, ...]:
    """What each open gap is worth now, by id; whether it is asked about is not decided yet.

    Args:
        situation: what the strategy decided on.
        mint: its tree; None: it is built here.
    """
    tree = mint or build_tree(situation.space, situation.belief, situation.settings, situation.metric)
    return gap_accounts(situation.space, situation.belief, tree, situation.settings, situation.metric)
