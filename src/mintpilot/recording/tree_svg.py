"""The MINT tree as a self-contained SVG: cards from left to right, each branch beside what it assumes."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator
from dataclasses import dataclass
from xml.sax.saxutils import escape

from mintpilot.core.message import message
from mintpilot.recording.record import TreeRecord
from mintpilot.recording.tree_drawing import details, percent, prune
from mintpilot.recording.words import printable
from mintpilot.wording.speech import IN_ENGLISH, Speech

_CARD, _GAP, _LINE, _PAD, _BETWEEN = 290.0, 62.0, 17.0, 11.0, 14.0
"""Widths of a card and of the space between columns, height of a line, padding, space between rows; pixels."""
_BOLD, _PLAIN = 31, 36
"""Letters in a line of a card, by weight; few enough for the widest of the fonts."""
_STYLE = """
.mint { font: 13px system-ui, -apple-system, "Segoe UI", "DejaVu Sans", sans-serif; }
.mint rect { fill: var(--card, #ffffff); stroke: var(--line, #c6ced6); stroke-width: 1.2; }
.mint text { fill: var(--ink, #1b2733); }
.mint .words { font-weight: 600; }
.mint .odds, .mint .fact { fill: var(--soft, #566472); }
.mint path { fill: none; stroke: var(--line, #c6ced6); stroke-width: 1.6; }
.mint path.asked { stroke: var(--accent, #0072b2); stroke-width: 3.2; }
.mint .edge { font-size: 11px; font-weight: 600; fill: var(--accent, #0072b2); }
.mint .asks rect { stroke: var(--accent, #0072b2); stroke-width: 2; }
.mint .asks .branch { fill: var(--accent, #0072b2); font-weight: 600; }
.mint .flown rect { fill: var(--good-soft, #dff3ea); stroke: var(--good, #007a5a); stroke-width: 2.4; }
.mint .flown .plan { fill: var(--good, #007a5a); font-weight: 600; }
.mint .out { opacity: .5; }
"""


@dataclass(slots=True, kw_only=True)
class _Card:
    """One node with its place."""

    node: TreeRecord
    lines: list[tuple[str, str]]
    """(style, text)."""
    depth: int
    children: list[_Card]
    middle: float = 0.0
    """Height of its middle, pixels from the top."""

    @property
    def height(self) -> float:
        return len(self.lines) * _LINE + 2 * _PAD

    @property
    def left(self) -> float:
        return 1.5 + self.depth * (_CARD + _GAP)


def tree_svg(tree: TreeRecord, *, max_nodes: int = 60, speech: Speech = IN_ENGLISH) -> str:
    """The tree as SVG; colours come from CSS variables of the page around it, with own ones where there are none.

    Args:
        tree: the tree.
        max_nodes: nodes drawn; those left out are counted where they would be.
        speech: the language of what is said around the tree's own words.
    """
    root = _card(prune(tree, max_nodes), 0, speech)
    bottom = _place(root, 1.5)
    cards = list(_walk(root))
    lift = 1.5 - min(card.middle - card.height / 2 for card in cards)
    for card in cards:
        card.middle += lift
    width = max(card.left for card in cards) + _CARD + 1.5
    height = max(bottom + lift, *(card.middle + card.height / 2 for card in cards)) + 1.5
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" class="mint" viewBox="0 0 {width:.0f} {height:.0f}" '
        f'width="{width:.0f}" height="{height:.0f}" role="img">',
        f"<title>{escape(speech.label('What the best way to fly depends on'))}</title>",
        f"<style>{_STYLE}</style>",
        *(_edge(card, child) for card in cards for child in card.children),
        *(_draw(card) for card in cards),
        "</svg>\n",
    ]
    return "\n".join(parts)


def _card(node: TreeRecord, depth: int, speech: Speech) -> _Card:
    lines = [("words", line) for line in _wrapped(node.words[:1].upper() + node.words[1:], _BOLD, 3)]
    odds = message("{share} likely", share=percent(node.probability, speech))
    lines.append(("odds", speech(odds if depth else message("Before any question"))))
    for kind, fact in details(node, speech):
        style = f"{kind} fact" if kind else "fact"
        lines.extend((style, line) for line in _wrapped(fact, _PLAIN if style == "fact" else _BOLD, 2))
    return _Card(
        node=node, lines=lines, depth=depth, children=[_card(child, depth + 1, speech) for child in node.children]
    )


def _place(card: _Card, top: float) -> float:
    """Gives the card and all under it their heights; returns where the next one may begin."""
    if not card.children:
        card.middle = top + card.height / 2
        return top + card.height + _BETWEEN
    bottom = top
    for child in card.children:
        bottom = _place(child, bottom)
    card.middle = (card.children[0].middle + card.children[-1].middle) / 2
    overhang = top - (card.middle - card.height / 2)
    if overhang > 0:
        for each in _walk(card):
            each.middle += overhang
        bottom += overhang
    return max(bottom, card.middle + card.height / 2 + _BETWEEN)


def _walk(card: _Card) -> Iterator[_Card]:
    yield card
    for child in card.children:
        yield from _walk(child)


def _edge(card: _Card, child: _Card) -> str:
    x0, x1 = card.left + _CARD, child.left
    bend = (x0 + x1) / 2
    y0, y1 = card.middle, child.middle
    path = f"M{x0:.1f},{y0:.1f} C{bend:.1f},{y0:.1f} {bend:.1f},{y1:.1f} {x1:.1f},{y1:.1f}"
    asked = card.node.asked and not child.node.ruled_out
    return f'<path class="{"asked" if asked else "open"}" d="{path}"/>'


def _draw(card: _Card) -> str:
    node = card.node
    marks = ("asks", node.asked), ("flown", node.flown), ("out", node.ruled_out)
    style = " ".join(["node", *(name for name, holds in marks if holds)])
    top = card.middle - card.height / 2
    x, base = card.left + 12, top + _PAD + 0.75 * _LINE
    texts = "".join(
        f'<text class="{kind}" x="{x:.1f}" y="{base + row * _LINE:.1f}">{escape(line)}</text>'
        for row, (kind, line) in enumerate(card.lines)
    )
    box = f'<rect x="{card.left:.1f}" y="{top:.1f}" width="{_CARD:.0f}" height="{card.height:.1f}" rx="9"/>'
    return f'<g class="{style}">{box}{texts}</g>'


def _wrapped(text: str, letters: int, rows: int) -> list[str]:
    return textwrap.wrap(printable(text), letters, max_lines=rows, placeholder=" …") or [""]
