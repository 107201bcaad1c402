"""Things, regions and rooms in the mission's language, for the page."""

from __future__ import annotations

from mintpilot.wording.tongues import TONGUES
from mintpilot.wording.translating import noun_phrase


def named(english: str, lang: str) -> str:
    """``the closed room`` in that language; in quotation marks and English where a word of it is not known."""
    tongue = TONGUES.get(lang)
    return english if tongue is None or not english else noun_phrase(english, tongue)
