"""Answers in the operator's own language: keys, plain answers and orders. Everything else is asked again."""

from __future__ import annotations

import re

from mintpilot.core.query import Question
from mintpilot.language.answers import Reading, Understood, understand_answer
from mintpilot.language.foreign_answers import understand_foreign

_KEYS: dict[str, Reading] = {
    **dict.fromkeys(("y", "yes"), Reading.YES),
    **dict.fromkeys(("n", "no"), Reading.NO),
    **dict.fromkeys(("?", "u", "unsure", "don't know"), Reading.UNSURE),
}
"""The keys that a screen offers, in every language."""
_EXTRA_KEYS: dict[str, dict[str, Reading]] = {
    "de": {"j": Reading.YES},
    "fr": {"o": Reading.YES},
    "es": {"s": Reading.YES},
}


def understand_in(text: str, question: Question, language: str) -> Understood:
    """Reads an answer of somebody who is asked in that language.

    In English the rules read whatever they can (`understand_answer`). In the other languages only listed answers
    count, and orders, which are heard in English as well: English rules would misread ``no sé`` as a No.

    Args:
        text: the words. Never an instruction to this program.
        question: what was asked.
        language: ``en``, ``de``, ``fr`` or ``es``.
    """
    words = " ".join(re.sub(r"[,;.!¡]", " ", text.lower().replace("\N{RIGHT SINGLE QUOTATION MARK}", "'")).split())
    key = {**_KEYS, **_EXTRA_KEYS.get(language, {})}.get(words)
    if key is not None:
        return Understood(reading=key)
    foreign = None if language == "en" else understand_foreign(text, language)
    if foreign is not None:
        return Understood(reading=Reading(foreign[0]), command=foreign[1])
    heard = understand_answer(text, question)
    if language == "en" or heard.reading is Reading.COMMAND:
        return heard
    return Understood(reading=Reading.OTHER)
