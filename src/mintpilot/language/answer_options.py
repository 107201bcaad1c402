"""Which option of a choice an answer names: its number, its words, or attributes of the thing (method, section 12)."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cache

from mintpilot.core.query import NONE_OF_THESE, Query, Question, Reply
from mintpilot.core.reading import Reading, ReadingKind
from mintpilot.language.answer_text import spoken, utterance, without_courtesies


@dataclass(frozen=True, slots=True, kw_only=True)
class _Numbers:
    """How one language counts options: expressions, for each number from 1 to 4."""

    lead: str
    """May stand before a number: ``option``."""
    cardinal: tuple[str, str, str, str]
    article: str
    ordinal: tuple[str, str, str, str]
    noun: str
    """May stand after an ordinal: ``the second one``."""
    none: str
    """Says that it is none of those that are named."""


_NUMBERS = {
    "en": _Numbers(
        lead="number|option",
        cardinal=("1|one", "2|two", "3|three", "4|four"),
        article="the",
        ordinal=("first|1st", "second|2nd", "third|3rd", "fourth|4th"),
        noun="one|option",
        none="none|none of these|none of them|neither|neither of them",
    ),
    "de": _Numbers(
        lead="nummer|option",
        cardinal=("1|eins", "2|zwei|zwo", "3|drei", "4|vier"),
        article="der|die|das",
        ordinal=("erste", "zweite", "dritte", "vierte"),
        noun="option",
        none="keins|keine|keiner|keins davon|keine davon|keiner davon|keins von beiden",
    ),
    "fr": _Numbers(
        lead="numéro|option",
        cardinal=("1|un|une", "2|deux", "3|trois", "4|quatre"),
        article="le|la",
        ordinal=("premier|première", "deuxième|second|seconde", "troisième", "quatrième"),
        noun="option",
        none="aucun|aucune|aucun des deux|aucune des deux|aucun d'eux|aucune d'elles|ni l'un ni l'autre",
    ),
    "es": _Numbers(
        lead="número|opción",
        cardinal=("1|uno|una", "2|dos", "3|tres", "4|cuatro"),
        article="el|la",
        ordinal=("primero|primera", "segundo|segunda", "tercero|tercera", "cuarto|cuarta"),
        noun="opción",
        none="ninguno|ninguna|ninguno de ellos|ninguna de ellas|ninguno de los dos",
    ),
}


_UNSURE = re.compile(r"[?¿]|\.\.|…")


def option_in(text: str, question: Question, lang: str) -> Reading | None:
    """The option that a whole utterance names: by its number or ordinal, or, to be read back, by its words.

    None where it names none, or where it asks or trails off.
    """
    query, said = question.query, without_courtesies(spoken(text), lang)
    if _UNSURE.search(text):
        return None
    if said in _none(lang) and (none := _none_of(query)) is not None:
        return Reading(kind=ReadingKind.OPTION, option=none + 1)
    for number, pattern in enumerate(_called(lang), 1):
        if pattern.fullmatch(said):
            return Reading(kind=ReadingKind.OPTION, option=number) if number <= query.part_count else None
    named = [part for part in range(query.part_count) if said == _words(query, part)]
    return Reading(kind=ReadingKind.READ_BACK, reply=Reply.OPTION, option=named[0] + 1) if len(named) == 1 else None


def _words(query: Query, part: int) -> str:
    return utterance(spoken(query.part_words(part)))


def _none_of(query: Query) -> int | None:
    """The part that is called none of these, or neither."""
    found = [part for part in range(query.part_count) if query.part_words(part) in (NONE_OF_THESE, "neither")]
    return found[0] if found else None


@cache
def _none(lang: str) -> frozenset[str]:
    return frozenset(utterance(spoken(entry)) for entry in _NUMBERS[lang].none.split("|"))


@cache
def _called(lang: str) -> tuple[re.Pattern[str], ...]:
    known = _NUMBERS[lang]
    return tuple(
        re.compile(
            rf"(?:(?:{known.lead}) )?(?:{cardinal})|(?:(?:{known.article}) )?(?:{ordinal})(?: (?:{known.noun}))?"
        )
        for cardinal, ordinal in zip(known.cardinal, known.ordinal, strict=True)
    )
