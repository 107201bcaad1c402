"""Words in order, and the noun phrases among them: ``the small red box next to the rack`` → `Reference`."""

from __future__ import annotations

import re
from collections.abc import Collection
from dataclasses import dataclass, field
from typing import NoReturn

from mintpilot.core.errors import InputError
from mintpilot.core.geometry import Vec3
from mintpilot.core.observation import Attribute
from mintpilot.core.task import Reference
from mintpilot.language import lexicon, verbs
from mintpilot.language.lexicon import singular

DEFAULT_HEIGHT_M = 1.5
"""Height of a place that is given by two numbers only, metres."""
_TOKEN = re.compile(r"\d+(?:\.\d+)?|[^\W\d_]+(?:['-][^\W\d_]+)*|[^\w\s]|\S")
_HESITATIONS = ("um", "uh", "er", "erm", "hm", "uhm")
_LARGEST = 1e6
_NUMBER = re.compile(r"\d+(?:\.\d+)?")
_PERSON = "person"


class InstructionError(InputError):
    """An instruction that is not understood.

    Attributes:
        word: the word that has no part in any reading; empty where it is not one word.
        reason: why it is refused.
    """

    def __init__(self, message: str, *, word: str = "", reason: str = "") -> None:
        super().__init__(message)
        self.word = word
        self.reason = reason or message


def refuse(word: str, reason: str) -> NoReturn:
    """Raises `InstructionError`: the word or phrase, and what is wrong with it."""
    raise InstructionError(f"'{word}' {reason}", word=word, reason=reason)


class Unread(Exception):  # noqa: N818
    """The words do not fit here. Tried further up in another way, and refused in the end."""


@dataclass(slots=True)
class Words:
    """A cursor over the words of an instruction."""

    tokens: list[str]
    known: Collection[str] = ()
    """Words of the map, which may name things besides those of the lexicon."""
    at: int = 0
    open: bool = False
    """Whether one unknown noun may stand here."""
    furthest: int = field(default=0, init=False)
    """The furthest word that anything was tried at: the one that is in the way where nothing fits."""

    def next(self, ahead: int = 0) -> str:
        """The word at the cursor, or further on; empty at the end."""
        index = self.at + ahead
        return self.tokens[index] if index < len(self.tokens) else ""

    def take(self, *phrases: str) -> str:
        """Takes the longest of these phrases that stands here; empty, and nothing taken, where none does."""
        best = ""
        for phrase in phrases:
            parts = phrase.split()
            if len(parts) > len(best.split()) and self.tokens[self.at : self.at + len(parts)] == parts:
                best = phrase
        self.move(self.at + len(best.split()))
        return best

    def need(self, *phrases: str) -> str:
        """As `take`. Raises `Unread` where none of them stands here."""
        return self.take(*phrases) or self.fail()

    def move(self, at: int) -> None:
        """Puts the cursor there."""
        self.at = at
        self.furthest = max(self.furthest, at)

    def fail(self) -> NoReturn:
        """Raises `Unread`."""
        raise Unread

    def said(self, start: int) -> str:
        """The words from there to the cursor."""
        first, *rest = self.tokens[start : self.at]
        first = "the" if first in ("this", "that", "these", "those") else first
        return " ".join((first, *rest)).replace("first-aid", "first aid")

    def number(self) -> float | None:
        """Takes a number in digits, its sign before it."""
        sign = self.next() == "-" and bool(_NUMBER.fullmatch(self.next(1)))
        if not _NUMBER.fullmatch(self.next(int(sign))):
            return None
        value = float(self.next(int(sign)))
        if value > _LARGEST:
            return None
        self.move(self.at + 1 + sign)
        return -value if sign else value


def words_of(text: str) -> list[str]:
    """Words, numbers and marks of an instruction, in lower case."""
    plain = text.replace("\N{RIGHT SINGLE QUOTATION MARK}", "'").replace("\N{LEFT SINGLE QUOTATION MARK}", "'")
    plain = plain.lower().replace("first aid", "first-aid")
    return [word for word in _TOKEN.findall(plain) if word not in _HESITATIONS]


