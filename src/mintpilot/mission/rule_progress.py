"""How far the rules have come: labels freeze when flown (method, section 14)."""

from __future__ import annotations

from dataclasses import dataclass, replace

from mintpilot.core.geometry import Floats
from mintpilot.core.plan import Stop, VehicleLimits
from mintpilot.core.rule import Ruling
from mintpilot.core.semantic_map import SemanticMap
from mintpilot.core.task import Task
from mintpilot.planning.rule_letters import letters_along
from mintpilot.rules.compiling import compile_rules
from mintpilot.uncertainty import letters_of, ruling_of


@dataclass(frozen=True, slots=True, kw_only=True)
class RuleProgress:
    """What was flown, as the rules see it."""

    states: frozenset[int] = frozenset({0})
    """Of the automaton of all rules together: those that the mission may be in."""
    held: int = 0
    """Bits of the propositions of stops that hold now."""


def ruling(task: Task, progress: RuleProgress, map: SemanticMap, stops: tuple[Stop, ...] = ()) -> Ruling | None:
    """The task's rules on that map, as far as they have come; None where there are none."""
    if not task.rules:
        return None
    automaton = compile_rules(task.rules)
    return ruling_of(map, task, automaton, stops, states=progress.states, held=progress.held)


def flown(task: Task, progress: RuleProgress, map: SemanticMap, limits: VehicleLimits, way_m: Floats) -> RuleProgress:
    """After a way (n, 3), metres."""
    rules = ruling(task, progress, map)
    if rules is None or not len(way_m):
        return progress
    letters = letters_along(rules, map, limits, way_m, spare_m=0.0)
    return replace(progress, states=rules.automaton.followed(progress.states, letters, progress.held))


def done(
    task: Task, progress: RuleProgress, map: SemanticMap, limits: VehicleLimits, stop: Stop, at_m: Floats
) -> RuleProgress:
    """After a stop was done at that place (3,)."""
    rules = ruling(task, progress, map)
    if rules is None:
        return progress
    stay = letters_along(rules, map, limits, at_m[None], spare_m=0.0)
    stop_letters = letters_of(stop, map, task, rules.automaton, seen_from_m=at_m)
    states = progress.states
    for now in stop_letters.moments(progress.held):
        states = rules.automaton.followed(states, stay, now)
    return RuleProgress(states=states, held=stop_letters.after(progress.held))


def hoped(task: Task, progress: RuleProgress, map: SemanticMap, stop: Stop) -> int:
    """Bits of the propositions of stops that hold once a stop is done, if there is all to be seen from it."""
    rules = ruling(task, progress, map)
    return progress.held if rules is None else letters_of(stop, map, task, rules.automaton).after(progress.held)
