"""Patterns of clauses: ``GO [ADVERBS] TO <things> [<height>]``, and how they are matched against words.

A pattern is made of plain words, names of phrase tables in `mintpilot.language.verbs` (in capitals, the longest phrase
that fits is taken), slots in angle brackets (`mintpilot.language.slots`), ``[…]`` for what may be left out and
``(… | …)`` for a choice. The first alternative that fits is kept; nothing taken is tried again in another way.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cache
from typing import TypeAlias

from mintpilot.core.task import Reference
from mintpilot.language import verbs
from mintpilot.language.clauses import Reading

_MACROS = {"{HOW}": "[[,] SLOWLY] [<height> [[,] SLOWLY]]", "{PLACE}": "[<room> | <venue>]"}
_SYMBOL = re.compile(r"[\[\]()|]|[^\s\[\]()|]+")


@dataclass(slots=True, kw_only=True)
class Found:
    """What the slots of one clause hold."""

    things: list[Reference] = field(default_factory=list)
    rooms: list[Reference] = field(default_factory=list)
    source: Reference | None = None
    goal: Reference | None = None
    height_m: float | None = None
    distance_m: float | None = None
    dwell_s: float | None = None
    said: dict[str, str] = field(default_factory=dict)
    """Name of a phrase table → the phrase of it that was taken."""

    def copy(self) -> Found:
        """The same, to go back to."""
        return replace(self, things=[*self.things], rooms=[*self.rooms], said={**self.said})


Slot: TypeAlias = Callable[[Reading, Found], None]
"""Takes what stands at the cursor into its part of `Found`; raises `Unread` where it does not fit."""


@dataclass(frozen=True, slots=True)
class _Part:
    """A word, a table's name or a slot; or, with ``choices``, a group."""

    word: str = ""
    choices: tuple[tuple[_Part, ...], ...] = ()
    is_optional: bool = False


@cache
def _compiled(pattern: str) -> _Part:
    for name, text in _MACROS.items():
        pattern = pattern.replace(name, text)
    symbols = iter(_SYMBOL.findall(pattern))
    return _Part(choices=_choices(symbols, ""))


def _choices(symbols: Iterator[str], closing: str) -> tuple[tuple[_Part, ...], ...]:
    choices: list[list[_Part]] = [[]]
    for symbol in symbols:
        if symbol == closing:
            break
        if symbol == "|":
            choices.append([])
        elif symbol in "[(":
            inner = _choices(symbols, "]" if symbol == "[" else ")")
            choices[-1].append(_Part(choices=inner, is_optional=symbol == "["))
        else:
            choices[-1].append(_Part(word=symbol))
    return tuple(tuple(choice) for choice in choices)


def matched(pattern: str, reading: Reading, slots: Mapping[str, Slot]) -> Found:
    """What the slots hold where the pattern fits at the cursor. Raises `Unread` where it does not."""
    found = _fit(_compiled(pattern), reading, Found(), slots)
    return found or reading.words.fail()


def _fit(part: _Part, reading: Reading, found: Found, slots: Mapping[str, Slot]) -> Found | None:
    """What is held after the part; None, and nothing taken, where it does not fit."""
    for choice in part.choices:
        tried: list[Found] = [found.copy()]

        def take(reading: Reading, choice: tuple[_Part, ...] = choice, tried: list[Found] = tried) -> None:
            for inner in choice:
                tried[0] = _fit(inner, reading, tried[0], slots) or reading.words.fail()

        if reading.attempt(take):
            return tried[0]
    if part.choices:
        return found if part.is_optional else None
    if part.word.startswith("<"):
        slots[part.word](reading, found)
        return found
    table = getattr(verbs, part.word) if part.word.isupper() else (part.word,)
    taken = reading.words.take(*table)
    if taken and part.word.isupper():
        found.said[part.word] = taken
    return found if taken else None
