"""Rules that an instruction says, bound to the regions of the mission by what these are called."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from mintpilot.core.errors import InputError
from mintpilot.core.observation import RegionKind
from mintpilot.core.rule import About, Proposition, Rule
from mintpilot.core.task import Task
from mintpilot.rules.formula import propositions_of
from mintpilot.rules.parsing import parse
from mintpilot.rules.satisfying import conflicting


def with_rules(task: Task, regions: Mapping[str, str], more: tuple[Rule, ...]) -> Task:
    """The task with the rules that it says, about the regions that are called so, and with more of them.

    Args:
        task: as the instruction says it.
        regions: id of each region that is known before the flight, and its description.
        more: of the mission file.

    Raises:
        InputError: no region, or more than one, is called so; or rules contradict each other.
    """
    rules = (*(_bound(rule, regions) for rule in task.rules), *more)
    against = conflicting(rules) if task.rules else ()
    if against:
        raise InputError(f"no flight can keep {' and '.join(repr(str(rule.text)) for rule in against)}: leave one out")
    return replace(task, rules=rules)


def _bound(rule: Rule, regions: Mapping[str, str]) -> Rule:
    formula = rule.formula
    for what in propositions_of(parse(formula)):
        if what.about in (About.IN, About.INSIDE, About.TOUCHES):
            meant = Proposition(about=what.about, subject=_region(what.subject, rule, regions))
            formula = formula.replace(str(what), str(meant))
    return replace(rule, formula=formula)


def _region(name: str, rule: Rule, regions: Mapping[str, str]) -> str:
    """Its id; kinds of regions have theirs already, and mean whatever is or will be on the map."""
    if name in regions or name in list(RegionKind):
        return name
    called = {id: set(said.lower().replace("-", " ").split()) | {id} for id, said in regions.items()}
    exact = [id for id, said in regions.items() if said.lower().removeprefix("the ") == name]
    meant = exact or [id for id, words in called.items() if set(name.split()) <= words]
    if len(meant) == 1:
        return meant[0]
    known = ", ".join(f"'{said or id}'" for id, said in regions.items()) or "none that has a name"
    fault = "there is no region of that name" if not meant else f"{len(meant)} regions are called so"
    raise InputError(f"'{rule.text}': {fault}; regions: {known}. Name one of them, or a kind: {', '.join(RegionKind)}")
