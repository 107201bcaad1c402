"""Places, rooms, heights and times within a clause: what the rules for its verbs share."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace

from mintpilot.core.task import Action, Reference
from mintpilot.language import lexicon, verbs
from mintpilot.language.clauses import ROOM, Reading
from mintpilot.language.phrases import Unread, Words, noun_phrase, refuse


def venue(words: Words) -> None:
    """Takes ``in the burning warehouse``. Raises `Unread`."""
    at = words.at
    try:
        words.need("in", "inside")
        words.take("the", "this")
        words.take(*lexicon.PLAIN_ADJECTIVES)
        words.need(*lexicon.VENUES)
    except Unread:
        words.at = at
        raise


def each(reading: Reading, action: Action) -> None:
    """A list of things or places, and what is said of how to go there."""
    count = 0
    for reference in reading.phrases():
        reading.add(action, reference)
        count += 1
    slowly = (*verbs.SLOWLY, *(f", {how}" for how in verbs.SLOWLY))
    reading.slowly |= bool(reading.words.take(*slowly))
    height_m = height_if_any(reading.words)
    if height_m is not None:
        reading.slowly |= bool(reading.words.take(*slowly))
        if count > 1:
            refuse("at", "a height after several places: say it for each of them, one step after another")
        at_height(reading, height_m)


def at_height(reading: Reading, height_m: float) -> None:
    """The last step is done at that height."""
    last = reading.subgoals[-1]
    if last.height_m is not None:
        reading.words.fail()
    if last.reference.position_m is not None:
        x, y, _ = last.reference.position_m
        last = replace(last, reference=replace(last.reference, position_m=(x, y, height_m)))
    reading.subgoals[-1] = replace(last, height_m=height_m)


def rooms_ahead(reading: Reading) -> list[Reference]:
    """A list of rooms. Raises `Unread`."""
    rooms = [behind(reading)] if reading.words.next() == "behind" else list(reading.phrases())
    if any(room.label != ROOM for room in rooms):
        reading.words.fail()
    return rooms


def room_ahead(reading: Reading) -> Reference | None:
    """``in the kitchen``, ``behind the brown door``; None where no room follows."""
    words, at = reading.words, reading.words.at
    with suppress(Unread):
        if words.next() == "behind":
            return behind(reading)
        if words.take("in", "inside", "into"):
            room = reading.phrase()
            if room.label == ROOM:
                return room
    words.at = at
    return None


def behind(reading: Reading) -> Reference:
    """The room behind a door."""
    reading.words.need("behind")
    door = noun_phrase(reading.words, tail=False)
    if door.label not in ("door", "doorway") or door.every:
        reading.words.fail()
    near = tuple(replace(a, name="") for a in door.attributes)
    return Reference(phrase=f"the room behind {door.phrase}", label=ROOM, attributes=near)


def height_if_any(words: Words) -> float | None:
    """``at 2 m``; None, and nothing taken, where no height follows."""
    at = words.at
    try:
        return height(words)
    except Unread:
        words.at = at
        return None


def height(words: Words) -> float:
    """``at a height of 2 m``, metres. Raises `Unread`."""
    words.need("at", "to", "at a height of", "at an altitude of", "to a height of", "to an altitude of", "at height")
    height_m = words.number()
    if height_m is None or not 0 < height_m <= 100:
        words.fail()
    words.need(*verbs.METRES)
    words.take("height", "altitude", "high", "above the ground", "above ground")
    return height_m


def duration(words: Words) -> float:
    """``10 seconds``, ``half a minute``, seconds. Raises `Unread`."""
    count = words.number()
    if count is None:
        count = verbs.NUMBERS[words.need(*verbs.NUMBERS)]
    return count * verbs.SECONDS[words.need(*verbs.SECONDS)]
