"""What a free answer means, by rules alone (method, section 12).

A reply that enlarges what the drone may do is taken from a key or from a closed list only; agreement in other known
words is read back first; everything else is asked again. A reply that adds caution is read loosely. Nothing that an
answer says can do more than answer: it is data.
"""

from __future__ import annotations

import re
from collections.abc import Collection
from dataclasses import dataclass, replace
from functools import cache

from mintpilot.core.errors import UnknownNameError
from mintpilot.core.gap import ABSENT, BLOCKED, PASSABLE, PRESENT, GapKind
from mintpilot.core.query import MAX_PARTS, Order, Question, Reply
from mintpilot.core.reading import AnsweredBy, Reading, ReadingKind, opposite, plain_reply
from mintpilot.language.answer_evidence import evidence_in
from mintpilot.language.answer_options import option_in
from mintpilot.language.answer_text import LONGEST, listed, loose, spoken, utterance, vetoes, without_courtesies, words
from mintpilot.language.answer_values import threshold_of, value_answer
from mintpilot.language.answer_words import ANSWER_WORDS, AnswerWords

_KEYS = {"y": Reply.YES, "yes": Reply.YES, "n": Reply.NO, "no": Reply.NO, "u": Reply.UNSURE, "unsure": Reply.UNSURE,
         "?": Reply.UNSURE}  # fmt: skip
_AGAIN = Reading(kind=ReadingKind.AGAIN)


@dataclass(frozen=True, slots=True, kw_only=True)
class _Heard:
    """One answer with what it is read against."""

    text: str
    question: Question
    guarded: Collection[Reply]
    lang: str
    by: AnsweredBy

    @property
    def known(self) -> AnswerWords:
        return ANSWER_WORDS[self.lang]


def read_answer(
    text: str,
    question: Question,
    *,
    guarded: Collection[Reply],
    lang: str = "en",
    by: AnsweredBy = AnsweredBy.TYPED,
    pending: Reply | None = None,
) -> Reading:
    """Reads an answer. Never raises for any text.

    Args:
        text: the raw words, or the key. Never an instruction to this program.
        question: what was asked, with the gaps that it speaks of.
        guarded: the replies that would enlarge what the drone may do (`mintpilot.core.reading.guarded_replies`).
        lang: of the question: ``en``, ``de``, ``fr`` or ``es``.
        by: how the words came.
        pending: the reply that was just read back; a plain yes to that (by voice: *confirm*) returns it as plain.

    Raises:
        UnknownNameError: another language.
    """
    if lang not in ANSWER_WORDS:
        raise UnknownNameError("language", lang, ANSWER_WORDS)
    heard = _Heard(text=text, question=question, guarded=guarded, lang=lang, by=by)
    if len(text) > LONGEST or not text.strip():
        return _AGAIN
    if by is AnsweredBy.KEY:
        return _by_key(heard, pending)
    return _order_or_question(heard) or (_answer(heard) if pending is None else _to_read_back(heard, pending))


def order_in(text: str, lang: str = "en") -> Order | None:
    """The order that a whole utterance is, where nothing is asked; None: it is none.

    Raises:
        UnknownNameError: another language.
    """
    if lang not in ANSWER_WORDS:
        raise UnknownNameError("language", lang, ANSWER_WORDS)
    said = spoken(text)
    if len(text) > LONGEST or "?" in said or "¿" in said:
        return None
    wholes = {utterance(said), without_courtesies(said, lang)}
    found = (order for order, entries in ANSWER_WORDS[lang].orders.items() if wholes & listed(entries))
    return next(found, None)


def confirmation_in(text: str, lang: str = "en") -> bool | None:
    """Whether a whole utterance confirms (True) or denies (False) what was read back; None: neither.

    Raises:
        UnknownNameError: another language.
    """
    if lang not in ANSWER_WORDS:
        raise UnknownNameError("language", lang, ANSWER_WORDS)
    whole, known = utterance(spoken(text)), ANSWER_WORDS[lang]
    if len(text) > LONGEST or (vetoes(text, lang, Reply.YES) and whole not in listed(known.no)):
        return None
    return True if whole in listed(known.confirm) else False if whole in listed(known.no) else None


