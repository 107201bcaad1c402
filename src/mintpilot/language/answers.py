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
from enum import StrEnum

from mintpilot.core.gap import ABSENT, BLOCKED, PASSABLE, PRESENT, GapKind
from mintpilot.core.query import Combine, Command, Literal, Question, Reply
from mintpilot.language.answer_claims import read_claims
from mintpilot.language.answer_lexing import atoms, plain
from mintpilot.language.answer_scope import Claim, Said
from mintpilot.language.answer_turns import ECHO, GENTLE, NO_SPEECH, PLAIN_NO, asks_back, corrected, turn
from mintpilot.language.orders import order_in
from mintpilot.language.referring import Mention, mention, said_relation
from mintpilot.language.slips import may_hide_caution

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
_MOST_STRANGE = {
    "yes, explained": 4,
    "yes": 1,
    "no": 9,
    "derived yes": 0,
    "benign": 2,
    "benign, explained": 4,
    "derived no": 3,
    "derived": 2,
    "absent": 1,
    "absent, explained": 3,
    "derived, explained": 5,
}
"""How many unknown words an answer may have. None where a way is called free: it may be about something else."""


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
    if not words or len(words) > _LONGEST or NO_SPEECH.search(text):
        return Understood(reading=Reading.OTHER)
    words = corrected(words)
    return _turned(words, question) or _read(words, question)


def _turned(words: str, question: Question) -> Understood | None:
    """What is said after a ``but``, or after a word thrown back, where it outweighs that; None otherwise.

    A danger, or another thing than the one asked about, does; of rooms and ways, how it is now against how it was.
    """
    about, echo, found = _topic(question), ECHO.match(words), turn(words)
    no_counts = about is not GapKind.OBSTACLE or _no_is_careful(question)
    if echo is not None and no_counts and (answer := _read(words[echo.end() :], question)).reading is Reading.NO:
        return answer
    if found is None:
        return None
    after = _read(found.after, question)
    if after.reading is Reading.NO and no_counts:
        return after if found.is_past or about is not GapKind.PRESENCE else None
    outweighs = found.is_past and (about is GapKind.PRESENCE or found.is_now)
    return after if after.reading is Reading.YES and outweighs else None


def _read(words: str, question: Question) -> Understood:
    said_of = mention(words, question.gaps)
    about = _topic(question)
    words_left = GENTLE.sub("", said_of.rest)
    known = frozenset(re.findall(r"\w+", question.text.lower()))
    said = read_claims(atoms(words_left, about, known), about)
    readings = _readings(said, said_of, words, question)
    reading = _weighed(readings, said, said_of, words, question)
    also = said_of.literal() if said_of.values and reading in (Reading.YES, Reading.NO) else None
    return Understood(reading=reading, also=also)


def _no_is_careful(question: Question) -> bool:
    """Whether a No keeps the vehicle out of all regions asked about."""
    return not question.query.holds(dict.fromkeys(question.query.gap_ids, BLOCKED))


def _topic(question: Question) -> GapKind:
    """The kind of thing asked about; where there are several, the one where most care is needed."""
    kinds = {gap.kind for gap in question.gaps}
    order = (GapKind.OBSTACLE, GapKind.PRESENCE, GapKind.TARGET, GapKind.VALUE)
    return next((kind for kind in order if kind in kinds), GapKind.OBSTACLE)


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


def _weighed(readings: set[Reading], said: Said, said_of: Mention, words: str, question: Question) -> Reading:
    """The one reading, if nothing speaks against it."""
    careful = Reading.NO if _topic(question) is GapKind.OBSTACLE else None
    if Claim.UNSURE in said.claims or (said.waits and (not readings or readings == {Reading.YES})):
        return Reading.UNSURE
    if not readings and said.is_hedged:
        return Reading.UNSURE
    if said.is_mockery and careful and said.claims >= {Claim.PASSABLE, Claim.BLOCKED} and not said.plain:
        return Reading.NO if _no_is_careful(question) else Reading.OTHER
    if len(readings) != 1 or said_of.confused or Claim.UNCLEAR in said.claims:
        return Reading.OTHER
    (reading,) = readings
    if (said.is_condition and reading is not careful) or (
        (said.is_condition or said.is_mockery) and not _is_refusal(said)
    ):
        return Reading.OTHER
    if asks_back(words) and (reading is not careful or not PLAIN_NO.search(words)):
        return Reading.OTHER
    if Claim.EITHER in said.claims and not said.plain:
        return Reading.OTHER
    if said.is_hedged and reading is not careful:
        return Reading.UNSURE
    if (reading is not careful and _is_long_ago(said)) or _was_free(said):
        return Reading.UNSURE
    if reading is Reading.YES and may_hide_caution(said.strange):
        return Reading.OTHER
    return reading if len(said.strange) <= _MOST_STRANGE[_basis(reading, said, question)] else Reading.OTHER


def _is_long_ago(said: Said) -> bool:
    """Whether it tells how it was, which may have changed; that somebody was there, or left, still counts."""
    stays = Claim.PRESENT in said.claims or said.is_parting
    return said.is_past and not said.plain & {Claim.YES, Claim.NO} and not stays


def _was_free(said: Said) -> bool:
    """Whether a way is only said to have been free."""
    return said.was_then and Claim.YES not in said.plain and bool(said.claims & {Claim.PASSABLE, Claim.AGREE})


def _is_refusal(said: Said) -> bool:
    """Whether a No stands whatever else is said: an explicit one, or an order to keep out."""
    return bool(said.claims & {Claim.NO, Claim.AWAY}) and not said.claims & {Claim.YES, Claim.AGREE, Claim.PASSABLE}


def _basis(reading: Reading, said: Said, question: Question) -> str:
    """What the reading rests on."""
    if _topic(question) is GapKind.OBSTACLE and Claim.PASSABLE in said.claims and not said.claims & {Claim.YES}:
        return "derived yes" if not said.is_benign else "benign, explained" if said.is_clean else "benign"
    if reading is Reading.YES and said.claims == {Claim.BOOST}:
        return "derived yes"
    if reading is Reading.YES:
        explained = said.breaks_after_plain or _topic(question) is not GapKind.OBSTACLE
        if Claim.YES in said.claims:
            return "yes, explained" if explained else "yes"
        return "derived, explained" if Claim.PRESENT in said.claims and said.is_clean else "derived"
    if Claim.NO in said.claims or Claim.ABSENT not in said.claims:
        return "no" if Claim.NO in said.claims else "derived no"
    return "absent, explained" if said.is_clean else "absent"


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
