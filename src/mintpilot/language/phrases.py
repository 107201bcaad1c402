"""Noun phrase → `Reference`. Words that are not known stay in it as unnamed attributes: they rule nothing out."""

from __future__ import annotations

import re

from mintpilot.core.errors import InputError
from mintpilot.core.geometry import Vec3
from mintpilot.core.observation import Attribute
from mintpilot.core.task import Reference
from mintpilot.language import lexicon, patterns

DEFAULT_HEIGHT_M = 1.5
"""Height of a place that is given by two numbers only, metres."""
_MOST_WORDS = 8
"""Noun and what stands before it, without articles."""


def parse_phrase(phrase: str, before: Reference | None = None) -> Reference:
    """What a noun phrase means.

    Args:
        phrase: e.g. ``the small red box next to the rack``, ``every room on the left``, ``3, 4``, ``it``.
        before: the reference before it, for ``the blue one``.

    Raises:
        InputError: the phrase names a choice, several things, or no thing at all.
    """
    words = " ".join(phrase.lower().strip(" ,.!;").split())
    if (position_m := parse_position(words)) is not None:
        return Reference(phrase=words, position_m=position_m)
    if words in lexicon.PRONOUNS:
        return Reference(phrase=words)
    if re.search(r"\b(or|either)\b", words):
        raise InputError(f"'{words}' names a choice: say which one is meant, or describe both by what they share")
    if re.search(r"\band\b", words) and not re.search(r"\b(with|wearing|containing)\b.* and ", words):
        raise InputError(f"'{words}' names several things: give a step for each")
    return _describe(patterns.HERE.sub("", patterns.VENUE.sub("", words)), before)


def parse_position(words: str) -> Vec3 | None:
    """A place given by two or three numbers, metres; None for anything else."""
    found = patterns.POSITION.match(words)
    if found is None:
        return None
    x, y, z = found.groups()
    return (float(x), float(y), DEFAULT_HEIGHT_M if z is None else float(z))


def singular(noun: str) -> str:
    """The noun in the singular, as far as the lexicon's few rules go."""
    if noun in lexicon.IRREGULAR:
        return lexicon.IRREGULAR[noun]
    if noun.endswith(("sses", "shes", "ches", "xes")):
        return noun[:-2]
    return noun[:-1] if noun.endswith("s") and not noun.endswith(("ss", "us")) else noun


def _describe(words: str, before: Reference | None) -> Reference:
    rest, after = _tail(words)
    tokens = patterns.RELATIVE.sub("", rest).split()
    every = bool(tokens) and tokens[0] in lexicon.EVERY
    if every and tokens[1:2] == ["of"]:
        tokens = [tokens[0], *tokens[2:]]
    tokens = [t for t in tokens[int(every) :] if t not in lexicon.DETERMINERS]
    if len(tokens) > 1 and tokens[-1] in lexicon.ADJECTIVES:  # anyone hurt, somebody injured
        tokens = [*tokens[-1:], *tokens[:-1]]
    tokens = [t for t in tokens if t not in ("else", "other", "further", "more")]
    if len(tokens) > _MOST_WORDS:
        raise InputError(f"'{words[:60]} …' is too long for one thing: describe it in at most {_MOST_WORDS} words")
    if not tokens or tokens[-1] in lexicon.ADJECTIVES or not tokens[-1][0].isalpha():
        raise InputError(f"'{words}' names no thing: add a noun, as in 'the red box'")
    *adjectives, noun = tokens
    if lexicon.FUNCTION_WORDS & set(tokens) or any("," in word for word in tokens):
        raise InputError(f"'{words}' is not understood as one thing: name it by what it looks like and where it is")
    said = tuple(_attribute(word) for word in adjectives)
    if noun in ("one", "ones") and before is not None:
        return Reference(phrase=words, label=before.label, attributes=(*said, *after), every=every)
    if noun in lexicon.ROOM_KINDS:
        said, noun = (*said, _attribute(noun)), "room"
    label = "person" if noun in lexicon.PEOPLE else "room" if noun in lexicon.ROOMS else singular(noun)
    plural = noun in lexicon.ANYBODY or (label != noun and noun not in lexicon.PEOPLE | lexicon.ROOMS)
    plural = plural or (noun in lexicon.PEOPLE | lexicon.ROOMS and singular(noun) != noun)
    return Reference(phrase=words, label=label, attributes=(*said, *after), every=every or plural)


def _tail(words: str) -> tuple[str, tuple[Attribute, ...]]:
    """Takes what follows the noun off its phrase: ``on the left``, ``next to the rack``, ``with the medicine``."""
    found: list[Attribute] = []
    for pattern, name in (
        (patterns.STATE, "condition"),
        (patterns.SIDE, "side"),
        (patterns.WITH, "contents"),
        (patterns.NEAR, "near"),
    ):
        match = pattern.search(words)
        if match is None:
            continue
        words, value = words[: match.start()], match.group(1)
        found.append(_attribute(value) if name == "condition" else Attribute(name=name, value=value))
    return words, tuple(found)


def _attribute(word: str) -> Attribute:
    name, value = lexicon.ADJECTIVES.get(word, ("", word))
    return Attribute(name=name, value=value)
