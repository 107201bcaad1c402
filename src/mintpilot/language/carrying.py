"""Picking up, bringing, handing over: clauses → steps."""

from __future__ import annotations

from dataclasses import replace

from mintpilot.core.observation import Attribute
from mintpilot.core.task import Action, Reference
from mintpilot.language import lexicon, verbs
from mintpilot.language.clauses import ROOM, Reading, is_person
from mintpilot.language.phrases import noun_phrase, refuse


def pick(reading: Reading) -> None:
    """``pick up the bottle from the table``."""
    reading.words.need(*verbs.PICK)
    thing = reading.phrase()
    reading.words.take("up")
    _picked(reading, thing, _source(reading))


def bring(reading: Reading) -> None:
    """``bring the bottle from the table to the man``."""
    words = reading.words
    words.need(*verbs.BRING)
    thing = reading.phrase()
    source = _source(reading)
    goal = _goal(reading)
    _delivered(reading, thing, source, goal)


def bring_somebody(reading: Reading) -> None:
    """``bring the man the bottle from the table``."""
    words = reading.words
    words.need(*verbs.BRING)
    if words.next() in ("me", "us"):
        _where_are_you(words.next())
    goal = reading.phrase()
    if not is_person(goal):
        words.fail()
    thing = reading.phrase()
    _delivered(reading, thing, _source(reading), goal)


def drop(reading: Reading) -> None:
    """``put the key on the table``."""
    words = reading.words
    words.need(*verbs.DROP)
    thing = reading.phrase(tail=False)
    words.take("down", "off")
    if words.take("there"):
        goal = reading.meant("there")
    else:
        words.need(*verbs.AT)
        goal = reading.phrase()
    _delivered(reading, thing, None, goal)


def needed(reading: Reading) -> None:
    """``the injured person needs the medicine from the red box``."""
    goal = noun_phrase(reading.words)
    reading.words.need("needs", "need")
    if not is_person(goal):
        reading.words.fail()
    thing = reading.phrase()
    _delivered(reading, thing, _source(reading), goal)


def _where_are_you(word: str) -> None:
    refuse(word, "names no place: where are you? Say whom or where to, as in 'to the start'")


def _source(reading: Reading) -> Reference | None:
    if not reading.words.take("from", "out of", "off", "in", "inside"):
        return None
    source = reading.phrase()
    if source.label == ROOM or is_person(source):
        refuse(source.phrase, "is no place to take something from: name what it lies on or in")
    return source


def _goal(reading: Reading) -> Reference:
    words = reading.words
    if words.take(*verbs.HOME):
        return reading.home()
    if words.take("there", "over there"):
        return reading.meant("there")
    words.need("to", "over to", "onto", "up to")
    if words.next() in ("me", "us"):
        _where_are_you(words.next())
    return reading.phrase()


def _picked(reading: Reading, thing: Reference, source: Reference | None) -> None:
    if is_person(thing) or thing.label == ROOM or thing.label in lexicon.FIXED:
        refuse(thing.phrase, "cannot be picked up or carried: the drone brings things to people")
    if reading.carried is not None:
        refuse(thing.phrase, f"cannot be picked up while '{reading.carried.phrase}' is carried: one by one")
    if thing.every or thing.position_m is not None:
        refuse(thing.phrase, "is not one thing that can be picked up: give a step for each")
    if source is None:
        reading.add(Action.PICK, thing)
    elif source.label in lexicon.SURFACES:
        near = Attribute(name="near", value=source.phrase)
        stands = replace(thing, attributes=(*thing.attributes, near), phrase=f"{thing.phrase} from {source.phrase}")
        reading.add(Action.PICK, stands)
    else:
        bare = " ".join(w for w in thing.phrase.split() if w not in lexicon.DETERMINERS)
        holder = replace(source, attributes=(*source.attributes, Attribute(name="contents", value=bare)))
        reading.add(Action.PICK, holder, thing)
    reading.carried = thing


def _delivered(reading: Reading, thing: Reference, source: Reference | None, goal: Reference) -> None:
    if goal.every:
        refuse(goal.phrase, "is more than one: say which one it is to be brought to")
    if reading.carried != thing:
        _picked(reading, thing, source)
    elif source is not None:
        reading.words.fail()
    reading.add(Action.DELIVER, goal, thing)
    reading.carried = None
