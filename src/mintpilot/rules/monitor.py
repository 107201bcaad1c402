"""Whether a flight kept a rule: its text is read and evaluated by LTLf's own definition (method, section 14).

It shares nothing with the planning of flights: no formula tree, no normal form, no automaton. Each word of the text
becomes the truth, moment by moment, of what it stands for.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from typing import TypeAlias

import numpy as np

from mintpilot.core.geometry import Bools

Lookup: TypeAlias = Callable[[str, str, float], Bools]
"""Truth (moments,) of a proposition: what it speaks of, of whom, metres (0 where it has none)."""
_WORD = re.compile(r"\s*([a-z]+\s*\([^()]*\)|->|[A-Z]|true|false|[!&|()])")
_JOINS = ("->", "|", "&", "UR")
"""From the loosest; the first and the last group to the right."""


def is_kept(rule: str, of: Lookup, moments: int) -> bool:
    """Whether a flight of so many moments, at least 1, keeps the rule, a formula as `mintpilot.rules.parsing` takes it.

    Raises:
        ValueError: it is no formula.
    """
    return bool(truth(rule, of, moments)[0])


def truth(rule: str, of: Lookup, moments: int) -> Bools:
    """Whether the rule holds from each moment on, (moments,); the first one tells of the whole flight."""
    words = [*_words(rule), ""]
    found, at = _joined(words, 0, 0, of, moments)
    if words[at]:
        raise ValueError(f"rule '{rule}': '{words[at]}' follows what is complete")
    return found


def _words(rule: str) -> Iterator[str]:
    at, rule = 0, rule.strip()
    while at < len(rule):
        match = _WORD.match(rule, at)
        if match is None:
            raise ValueError(f"rule '{rule}': nothing is read from '{rule[at:]}'")
        yield match.group(1)
        at = match.end()


def _joined(words: list[str], at: int, level: int, of: Lookup, moments: int) -> tuple[Bools, int]:
    """Truth of what begins with that word and joins as tightly as that level, and where it ends."""
    if level == len(_JOINS):
        return _single(words, at, of, moments)
    left, at = _joined(words, at, level + 1, of, moments)
    while words[at] and words[at] in _JOINS[level]:
        sign = words[at]
        right, at = _joined(words, at + 1, level if sign in "->UR" else level + 1, of, moments)
        match sign:
            case "->":
                left = ~left | right
            case "|":
                left = left | right
            case "&":
                left = left & right
            case "U":
                left = _until(left, right)
            case _:
                left = ~_until(~left, ~right)
    return left, at


def _single(words: list[str], at: int, of: Lookup, moments: int) -> tuple[Bools, int]:
    word = words[at]
    if word == "(":
        found, at = _joined(words, at + 1, 0, of, moments)
        if words[at] != ")":
            raise ValueError(f"a bracket is not closed before '{words[at]}'")
        return found, at + 1
    if word in ("!", "G", "F"):
        found, at = _single(words, at + 1, of, moments)
        every = np.ones(moments, bool)
        return (~found if word == "!" else _until(every, found) if word == "F" else ~_until(every, ~found)), at
    if word in ("true", "false"):
        return np.full(moments, word == "true"), at + 1
    about, _, inside = word.partition("(")
    if not inside:
        raise ValueError(f"'{word}' where a proposition is wanted")
    subject, *metres = (part.strip() for part in inside.rstrip(")").split(","))
    away_m = float(metres[0].removesuffix("m")) if metres else 0.0
    return np.asarray(of(about.strip(), subject, away_m), bool), at + 1


def _until(left: Bools, right: Bools) -> Bools:
    """From which moments on the right one comes, the left one holding at every moment before."""
    moments = np.arange(len(left))
    comes = np.minimum.accumulate(np.where(right, moments, len(left))[::-1])[::-1]
    fails = np.minimum.accumulate(np.where(left, len(left), moments)[::-1])[::-1]
    found: Bools = (comes < len(left)) & (comes <= fails)
    return found
