"""An answer that is a length: ``0.9 m``, ``90 cm``, ``3,5 m``, ``three feet`` (method, section 13).

People estimate lengths. An estimate is taken to be normal around the true value, with a standard deviation of
`ESTIMATE_SIGMA` of it; so a region is only called free where the estimate is clear of the threshold by twice that.
"""

from __future__ import annotations

import re

from mintpilot.core.gap import GapKind
from mintpilot.core.query import Query, Question, Reply, SayingKind
from mintpilot.core.reading import Reading, ReadingKind, plain_reply
from mintpilot.language.answer_text import spoken

ESTIMATE_SIGMA = 0.15
"""Standard deviation of a person's estimate, as a share of the true length."""
CLEAR = 2.0
"""An estimate is clear of a threshold by so many standard deviations."""
_UNITS = {
    "m|metres?|meters?|mètres?|metros?|meter": 1.0,
    "cm|centimetres?|centimeters?|zentimeter|centimètres?|centímetros?": 0.01,
    "mm|millimetres?|millimeters?|millimeter|millimètres?|milímetros?": 0.001,
    "ft|feet|foot|fuss|fuß|pieds?|pies?": 0.3048,
    "in|inch|inches|zoll|pouces?|pulgadas?": 0.0254,
}
_WORDS = ("zero one two three four five six seven eight nine ten", "null eins zwei drei vier fünf sechs sieben acht "
          "neun zehn", "zéro un deux trois quatre cinq six sept huit neuf dix",
          "cero uno dos tres cuatro cinco seis siete ocho nueve diez")  # fmt: skip
_NUMBERS = {word: float(n) for words in _WORDS for n, word in enumerate(words.split())} | {
    "a": 1.0, "half a": 0.5, "einen": 1.0, "ein": 1.0, "une": 1.0,
}  # fmt: skip
_ABOUT = "about|around|roughly|some|it is|it's|etwa|ungefähr|environ|unos|unas"
_LENGTH = re.compile(
    rf"(?:(?:{_ABOUT}) )*(?P<number>\d+(?:[.,]\d+)?|{'|'.join(sorted(_NUMBERS, key=len, reverse=True))})"
    rf" ?(?P<unit>{'|'.join(_UNITS)})?(?: (?:wide|high|breit|hoch|de large|de haut))?"
)


def length_in(text: str) -> float | None:
    """The length that a whole utterance is, metres; None where it is none.

    A number without a unit is metres; a comma is a decimal point. Nothing else may be said besides.
    """
    match = _LENGTH.fullmatch(re.sub(r"[.!?]+$", "", spoken(text)).strip())
    if match is None:
        return None
    number, unit = match["number"], match["unit"]
    if unit is None and not number[0].isdigit():
        return None  # "one" alone is no length
    metres = next((per for units, per in _UNITS.items() if unit and re.fullmatch(units, unit)), 1.0)
    return (_NUMBERS[number] if number in _NUMBERS else float(number.replace(",", "."))) * metres


def value_answer(text: str, question: Question) -> Reading | None:
    """What a length says to a question about a threshold; None where it is no such question, or no length.

    Below the threshold is a No. Clear of it is a Yes, to be read back. Between the two it is asked again.
    """
    threshold_m = threshold_of(question)
    length_m = length_in(text)
    if threshold_m is None or length_m is None:
        return None
    if length_m < threshold_m:
        return plain_reply(Reply.NO)
    if length_m * (1 - CLEAR * ESTIMATE_SIGMA) < threshold_m or "?" in text:
        return Reading(kind=ReadingKind.AGAIN)
    return Reading(kind=ReadingKind.READ_BACK, reply=Reply.YES)


def threshold_of(question: Question) -> float | None:
    """The threshold that a yes/no question about one ordered value asks for, metres; None for other questions."""
    if not _is_threshold(question.query):
        return None
    found = [gap.threshold for gap in question.gaps if gap.kind is GapKind.OBSTACLE and gap.threshold is not None]
    return max((one.at_least_m for one in found), default=None)


def _is_threshold(query: Query) -> bool:
    return bool(query.literals) and all(x.saying.kind is SayingKind.THRESHOLD for x in query.literals)
