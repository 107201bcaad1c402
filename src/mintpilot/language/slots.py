"""What stands in the slots of a clause's pattern: things, rooms, places, heights, distances, times."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from dataclasses import replace

from mintpilot.core.observation import Attribute
from mintpilot.core.task import Reference
from mintpilot.language import lexicon, verbs
from mintpilot.language.clauses import ROOM, Reading, is_alive, is_person
from mintpilot.language.grammar import Found, Slot
from mintpilot.language.phrases import Unread, Words, noun_phrase, refuse


def _thing(reading: Reading, found: Found) -> None:
    found.things.append(reading.phrase())


def _bare(reading: Reading, found: Found) -> None:
    """A thing without what says where it is."""
    found.things.append(reading.phrase(tail=False))


def _place(reading: Reading, found: Found) -> None:
    """A thing or place that may have an unknown name, whatever the verb is."""
    reading.words.open = True
    _thing(reading, found)


def _named(reading: Reading, found: Found) -> None:
    """A thing by its noun: no pronoun."""
    found.things.append(noun_phrase(reading.words))


def _things(reading: Reading, found: Found) -> None:
    found.things += reading.phrases()


def _who(reading: Reading, found: Found) -> None:
    """Somebody to whom something is brought; for *me*, `InstructionError`: where is that?"""
    _no_speaker(reading.words)
    found.goal = reading.phrase()
    if not is_person(found.goal):
        reading.words.fail()


def _goal(reading: Reading, found: Found) -> None:
    """``to the man``, ``there``, ``back to the start``."""
    words = reading.words
    if words.take(*verbs.HOME):
        found.goal = reading.home()
    elif words.take("there", "over there"):
        found.goal = reading.meant("there")
    else:
        said = words.need("to", "over to", "onto", "up to")
        _no_speaker(words)
        found.goal = reading.phrase()
        if said == "onto" and is_alive(found.goal):
            refuse(said, f"{found.goal.phrase}: nothing is put on somebody; say 'bring it to {found.goal.phrase}'")


def _no_speaker(words: Words) -> None:
    if words.next() in ("me", "us"):
        refuse(words.next(), "names no place: where are you? Say whom or where to, as in 'to the start'")


def _source(reading: Reading, found: Found) -> None:
    """``from the table``, ``out of the box``."""
    reading.words.need("from", "out of", "off", "in", "inside")
    found.source = reading.phrase()
    if found.source.label == ROOM or is_person(found.source):
        refuse(found.source.phrase, "is no place to take something from: name what it lies on or in")


def _rooms(reading: Reading, found: Found) -> None:
    """A list of rooms."""
    behind = reading.words.next() == "behind"
    rooms = [_door_room(reading.words)] if behind else [_enclosed(one) for one in reading.phrases()]
    if any(room.label != ROOM for room in rooms):
        reading.words.fail()
    found.rooms += rooms


def _room(reading: Reading, found: Found) -> None:
    """``in the kitchen``, ``behind the brown door``."""
    if reading.words.next() == "behind":
        found.rooms.append(_door_room(reading.words))
        return
    reading.words.need("in", "inside", "into")
    room = _enclosed(reading.phrase())
    if room.label != ROOM:
        reading.words.fail()
    found.rooms.append(room)


def _enclosed(reference: Reference) -> Reference:
    """What can be looked into, as a room of that kind; all else as it is."""
    if reference.label not in lexicon.ENCLOSED:
        return reference
    kind = Attribute(name="kind", value=reference.label)
    return replace(reference, label=ROOM, attributes=(kind, *reference.attributes))


def _door_room(words: Words) -> Reference:
    """The room behind a door."""
    words.need("behind")
    door = noun_phrase(words, tail=False)
    if door.label not in ("door", "doorway") or door.every:
        words.fail()
    near = tuple(replace(a, name="") for a in door.attributes)
    return Reference(phrase=f"the room behind {door.phrase}", label=ROOM, attributes=near)


def _venue(reading: Reading, _: Found) -> None:
    """``in the burning warehouse``: where it all happens tells nothing apart."""
    reading.words.need("in", "inside")
    _hall(reading, _)


def _hall(reading: Reading, _: Found) -> None:
    words = reading.words
    words.take("the", "this", "whole", "the whole", "the entire", "this whole")
    words.take(*lexicon.PLAIN_ADJECTIVES)
    words.need(*lexicon.VENUES)


def _height(reading: Reading, found: Found) -> None:
    """``at a height of 2 m``, metres."""
    words = reading.words
    words.need("at", "to", *(f"{to} {a}" for to in ("at", "to") for a in ("a height of", "an altitude of", "height")))
    found.height_m = words.number()
    if found.height_m is None or not 0 < found.height_m <= 100:
        words.fail()
    words.need(*verbs.METRES)
    words.take("height", "altitude", "high", "above the ground", "above ground")


def _distance(reading: Reading, found: Found) -> None:
    """``at least 2 m``, metres."""
    words = reading.words
    words.take("at least", "a distance of", "at least a distance of", "a distance of at least")
    found.distance_m = _number(words)
    words.need(*verbs.METRES)
    words.take("or more")


def _duration(reading: Reading, found: Found) -> None:
    """``10 seconds``, ``half a minute``, seconds."""
    count = _number(reading.words)
    found.dwell_s = count * verbs.SECONDS[reading.words.need(*verbs.SECONDS)]


def _number(words: Words) -> float:
    count = words.number()
    return verbs.NUMBERS[words.need(*verbs.NUMBERS)] if count is None else count


def _outs(reading: Reading, found: Found) -> None:
    """What is to be stayed out of: a list with *and* or *or*."""
    words = reading.words
    words.take("any", "any of")
    found.things.append(noun_phrase(words))
    at = words.at
    with suppress(Unread):
        words.need(", and", ", or", "and", "or", ",")
        _outs(reading, found)
        return
    words.at = at


SLOTS: Mapping[str, Slot] = {
    f"<{name}>": slot
    for name, slot in (
        ("thing", _thing), ("bare", _bare), ("named", _named), ("place", _place),
        ("things", _things), ("who", _who), ("goal", _goal),
        ("source", _source), ("rooms", _rooms), ("room", _room), ("venue", _venue), ("hall", _hall),
        ("height", _height), ("distance", _distance), ("duration", _duration), ("outs", _outs),
    )
}  # fmt: skip
"""By name, as patterns have them."""
