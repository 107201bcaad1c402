"""What the clauses of an instruction do: the contents of a pattern's slots → typed steps."""

from __future__ import annotations

from dataclasses import replace

from mintpilot.core.observation import Attribute, RegionKind
from mintpilot.core.task import KEEP_AWAY_M, Action, KeepAway, Reference
from mintpilot.language import lexicon, verbs
from mintpilot.language.clauses import ROOM, Reading, is_alive, is_person
from mintpilot.language.grammar import Found
from mintpilot.language.phrases import refuse
from mintpilot.language.rule_phrases import names_region, never_enter


def take_off(reading: Reading, found: Found) -> None:
    """Needs no step, unless to a height."""
    if reading.subgoals or reading.took_off:
        reading.words.fail()
    reading.took_off = True
    if found.height_m is not None:
        reading.add(Action.GO, reading.home())
        _how(reading, found)


def home(reading: Reading, found: Found) -> None:
    """Back to the start."""
    reading.add(Action.GO, reading.home())
    _how(reading, found)


def home_too(reading: Reading, found: Found) -> None:
    """``… and back to the start``: the verb is the one before."""
    if not reading.subgoals:
        reading.words.fail()
    home(reading, found)


def go(reading: Reading, found: Found) -> None:
    """To each of the things."""
    _each(reading, found, Action.GO)


def go_too(reading: Reading, found: Found) -> None:
    """``… and to the gate``: the verb is the one before."""
    if not reading.subgoals or reading.subgoals[-1].action is not Action.GO:
        reading.words.fail()
    go(reading, found)


def rise(reading: Reading, found: Found) -> None:
    """To a height, where it is."""
    reading.add(Action.GO, _last(reading))
    _how(reading, found)


def same(reading: Reading, found: Found) -> None:
    """``… and then the blue one``: the verb is the one before."""
    action = reading.subgoals[-1].action if reading.subgoals else None
    if (
        action not in (Action.GO, Action.PHOTOGRAPH, Action.LOOK)
        or reading.words.tokens[reading.clause_at - 1] != "then"
    ):
        reading.words.fail()
    if action is Action.LOOK and any(room.label != ROOM for room in found.things):
        reading.words.fail()
    _each(reading, found, action)


def visit(reading: Reading, found: Found) -> None:
    """``approach the van``; the drone's own parts are no places."""
    if any(thing.label in lexicon.OWN_PARTS for thing in found.things):
        reading.words.fail()
    go(reading, found)


def find(reading: Reading, found: Found) -> None:
    """What is looked for in a room is a look into it; whoever is there is sought everywhere."""
    for thing in found.things:
        if found.rooms:
            reading.add(Action.LOOK, found.rooms[0], thing)
            continue
        told = [a for a in thing.attributes if a.name != "condition" and a.value]
        reading.seeks_people |= is_person(thing) and thing.every and not told
        reading.add(Action.GO, thing)


def look(reading: Reading, found: Found) -> None:
    """Into rooms, for a thing or for whatever is there."""
    thing = found.things[0] if found.things else None
    if thing is not None and thing.label == ROOM:
        reading.words.fail()
    outside = thing is None and found.said.get("LOOK_INTO") in verbs.VISIT
    if outside and any(a.value in lexicon.ENCLOSED for room in found.rooms for a in room.attributes):
        reading.words.fail()  # inspect the tent: from outside
    for room in found.rooms:
        reading.add(Action.LOOK, room, thing)


def somebody_in(reading: Reading, found: Found) -> None:
    """``is there anybody in the kitchen``."""
    who = f"anyone {found.said.get('STATES', '')}".strip()
    reading.add(Action.LOOK, found.rooms[0], Reference(phrase=who, label="person", every=True))


def seek(reading: Reading, found: Found) -> None:
    """Everybody who needs help. ``check for anyone else`` alone does not say so."""
    said = found.said.get("SOMEBODY", "")
    if said.endswith(" else") and not found.said.keys() & {"HELP", "STATES", "HERE"}:
        reading.words.fail()
    reading.seeks_people, reading.sought_at = True, len(reading.subgoals)


def seek_too(reading: Reading, found: Found) -> None:
    """``… and anybody else who needs help``: the verb is the one before."""
    if not reading.subgoals or not found.said["EVERYBODY"].endswith(" else"):
        reading.words.fail()
    seek(reading, found)


def count(reading: Reading, found: Found) -> None:
    """All things of a kind, or those in a room."""
    thing = replace(found.things[0], every=True)
    if found.rooms:
        reading.add(Action.COUNT, found.rooms[0], thing)
    else:
        reading.add(Action.COUNT, thing)


def photograph(reading: Reading, found: Found) -> None:
    """Each thing, or what is where the last step ended."""
    if not found.things:
        if not reading.subgoals:
            reading.words.fail()
        found.things.append(_last(reading))
    _each(reading, found, Action.PHOTOGRAPH)


def report(reading: Reading, found: Found) -> None:
    """What is seen there."""
    places = [*found.rooms, *found.things]
    reading.add(Action.REPORT, places[0] if places else _last(reading))


