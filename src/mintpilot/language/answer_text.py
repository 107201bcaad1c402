"""An answer's raw text made comparable, and the vetoes in it (method, section 12)."""

from __future__ import annotations

import re
import unicodedata
from functools import cache

from mintpilot.core.query import Reply
from mintpilot.language.answer_words import ANSWER_WORDS

LONGEST = 300
"""Characters; a longer text is no answer."""
_APOSTROPHES = str.maketrans(dict.fromkeys("’‘ʼ`´", "'"))
_SPACES = re.compile(r"[ \t\r\n\u00a0\u202f]+")
_MARK = re.compile(r"[^\w .,;!'¡?¿-]|_|\.\.+|…")
"""Everything but letters, digits and plain punctuation: emoji, brackets, control characters, dots that trail off."""


def spoken(text: str) -> str:
    """The text composed (NFC), case folded, with plain apostrophes and single spaces; accents and marks are kept."""
    composed = unicodedata.normalize("NFC", unicodedata.normalize("NFC", text).casefold())
    return _SPACES.sub(" ", composed.translate(_APOSTROPHES)).strip()


def utterance(said: str) -> str:
    """The words alone, for comparison with a closed list: without plain punctuation."""
    return " ".join(re.sub(r"[.,;!¡?¿-]", " ", said).split())


def loose(text: str) -> str:
    """For caution only: compatibility forms resolved (NFKC) and accents left out, so that more is heard."""
    split = unicodedata.normalize("NFKD", spoken(unicodedata.normalize("NFKC", text)))
    return "".join(c for c in split if not unicodedata.combining(c))


@cache
def listed(entries: str) -> frozenset[str]:
    """The entries of a closed list."""
    return frozenset(utterance(spoken(entry)) for entry in entries.split("|"))


@cache
def words(pattern: str) -> re.Pattern[str]:
    """An expression that matches whole words only."""
    return re.compile(rf"(?<!\w)(?:{folded(pattern)})(?!\w)")


def folded(pattern: str) -> str:
    """The expression as case folding leaves the text: ``ß`` is ``ss``."""
    return pattern.replace("ß", "ss")


def without_courtesies(said: str, lang: str) -> str:
    """The utterance without words at either end that say nothing."""
    polite = rf"(?:{folded(ANSWER_WORDS[lang].courtesies)})"
    return re.sub(rf"^(?:{polite} )+|(?: {polite}| over)+$", "", utterance(said))


def vetoes(text: str, lang: str, reply: Reply) -> tuple[str, ...]:
    """The words and marks that forbid taking the text for that guarded reply, in order of appearance.

    Args:
        text: raw, with accents and emoji.
        lang: of the question.
        reply: YES or NO; words that deny forbid the one, words that affirm the other.
    """
    said = spoken(text)
    found = [(m.start(), m[0]) for pattern in _patterns(lang, reply) for m in pattern.finditer(said)]
    if unicodedata.normalize("NFKC", said) != said:
        found.append((len(said), "unusual letters"))
    return tuple(dict.fromkeys(word for _, word in sorted(found)))


@cache
def _patterns(lang: str, reply: Reply) -> tuple[re.Pattern[str], ...]:
    known = ANSWER_WORDS[lang]
    classes = (known.denial, known.danger, known.doubt, known.condition, known.limits, known.asks)
    return (_MARK, re.compile("[?¿]"), *map(words, classes), words(known.nay if reply is Reply.YES else known.aye))
