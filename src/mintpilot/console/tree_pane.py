"""The MINT tree for the page: what is still possible, what which answer ruled out, why gaps were asked."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from mintpilot.console.protocol import AnswerLine, GapLine, TreeNode, TreePane, TreeRound
from mintpilot.core.gap import KnowledgeGap
from mintpilot.core.query import Evidence
from mintpilot.core.tree import Certificate, GapExplanation, Mint
from mintpilot.recording.record import TreeRecord
from mintpilot.recording.tree_data import Told, tree_record
from mintpilot.recording.words import LEAF_WORDS
from mintpilot.wording.speech import Speech


def tree_pane(
    mint: Mint | None,
    gaps: Iterable[KnowledgeGap],
    replies: Sequence[tuple[Evidence, AnswerLine]],
    explanations: Iterable[GapExplanation],
    *,
    round: int,
    asked: frozenset[str] = frozenset(),
    flown: str = "",
    certificate: Certificate | None = None,
    earlier: tuple[TreeRound, ...] = (),
    speech: Speech,
) -> TreePane:
    """The tree as it stands.

    Args:
        mint: the tree of the latest deliberation; None: its strategy builds none.
        gaps: for their words.
        replies: queries that were answered since it was built, with their words.
        explanations: of all gaps.
        round: of the deliberation, from 0.
        asked: ids of the gaps that were asked about.
        flown: signature of the plan that was chosen, if any.
        certificate: why no more is asked; None while asking goes on.
        earlier: trees of the deliberations before.
        speech: the mission's language.
    """
    root = None
    if mint is not None:
        known = tuple(gaps)
        whole = tree_record(mint, known, Told(asked=asked, flown=flown), speech=speech)
        each = [tree_record(mint, known, Told(replies=(evidence,)), speech=speech) for evidence, _ in replies]
        root = _node(whole, each, speech)
    return TreePane(
        round=round,
        root=root,
        nodes=mint.nodes if mint is not None else 0,
        answers=tuple(line for _, line in replies),
        gaps=tuple(_gap(e, asked, speech) for e in sorted(explanations, key=lambda e: (-e.gain_bits, e.gap_id))),
        certificate=speech(certificate.text) if certificate is not None else "",
        earlier=earlier,
    )


def _node(record: TreeRecord, pruned: Sequence[TreeRecord], speech: Speech) -> TreeNode:
    """``pruned``: the same node with each answer's effect, in the order of the answers."""
    children = zip(record.children, *(p.children for p in pruned), strict=True)
    return TreeNode(
        words=record.words,
        probability=record.probability,
        branch=record.branch_words,
        leaf=speech(LEAF_WORDS[record.leaf]) if record.leaf is not None else "",
        cost_s=record.cost_s,
        divergence_m=record.divergence_m,
        ruled_out_by=next((number for number, p in enumerate(pruned, 1) if p.ruled_out), None),
        flown=record.flown,
        left_out=record.left_out,
        children=tuple(_node(child, rest, speech) for child, *rest in children),
    )


def _gap(explanation: GapExplanation, asked: frozenset[str], speech: Speech) -> GapLine:
    return GapLine(
        words=speech.thing(explanation.description),
        asked=explanation.asked or explanation.gap_id in asked,
        relevant=explanation.relevant,
        why=speech(explanation.why),
        figures=speech(explanation.figures),
        entropy_bits=explanation.entropy_bits,
        gain_bits=explanation.gain_bits,
    )