def wait(reading: Reading, found: Found) -> None:
    """At a thing, or where the last step ended."""
    if found.things:
        reading.add(Action.GO, found.things[0])
    elif not reading.subgoals:
        reading.add(Action.GO, reading.home())
    if found.said.get("OVER") in ("near", "next to", "by") and found.dwell_s is None:
        refuse(found.said["OVER"], "without a time says how to fly, not where to: say 'go to …, stay there for 10 s'")
    _how(reading, found)


def bring(reading: Reading, found: Found) -> None:
    """A thing to a person or place; it is picked up first unless that was said."""
    goal = found.goal or found.things.pop(0)
    (thing,) = found.things
    if goal.every:
        refuse(goal.phrase, "is more than one: say which one it is to be brought to")
    if reading.carried != thing:
        pick(reading, found)
    elif found.source is not None:
        reading.words.fail()
    reading.add(Action.DELIVER, goal, thing)
    reading.carried = None


def drop(reading: Reading, found: Found) -> None:
    """``put the key on the table``, ``… there``."""
    goal = found.things.pop() if len(found.things) > 1 else reading.meant("there")
    upon(found.said.get("UPON", "") or ("at" if found.said.get("AT") == "at" else ""), goal)
    bring(reading, replace(found, goal=goal))


def upon(said: str, goal: Reference) -> None:
    """What is put on, into or at something: that is a place. Raises `InstructionError` for somebody, or an animal."""
    if said and (is_alive(goal) or goal.every):
        refuse(said, f"{goal.phrase}: nothing is put on somebody, or thrown; say 'bring it to {goal.phrase}'")


def needed(reading: Reading, found: Found) -> None:
    """``the injured person needs the medicine``."""
    if not is_person(found.things[0]):
        reading.words.fail()
    bring(reading, found)


def pick(reading: Reading, found: Found) -> None:
    """A thing, from what it stands on or out of what holds it."""
    (thing,), source = found.things, found.source
    if is_alive(thing) or thing.label == ROOM or thing.label in lexicon.FIXED:
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


def told(reading: Reading, found: Found) -> None:
    """``there is an injured person in the hall``: no step, but what pronouns may mean."""
    (who, *marks), state = found.things, found.said.get("STATES", "")
    if reading.told is not None or who.position_m is not None:
        reading.words.fail()
    phrase = " ".join((who.phrase, *([state] if state else []), *(f"{found.said['BY']} {m.phrase}" for m in marks)))
    hurt = [Attribute(name="condition", value="injured")] if state else []
    near = [Attribute(name="near", value=mark.phrase) for mark in marks]
    reading.told = replace(who, phrase=phrase, attributes=(*who.attributes, *hurt, *near), every=False)
    reading.named.append(reading.told)


def keep_out(reading: Reading, found: Found) -> None:
    """Regions and things to stay out of, or away from by a distance."""
    for reference in found.things:
        kind, is_region = lexicon.AVOIDED.get(reference.label), names_region(reference)
        if reference.position_m is not None or (reference.label == ROOM and not is_region):
            refuse(reference.phrase, "cannot be stayed out of by name: smoke, doors, marked areas and things can")
        if not is_region:
            distance_m = KEEP_AWAY_M if found.distance_m is None else found.distance_m
            reading.keep_away.append(KeepAway(reference=replace(reference, every=True), distance_m=distance_m))
            continue
        if kind not in (None, RegionKind.AREA) and reference.attributes:
            refuse(reference.phrase, f": only all {kind} can be stayed out of; say 'avoid the {kind}'")
        if "WISH" not in found.said:
            never_enter(reading, reference)
        elif kind is not None:
            reading.avoid.append(kind)
        else:
            refuse(reference.phrase, "can only be stayed out of altogether: leave 'if possible' out")
        if found.distance_m is not None and kind is not None:
            what = Reference(phrase=str(kind), label=str(kind))
            reading.keep_away.append(KeepAway(reference=what, distance_m=found.distance_m))


def _last(reading: Reading) -> Reference:
    """Where the last step ends; the start before the first one."""
    return reading.subgoals[-1].reference if reading.subgoals else reading.home()


def _each(reading: Reading, found: Found, action: Action) -> None:
    for thing in found.things:
        reading.add(action, thing)
    if found.height_m is not None and len(found.things) > 1:
        refuse("at", "a height after several places: say it for each of them, one step after another")
    _how(reading, found)


def _how(reading: Reading, found: Found) -> None:
    """The last step is done at that height, for that long; slowly holds for the whole flight."""
    reading.slowly |= "SLOWLY" in found.said
    last = reading.subgoals[-1]
    if found.height_m is not None:
        if last.height_m is not None:
            reading.words.fail()
        if last.reference.position_m is not None:
            x, y, _ = last.reference.position_m
            last = replace(last, reference=replace(last.reference, position_m=(x, y, found.height_m)))
        last = replace(last, height_m=found.height_m)
    reading.subgoals[-1] = last if found.dwell_s is None else replace(last, dwell_s=found.dwell_s)