def noun_phrase(words: Words, *, tail: bool = True, before: Reference | None = None) -> Reference:
    """Takes one noun phrase that stands at the cursor.

    Args:
        words: where to read.
        tail: False leaves what says where the thing is (``at the gate``) to the caller.
        before: the reference before it, for ``the blue one``.

    Raises:
        Unread: there is none.
    """
    start = words.at
    position_m = _position(words)
    if position_m is not None:
        numbers = [float(w) for w in words.said(start).replace("- ", "-").split() if w.lstrip("-")[:1].isdecimal()]
        return Reference(phrase=", ".join(f"{number:g}" for number in numbers), position_m=position_m)
    every = _quantifier(words)
    article = words.take(*lexicon.DETERMINERS) if not every or words.next() in ("the", "my", "our", "these") else every
    said, noun = _core(words, bool(article), before)
    label, more, plural = _label(noun, before)
    first = words.at
    attributes = [*said, *more]
    attributes += _whereabouts(words, label) if tail else []
    phrase = words.said(start)
    # A postponed adjective belongs before the noun: someone hurt.
    if words.at == first and noun in lexicon.ANYBODY | {"people"} and words.next() in lexicon.ADJECTIVES:
        attributes.append(_attribute(words.next()))
        words.move(words.at + 1)
        phrase = words.said(start)
    return Reference(phrase=phrase, label=label, attributes=tuple(attributes), every=bool(every) or plural)


def parse_phrase(phrase: str, known: Collection[str] = ()) -> Reference:
    """What a noun phrase by itself means, e.g. ``the small red box next to the rack``. Raises `InputError`."""
    words = Words(words_of(phrase), known, open=True)
    try:
        found = noun_phrase(words)
    except Unread:
        found = None
    if found is None or words.next():
        refuse(phrase, "is not understood as one thing: name it by what it looks like and where it is")
    return found


def _quantifier(words: Words) -> str:
    every = words.take("each of", "all of", *lexicon.EVERY)
    return every.split()[0] if every else ""


def _core(words: Words, has_article: bool, before: Reference | None) -> tuple[list[Attribute], str]:
    """Adjectives and noun. One noun may be unknown: directly after its article and known adjectives, and the last."""
    adjectives: list[str] = []
    while _is_adjective(words, words.next()) and (_names_more(words) or not _is_noun(words, words.next())):
        adjectives.append(words.next())
        words.move(words.at + 1)
    nouns: list[str] = []
    while _is_noun(words, words.next()):
        nouns.append(words.next())
        words.move(words.at + 1)
    if not nouns and words.next() in ("one", "ones") and before is not None and adjectives and before.label:
        words.move(words.at + 1)
        return [_attribute(word) for word in adjectives], "one"
    if not nouns and has_article and words.open and _may_be_noun(words.next()) and not _is_noun(words, words.next(1)):
        nouns.append(words.next())
        words.move(words.at + 1)
    if not nouns:
        words.fail()
    *compound, noun = nouns
    if noun in lexicon.ROOMS and compound:
        return [*map(_attribute, adjectives), Attribute(name="kind", value=" ".join((*compound, singular(noun))))], noun
    return [*(_attribute(word) for word in adjectives), *(Attribute(name="", value=word) for word in compound)], noun


def _is_adjective(words: Words, word: str) -> bool:
    return word in lexicon.ADJECTIVES or word in lexicon.PLAIN_ADJECTIVES or word in words.known


def _names_more(words: Words) -> bool:
    """Whether something that names a thing follows the word at the cursor."""
    after = words.next(1)
    return _is_adjective(words, after) or _is_noun(words, after) or after in ("one", "ones") or _may_be_noun(after)


def _is_noun(words: Words, word: str) -> bool:
    if word in lexicon.ROOM_WORDS and words.next(1) in lexicon.ROOMS:
        return True
    names = lexicon.NOUNS | lexicon.PEOPLE | lexicon.ANYBODY | lexicon.ROLES | lexicon.ROOMS | lexicon.ROOM_KINDS
    names |= lexicon.VENUES
    return word in names or singular(word) in names or word in words.known or singular(word) in words.known


def _may_be_noun(word: str) -> bool:
    """Whether an unknown word may be taken for a noun: letters only, and no word that the grammar knows otherwise."""
    taken = lexicon.ADJECTIVES.keys() | lexicon.PLAIN_ADJECTIVES | lexicon.REASONS.keys() | lexicon.GRAMMAR
    return word.isascii() and word.isalpha() and len(word) > 2 and word not in taken