def _by_key(heard: _Heard, pending: Reply | None) -> Reading:
    key = heard.text.strip().casefold()
    key = heard.known.keys.get(key, key)
    if key in _KEYS:
        reply = _KEYS[key]
        if pending is not None and reply in (Reply.YES, Reply.NO):
            return plain_reply(pending, by="key") if reply is Reply.YES else _denied(heard, pending, by="key")
        if heard.question.query.is_choice and reply in (Reply.YES, Reply.NO):
            return Reading(kind=ReadingKind.AGAIN, by="key")
        return plain_reply(reply, by="key")
    query = heard.question.query
    most = query.part_count if query.is_choice else MAX_PARTS
    if key in map(str, range(1, most + 1)) and pending is None:
        return Reading(kind=ReadingKind.OPTION, option=int(key), by="key")
    return Reading(kind=ReadingKind.AGAIN, by="key")


def _order_or_question(heard: _Heard) -> Reading | None:
    """An order, or a question back: only where that is all that was said."""
    said = spoken(heard.text)
    order = order_in(heard.text, heard.lang)
    if order is not None:
        return Reading(kind=ReadingKind.ORDER, order=order)
    for whole in (utterance(said), without_courtesies(said, heard.lang)):
        for kind, entries in heard.known.back.items():
            if whole in listed(entries):
                return Reading(kind=kind)
    return None


def _to_read_back(heard: _Heard, pending: Reply) -> Reading:
    """The answer to a read-back: a plain yes confirms, a plain no denies, more caution counts, nothing else does."""
    whole, known = utterance(spoken(heard.text)), heard.known
    confirms = listed(known.confirm if heard.by is AnsweredBy.VOICE else f"{known.confirm}|{known.yes}")
    if whole in confirms and not vetoes(heard.text, heard.lang, Reply.YES):
        return plain_reply(pending)
    if whole in listed(heard.known.no):
        return _denied(heard, pending)
    reading = _answer(heard)
    is_caution = reading.reply is not None and reading.reply not in (*heard.guarded, pending)
    return reading if is_caution else replace(_AGAIN, vetoes=reading.vetoes)


def _denied(heard: _Heard, pending: Reply, *, by: str = "rules") -> Reading:
    """The opposite of what was read back where that adds caution; else nothing was said."""
    other = opposite(pending)
    return replace(_AGAIN, by=by) if other is None or other in heard.guarded else plain_reply(other, by=by)


def _answer(heard: _Heard) -> Reading:
    length = value_answer(heard.text, heard.question)
    if length is not None:
        return length
    evidence = evidence_in(heard.text, heard.question, heard.lang, is_voice=heard.by is AnsweredBy.VOICE)
    if evidence:
        return Reading(kind=ReadingKind.EVIDENCE, evidence=evidence)
    if heard.text.strip() == "?":
        return plain_reply(Reply.UNSURE)
    if heard.question.query.is_choice:
        return _to_choice(heard)
    reading = _listed_reply(heard) or _cautious(heard) or _read_back(heard)
    if reading is not None:
        return reading
    found = dict.fromkeys(v for reply in heard.guarded for v in vetoes(heard.text, heard.lang, reply))
    return replace(_AGAIN, vetoes=tuple(found))


def _to_choice(heard: _Heard) -> Reading:
    """An option of a choice, or that the person does not know; a yes or no is neither."""
    option = option_in(heard.text, heard.question, heard.lang)
    if option is not None:
        return option
    if not _asks(heard) and words(loose(heard.known.unsure)).search(loose(heard.text)):
        return plain_reply(Reply.UNSURE)
    return replace(_AGAIN, vetoes=vetoes(heard.text, heard.lang, Reply.YES))


def _listed_reply(heard: _Heard) -> Reading | None:
    """A whole utterance of the closed lists."""
    whole, known = utterance(spoken(heard.text)), heard.known
    stated = {PASSABLE: known.passable, ABSENT: known.absent}
    replies = {reply for value, entries in stated.items() if whole in listed(entries)
               and (reply := _reply_if(value, heard.question)) is not None}  # fmt: skip
    replies |= {reply for reply, entries in ((Reply.YES, known.yes), (Reply.NO, known.no)) if whole in listed(entries)}
    if len(replies) != 1:
        return None
    (reply,) = replies
    if reply not in heard.guarded:
        return None if _asks(heard) else plain_reply(reply)
    if vetoes(heard.text, heard.lang, reply):
        return None
    return plain_reply(reply) if heard.by is AnsweredBy.TYPED else Reading(kind=ReadingKind.READ_BACK, reply=reply)


