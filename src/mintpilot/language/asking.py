"""Questions of who and what is there, counting, pictures, reports: clauses → steps."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace

from mintpilot.core.observation import Attribute
from mintpilot.core.task import Action, Reference
from mintpilot.language import verbs
from mintpilot.language.clauses import Reading
from mintpilot.language.going import last
from mintpilot.language.phrases import Unread, noun_phrase
from mintpilot.language.places import behind, each, room_ahead, venue


def somebody_in(reading: Reading) -> None:
    """``is there anybody in the kitchen``, ``check whether anyone is trapped in the office``."""
    words = reading.words
    if words.take(*verbs.CHECK):
        words.need("if", "whether", "for")
        words.need(*verbs.SOMEBODY)
        words.take("is", "are")
    else:
        words.need("is", "are")
        words.take("there")
        words.need(*verbs.SOMEBODY)
    state = words.take(*verbs.STATES)
    room = room_ahead(reading)
    if room is None:
        words.fail()
    who = Reference(phrase=f"anyone {state}".strip(), label="person", every=True)
    reading.add(Action.LOOK, room, who)


def seek(reading: Reading) -> None:
    """``check whether anyone else is hurt``, ``look for anybody who needs help``."""
    words, at = reading.words, reading.words.at
    if (words.take(*verbs.FIND) and words.take(*verbs.EVERYBODY)) or (
        reading.subgoals and words.take(*verbs.EVERYBODY) and words.tokens[words.at - 1] == "else"
    ):
        words.need(*verbs.HELP)
    else:
        words.at = at
        nobody = bool(words.take(*verbs.ENSURE) and words.take(*verbs.NOBODY))
        if not nobody:
            words.at = at
            words.need(*verbs.CHECK)
            words.need("if", "whether", "for")
            words.need(*verbs.SOMEBODY)
        if not words.take(*verbs.HELP) and words.take("is", "are"):
            words.need(*verbs.STATES, *(("missing",) if nobody else ()))
        elif words.tokens[words.at - 1] == "else" and words.next() not in ("inside", "here"):
            words.fail()
    words.take("here", "inside", "in here")
    with suppress(Unread):
        venue(words)
    reading.seeks_people = True


def count(reading: Reading) -> None:
    """``count the barrels``, ``how many people are in the hall``."""
    words = reading.words
    if words.take("count"):
        words.take("how many")
    else:
        words.need("how many", "tell me how many", "report how many")
    thing = replace(reading.phrase(), every=True)
    words.take("are there", "there are", "do you see", "can you see", "you see", "are")
    room = room_ahead(reading)
    if room is None:
        with suppress(Unread):
            venue(words)
        reading.add(Action.COUNT, thing)
    else:
        reading.add(Action.COUNT, room, thing)


def photograph(reading: Reading) -> None:
    """``take a picture of the gate``."""
    words = reading.words
    if words.take("photograph"):
        each(reading, Action.PHOTOGRAPH)
        return
    words.need(*verbs.PICTURE)
    if words.take("of"):
        each(reading, Action.PHOTOGRAPH)
    else:
        words.take("there")
        if not reading.subgoals:
            words.fail()
        reading.add(Action.PHOTOGRAPH, last(reading))


def report(reading: Reading) -> None:
    """``report what you see in the kitchen``."""
    words = reading.words
    if not words.take("what do you see", "what can you see", "what is there"):
        words.need("report", "tell me", "describe", "say", "tell us", "and report")
        words.need(*verbs.SEEN)
    room = room_ahead(reading)
    if room is None and words.next() in ("behind",):
        room = behind(reading)
    if room is None and words.take("at", "near", "by", "next to", "around"):
        room = reading.phrase()
    words.take("there")
    reading.add(Action.REPORT, room or last(reading))


def told(reading: Reading) -> None:
    """``there is an injured person in the hall``: no step, but what pronouns may mean."""
    words = reading.words
    if words.take("there is", "there's"):
        told = noun_phrase(words)
    else:
        told = noun_phrase(words)
        words.need("is")
        state = words.next()
        words.need(*verbs.STATES)
        attributes = (*told.attributes, Attribute(name="condition", value="injured"))
        told = replace(told, attributes=attributes, phrase=f"{told.phrase} {state}")
        where = words.take("behind", "near", "next to", "at", "by")
        if where:
            mark = noun_phrase(words, tail=False)
            told = replace(told, attributes=(*attributes, Attribute(name="near", value=mark.phrase)))
            told = replace(told, phrase=" ".join((told.phrase, where, mark.phrase)))
        with suppress(Unread):
            venue(words)
    if reading.told is not None or told.position_m is not None:
        words.fail()
    told = replace(told, every=False)
    reading.named.append(told)
    reading.told = told
