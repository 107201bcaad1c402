"""The explanation of every gap of a mission: asked or not, and why, in figures."""

from __future__ import annotations

from mintpilot.core.tree import GapExplanation
from mintpilot.mission.asking import Interview
from mintpilot.mission.mind import Thought
from mintpilot.reasoning.explain import explain_gaps
from mintpilot.reasoning.tree import build_tree


def explained_first(thought: Thought, *, asked: frozenset[str] | None = None) -> tuple[GapExplanation, ...]:
    """The explanations of all gaps of one deliberation, by id.

    Args:
        thought: the deliberation, the first one that knew of these gaps.
        asked: ids of gaps that were asked about, then or later; None while that is not decided yet.
    """
    seen = thought.situation
    mint = thought.decision.mint or build_tree(seen.space, seen.belief, seen.settings, seen.metric)
    return explain_gaps(seen.space, seen.belief, mint, seen.settings, seen.metric, asked=asked)


def explanations_of(interview: Interview, thought: Thought) -> tuple[GapExplanation, ...]:
    """The explanations of every gap that was ever open in a mission.

    Each is taken from the first deliberation that knew of the gap: what it was worth before anything was asked.
    """
    asked = frozenset(interview.asked_gaps)
    explanations: dict[str, GapExplanation] = {}
    for earlier in (*interview.firsts, thought):
        for one in explained_first(earlier, asked=asked):
            explanations.setdefault(one.gap_id, one)
    return tuple(explanations[name] for name in sorted(explanations))