def _read_back(heard: _Heard) -> Reading | None:
    """Agreement with a guarded reply made of the closed vocabulary only, without a veto."""
    said = spoken(heard.text)
    vocabulary = _vocabulary(heard.lang) | frozenset(re.findall(r"[\w']+", spoken(heard.question.text)))
    tokens = re.findall(r"[\w']+", re.sub(r"[ ,]over[.!]*$", "", said))
    if not tokens or not vocabulary.issuperset(tokens):
        return None
    agreed = [reply for reply in sorted(heard.guarded) if _agrees(said, reply, heard)]
    if len(agreed) != 1 or vetoes(heard.text, heard.lang, agreed[0]):
        return None
    return Reading(kind=ReadingKind.READ_BACK, reply=agreed[0])


def _agrees(said: str, reply: Reply, heard: _Heard) -> bool:
    known = heard.known
    signs = [known.aye] if reply is Reply.YES else [rf"(?:{known.no})(?=[,.;!]|$)"]
    for value, pattern in ((PASSABLE, known.seems_passable), (ABSENT, known.seems_absent)):
        if _reply_if(value, heard.question) is reply:
            signs.append(pattern)
    return any(words(sign).search(said) for sign in signs)


def _cautious(heard: _Heard) -> Reading | None:
    """What adds caution, read loosely: a danger, somebody inside, not knowing, and a No or Yes that is not guarded."""
    said, known = loose(heard.text), heard.known
    if _asks(heard):
        return None
    if words(loose(known.unsure)).search(said):
        return plain_reply(Reply.UNSURE)
    for value, pattern in ((BLOCKED, known.blocked), (PRESENT, known.present)):
        reply = _reply_if(value, heard.question)
        if reply is None or reply in heard.guarded or not words(loose(pattern)).search(said):
            continue
        if not (value == BLOCKED and words(loose(known.not_blocked)).search(said)):
            return plain_reply(reply)
    return _loose_reply(said, heard)


def _loose_reply(said: str, heard: _Heard) -> Reading | None:
    """A Yes or No at the beginning that is not guarded, without its opposite, a doubt or a condition."""
    known = heard.known
    begins = re.sub(rf"^(?:(?:{loose(known.courtesies)})[ ,.]+)+", "", said)
    for reply, entries, against in (
        (Reply.YES, known.yes, known.nay),
        (Reply.NO, known.no, f"{known.aye}|{known.seems_passable}"),
    ):
        ends = "(?=[,.;!]|$)" if known.negates in listed(entries) else "(?![\\w'])"
        if reply in heard.guarded or not re.match(rf"(?:{loose(entries)}){ends}", begins):
            continue
        spoils = (against, known.doubt, known.condition, known.denial if reply is Reply.YES else known.not_blocked)
        if not any(words(loose(pattern)).search(begins) for pattern in spoils):
            return plain_reply(reply)
    return None


def _asks(heard: _Heard) -> bool:
    said = spoken(heard.text)
    return "?" in said or "¿" in said or words(heard.known.asks).search(said) is not None


def _reply_if(value: str, question: Question) -> Reply | None:
    """The reply that a statement about the world makes of the query: every gap of the question has that value."""
    kind = GapKind.OBSTACLE if value in (PASSABLE, BLOCKED) else GapKind.PRESENCE
    if any(g.kind is not kind for g in question.gaps) or {g.id for g in question.gaps} != set(question.query.gap_ids):
        return None
    if value == PASSABLE and threshold_of(question) is not None:
        return None  # "it is safe" says nothing of how wide or how high it is
    if len(question.gaps) > 1 and value in (PASSABLE, ABSENT):
        return None  # of several regions or rooms, "it is safe" does not say which
    return Reply.YES if question.query.holds({gap.id: value for gap in question.gaps}) else Reply.NO


@cache
def _vocabulary(lang: str) -> frozenset[str]:
    """Every word of the closed lists, the courtesies and the fillers."""
    known = ANSWER_WORDS[lang]
    lists = "|".join((known.yes, known.no, known.passable, known.absent, known.courtesies))
    return frozenset(re.findall(r"[\w']+", spoken(f"{lists} {known.fillers}")))
