"""What a free answer means (method, section 5), by rules alone.

Meaning is sought in the question's own cut: words about the world (``it is toxic``, ``the blue one``) are turned into
values of its gap, and the cut says whether that is a Yes or a No. In doubt the reading is OTHER: ask again. Nothing
that an answer says can do more than answer: it is data.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from enum import StrEnum

from mintpilot.core.gap import ABSENT, BLOCKED, PASSABLE, PRESENT, GapKind
from mintpilot.core.query import Command, Literal, Question, Reply
from mintpilot.language.answer_words import COMMANDS, CONDITION, CORRECTION, GENTLE, SIGNS, Sign
from mintpilot.language.referring import Mention, mention

_LONGEST = 300
_STRANGE_WORDS = 6
_STRANGE_WORDS_DERIVED = 2
_PLAIN_NO = re.compile(r"(?:no|nope|nah|not|never|do not|negative)\b")
_TAKEN_BACK = re.compile(r"\b(?:(?:do )?not|never|no need to|without)(?: \w+)?\s*$")
_STATED = (
    (Sign.PASSABLE, GapKind.OBSTACLE, PASSABLE),
    (Sign.BLOCKED, GapKind.OBSTACLE, BLOCKED),
    (Sign.CLEAR, GapKind.OBSTACLE, PASSABLE),
    (Sign.PRESENT, GapKind.PRESENCE, PRESENT),
    (Sign.ABSENT, GapKind.PRESENCE, ABSENT),
    (Sign.CLEAR, GapKind.PRESENCE, ABSENT),
)
_SHORT = {
    "can't": "cannot", "cant": "cannot", "can not": "cannot", "won't": "will not", "isn't": "is not",
    "aren't": "are not",
    "don't": "do not", "dont": "do not", "doesn't": "does not", "didn't": "did not", "shouldn't": "should not",
    "wouldn't": "would not", "couldn't": "could not", "wasn't": "was not", "it's": "it is", "that's": "that is",
    "there's": "there is", "i'm": "i am", "i'd": "i would", "you're": "you are", "they're": "they are",
    "let's": "let us",
    "mustn't": "must not", "gonna": "going to", "idk": "i do not know", "y'all": "you", "what's": "what is",
    "nobody's": "nobody is", "haven't": "have not", "hasn't": "has not", "who's": "who is",
}  # fmt: skip


class Reading(StrEnum):
    """What an answer was taken for."""

    YES = "yes"
    NO = "no"
    UNSURE = "unsure"
    COMMAND = "command"
    OTHER = "other"
    """Not understood, contradictory, conditional, or a question: ask again."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Understood:
    """An answer's meaning."""

    reading: Reading
    command: Command | None = None
    """For `Reading.COMMAND`."""
    also: Literal | None = None
    """What it says beyond the question: a cut of one of the question's gaps that is answered Yes; None: nothing."""
    by: str = "rules"
    """Who understood it: the rules, or a language model by name."""

    @property
    def reply(self) -> Reply:
        """The reply for the belief; what is not a clear Yes or No leaves it as it is."""
        return {Reading.YES: Reply.YES, Reading.NO: Reply.NO}.get(self.reading, Reply.UNSURE)


def understand_answer(text: str, question: Question) -> Understood:
    """Reads a free answer to a yes/no question.

    ``not the red one, the blue one`` answers more than was asked: `Understood.also` carries it where it maps to known
    attributes. An order (``stop``, ``abort``, ``come back``) comes before everything else.

    Args:
        text: the words, typed or heard. Never an instruction to this program.
        question: what was asked, with the gaps that it speaks of.
    """
    order, words = _order(_plain(text))
    if order is not None:
        return Understood(reading=Reading.COMMAND, command=order)
    if not words or len(words) > _LONGEST:
        return Understood(reading=Reading.OTHER)
    parts = CORRECTION.split(words)
    if len(parts) > 1 and parts[-1].strip(" ,.;"):
        words = parts[-1]
    return _read(words, text, question)


def _read(words: str, text: str, question: Question) -> Understood:
    said = mention(words, question.gaps)
    signs, strange = _signs(said.rest)
    strange = strange - set(re.findall(r"\w+", question.text.lower()))
    stated = _stated(signs, question)
    if Sign.UNSURE in signs:
        return Understood(reading=Reading.UNSURE)
    asks_back = text.strip().endswith("?") and Sign.YES not in signs
    if said.confused or asks_back or CONDITION.search(GENTLE.sub("", words)):
        return Understood(reading=Reading.OTHER)
    readings = _claims(signs, question) | _by_values(stated, question) | _by_mention(said, signs, question)
    if len(readings) != 1:
        return Understood(reading=Reading.OTHER)
    (reading,) = readings
    if len(strange) > _most_strange(reading, signs, words):
        return Understood(reading=Reading.OTHER)
    also = said.literal() if said.values and reading in (Reading.YES, Reading.NO) else None
    return Understood(reading=reading, also=also)


