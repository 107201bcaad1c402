"""Slips of typing in the verbs of an instruction."""

from __future__ import annotations

from collections.abc import Collection

_SHORTEST = 3
"""Letters; a shorter word may be a slip of too many others."""


def mended(word: str, known: Collection[str]) -> str:
    """The one known word that has a letter more or two letters exchanged, else the word itself.

    Args:
        word: in lower case.
        known: words that a slip may be of.
    """
    if word in known or len(word) < _SHORTEST:
        return word
    near = [k for k in known if _is_slip(word, k) and (sorted(word) == sorted(k) or (len(k) == len(word) + 1 > 5))]
    return near[0] if len(near) == 1 else word


def _is_slip(a: str, b: str) -> bool:
    """Whether one letter too many, too few, wrong, or two exchanged make the one of the other."""
    if abs(len(a) - len(b)) > 1:
        return False
    start = next((i for i, (x, y) in enumerate(zip(a, b, strict=False)) if x != y), min(len(a), len(b)))
    rest_a, rest_b = a[start:], b[start:]
    if rest_a[1:] == rest_b[1:] or rest_a[1:] == rest_b or rest_a == rest_b[1:]:
        return True
    return rest_a[:2] == rest_b[1::-1] and rest_a[2:] == rest_b[2:]
