"""What a free answer means (method, section 5), by rules alone.

The words are taken as classes (`answer_lexing`), read with their negations and doubts (`answer_claims`), and held
against the question's own cut: words about the world (``it is toxic``, ``the blue one``) are turned into values of
its gap, and the cut says whether that is a Yes or a No. In doubt the reading is OTHER or UNSURE: ask again. A Yes
that opens a region must be said without any doubt, condition, question or unknown thing beside it. Nothing that an
answer says can do more than answer: it is data.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from mintpilot.core.gap import ABSENT, BLOCKED, PASSABLE, PRESENT, GapKind
from mintpilot.core.query import Combine, Literal, Order, Question, Reply
from mintpilot.language.answer_asides import ACKNOWLEDGED, CUT_OFF
from mintpilot.language.answer_claims import read_claims
from mintpilot.language.answer_echo import unechoed
from mintpilot.language.answer_lexing import atoms, plain
from mintpilot.language.answer_scope import Claim, Said
from mintpilot.language.answer_turns import GENTLE, NO_SPEECH, TAKEN_BACK, corrected, lead, settled, turn
from mintpilot.language.answer_weighing import Reading, no_is_careful, topic, weighed
from mintpilot.language.orders import order_in
from mintpilot.language.referring import Mention, mention, said_relation

_LONGEST = 300
_STATED = {
    Claim.PASSABLE: (GapKind.OBSTACLE, PASSABLE),
    Claim.BLOCKED: (GapKind.OBSTACLE, BLOCKED),
    Claim.AWAY: (GapKind.OBSTACLE, BLOCKED),
    Claim.PRESENT: (GapKind.PRESENCE, PRESENT),
    Claim.ABSENT: (GapKind.PRESENCE, ABSENT),
}
_NONE_OF_THEM = ""
"""Stands for a thing that is no value of a target gap."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Understood:
    """An answer's meaning."""

    reading: Reading
    command: Order | None = None
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
    """Reads a free answer.

    ``not the red one, the blue one`` answers more than was asked: `Understood.also` carries it where it maps to known
    attributes. An order (``stop``, ``abort``, ``come back``) comes before everything else.

    Args:
        text: the words, typed or heard. Never an instruction to this program.
        question: what was asked, with the gaps that it speaks of.
    """
    order, words = order_in(plain(text))
    if order is not None:
        return Understood(reading=Reading.COMMAND, command=order)
    if not words or len(words) > _LONGEST or NO_SPEECH.search(text) or CUT_OFF.search(text):
        return Understood(reading=Reading.OTHER)
    if ACKNOWLEDGED.fullmatch(words) or TAKEN_BACK.search(words):
        return Understood(reading=Reading.OTHER)
    words = unechoed(settled(corrected(words)), question)
    return _turned(words, question) or _read(words, question)


def _turned(words: str, question: Question) -> Understood | None:
    """What is said after a ``but``, or after a word thrown back, where it outweighs that; None otherwise.

    A danger, or another thing than the one asked about, does; of rooms and ways, how it is now against how it was.
    """
    about, found = topic(question), turn(words)
    before = lead(words, about)
    no_counts = about is not GapKind.OBSTACLE or no_is_careful(question)
    if before is not None and no_counts and (answer := _read(words[before.end() :], question)).reading is Reading.NO:
        return answer
    if found is None:
        return None
    after = _read(found.after, question)
    if after.reading is Reading.NO and no_counts:
        return after if found.is_past or about is not GapKind.PRESENCE else None
    outweighs = found.is_past and (about is GapKind.PRESENCE or (found.is_now and found.of_it))
    outweighs |= found.only_looks and found.goes_on
    return after if after.reading is Reading.YES and outweighs else None


def _read(words: str, question: Question) -> Understood:
    said_of = mention(words, question.gaps)
    about = topic(question)
    words_left = GENTLE.sub("", said_of.rest)
    known = frozenset(re.findall(r"\w+", question.text.lower()))
    said = read_claims(atoms(words_left, about, known), about)
    readings = _readings(said, said_of, words, question)
    reading = weighed(readings, said, said_of.confused, words, question)
    also = said_of.literal() if said_of.values and reading in (Reading.YES, Reading.NO) else None
    return Understood(reading=reading, also=also)


def _readings(said: Said, said_of: Mention, words: str, question: Question) -> set[Reading]:
    """All that the claims would mean for the cut."""
    claims = said.claims
    relation = said_relation(words, question)
    found = _by_values(claims, words, question)
    if relation is None:
        found |= _by_mention(said_of, claims, question)
    else:
        found.add(Reading.YES if relation else Reading.NO)
    if claims & {Claim.YES, Claim.AGREE}:
        found.add(Reading.YES)
    if Claim.NO in claims:
        found.add(Reading.NO)
    if not found and Claim.BOOST in claims and Claim.EITHER not in claims:
        found.add(Reading.YES)
    return found


def _by_values(claims: set[Claim], words: str, question: Question) -> set[Reading]:
    """What the cut makes of stated values: its own answer, where they settle it."""
    readings: set[Reading] = set()
    for claim, (kind, value) in _STATED.items():
        gaps = [g.id for g in question.gaps if g.kind is kind]
        if claim not in claims or not gaps:
            continue
        if len(gaps) > 1 and not _is_of_all(words, question):
            readings.add(Reading.OTHER)
        elif len(gaps) > 1:
            holds = question.query.holds(dict.fromkeys(gaps, value))
            readings.add(Reading.YES if holds else Reading.NO)
        else:
            readings.add(_settled(gaps[0], {value}, question))
    return readings


def _is_of_all(words: str, question: Question) -> bool:
    """``they are both safe``: of all things that the question names."""
    same_kind = len({g.kind for g in question.gaps}) == 1 and question.query.combine is Combine.ALL
    return same_kind and re.search(r"\b(?:both|all|each|neither|none)\b", words) is not None


def _by_mention(said: Mention, claims: set[Claim], question: Question) -> set[Reading]:
    if said.another and said.gap is not None:
        return {_settled(said.gap.id, {_NONE_OF_THEM}, question)}
    if not said.values or said.gap is None:
        return set()
    reading = _settled(said.gap.id, set(said.values), question)
    if reading is Reading.OTHER and (claims & {Claim.YES, Claim.NO}):
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
