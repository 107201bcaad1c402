"""One clause → sub-goals. The patterns are tried in order; the first that fits decides."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, field, replace

from mintpilot.core.errors import InputError
from mintpilot.core.geometry import Vec3
from mintpilot.core.observation import Attribute
from mintpilot.core.task import Action, Reference, SubGoal
from mintpilot.language import lexicon
from mintpilot.language.patterns import (
    AT,
    BRING,
    DROP,
    FIND,
    FROM,
    GO,
    HOME,
    LOOK,
    PICK,
    SECONDS,
    SOMEBODY,
    STAY,
    TO,
    WAIT,
)
from mintpilot.language.phrases import parse_phrase

_PEOPLE = lexicon.PEOPLE | lexicon.ROLES | lexicon.PERSONAL
_NOT_CARRIED = "'{}' cannot be picked up or carried: the drone brings things to people, not people to places"


@dataclass(slots=True, kw_only=True)
class Reading:
    """What was understood so far."""

    home_m: Vec3 | None = None
    subgoals: list[SubGoal] = field(default_factory=list)
    carrying: bool = False
    """Whether something was picked up and not handed over."""

    def reference(self, phrase: str) -> Reference:
        """The phrase read in its place: ``the blue one`` and ``it`` look back. Raises `InputError`."""
        before = next((g.reference for g in reversed(self.subgoals)), None)
        reference = parse_phrase(phrase, before)
        if reference.phrase in lexicon.PRONOUNS:
            people = (g.reference for g in reversed(self.subgoals) if _is_of_people(g.reference))
            before = next(people, None) if reference.phrase in lexicon.PERSONAL else before
            if before is None:
                raise InputError(f"'{reference.phrase}' refers to nothing that was named before: name the thing")
            return before
        return reference

    def add(self, action: Action, reference: Reference) -> None:
        """Notes one step."""
        self.subgoals.append(SubGoal(action=action, reference=reference))


def _is_of_people(reference: Reference) -> bool:
    return reference.label == "person" or reference.label in lexicon.ROLES


def read_clause(clause: str, reading: Reading) -> bool:
    """Adds what the clause asks for to the reading; False where no pattern fits.

    Raises:
        InputError: the clause is understood, but unclear or impossible.
    """
    for pattern, read in _PATTERNS:
        found = pattern.fullmatch(clause)
        if found is not None and read(reading, **found.groupdict()):
            return True
    return False


def _move(reading: Reading, *, thing: str, source: str | None = None, goal: str) -> bool:
    """Bring something somewhere: picked up first unless it is carried already."""
    if thing in ("over", "up", "back", "straight", "directly", "on"):
        return False
    if thing in lexicon.PERSONAL:
        raise InputError(_NOT_CARRIED.format(thing))
    if goal in ("me", "us"):
        raise InputError(f"'{thing}' to be brought to '{goal}': where you are is not known here, so name the place")
    if thing in lexicon.PRONOUNS or (reading.carrying and source is None):
        if not reading.carrying and not _pick_named(reading):
            raise InputError(f"'{thing}' to be brought to '{goal}' was not picked up before: say what to pick up")
    elif not _pick(reading, thing=thing, source=source):
        return False
    reading.add(Action.DELIVER, reading.reference(goal))
    reading.carrying = False
    return True


def _pick_named(reading: Reading) -> bool:
    """``find the box and bring it to …``: what was gone to last is picked up, where it is one thing and nobody."""
    last = reading.subgoals[-1] if reading.subgoals else None
    if last is None or last.action is not Action.GO or last.reference.every or not last.reference.label:
        return False
    if _is_of_people(last.reference) or last.reference.label == "room":
        return False
    reading.add(Action.PICK, last.reference)
    reading.carrying = True
    return True


def _pick(reading: Reading, *, thing: str, source: str | None = None) -> bool:
    """Pick something up; out of a container it is the container that is flown to. Nobody is picked up."""
    thing = re.sub(r" (?:out|outside|away|along)$", "", thing)
    reference = reading.reference(thing) if source is None or set(thing.split()) & _PEOPLE else None
    if reference is not None and _is_of_people(reference):
        raise InputError(_NOT_CARRIED.format(thing))
    if source is None and reference is not None:
        reading.add(Action.PICK, reference)
    elif source is None:
        return False
    else:
        inside = " ".join(w for w in thing.split() if w not in lexicon.DETERMINERS)
        holder = reading.reference(source)
        contents = () if inside in lexicon.PRONOUNS else (Attribute(name="contents", value=inside),)
        reading.add(Action.PICK, replace(holder, attributes=(*holder.attributes, *contents)))
    reading.carrying = True
    return True


def _drop(reading: Reading, *, thing: str, goal: str) -> bool:
    return _move(reading, thing=thing, goal=goal)


def _look(reading: Reading, *, place: str) -> bool:
    """Look into a room; other places are gone to."""
    reference = reading.reference(re.sub(r"^(behind (?:the|every|each|all) (?:\w+ )?doors?)$", r"the room \1", place))
    if reference.label != "room":
        return False
    reading.add(Action.LOOK, reference)
    return True


def _go(reading: Reading, *, place: str, seconds: str | None = None, unit: str | None = None) -> bool:
    reading.add(Action.GO, reading.reference(place))
    return seconds is None or unit is None or _wait(reading, seconds=seconds, unit=unit)


def _go_on(reading: Reading, *, place: str) -> bool:
    """``… and then to the blue one``: the verb is the one before."""
    return bool(reading.subgoals) and reading.subgoals[-1].action is Action.GO and _go(reading, place=place)


def _same(reading: Reading, *, place: str) -> bool:
    """``… and the blue one``: the action is the one before, where it can be done twice."""
    if not reading.subgoals or reading.subgoals[-1].action not in (Action.GO, Action.LOOK):
        return False
    reading.add(reading.subgoals[-1].action, reading.reference(place))
    return True


def _home(reading: Reading) -> bool:
    if reading.home_m is None:
        raise InputError(
            "where to come back to is not known here: name the place, or give the steps without the way back"
        )
    reading.add(Action.GO, Reference(phrase="home", position_m=reading.home_m))
    return True


def _wait(reading: Reading, *, seconds: str, unit: str) -> bool:
    """Stay where the last step ended."""
    if not reading.subgoals:
        raise InputError("waiting before the first step: say where to wait")
    dwell_s = float(seconds) * (60 if unit.startswith("min") else 1)
    reading.subgoals[-1] = replace(reading.subgoals[-1], dwell_s=dwell_s)
    return True


_PATTERNS: tuple[tuple[re.Pattern[str], Callable[..., bool]], ...] = tuple(
    (re.compile(pattern), read)
    for pattern, read in (
        (HOME, _home),
        (f"{WAIT} {SECONDS}", _wait),
        (f"{BRING} (?P<thing>.+?) {FROM} (?P<source>.+?) {TO} (?P<goal>.+)", _move),
        (f"{BRING} (?P<goal>{SOMEBODY}) (?P<thing>the .+?|it) {FROM} (?P<source>.+)", _move),
        (f"{BRING} (?P<goal>{SOMEBODY}) (?P<thing>the .+|it|some .+|a .+)", _move),
        (f"{BRING} (?P<thing>.+?) {TO} (?P<goal>.+)", _move),
        (f"{DROP} (?P<thing>.+?)(?: down| off)? {AT} (?P<goal>.+)", _drop),
        (f"{PICK} (?P<thing>.+?) {FROM} (?P<source>.+)", _pick),
        (f"{PICK} (?P<thing>.+?)(?: up)?", _pick),
        (f"{LOOK} (?:.+) for (?P<place>(?:the|a|an) .+)", _go),
        (f"{LOOK} (?!for )(?P<place>.+)", _look),
        (f"{FIND} (?P<place>.+)", _go),
        (f"{GO} (?P<place>.+?){STAY}", _go),
        ("go (?P<place>there)", _go),
        ("(?:on )?to (?P<place>.+)", _go_on),
        ("(?P<place>(?:the|every|each|all) .+)", _same),
    )
)