def _label(noun: str, before: Reference | None) -> tuple[str, tuple[Attribute, ...], bool]:
    """Label, what the noun says besides, and whether it means all that match."""
    if noun == "one" and before is not None:
        return before.label, (), False
    if noun in lexicon.ROOM_KINDS or singular(noun) in lexicon.ROOM_KINDS:
        return "room", (Attribute(name="kind", value=singular(noun)),), singular(noun) != noun
    if noun in lexicon.ROOMS:
        return "room", (), singular(noun) != noun
    if noun in lexicon.ANYBODY:
        return _PERSON, (), True
    if noun in lexicon.PEOPLE:
        return _PERSON, (), singular(noun) != noun
    return singular(noun), (), singular(noun) != noun


def _whereabouts(words: Words, label: str) -> list[Attribute]:
    """What follows the noun: side, neighbours, contents, clothes."""
    found: list[Attribute] = []
    while True:
        start = words.at
        words.take(*verbs.THAT_IS)
        words.take("somewhere")
        try:
            attribute = _one_tail(words, label, joined=words.at > start)
        except Unread:
            attribute = None
        if attribute is None:
            words.at = start
            return found
        found += [attribute] if attribute.value else []


def _one_tail(words: Words, label: str, *, joined: bool) -> Attribute | None:
    if side := words.take(*verbs.SIDES):
        return Attribute(name="side", value="left" if "left" in side else "right")
    if joined and words.next() in lexicon.ADJECTIVES and not _names_more(words):
        words.move(words.at + 1)
        return _attribute(words.tokens[words.at - 1])
    if label == _PERSON and (worn := _clothes(words)) is not None:
        return worn
    if held := words.take(*verbs.HOLDING):
        thing = noun_phrase(words, tail=False)
        if thing.position_m is not None or thing.label in (_PERSON, *lexicon.ROLES):
            words.fail()
        if held == "with" and label in lexicon.FIXED - {"door", "gate"}:
            words.fail()  # go to the tower with the box: who has the box?
        return Attribute(name="" if label in (_PERSON, "room") else "contents", value=_bare(thing.phrase))
    if words.take("in", "inside"):
        words.take("the", "this", "that", "our")
        while _is_adjective(words, words.next()):
            words.move(words.at + 1)
        words.need(*lexicon.VENUES)
        return Attribute(name="", value="")
    if words.next() in ("at", "on") and (_NUMBER.fullmatch(words.next(1)) or words.next(1) == "a"):
        return None  # at 2 m, at a height of 2 m
    if words.take(*verbs.NEAR):
        mark = noun_phrase(words, tail=False)
        if mark.position_m is not None or mark.every or (mark.label == "room" and not mark.attributes):
            words.fail()
        return Attribute(name="near", value=mark.phrase)
    return None


def _clothes(words: Words) -> Attribute | None:
    """``wearing a helmet``, ``in the blue jacket``, ``in red``; None, and nothing taken, where no clothes follow."""
    start = words.at
    if not words.take(*verbs.DRESSED):
        return None
    first = words.at
    words.take(*lexicon.DETERMINERS)
    colour = words.next() in lexicon.ADJECTIVES
    while words.next() in lexicon.ADJECTIVES:
        words.move(words.at + 1)
    if singular(words.next()) in lexicon.CLOTHES:
        words.move(words.at + 1)
    elif not colour or words.tokens[first] in lexicon.DETERMINERS or _is_noun(words, words.next()):
        words.at = start
        return None
    return Attribute(name="", value=_bare(" ".join(words.tokens[first : words.at])))


def _position(words: Words) -> Vec3 | None:
    """A place given by two or three numbers, metres."""
    start = words.at
    words.take("the position", "position", "the point", "point", "coordinates", "the coordinates", "waypoint")
    bracket = words.take("(")
    values: list[float] = []
    for axis in "xyz":
        words.take(f"{axis} =", f"{axis} :", axis)
        value = words.number()
        if value is None:
            break
        values.append(value)
        words.take("m", "metres", "meters")
        comma = words.at
        if not words.take(", and", ",", "and") or not (words.next() in "xyz(-" or _NUMBER.fullmatch(words.next())):
            words.at = comma
            if words.next() not in ("y", "z") and not _NUMBER.fullmatch(words.next()):
                break
    if len(values) < 2 or (bracket and not words.take(")")):
        words.at = start
        return None
    return (values[0], values[1], values[2] if len(values) > 2 else DEFAULT_HEIGHT_M)


def _attribute(word: str) -> Attribute:
    name, value = lexicon.ADJECTIVES.get(word, ("", word.replace("-", " ")))
    return Attribute(name=name, value=value)


def _bare(phrase: str) -> str:
    first, _, rest = phrase.partition(" ")
    return rest if first in lexicon.DETERMINERS and rest else phrase
