"""The instruction [I] made into ordered sub-goals, and the steps that a person is shown before anything is flown."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from enum import StrEnum

from mintpilot.core.errors import MissionError
from mintpilot.core.geometry import Vec3
from mintpilot.core.message import Message, Named, joined, message
from mintpilot.core.observation import Attribute, RegionKind
from mintpilot.core.rule import Rule

START = "the start"
"""What the place of take-off is called in references and steps."""
KEEP_AWAY_M = 2.0
"""Distance kept from what is to be kept away from where the person names none, metres."""
DWELL_S = 2.0
"""How long the drone stays at a stop where nothing else is said, seconds."""
SLOW = 0.5
"""Share of the cruise speed that is flown when the person says "slowly"."""


class Action(StrEnum):
    """What is done at a stop."""

    GO = "go"
    """Reach it."""
    PICK = "pick"
    """Take something up there."""
    DELIVER = "deliver"
    """Hand over what is carried."""
    LOOK = "look"
    """Look into a room from its viewpoint."""
    COUNT = "count"
    """Go near each thing of the kind, or look into the room that holds them: how many there are is reported."""
    PHOTOGRAPH = "photograph"
    """Take a picture of it from near."""
    REPORT = "report"
    """Say what is seen from there."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Reference:
    """A phrase of the instruction that means a thing in the world."""

    phrase: str
    """The words themselves: ``the red box``."""
    label: str = ""
    """Semantic class that it must have; empty for any."""
    attributes: tuple[Attribute, ...] = ()
    """What it must have besides."""
    position_m: Vec3 | None = None
    """A fixed place instead of a thing: then nothing else counts."""
    object_id: str = ""
    """A known object of the map instead of a description."""
    every: bool = False
    """True when all things that match are meant (``every room on the left``), in whichever order is shortest."""


@dataclass(frozen=True, slots=True, kw_only=True)
class SubGoal:
    """One step of the task."""

    action: Action
    reference: Reference
    """Where it is done: the thing itself, the container, the receiver, or the room."""
    dwell_s: float = DWELL_S
    """How long the drone stays there, seconds."""
    thing: Reference | None = None
    """What the step is about where that is not the place: what is looked for or counted in a room, taken out of a
    container, or handed over."""
    height_m: float | None = None
    """Height at which the drone arrives, metres; None: whichever is nearest."""
    price_s: float | None = None
    """What leaving it undone costs, seconds of flight; None: what a failed mission counts for."""
    id: str = ""
    """What rules call it by; empty: no rule speaks of it."""

    def __post_init__(self) -> None:
        if self.price_s is not None and not 0 <= self.price_s < math.inf:
            raise MissionError(f"price_s = {self.price_s} of a step: must be finite and not below 0")


@dataclass(frozen=True, slots=True, kw_only=True)
class KeepAway:
    """A distance to be kept from things or regions. A wish: a plan that cannot keep it says so."""

    reference: Reference
    """Things by description, all that match; or a region by its kind (as label) or its id (as ``object_id``)."""
    distance_m: float = KEEP_AWAY_M
    """Between the drone's body and their surface, metres."""

    def __post_init__(self) -> None:
        if not 0 < self.distance_m <= 100:
            raise MissionError(f"keep {self.distance_m:g} m away: must be above 0 and at most 100 metres")


