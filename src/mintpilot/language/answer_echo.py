"""The question's own words in an answer: ``there is no one in the storage room`` is ``there is no one inside``."""

from __future__ import annotations

import re

from mintpilot.core.gap import GapKind
from mintpilot.core.query import Question
from mintpilot.language.answer_lexing import plain

PREPOSITION = (
    r"(?:by|near|at|in|on|next to|behind|beside|between|under|over|above|below|across|opposite|close to|to the|outside"
    r"|inside|around|beyond|past|in front of|with|from|along)"
)
"""What begins where something is."""
_TAIL = re.compile(rf"^(?P<head>.+?) (?P<tail>{PREPOSITION} .+)$")


def unechoed(words: str, question: Question) -> str:
    """The answer with the name of the region or room that was asked about as a mere ``it``, or ``inside``.

    Its short name (``the grey smoke`` for ``the grey smoke near the crates``) counts only where no other place follows
    it. With several gaps, or a choice among things, the words stay.

    Args:
        words: as `answer_lexing.plain` gives them.
        question: what was asked.
    """
    if len(question.gaps) != 1 or question.gaps[0].kind not in (GapKind.OBSTACLE, GapKind.PRESENCE):
        return words
    name = re.sub(r"^(?:the|a|an) ", "", plain(question.gaps[0].description))
    if " " not in name:
        return words  # a mere ``smoke`` may be the start of other words: ``smoke machine``
    parts = _TAIL.match(name)
    head, tail = (parts["head"], parts["tail"]) if parts else (name, "")
    whole = [name, *(f"{noun} {tail}" for noun in ("one", head.split()[-1]) if tail)]
    short = head if " " in head else name
    called = rf"\b(?:the|that|this) (?:{'|'.join(map(re.escape, whole))}|{re.escape(short)}(?! {PREPOSITION} ))(?!\w)"
    if question.gaps[0].kind is GapKind.PRESENCE:
        words = re.sub(rf"\b(?:in|inside|within) {called}", "inside", words)
    return re.sub(called, "it", words)
