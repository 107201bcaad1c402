"""Phrases that are rules in time: ``never enter the smoke``, ``always stay within the hall`` (method, section 14).

A rule calls a step by the id that it gives it, and a region by its kind or by its name; whether there is a region of
that name is found out where there is a map.
"""

from __future__ import annotations

from dataclasses import replace

from mintpilot.core import rule_patterns
from mintpilot.core.message import Message, Named, message
from mintpilot.core.observation import RegionKind
from mintpilot.core.rule import About, Proposition, Rule
from mintpilot.core.task import Action, Reference, SubGoal, Task
from mintpilot.language import lexicon
from mintpilot.language.clauses import ROOM, Reading, is_person
from mintpilot.language.grammar import Found
from mintpilot.language.phrases import refuse


def names_region(reference: Reference) -> bool:
    """Whether it means regions: all of a kind, or one that is called like a place or like a certain room."""
    is_certain_room = reference.label == ROOM and not _is_any_room(reference)
    return reference.label in lexicon.AVOIDED or reference.label in lexicon.VENUES or is_certain_room


def never_enter(reading: Reading, reference: Reference) -> None:
    """``never enter the smoke``."""
    _add(
        reading, message("never enter {place}", place=Named(reference.phrase)), rule_patterns.never(_touches(reference))
    )


def stay_within(reading: Reading, found: Found) -> None:
    """``always stay within the hall``, ``never leave the hall``."""
    for reference in found.things:
        hides = lexicon.AVOIDED.get(reference.label, RegionKind.AREA) is not RegionKind.AREA
        if hides or reference.position_m is not None or is_person(reference) or _is_any_room(reference):
            refuse(reference.phrase, "is nothing to stay within: name a region of the map, such as the hall")
        inside = rule_patterns.always(Proposition(about=About.IN, subject=_name(reference)))
        _add(reading, message("always stay within {place}", place=Named(reference.phrase)), inside)


def enter_later(reading: Reading, found: Found) -> None:
    """``before you go through the smoke``: not before a step that is said beside it, see `ordered`."""
    if not all(map(names_region, found.things)):
        reading.words.fail()
    reading.entered_later = tuple(found.things)


def ordered(reading: Reading, earlier: int, later: int) -> None:
    """Makes rules of a ``before``: a step, by its place in the list, is done before the later one, or before entering.

    Where that step is many things, later steps only stand after it: a rule needs one step that is done.
    """
    goals, entered = reading.subgoals, reading.entered_later
    reading.entered_later = ()
    if not 0 <= earlier < len(goals) or (goals[earlier].reference.every and entered):
        refuse("before", "needs one step that is done before: name one place or thing")
    if goals[earlier].reference.every or (not entered and later >= len(goals)):
        return
    first = _said(goals[earlier])
    for reference in entered:
        text = message("never enter {place} before this is done: {step}", place=Named(reference.phrase), step=first)
        _add(reading, text, rule_patterns.never_before(_touches(reference), _done(reading, earlier)))
    if not entered:
        text = message("never {later} before this is done: {step}", later=_said(goals[later]), step=first)
        _add(reading, text, rule_patterns.never_before(_done(reading, later), _done(reading, earlier)))


def back_at_the_end(reading: Reading, _: Found) -> None:
    """``come back at the end``: the last step, wherever it is said."""
    reading.back_last = True


def come_back(reading: Reading) -> None:
    """The way back that was said to come at the end becomes the last step, and a rule."""
    if reading.back_last:
        if reading.seeks_people:
            refuse("at the end", "cannot be said of a search for people: say the search last")
        reading.add(Action.GO, reading.home())
        back = _done(reading, len(reading.subgoals) - 1)
        _add(
            reading,
            message("come back to {place} at the end", place=Named(reading.home().phrase)),
            rule_patterns.at_end(back),
        )


def _is_any_room(reference: Reference) -> bool:
    return reference.label == ROOM and all(a.name != "kind" for a in reference.attributes)


def _done(reading: Reading, index: int) -> Proposition:
    """That a step was done; a look only counts where something could be seen."""
    goal = reading.subgoals[index]
    goal = replace(goal, id=goal.id or f"step-{1 + sum(g.id != '' for g in reading.subgoals)}")
    reading.subgoals[index] = goal
    return Proposition(about=About.LOOKED if goal.action is Action.LOOK else About.DID, subject=goal.id)


def _touches(reference: Reference) -> Proposition:
    return Proposition(about=About.TOUCHES, subject=_name(reference))


def _name(reference: Reference) -> str:
    """Kind of region, or what a region is called."""
    kind = lexicon.AVOIDED.get(reference.label)
    if kind is None or any(a.value not in ("marked", "restricted") for a in reference.attributes):
        return " ".join(word for word in reference.phrase.split() if word not in lexicon.DETERMINERS)
    return str(kind)


def _said(goal: SubGoal) -> Message:
    return Task(instruction="", subgoals=(goal,)).steps[0].text


def _add(reading: Reading, text: Message, rule: Rule) -> None:
    reading.rules.append(Rule(text=text, formula=rule.formula))