@dataclass(frozen=True, slots=True, kw_only=True)
class Step:
    """One step as it was understood, in plain words, for the person to check."""

    n: int
    """From 1, in the order in which the steps are done."""
    action: str
    """A value of `Action`, or ``seek``: look for everybody who needs help."""
    target: str
    """What it is about; empty where the place says it all."""
    place: str
    """Where; empty where the target says it."""
    text: Message
    """The step as one short sentence without a full stop: ``bring the bottle to the injured person``."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Task:
    """Sub-goals in the order in which they are to be reached."""

    instruction: str
    """The words of the person who gave it."""
    subgoals: tuple[SubGoal, ...]
    seeks_people: bool = False
    """True when everybody who is hurt must be found: closed rooms then open presence gaps."""
    avoid: tuple[RegionKind, ...] = ()
    """Kinds of region that the person wishes to be stayed out of (``skip the smoke if you can``): they open no gap, so
    that no plan enters them, unless the task cannot be done otherwise. What is never to be entered is a rule."""
    keep_away: tuple[KeepAway, ...] = ()
    """What a distance is to be kept from."""
    slowly: bool = False
    """True when the person asked to fly slowly: the whole flight is flown at `SLOW` of the cruise speed."""
    rules: tuple[Rule, ...] = ()
    """What every flight keeps from take-off to its end; orders and fail-safes go before it (method, section 14)."""
    needs_confirmation: bool = False
    """True when a language model read the instruction: nothing is flown before the operator's yes to the steps."""

    @property
    def steps(self) -> tuple[Step, ...]:
        """What will be done, in order, as a person should read it before take-off."""
        done = [g for g in self.subgoals if not (self.seeks_people and _is_anybody(g))]
        found = [_step(n, subgoal) for n, subgoal in enumerate(done, start=1)]
        if self.seeks_people:
            text = message("look for everybody who needs help")
            found.append(Step(n=len(found) + 1, action="seek", target="everybody who needs help", place="", text=text))
        return tuple(found)

    def step_for(self, number: int) -> Step:
        """The step that a sub-goal belongs to; ``number`` counts the sub-goals from 1, 0 means the search for people.

        Raises `IndexError` where there is none.
        """
        listed = [i for i, g in enumerate(self.subgoals, start=1) if not (self.seeks_people and _is_anybody(g))]
        return self.steps[listed.index(number) if number in listed else -1]

    @property
    def keep_out(self) -> tuple[str, ...]:
        """What the drone stays out of or away from, in plain words: ``smoke``, ``people (2 m)``."""
        return (*(r.keeps_out_of for r in self.rules if r.keeps_out_of), *self.wishes)

    @property
    def wishes(self) -> tuple[str, ...]:
        """What of that is given up where the task cannot be done otherwise."""
        kinds = (f"{kind}, if possible" for kind in self.avoid)
        return (*kinds, *(f"{_bare(k.reference.phrase)} ({k.distance_m:g} m)" for k in self.keep_away))


def step_lines(task: Task) -> Iterator[Message]:
    """The steps and what is stayed out of, line by line, to be shown before anything is flown."""
    for step in task.steps:
        yield message("{n} {step}", n=step.n, step=step.text)
    if task.slowly:
        yield message("the whole flight slowly")
    if task.wishes:
        kinds = [message("{kind}, if possible", kind=Named(kind)) for kind in task.avoid]
        near = [
            message("{kind} ({distance_m:g} m)", kind=Named(_bare(k.reference.phrase)), distance_m=k.distance_m)
            for k in task.keep_away
        ]
        yield message("keep out of: {kinds}", kinds=joined([*kinds, *near], ", "))
    for rule in task.rules:
        yield message("rule: {rule}", rule=rule.text)


def _step(n: int, goal: SubGoal) -> Step:
    place = goal.reference.phrase
    thing = goal.thing.phrase if goal.thing is not None else ""
    text = what_is_done(goal.action, place, thing)
    if goal.height_m is not None:
        text = message("{step}, at a height of {height_m:g} m", step=text, height_m=goal.height_m)
    if goal.dwell_s != DWELL_S:
        text = message("{step}, stay there for {dwell_s:g} s", step=text, dwell_s=goal.dwell_s)
    at_place = bool(thing) or goal.action in (Action.LOOK, Action.REPORT, Action.DELIVER)
    return Step(n=n, action=str(goal.action), target=thing if at_place else place, place=place if at_place else "",
                text=text)  # fmt: skip


def what_is_done(action: Action, place: str, thing: str = "") -> Message:
    """One step in words: ``bring the bottle to the injured person``."""
    at, what = Named(place), Named(thing)
    match action, bool(thing):
        case Action.GO, _:
            return message("go to {place}", place=at)
        case Action.PICK, True:
            return message("pick up {thing} from {place}", thing=what, place=at)
        case Action.PICK, False:
            return message("pick up {place}", place=at)
        case Action.DELIVER, True:
            return message("bring {thing} to {place}", thing=what, place=at)
        case Action.DELIVER, False:
            return message("bring what is carried to {place}", place=at)
        case Action.LOOK, True:
            return message("look into {place} for {thing}", place=at, thing=what)
        case Action.LOOK, False:
            return message("look into {place}", place=at)
        case Action.COUNT, True:
            return message("count {thing} in {place}", thing=what, place=at)
        case Action.COUNT, False:
            return message("count {place}", place=at)
        case Action.PHOTOGRAPH, _:
            return message("photograph {place}", place=at)
    return message("report what is seen at {place}", place=at)


def _is_anybody(goal: SubGoal) -> bool:
    """Whether going there is part of looking for everybody."""
    return goal.action is Action.GO and goal.reference.every and goal.reference.label == "person"


def _bare(phrase: str) -> str:
    return phrase.removeprefix("the ")
