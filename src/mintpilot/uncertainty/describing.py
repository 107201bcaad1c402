"""Plain words for things, distinct from each other, so that a person can tell which one is meant."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence

from mintpilot.core.geometry import Vec3
from mintpilot.core.message import Message, Named, joined, message
from mintpilot.uncertainty.things import Thing, name_of, synonyms, values_of

_BEFORE = ("size", "colour", "pattern", "material", "shape")
"""Attributes said before the noun, in this order; others follow it."""
_ORDINALS = ("", "second ", "third ", "fourth ", "fifth ", "sixth ", "seventh ", "eighth ", "ninth ", "tenth ")
_PLACE_M = 3.0
_NO_PLACE = frozenset({"fire", "smoke", "floor", "ceiling"})


def describe(thing: Thing) -> str:
    """The thing in plain words with its article: ``the small red box``."""
    if thing.description:
        return thing.description if thing.description.startswith("the ") else f"the {thing.description}"
    before = [sorted(values_of(thing, name) - {"none"}) for name in _BEFORE]
    return " ".join(["the", *(value for values in before for value in values), thing.label.replace("_", " ")])


def describe_apart(things: Sequence[Thing], others: Sequence[Thing], start_m: Vec3) -> dict[str, str]:
    """Words for each thing, by id, no two alike and none true of another one.

    As much is said as tells them apart: size, colour and shape first, then other attributes, then a landmark next to
    it, then how near it is.

    Args:
        things: what is to be told apart.
        others: everything on the map, for landmarks.
        start_m: where the drone is, metres.
    """
    words = {t.id: describe(t) for t in things}
    for name in sorted({name_of(a) for t in things for a in t.attributes} - set(_BEFORE)):
        twins = _twins(words)
        mixed_up = {other for i in twins for other in _family(words[i], words)}
        longer = {t.id: _add(words[t.id], t, name) for t in things if t.id in mixed_up}
        if len(_twins(words | longer)) < len(twins):
            words |= longer
    twins = _twins(words)
    placed = {t.id: words[t.id] + place(t, others) for t in things if t.id in twins}
    words |= {i: text for i, text in placed.items() if Counter(placed.values())[text] == 1}
    return words | _ranked(things, words, start_m)


def place(thing: Thing, others: Sequence[Thing]) -> str:
    """`` next to the red rack``, from the nearest landmark of another class; empty where none is near."""
    marks = [t for t in others if not synonyms(t.label) & synonyms(thing.label) and t.label not in _NO_PLACE]
    near = [(math.dist(t.position_m, thing.position_m), t.id, t) for t in marks]
    if not near or min(near)[0] > _PLACE_M:
        return ""
    return f" next to {describe(min(near)[2])}"


def seen(things: Sequence[Thing]) -> Message:
    """What is on the map, in a few words: ``the red box, 2 racks``; for messages."""
    if not things:
        return message("nothing")
    counts = Counter(describe(t).removeprefix("the ") for t in things)
    parts = [
        Named(f"the {text}") if n == 1 else message("{n} times '{what}'", n=n, what=Named(text))
        for text, n in sorted(counts.items())
    ]
    said = joined(parts[:8], ", ")
    return message("{what} and {count} more", what=said, count=len(parts) - 8) if len(parts) > 8 else said


def _after(name: str, value: str) -> str:
    """``brown hair`` from ``hair colour: brown``; ``glasses`` from ``accessories: glasses``."""
    if name in ("accessories", "accessory", "contents", "feature", "features", "facial hair"):
        return value
    noun = name.removesuffix(" colour").removesuffix(" style").removesuffix(" type")
    return f"{value} {noun}"


def _add(words: str, thing: Thing, name: str) -> str:
    said = [_after(name, value) for value in sorted(values_of(thing, name) - {"none"})]
    if not said:
        return words
    return words + (" and " if " with " in words else " with ") + " and ".join(said)


def _twins(words: dict[str, str]) -> frozenset[str]:
    """Ids of things whose words are true of another thing too."""
    return frozenset(i for i, text in words.items() if len(_family(text, words)) > 1)


def _family(text: str, words: dict[str, str]) -> list[str]:
    """Ids of the things of which ``text`` says nothing that their own words do not say too."""
    said = set(text.split())
    return [i for i, other in words.items() if said <= set(other.split())]


def _ranked(things: Sequence[Thing], words: dict[str, str], start_m: Vec3) -> dict[str, str]:
    """``the second nearest red box`` for things that nothing else tells apart."""
    order = {t.id: (math.dist(start_m, t.position_m), t.position_m, t.id) for t in things}
    ranked: dict[str, str] = {}
    for name in _twins(words):
        noun = words[name].removeprefix("the ")
        rank = sorted(_family(words[name], words), key=lambda i: order[i]).index(name)
        known = rank < len(_ORDINALS)
        ranked[name] = f"the {_ORDINALS[rank]}nearest {noun}" if known else f"the {noun}, number {rank + 1} by distance"
    return ranked
