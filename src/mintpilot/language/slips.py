"""Slips of typing and hearing that may hide a doubt, a condition or a negation beside a Yes."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from itertools import pairwise


def _words(text: str) -> frozenset[str]:
    return frozenset(text.split())


_CAUTION = _words(
    "not no never dont isnt cant wont without nobody none think maybe perhaps probably possibly guess guessing "
    "suppose believe should could might would hope hopefully seems looks likely almost fairly pretty sure "
    "unsure if unless until when but except only though what where which why how who are toxic unsafe danger "
    "dangerous poison blocked says said just kidding forget opposite leave haha idea percent fire leaning "
    "something anyone try check wait stop have does stay keep out away avoid around "
)
_SHORTEST_WHOLE = 3
_SHORTEST_PART = 3


def is_slip(a: str, b: str) -> bool:
    """Whether one letter too many, too few, wrong, or two exchanged make the one of the other."""
    if abs(len(a) - len(b)) > 1:
        return False
    start = next((i for i, (x, y) in enumerate(zip(a, b, strict=False)) if x != y), min(len(a), len(b)))
    rest_a, rest_b = a[start:], b[start:]
    if rest_a[1:] == rest_b[1:] or rest_a[1:] == rest_b or rest_a == rest_b[1:]:
        return True
    return rest_a[:2] == rest_b[1::-1] and rest_a[2:] == rest_b[2:]


_KEYS = ("nobody", "someone", "somebody", "anyone", "anybody", "dangerous", "toxic", "empty", "safe")
_SHORTEST_LOSING = 5


def key_word(token: str) -> str | None:
    """The word on which an answer hangs of which this is a plain slip: letters exchanged, one doubled, one lost."""
    for key in _KEYS:
        if token[:1] != key[0] or token == key or not is_slip(token, key):
            continue
        is_doubled = len(token) > len(key) and any(a == b for a, b in pairwise(token))
        is_lost = len(token) < len(key) >= _SHORTEST_LOSING
        if sorted(token) == sorted(key) or is_doubled or is_lost:
            return key
    return None


def mended(word: str, known: Collection[str]) -> str:
    """The one known word that has a letter more or two letters exchanged, else the word itself.

    Args:
        word: in lower case.
        known: words that a slip may be of.
    """
    if word in known or len(word) < _SHORTEST_WHOLE:
        return word
    near = [k for k in known if is_slip(word, k) and (sorted(word) == sorted(k) or (len(k) == len(word) + 1 > 5))]
    return near[0] if len(near) == 1 else word


def may_hide_caution(unknown: Sequence[str]) -> bool:
    """Whether one of the unknown words of an answer may be a word of caution, mistyped or run into another.

    Args:
        unknown: the words, in order.
    """
    pairs = (a + b for a, b in pairwise(unknown))
    return any(_hides(word) for word in (*unknown, *pairs))


def may_be_not(unknown: Collection[str]) -> bool:
    """Whether one of the unknown words may be a mistyped ``not``, which would turn what is said."""
    return any(word.startswith("n") and is_slip(word, "not") for word in unknown)


def _hides(word: str) -> bool:
    if len(word) < _SHORTEST_WHOLE:
        return word.isalpha()
    if any(is_slip(word, caution) for caution in _CAUTION):
        return True
    ends = (word[:cut] for cut in range(_SHORTEST_PART, len(word)))
    starts = (word[cut:] for cut in range(1, len(word) - _SHORTEST_PART + 1))
    return not _CAUTION.isdisjoint((*ends, *starts))
