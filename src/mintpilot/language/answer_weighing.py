"""What the claims of an answer are worth together: one reading, if nothing speaks against it.

A Yes that opens a region must be said without any doubt, condition, question or unknown thing beside it.
"""

from __future__ import annotations

from enum import StrEnum

from mintpilot.core.gap import BLOCKED, GapKind
from mintpilot.core.query import Question
from mintpilot.language.answer_asides import beside_no, beside_yes
from mintpilot.language.answer_scope import Claim, Said
from mintpilot.language.answer_turns import EITHER_WAY, PLAIN_NO, asks_back
from mintpilot.language.slips import may_be_not, may_hide_caution

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


def topic(question: Question) -> GapKind:
    """The kind of thing asked about; where there are several, the one where most care is needed."""
    kinds = {gap.kind for gap in question.gaps}
    order = (GapKind.OBSTACLE, GapKind.PRESENCE, GapKind.TARGET, GapKind.VALUE)
    return next((kind for kind in order if kind in kinds), GapKind.OBSTACLE)


def no_is_careful(question: Question) -> bool:
    """Whether a No keeps the vehicle out of all regions asked about."""
    return not question.query.holds(dict.fromkeys(question.query.gap_ids, BLOCKED))


def weighed(readings: set[Reading], said: Said, confused: bool, words: str, question: Question) -> Reading:
    """The one reading, if nothing speaks against it.

    Args:
        readings: all that the claims would mean for the question's cut.
        said: the claims and what weakens them.
        confused: whether candidates are named in a way that leaves none.
        words: the answer, as `answer_lexing.plain` gives it.
        question: what was asked.
    """
    careful = Reading.NO if topic(question) is GapKind.OBSTACLE else None
    if Claim.UNSURE in said.claims or (said.waits and (not readings or readings == {Reading.YES})):
        return Reading.UNSURE
    if (Claim.UNSEEN in said.claims and Claim.NO not in said.plain) or (not readings and said.is_hedged):
        return Reading.UNSURE
    if said.is_mockery and careful and said.claims >= {Claim.PASSABLE, Claim.BLOCKED} and not said.plain:
        return Reading.NO if no_is_careful(question) else Reading.OTHER
    if len(readings) != 1 or confused or Claim.UNCLEAR in said.claims:
        return Reading.OTHER
    (reading,) = readings
    if (said.is_condition and reading is not careful) or (
        (said.is_condition or said.is_mockery) and not _is_refusal(said)
    ):
        return Reading.OTHER
    beside = {Reading.YES: beside_yes, Reading.NO: beside_no}.get(reading)
    if EITHER_WAY.search(words) or (beside and beside(words, said, topic(question), question.text)):
        return Reading.OTHER
    if asks_back(words) and (reading is not careful or not PLAIN_NO.search(words)):
        return Reading.OTHER
    if Claim.EITHER in said.claims and not said.plain:
        return Reading.OTHER
    if said.is_hedged and reading is not careful:
        return Reading.UNSURE
    if (reading is not careful and _is_long_ago(said)) or _was_free(said):
        return Reading.UNSURE
    is_emptied = Claim.ABSENT in said.claims and Claim.NO not in said.claims
    if (reading is Reading.YES and may_hide_caution(said.strange)) or (is_emptied and may_be_not(said.strange)):
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
    if topic(question) is GapKind.OBSTACLE and Claim.PASSABLE in said.claims and not said.claims & {Claim.YES}:
        return "derived yes" if not said.is_benign else "benign, explained" if said.is_clean else "benign"
    if reading is Reading.YES and said.claims == {Claim.BOOST}:
        return "derived yes"
    if reading is Reading.YES:
        explained = said.breaks_after_plain or topic(question) is not GapKind.OBSTACLE
        if Claim.YES in said.claims:
            return "yes, explained" if explained else "yes"
        return "derived, explained" if Claim.PRESENT in said.claims and said.is_clean else "derived"
    if Claim.NO in said.claims or Claim.ABSENT not in said.claims:
        return "no" if Claim.NO in said.claims else "derived no"
    return "absent, explained" if said.is_clean else "absent"