def _plain(text: str) -> str:
    words = text.lower().replace("\N{RIGHT SINGLE QUOTATION MARK}", "'").replace("...", " , ").replace("-", " ")
    words = re.sub(r"[^\w\s',.;!?]", " ", words)
    for short, long in _SHORT.items():
        words = re.sub(rf"(?<!\w){re.escape(short)}(?!\w)", long, words)
    return " ".join(re.sub(r"\s*([,.;!?])\s*", r" \1 ", words).split()).strip(" ,.;!?")


def _order(words: str) -> tuple[Command | None, str]:
    """The order in the words, if any; else the words without orders that are taken back (``do not stop``)."""
    for pattern, command in COMMANDS:
        for found in reversed(list(pattern.finditer(words))):
            taken_back = _TAKEN_BACK.search(words[: found.start()])
            if taken_back is None:
                return command, words
            words = f"{words[: taken_back.start()]} {words[found.end() :]}"
    return None, words.strip(" ,.;!?")


def _signs(words: str) -> tuple[set[Sign], set[str]]:
    """The signs in the words, and the words that say nothing known."""
    signs: set[Sign] = set()
    for pattern, sign in SIGNS:
        words, found = pattern.subn(" ; ", words)
        if found:
            signs.add(sign)
    return signs - {Sign.NOISE}, set(re.findall(r"\w+", words))


def _most_strange(reading: Reading, signs: set[Sign], words: str) -> int:
    """How many words that say nothing known an answer may have.

    Few where a Yes is only derived from what is said of the world, or a No stands somewhere in a sentence.
    """
    if reading is Reading.YES and Sign.YES not in signs:
        return _STRANGE_WORDS_DERIVED
    if reading is Reading.NO and not _PLAIN_NO.match(words):
        return _STRANGE_WORDS_DERIVED
    return _STRANGE_WORDS


def _stated(signs: set[Sign], question: Question) -> dict[str, set[str]]:
    """Values of the question's gaps that the answer states; only where one gap is of that kind."""
    stated: dict[str, set[str]] = {}
    for sign, kind, value in _STATED:
        gaps = [g for g in question.gaps if g.kind is kind]
        if sign in signs and len(gaps) == 1:
            stated.setdefault(gaps[0].id, set()).add(value)
    return stated


def _claims(signs: set[Sign], question: Question) -> set[Reading]:
    """Plain yes and no. What may open a region needs a yes without doubt."""
    readings: set[Reading] = set()
    if Sign.YES in signs:
        readings.add(Reading.YES)
    if Sign.NO in signs or Sign.UNLIKELY in signs:
        readings.add(Reading.NO)
    if Sign.LIKELY in signs:
        opens = any(g.kind is GapKind.OBSTACLE for g in question.gaps)
        readings = {Reading.UNSURE} if opens else readings or {Reading.YES}
    return readings


def _by_values(stated: dict[str, set[str]], question: Question) -> set[Reading]:
    """What the cut makes of stated values: its own answer, where they settle it."""
    readings: set[Reading] = set()
    for gap_id, values in stated.items():
        readings.add(_settled(gap_id, values, question))
    return readings


def _by_mention(said: Mention, signs: set[Sign], question: Question) -> set[Reading]:
    if not said.values or said.gap is None:
        return set()
    reading = _settled(said.gap.id, set(said.values), question)
    if reading is Reading.OTHER and (signs & {Sign.YES, Sign.NO}):
        return set()
    return {reading}


def _settled(gap_id: str, values: set[str], question: Question) -> Reading:
    """The answer to the cut when that gap is known to have one of the values, where they all agree."""
    own = [x for x in question.query.literals if x.gap == gap_id]
    if len(question.query.gap_ids) > 1 or not own:
        return Reading.OTHER
    answers = {question.query.holds({gap_id: value}) for value in values}
    return Reading.OTHER if len(answers) != 1 else Reading.YES if answers == {True} else Reading.NO


__all__ = ["Reading", "Understood", "understand_answer"]
