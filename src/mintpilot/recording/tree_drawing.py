"""The MINT tree as text, JSON and Graphviz."""

from __future__ import annotations

from collections.abc import Iterator

from mintpilot.core.message import message
from mintpilot.recording.record import TreeRecord
from mintpilot.recording.words import LEAF_WORDS, printable
from mintpilot.wording.speech import IN_ENGLISH, Speech

MAX_DRAWN = 80
"""Nodes drawn; the rest is counted."""


def tree_json(tree: TreeRecord) -> str:
    """The tree as JSON, in the form of `TreeRecord`."""
    return tree.model_dump_json(indent=1)


def tree_text(tree: TreeRecord, *, max_nodes: int = MAX_DRAWN, speech: Speech = IN_ENGLISH) -> str:
    """The tree for a terminal, one node a line, in Unicode box drawing.

    Args:
        tree: the tree.
        max_nodes: nodes shown; those left out are counted where they would be.
        speech: the language of what is said around the tree's own words.
    """
    shown = prune(tree, max_nodes)
    return "\n".join(printable(line) for line in _lines(shown, "", "", "", speech))


def tree_dot(tree: TreeRecord, *, max_nodes: int = MAX_DRAWN, speech: Speech = IN_ENGLISH) -> str:
    """The tree for Graphviz (``dot -Tsvg``).

    Args:
        tree: the tree.
        max_nodes: nodes drawn; those left out are counted where they would be.
        speech: as in `tree_text`.
    """
    lines = [
        "digraph mint {",
        '  rankdir=LR; node [shape=box, style="rounded,filled", fillcolor=white, fontname="Helvetica", fontsize=11];',
        '  edge [color="#8a94a0"];',
    ]
    nodes = list(_numbered(prune(tree, max_nodes)))
    for number, above, node in nodes:
        style = ', fillcolor="#d6efe4", penwidth=2' if node.flown else ', fontcolor="#8a94a0"' if node.ruled_out else ""
        facts = (text for _, text in details(node, speech))
        label = "\n".join((f"{node.words} ({percent(node.probability, speech)})", *facts))
        lines.append(f"  n{number} [label={_quoted(label)}{style}];")
        if above is not None:
            parent = nodes[above][2]
            asked = _quoted(speech.label("asked"))
            mark = f' [color="#0072b2", penwidth=2.5, label={asked}]' if parent.asked and not node.ruled_out else ""
            lines.append(f"  n{above} -> n{number}{mark};")
    return "\n".join((*lines, "}", ""))


def details(node: TreeRecord, speech: Speech) -> tuple[tuple[str, str], ...]:
    """What a drawing says of a node under its assumptions: why it branches, or what is flown there and why.

    Each is (kind, text); the kind is ``branch``, ``plan`` or empty.
    """
    lines = []
    if node.branch_on:
        about = node.branch_words
        asked = message("asked about: {what}", what=about)
        lines.append(("branch", speech(asked if node.asked else message("depends on: {what}", what=about))))
    if node.leaf is not None:
        if node.cost_s is not None:
            flown = message("flown: {cost_s:.1f} s", cost_s=node.cost_s)
            lines.append(("plan", speech(flown if node.flown else message("fly: {cost_s:.1f} s", cost_s=node.cost_s))))
        lines.append(("", speech(LEAF_WORDS[node.leaf])))
    if node.left_out:
        lines.append(("", speech(message("{count} more nodes are not shown", count=node.left_out))))
    return tuple(lines)


def prune(tree: TreeRecord, max_nodes: int) -> TreeRecord:
    """The tree with at most ``max_nodes`` nodes: whole families stay, the likeliest first."""
    kept = {id(tree)}
    frontier = [tree]
    while frontier:
        frontier.sort(key=lambda node: node.probability)
        children = frontier.pop().children
        if children and len(kept) + len(children) <= max_nodes:
            kept.update(map(id, children))
            frontier.extend(children)
    return _only(tree, kept)


def percent(probability: float, speech: Speech = IN_ENGLISH) -> str:
    """A probability for people: ``37 %``; never ``0 %`` or ``100 %`` for what is not certain."""
    if 0 < probability < 0.01:
        return speech.label("under 1 %")
    return speech.label("over 99 %") if 0.99 < probability < 1 else f"{probability:.0%}".replace("%", " %")


def _only(node: TreeRecord, kept: set[int]) -> TreeRecord:
    children = tuple(_only(child, kept) for child in node.children if id(child) in kept)
    left_out = node.left_out if children or not node.children else _size(node) - 1
    return node.model_copy(update={"children": children, "left_out": left_out})


def _size(node: TreeRecord) -> int:
    return 1 + node.left_out + sum(map(_size, node.children))


def _lines(node: TreeRecord, lead: str, own: str, below: str, speech: Speech) -> Iterator[str]:
    """A node's assumptions, its details under them, and then its children."""
    out = f"  ✘ {speech.label('ruled out by the answer')}" if node.ruled_out else ""
    mark = f"  ✔ {speech.label('flown')}" if node.flown else out
    yield f"{lead}{own}{node.words} ({percent(node.probability, speech)}){mark}"
    beside = "│  " if node.children else "   "
    yield f"{lead}{below}{beside}{' · '.join(text for _, text in details(node, speech))}".rstrip()
    for child in node.children:
        last = child is node.children[-1]
        bold = node.asked and not child.ruled_out
        corner = ("┗━ " if bold else "└─ ") if last else ("┣━ " if bold else "├─ ")
        yield from _lines(child, lead + below, corner, "   " if last else "│  ", speech)


def _numbered(tree: TreeRecord) -> Iterator[tuple[int, int | None, TreeRecord]]:
    """(number, number of the node above, node) in drawing order."""
    count = 0
    stack: list[tuple[int | None, TreeRecord]] = [(None, tree)]
    while stack:
        above, node = stack.pop()
        yield count, above, node
        stack.extend((count, child) for child in reversed(node.children))
        count += 1


def _quoted(text: str) -> str:
    """A DOT string; only quotes and backslashes are special in it."""
    lines = (printable(line).replace("\\", "\\\\").replace('"', '\\"') for line in text.split("\n"))
    return '"' + "\\n".join(lines) + '"'
