"""One clause → sub-goals. Each rule accounts for every word that it takes; what no rule takes refuses the instruction."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace

from mintpilot.core.errors import InputError
from mintpilot.core.observation import Attribute
from mintpilot.core.task import KEEP_AWAY_M, Action, Avoidance, KeepAway, Reference, SubGoal
from mintpilot.language import lexicon
from mintpilot.language.clauses import ROOM, Reading, is_person
from mintpilot.language.phrases import Unread, Words, noun_phrase

_SLOWLY = ("slowly", "carefully", "gently", "slowly and carefully")
_ADVERBS = ("straight", "directly", "over", "up", "back", "on", "out", *_SLOWLY)
_GO = (
    "go", "fly", "move", "head", "travel", "proceed", "navigate", "come", "get", "return", "continue", "hover",
    "make your way", "fly yourself",
)  # fmt: skip
_TO = ("to", "towards", "toward", "over to", "up to", "back to", "over")
_FIND = (
    "find", "locate", "search for", "look for", "seek", "track down", "go and find", "go find", "go look for",
    "go and look for", "have a look for", "go and search for", "go and locate",
)  # fmt: skip
_VISIT = ("approach", "visit", "reach", "check", "check on", "inspect", "examine", "look at", "have a look at",
          "take a look at", "go and check", "go and inspect")  # fmt: skip
_LOOK_INTO = (
    "look into", "look in", "look inside", "peek into", "check inside", "have a look into", "take a look into",
    "have a look in", "look through", "go and look into", "search", "scan", "sweep", "check", "inspect", "examine",
    "explore", "go and check", "go and search", "visit", "search through", "have a look inside",
)  # fmt: skip
_PICK = ("pick up", "grab", "take", "collect", "fetch", "get", "retrieve", "lift", "lift up", "go and get", "pick")
_BRING = (
    "bring", "take", "carry", "deliver", "transport", "give", "hand", "get", "fetch", "return", "move", "hand over", "fly",
)  # fmt: skip
_DROP = ("drop", "put", "place", "leave", "set down", "put down", "drop off", "unload", "lay")
_AT = ("at", "on", "onto", "in", "into", "next to", "near", "by", "beside", "in front of", "to", "on top of")
_STARTS = ("the start", "the start position", "the starting point", "the home position", "base", "the base", "launch",
           "the launch point", "the take off point", "start", "home", "the pad", "where you started")  # fmt: skip
_HOME = ("home", "back", "back home", *(f"{back}to {start}" for back in ("", "back ") for start in _STARTS))
_SOMEBODY = tuple(
    f"{there}{who}{other}"
    for there in ("", "there is ", "there's ", "there are ")
    for who in ("anyone", "anybody", "someone", "somebody", "everyone", "everybody", "any people", "people", "any person")
    for other in ("", " else")
)
_NOBODY = ("nobody", "no one", "nobody else", "no one else")
_CHECK = ("check", "see", "find out", "make sure", "look", "determine", "verify", "make certain", "ensure")
_STATES = ("hurt", "injured", "wounded", "trapped", "in danger", "left behind", "in need of help", "unconscious",
           "stuck", "in trouble")  # fmt: skip
_HELP = ("who needs help", "needing help", "in need of help", "needs help", "who need help", "need help", "who is hurt",
         "who is injured", "who is trapped", "who are hurt", "who are injured", "who is wounded")  # fmt: skip
_PICTURE = tuple(
    f"{verb} {one}{picture}"
    for verb in ("take", "make", "get", "snap", "shoot")
    for one in ("a ", "", "some ")
    for picture in ("picture", "photo", "photograph", "image", "snapshot", "pictures", "photos", "photographs")
)
_SEEN = ("what you see", "what you can see", "what is there", "what's there", "what is visible")
_WISH = ("if possible", "if you can", "where possible", "when possible", "wherever possible", "if it is possible")
_ENTER = (
    "go through", "fly through", "pass through", "go into", "fly into", "enter", "cross", "go near", "fly near",
    "come near", "get near", "get close to", "go close to", "fly close to", "go in", "come close to",
)  # fmt: skip
_ENTERING = (
    "going through", "flying through", "passing through", "going into", "flying into", "entering", "crossing",
    "going near", "flying near", "getting near", "coming near",
)  # fmt: skip
_NUMBERS = {"one": 1.0, "two": 2.0, "three": 3.0, "four": 4.0, "five": 5.0, "ten": 10.0, "a": 1.0, "half a": 0.5}
_METRES = ("m", "metre", "metres", "meter", "meters")
_SECONDS = {"s": 1.0, "sec": 1.0, "second": 1.0, "seconds": 1.0, "min": 60.0, "minute": 60.0, "minutes": 60.0}


def read_clause(reading: Reading) -> bool:
    """Takes one clause; False, and nothing taken, where no rule fits. Raises `InputError` for what is impossible."""
    return any(reading.attempt(rule) for rule in _RULES)


def keeps_out(reading: Reading) -> bool:
    """Takes one clause that says what is to be stayed out of; False where there is none."""
    return reading.attempt(_keep_out)


# Going and finding ----------------------------------------------------------------------------------------------------


def _home(reading: Reading) -> None:
    words = reading.words
    if not words.take("rtl"):
        if not words.take("return"):
            words.need(*_GO)
            words.take("straight", "directly")
            words.need(*_HOME)
        elif words.next() in ("to", "home", "back"):
            words.need(*_HOME)
    elif words.next() == "to":
        words.need("to home")
    reading.add(Action.GO, reading.home())


def _go_on_home(reading: Reading) -> None:
    """``… and back to the start``: the verb is the one before."""
    if not reading.subgoals:
        reading.words.fail()
    reading.words.need(*_HOME[1:])
    reading.add(Action.GO, reading.home())


def _take_off(reading: Reading) -> None:
    words = reading.words
    words.need("take off", "launch", "lift off")
    if reading.subgoals:
        words.fail()
    if words.next() in ("to", "at"):
        height_m = _height(words)
        reading.add(Action.GO, reading.home())
        _at_height(reading, height_m)


def _go(reading: Reading) -> None:
    words = reading.words
    reading.slowly |= bool(words.take(*_SLOWLY))
    height_m = _height_if_any(words)
    words.take(",")
    if words.take(*_GO):
        while adverb := words.take(*_ADVERBS):
            reading.slowly |= adverb in _SLOWLY
        words.need(*_TO)
    elif not (reading.subgoals and reading.subgoals[-1].action is Action.GO and words.take("to", "back to")):
        words.fail()
    _each(reading, Action.GO)
    if height_m is not None:
        _at_height(reading, height_m)


def _same(reading: Reading) -> None:
    """``… and then the blue one``: the verb is the one before."""
    words = reading.words
    action = reading.subgoals[-1].action if reading.subgoals else None
    if action not in (Action.GO, Action.PHOTOGRAPH) or words.tokens[words.at - 1] != "then":
        words.fail()
        return
    _each(reading, action)


def _visit(reading: Reading) -> None:
    reading.slowly |= bool(reading.words.take(*_SLOWLY))
    reading.words.need(*_VISIT)
    _each(reading, Action.GO)


def _find(reading: Reading) -> None:
    reading.words.need(*_FIND)
    things = list(reading.phrases())
    room = _room(reading)
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


def _look_into(reading: Reading) -> None:
    words = reading.words
    words.need(*_LOOK_INTO)
    rooms = [*_rooms(reading)]
    thing = None
    if words.take("for"):
        thing = reading.phrase()
        if thing.label == ROOM:
            words.fail()
    for room in rooms:
        reading.add(Action.LOOK, room, thing)


def _look_behind(reading: Reading) -> None:
    reading.words.need("look", "check", "have a look", "search")
    reading.add(Action.LOOK, _behind(reading))


def _search_venue(reading: Reading) -> None:
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


def _somebody_in(reading: Reading) -> None:
    """``is there anybody in the kitchen``, ``check whether anyone is trapped in the office``."""
    words = reading.words
    if words.take(*_CHECK):
        words.need("if", "whether", "that", "for")
        words.take(*_SOMEBODY) or words.fail()
        words.take("is", "are")
    elif not (words.take("is", "are") and words.take("there", "") is not None and words.take(*_SOMEBODY)):
        words.fail()
    state = words.take(*_STATES)
    room = _room(reading)
    if room is None:
        words.fail()
        return
    who = Reference(phrase=f"anyone {state}".strip(), label="person", every=True)
    reading.add(Action.LOOK, room, who)


def _seek(reading: Reading) -> None:
    """``check whether anyone else is hurt``, ``look for anybody who needs help``."""
    words, at = reading.words, reading.words.at
    if words.take(*_FIND) and words.take(*_SOMEBODY):
        words.need(*_HELP)
    else:
        words.at = at
        words.need(*_CHECK)
        words.take("if", "whether", "that")
        nobody = words.take(*_NOBODY)
        if not nobody:
            words.need(*_SOMEBODY)
        if not words.take(*_HELP):
            words.need("is", "are")
            words.need(*_STATES, *(("missing",) if nobody else ()))
    words.take("here", "inside")
    with suppress(Unread):
        _venue(words)
    reading.seeks_people = True


def _venue(words: Words) -> None:
    at = words.at
    try:
        words.need("in", "inside")
        words.take("the", "this")
        words.take(*lexicon.PLAIN_ADJECTIVES)
        words.need(*lexicon.VENUES)
    except Unread:
        words.at = at
        raise


# Carrying -------------------------------------------------------------------------------------------------------------


def _pick(reading: Reading) -> None:
    reading.words.need(*_PICK)
    thing = reading.phrase()
    reading.words.take("up")
    _picked(reading, thing, _source(reading))


def _bring(reading: Reading) -> None:
    """``bring the bottle from the table to the man``."""
    words = reading.words
    words.need(*_BRING)
    thing = reading.phrase()
    source = _source(reading)
    goal = _goal(reading)
    _delivered(reading, thing, source, goal)


def _bring_somebody(reading: Reading) -> None:
    """``bring the man the bottle from the table``."""
    words = reading.words
    words.need(*_BRING)
    if words.next() in ("me", "us"):
        raise InputError(f"where are you? '{words.next()}' names no place: say whom or where to, as in 'to the start'")
    goal = reading.phrase()
    if not is_person(goal):
        words.fail()
    thing = reading.phrase()
    _delivered(reading, thing, _source(reading), goal)


def _drop(reading: Reading) -> None:
    words = reading.words
    words.need(*_DROP)
    thing = reading.phrase(tail=False)
    words.take("down", "off")
    if words.take("there"):
        goal = reading.meant("there")
    else:
        words.need(*_AT)
        goal = reading.phrase()
    _delivered(reading, thing, None, goal)


def _needed(reading: Reading) -> None:
    """``the injured person needs the medicine from the red box``."""
    goal = noun_phrase(reading.words)
    reading.words.need("needs", "need")
    if not is_person(goal):
        reading.words.fail()
    thing = reading.phrase()
    _delivered(reading, thing, _source(reading), goal)


def _source(reading: Reading) -> Reference | None:
    if not reading.words.take("from", "out of", "off"):
        return None
    source = reading.phrase()
    if source.label == ROOM or is_person(source):
        raise InputError(f"'{source.phrase}' is no place to take something from: name what it lies on or in")
    return source


def _goal(reading: Reading) -> Reference:
    words = reading.words
    if words.take(*_HOME):
        return reading.home()
    if words.take("there", "over there"):
        return reading.meant("there")
    words.need("to", "over to", "onto", "up to")
    if words.next() in ("me", "us"):
        raise InputError(f"where are you? '{words.next()}' names no place: say whom or where to, as in 'to the start'")
    return reading.phrase()


def _picked(reading: Reading, thing: Reference, source: Reference | None) -> None:
    if is_person(thing) or thing.label == ROOM:
        raise InputError(f"'{thing.phrase}' cannot be picked up or carried: the drone brings things to people")
    if reading.carried is not None:
        raise InputError(f"'{thing.phrase}' cannot be picked up while '{reading.carried.phrase}' is carried: one by one")
    if thing.every or thing.position_m is not None:
        raise InputError(f"'{thing.phrase}' is not one thing that can be picked up: give a step for each")
    if source is None:
        reading.add(Action.PICK, thing)
    elif source.label in lexicon.SURFACES:
        near = Attribute(name="near", value=source.phrase)
        stands = replace(thing, attributes=(*thing.attributes, near), phrase=f"{thing.phrase} from {source.phrase}")
        reading.add(Action.PICK, stands)
        thing = stands
    else:
        bare = " ".join(w for w in thing.phrase.split() if w not in lexicon.DETERMINERS)
        holder = replace(source, attributes=(*source.attributes, Attribute(name="contents", value=bare)))
        reading.add(Action.PICK, holder, thing)
    reading.carried = thing


def _delivered(reading: Reading, thing: Reference, source: Reference | None, goal: Reference) -> None:
    if goal.every:
        raise InputError(f"'{goal.phrase}' is more than one: say which one it is to be brought to")
    if reading.carried != thing:
        _picked(reading, thing, source)
    elif source is not None:
        reading.words.fail()
    reading.add(Action.DELIVER, goal, thing)
    reading.carried = None


# Looking, counting, telling -------------------------------------------------------------------------------------------


def _count(reading: Reading) -> None:
    words = reading.words
    if words.take("count"):
        words.take("how many")
    else:
        words.need("how many", "tell me how many", "report how many")
    thing = replace(reading.phrase(), every=True)
    words.take("are there", "there are", "do you see", "can you see", "you see", "are")
    room = _room(reading)
    if room is None:
        with suppress(Unread):
            _venue(words)
        reading.add(Action.COUNT, thing)
    else:
        reading.add(Action.COUNT, room, thing)


def _photograph(reading: Reading) -> None:
    words = reading.words
    if words.take("photograph"):
        _each(reading, Action.PHOTOGRAPH)
        return
    words.need(*_PICTURE)
    if words.take("of"):
        _each(reading, Action.PHOTOGRAPH)
    else:
        words.take("there")
        reading.add(Action.PHOTOGRAPH, _last(reading))


def _report(reading: Reading) -> None:
    words = reading.words
    if not words.take("what do you see", "what can you see", "what is there"):
        words.need("report", "tell me", "describe", "say", "tell us", "and report")
        words.need(*_SEEN)
    room = _room(reading)
    if room is None and words.next() in ("behind",):
        room = _behind(reading)
    if room is None and words.take("at", "near", "by", "next to", "around"):
        room = reading.phrase()
    words.take("there")
    reading.add(Action.REPORT, room or _last(reading))


def _last(reading: Reading) -> Reference:
    return reading.subgoals[-1].reference if reading.subgoals else reading.home()


def _wait(reading: Reading) -> None:
    words = reading.words
    words.need("wait", "hover", "stay", "hold", "remain", "hold position")
    words.take("there", "here")
    if words.take("at", "over", "above", "near", "next to", "by"):
        reading.add(Action.GO, reading.phrase())
        if words.next() not in ("for", "") and not words.next().isdigit():
            words.fail()
        if not words.next():
            return
    words.take("for")
    dwell_s = _duration(words)
    if not reading.subgoals:
        reading.add(Action.GO, reading.home())
    reading.subgoals[-1] = replace(reading.subgoals[-1], dwell_s=dwell_s)


def _told(reading: Reading) -> None:
    """``there is an injured person in the hall``: no step, but what pronouns may mean."""
    words = reading.words
    if words.take("there is", "there's"):
        told = noun_phrase(words)
    else:
        told = noun_phrase(words)
        words.need("is")
        state = words.next()
        words.need(*_STATES)
        attributes = (*told.attributes, Attribute(name="condition", value="injured"))
        told = replace(told, attributes=attributes, phrase=f"{told.phrase} {state}")
        if words.take("behind", "near", "next to", "at", "by"):
            mark = noun_phrase(words, tail=False)
            told = replace(told, attributes=(*attributes, Attribute(name="near", value=mark.phrase)))
            told = replace(told, phrase=" ".join((told.phrase, "near", mark.phrase)))
        with suppress(Unread):
            _venue(words)
    if reading.told is not None or told.position_m is not None:
        words.fail()
    told = replace(told, every=False)
    reading.named.append(told)
    reading.told = told


# Places, heights, what is stayed out of -------------------------------------------------------------------------------


def _each(reading: Reading, action: Action) -> None:
    """A list of things or places, and what is said of how to go there."""
    count = 0
    for reference in reading.phrases():
        reading.add(action, reference)
        count += 1
    if reading.words.take(*_SLOWLY):
        reading.slowly = True
    height_m = _height_if_any(reading.words)
    if height_m is not None:
        if count > 1:
            raise InputError("a height after several places: say it for each of them, one step after another")
        _at_height(reading, height_m)


def _at_height(reading: Reading, height_m: float) -> None:
    last = reading.subgoals[-1]
    if last.height_m is not None:
        reading.words.fail()
    if last.reference.position_m is not None:
        x, y, _ = last.reference.position_m
        last = replace(last, reference=replace(last.reference, position_m=(x, y, height_m)))
    reading.subgoals[-1] = replace(last, height_m=height_m)


def _rooms(reading: Reading) -> list[Reference]:
    rooms = [_behind(reading)] if reading.words.next() == "behind" else list(reading.phrases())
    if any(room.label != ROOM for room in rooms):
        reading.words.fail()
    return rooms


def _room(reading: Reading) -> Reference | None:
    """``in the kitchen``, ``behind the brown door``; None where no room follows."""
    words, at = reading.words, reading.words.at
    with suppress(Unread):
        if words.next() == "behind":
            return _behind(reading)
        if words.take("in", "inside", "into"):
            room = reading.phrase()
            if room.label == ROOM:
                return room
    words.at = at
    return None


def _behind(reading: Reading) -> Reference:
    """The room behind a door."""
    reading.words.need("behind")
    door = noun_phrase(reading.words, tail=False)
    if door.label not in ("door", "doorway") or door.every:
        reading.words.fail()
    near = tuple(replace(a, name="") for a in door.attributes)
    return Reference(phrase=f"the room behind {door.phrase}", label=ROOM, attributes=near)


def _height_if_any(words: Words) -> float | None:
    at = words.at
    try:
        return _height(words)
    except Unread:
        words.at = at
        return None


def _height(words: Words) -> float:
    words.need("at", "to", "at a height of", "at an altitude of", "to a height of", "to an altitude of", "at height")
    height_m = words.number()
    if height_m is None or not 0 < height_m <= 100:
        words.fail()
        return 0.0
    words.need(*_METRES)
    words.take("height", "altitude", "high", "above the ground", "above ground")
    return height_m


def _duration(words: Words) -> float:
    count = words.number()
    if count is None:
        count = _NUMBERS[words.need(*_NUMBERS)]
    return count * _SECONDS[words.need(*_SECONDS)]


def _keep_out(reading: Reading) -> None:
    words = reading.words
    wish = bool(words.take(*_WISH))
    words.take(",")
    distance_m: float | None = None
    if words.take("avoid", "avoiding", "bypass", "skip", "skipping"):
        pass
    elif words.take("without"):
        words.need(*_ENTERING)
    elif words.take("do not", "don't", "never", "not"):
        words.need(*_ENTER) if words.tokens[words.at - 1] != "not" else words.need(*_ENTERING)
    elif words.take("stay", "staying", "keep", "keeping", "steer", "steering", "remain"):
        distance_m = _distance(words)
        words.need("out of", "away from", "clear of", "outside of", "outside", "from", "off")
        if words.tokens[words.at - 1] == "from" and distance_m is None and words.tokens[words.at - 2] != "away":
            words.fail()
    else:
        _off_limits(reading)
        return
    for reference in _kept_out(reading):
        _note(reading, reference, distance_m, strict=not wish)
    if words.take(*_WISH):
        reading.avoid = [replace(a, strict=False) for a in reading.avoid]


def _off_limits(reading: Reading) -> None:
    reference = noun_phrase(reading.words)
    reading.words.need("is off limits", "are off limits", "is forbidden", "are forbidden", "must be avoided")
    _note(reading, reference, None, strict=True)


def _distance(words: Words) -> float | None:
    words.take("at least", "a distance of", "at least a distance of", "a distance of at least")
    distance_m = words.number()
    if distance_m is None:
        number = words.take("one", "two", "three", "four", "five", "ten", "a", "half a")
        distance_m = _NUMBERS[number] if number else None
    if distance_m is not None:
        words.need(*_METRES)
        words.take("or more")
    return distance_m


def _kept_out(reading: Reading) -> list[Reference]:
    found = []
    while True:
        reading.words.take("any", "any of")
        found.append(noun_phrase(reading.words))
        at = reading.words.at
        if not reading.words.take(", and", ", or", "and", "or", ","):
            return found
        ahead = reading.words.at
        try:
            reading.words.take("any", "any of")
            noun_phrase(reading.words)
        except Unread:
            reading.words.at = at
            return found
        reading.words.at = ahead


def _note(reading: Reading, reference: Reference, distance_m: float | None, *, strict: bool) -> None:
    if reference.position_m is not None or reference.label == ROOM:
        raise InputError(f"'{reference.phrase}' cannot be stayed out of by name: smoke, doors, marked areas and things can")
    kind = lexicon.AVOIDED.get(reference.label)
    if kind is None:
        keep = KeepAway(reference=replace(reference, every=True), distance_m=distance_m or KEEP_AWAY_M)
        reading.keep_away.append(keep)
        return
    if any(a.value not in ("marked", "restricted") for a in reference.attributes):
        raise InputError(f"'{reference.phrase}': only all {kind} can be stayed out of; say 'avoid the {kind}'")
    reading.avoid.append(Avoidance(kind=kind, strict=strict))
    if distance_m is not None:
        reading.keep_away.append(KeepAway(reference=Reference(phrase=str(kind), label=str(kind)), distance_m=distance_m))


_RULES: tuple[Callable[[Reading], None], ...] = (
    _take_off, _home, _photograph, _report, _count, _wait, _somebody_in, _seek, _search_venue, _look_into, _look_behind,
    _find, _go, _visit, _bring, _bring_somebody, _drop, _pick, _needed, _go_on_home, _same, _told,
)  # fmt: skip
"""The first that fits the words at the cursor decides; a longer reading stands before a shorter one."""
