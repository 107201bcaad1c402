"""Going, finding, looking into rooms, waiting: clauses → steps."""

from __future__ import annotations

from dataclasses import replace

from mintpilot.core.task import Action, Reference
from mintpilot.language import lexicon, verbs
from mintpilot.language.clauses import ROOM, Reading, is_person
from mintpilot.language.places import at_height, behind, duration, each, height, height_if_any, room_ahead, rooms_ahead


def home(reading: Reading) -> None:
    """``come back``, ``return to launch``."""
    words = reading.words
    reading.slowly |= bool(words.take(*verbs.SLOWLY))
    if not words.take("rtl"):
        if not words.take("return"):
            words.need(*verbs.GO)
            words.take("straight", "directly")
            words.need(*verbs.HOME)
        elif words.next() in ("to", "home", "back"):
            words.need(*verbs.HOME)
    elif words.next() == "to":
        words.need("to home")
    reading.slowly |= bool(words.take(*verbs.SLOWLY))
    reading.add(Action.GO, reading.home())


def go_on_home(reading: Reading) -> None:
    """``… and back to the start``: the verb is the one before."""
    if not reading.subgoals:
        reading.words.fail()
    reading.words.need(*verbs.HOME[1:])
    reading.add(Action.GO, reading.home())


def take_off(reading: Reading) -> None:
    """``take off``: needs no step, unless to a height."""
    words = reading.words
    words.need("take off", "launch", "lift off")
    if reading.subgoals or reading.took_off:
        words.fail()
    reading.took_off = True
    if words.next() in ("to", "at"):
        height_m = height(words)
        reading.add(Action.GO, reading.home())
        at_height(reading, height_m)


def go(reading: Reading) -> None:
    """``fly to the gate at 2 m``."""
    words = reading.words
    reading.slowly |= bool(words.take(*verbs.SLOWLY))
    height_m = height_if_any(words)
    words.take(",")
    if words.take(*verbs.GO):
        while adverb := words.take(*verbs.ADVERBS):
            reading.slowly |= adverb in verbs.SLOWLY
        words.need(*verbs.TO)
    elif not (reading.subgoals and reading.subgoals[-1].action is Action.GO and words.take("to", "back to")):
        words.fail()
    each(reading, Action.GO)
    if height_m is not None:
        at_height(reading, height_m)


def same(reading: Reading) -> None:
    """``… and then the blue one``: the verb is the one before."""
    words = reading.words
    action = reading.subgoals[-1].action if reading.subgoals else None
    if action not in (Action.GO, Action.PHOTOGRAPH, Action.LOOK) or words.tokens[words.at - 1] != "then":
        words.fail()
    if action is Action.LOOK:
        for room in rooms_ahead(reading):
            reading.add(Action.LOOK, room)
    else:
        each(reading, action)


def visit(reading: Reading) -> None:
    """``approach the van``, ``check the barrel``."""
    reading.slowly |= bool(reading.words.take(*verbs.SLOWLY))
    verb = reading.words.need(*verbs.VISIT)
    each(reading, Action.GO)
    if "check" in verb and reading.subgoals[-1].reference.label in lexicon.OWN_PARTS:
        reading.words.fail()


def find(reading: Reading) -> None:
    """``find the keys``; what is looked for in a room is a look into it."""
    reading.words.need(*verbs.FIND)
    things = list(reading.phrases())
    room = room_ahead(reading)
    for thing in things:
        if room is not None:
            reading.add(Action.LOOK, room, thing)
        elif thing.label == ROOM or not _is_anybody(thing):
            reading.add(Action.GO, thing)
        else:
            reading.seeks_people = True
            reading.add(Action.GO, thing)


def _is_anybody(reference: Reference) -> bool:
    """Whether whoever is there is meant: all people, or all who are hurt."""
    told = [a for a in reference.attributes if a.name != "condition" and a.value]
    return is_person(reference) and reference.every and not told


def look_into(reading: Reading) -> None:
    """``look into the kitchen``, ``search the office for a laptop``."""
    words = reading.words
    words.need(*verbs.LOOK_INTO)
    rooms = [*rooms_ahead(reading)]
    thing = None
    if words.take("for"):
        thing = reading.phrase()
        if thing.label == ROOM:
            words.fail()
    for room in rooms:
        reading.add(Action.LOOK, room, thing)


def look_behind(reading: Reading) -> None:
    """``look behind the brown door``."""
    reading.words.need("look", "check", "have a look", "search")
    reading.add(Action.LOOK, behind(reading))


def search_venue(reading: Reading) -> None:
    """``search the hall for the keys``: the place is where it all happens."""
    words = reading.words
    words.need("search", "scan", "look through", "explore", "sweep")
    words.take("the", "this", "whole", "the whole", "the entire", "this whole")
    words.take(*lexicon.PLAIN_ADJECTIVES)
    words.need(*lexicon.VENUES)
    words.need("for")
    for thing in list(reading.phrases()):
        reading.seeks_people |= _is_anybody(thing)
        reading.add(Action.GO, thing)


def wait(reading: Reading) -> None:
    """``hover there for 10 seconds``."""
    words = reading.words
    hover = words.need("wait", "hover", "stay", "hold", "remain", "hold position") == "hover"
    words.take("there", "here")
    ahead = words.at
    if height_if_any(words) is not None:
        words.at = ahead
    elif words.take("at", "over", "above", "near", "next to", "by"):
        reading.add(Action.GO, reading.phrase())
        if words.next() != "for":
            return
    if not reading.subgoals:
        reading.add(Action.GO, reading.home())
    if hover:
        height_m = height_if_any(words)
        if height_m is not None:
            at_height(reading, height_m)
        if words.next() != "for" and not words.next().isdigit():
            return
    words.take("for")
    dwell_s = duration(words)
    reading.subgoals[-1] = replace(reading.subgoals[-1], dwell_s=dwell_s)


def last(reading: Reading) -> Reference:
    """Where the last step ends; the start before the first one."""
    return reading.subgoals[-1].reference if reading.subgoals else reading.home()
