"""Sub-goals bound to things: one match is a place, several are a target gap, none is a problem to be told."""

from __future__ import annotations

import math
import re
from collections.abc import Collection, Sequence
from dataclasses import dataclass, field

from mintpilot.core.gap import NOWHERE, Candidate, GapKind, KnowledgeGap, target_id
from mintpilot.core.message import Message, message
from mintpilot.core.observation import PERSON
from mintpilot.core.plan import Site, Stop
from mintpilot.core.task import Action, Reference, SubGoal, Task
from mintpilot.uncertainty.describing import describe_apart, seen
from mintpilot.uncertainty.doubts import SURE_NAME, is_doubtful_person, referents
from mintpilot.uncertainty.gaps import LOOK_REACH_M, look_id
from mintpilot.uncertainty.matching import Standpoint, asked_name, match, name_probability
from mintpilot.uncertainty.things import ROOM, Thing, middle_m, nearest_first, synonyms

_REACH_M = {Action.PICK: 1.2, Action.COUNT: 2.5, Action.PHOTOGRAPH: 2.5, Action.REPORT: 2.5}
"""From how far a step can be done where that is not `_NEAR_M`, metres."""
_NEAR_M = 1.5
_POSITION_REACH_M = 0.75
_PRONOUNS = frozenset({"it", "him", "her", "them", "there", "that", "this", "one"})


@dataclass(slots=True, kw_only=True)
class Binding:
    """What the sub-goals come to, collected in order."""

    things: Sequence[Thing]
    view: Standpoint
    finished: Collection[str]
    """Ids of stops that are left out."""
    asked_for: Collection[str] = ()
    """Ids of things that are asked about by themselves: where all people are sought, those who may be none."""
    stops: list[Stop] = field(default_factory=list)
    gaps: dict[str, KnowledgeGap] = field(default_factory=dict)
    problems: list[Message] = field(default_factory=list)
    unmatched: dict[str, Message] = field(default_factory=dict)
    """Phrases that match nothing which was seen, with the problem that says so."""

    def one(self, stop_id: str, subgoal: SubGoal, reference: Reference, first: int) -> None:
        """Binds a sub-goal that means one thing; ``first`` is the number of the first one with this reference."""
        if stop_id in self.finished:
            return
        if reference.position_m is not None:
            site = Site(position_m=reference.position_m, reach_m=_POSITION_REACH_M, label=reference.phrase)
            self.stops.append(_stop(stop_id, subgoal, (site,)))
            return
        found = self._found(reference)
        if not found:
            return
        doubtful = reference.object_id == "" and name_probability(asked_name(reference, found), found[0]) < SURE_NAME
        gap = _gap(reference, first, found, self.things, self.view) if len(found) > 1 or doubtful else None
        sites = tuple(_site(thing, subgoal, value=thing.id if gap else "") for thing in found)
        self.stops.append(_stop(stop_id, subgoal, sites, gap.id if gap else ""))
        if gap:
            self.gaps[gap.id] = gap

    def all(self, stop_id: str, subgoal: SubGoal, reference: Reference) -> None:
        """Binds a sub-goal that means every match: one stop for each, nearest first.

        Nobody in sight is no problem for who looks for anybody.
        """
        found = self._found(reference, told=not (reference.every and reference.label == PERSON))
        left = [
            t
            for t in found
            if not (t.searched or t.id in self.asked_for)
            and not {f"{stop_id}:{t.id}", look_id(t.id)} & set(self.finished)
        ]
        here_m = self.stops[-1].sites[0].position_m if self.stops else self.view.start_m
        for thing in nearest_first(left, here_m):
            self.stops.append(_stop(f"{stop_id}:{thing.id}", subgoal, (_site(thing, subgoal),)))

    def _found(self, reference: Reference, *, told: bool = True) -> tuple[Thing, ...]:
        if reference.object_id:
            return tuple(t for t in self.things if t.id == reference.object_id) or self._none(reference)
        found = match(reference, self.things, self.view)
        return tuple(t for t in found if not t.behind_door) or found or (self._none(reference) if told else ())

    def _none(self, reference: Reference) -> tuple[Thing, ...]:
        label = reference.label
        alike = [t for t in self.things if synonyms(t.label) & synonyms(label)] if label else []
        wanted = reference.object_id or reference.phrase
        self.problems.append(
            message(
                "Nothing on the map matches '{wanted}'. Seen was {seen}.",
                wanted=wanted,
                seen=seen(alike or self.things),
            )
        )
        if not reference.object_id:
            self.unmatched[reference.phrase] = self.problems[-1]
        return ()


def bind(task: Task, things: Sequence[Thing], view: Standpoint, *, finished: Collection[str]) -> Binding:
    """Binds each sub-goal to the things it may mean.

    A stop's id is its action and its number in the task (``pick:1``), so that it stays the same when the map grows;
    of a sub-goal that means every match there is one stop for each (``go:1:person-2``), nearest first. A pronoun means
    what the sub-goal before it meant. The same reference used twice is one gap.
    """
    doubtful = {t.id for t in things if task.seeks_people and is_doubtful_person(t)}
    binding = Binding(things=things, view=view, finished=finished, asked_for=doubtful)
    numbers: dict[Reference, int] = {}
    meant: Reference | None = None
    for number, subgoal in enumerate(task.subgoals, start=1):
        reference = subgoal.reference
        if reference.phrase.lower().strip() in _PRONOUNS and meant is not None and not _is_fixed(reference):
            reference = meant
        meant = reference
        stop_id = f"{subgoal.action}:{number}"
        if reference.every or _is_search(task, subgoal):
            binding.all(stop_id, subgoal, reference)
        else:
            binding.one(stop_id, subgoal, reference, numbers.setdefault(reference, number))
    return binding


def _is_search(task: Task, subgoal: SubGoal) -> bool:
    """Who looks for everybody goes to each person in sight: which one was meant need not be asked."""
    fixed = _is_fixed(subgoal.reference)
    return task.seeks_people and subgoal.action is Action.GO and not fixed and subgoal.reference.label == PERSON


def _is_fixed(reference: Reference) -> bool:
    return reference.position_m is not None or bool(reference.object_id)


def _gap(
    reference: Reference, number: int, found: Sequence[Thing], things: Sequence[Thing], view: Standpoint
) -> KnowledgeGap:
    words = describe_apart(found, things, view.start_m)
    values, prior = _meanings(reference, found)
    return KnowledgeGap(
        id=target_id(number, _slug(reference.phrase)),
        kind=GapKind.TARGET,
        subject=reference.phrase,
        description=reference.phrase if reference.phrase.lower().startswith("the ") else f"the {reference.phrase}",
        values=values,
        prior=prior,
        position_m=middle_m(t.position_m for t in found),
        candidates=tuple(
            Candidate(
                id=t.id,
                position_m=t.position_m,
                attributes=t.attributes,
                size_m=t.size_m,
                description=words[t.id],
            )
            for t in found
        ),
    )


def _meanings(reference: Reference, found: Sequence[Thing]) -> tuple[tuple[str, ...], tuple[float, ...]]:
    """P(g | I, V): the things found, equally likely where all of them are surely what the phrase says.

    Else each by how sure its name is, with the values `NOWHERE`: it may be none of them, or not yet seen.
    """
    ids = tuple(thing.id for thing in found)
    name = asked_name(reference, found)
    if all(name_probability(name, thing) >= SURE_NAME for thing in found):
        return ids, (1 / len(ids),) * len(ids)
    meant = referents(name, found)
    chances = dict(meant.things)
    prior = (*(chances.get(i, 0.0) for i in ids), meant.none_of_them, meant.not_yet_seen)
    total = math.fsum(prior)
    return (*ids, *NOWHERE), tuple(p / total for p in prior)


def _site(thing: Thing, subgoal: SubGoal, value: str = "") -> Site:
    x, y, z = thing.goal_m
    place = (x, y, z if subgoal.height_m is None else subgoal.height_m)
    if thing.label == ROOM:
        return Site(position_m=place, reach_m=LOOK_REACH_M, value=value, label=thing.id)
    half_m = math.hypot(thing.size_m[0], thing.size_m[1]) / 2
    reach_m = _REACH_M.get(subgoal.action, _NEAR_M) + max(0.0, half_m - 0.5)
    return Site(position_m=place, reach_m=reach_m, value=value, label=thing.id)


def _stop(stop_id: str, subgoal: SubGoal, sites: tuple[Site, ...], gap: str = "") -> Stop:
    """What is counted or reported in a room is looked for from its viewpoint."""
    in_room = subgoal.reference.label == ROOM and subgoal.action in (Action.COUNT, Action.REPORT)
    action = Action.LOOK if in_room else subgoal.action
    return Stop(id=stop_id, action=action, sites=sites, gap=gap, dwell_s=subgoal.dwell_s)


def _slug(phrase: str) -> str:
    words = re.sub(r"[^a-z0-9]+", "-", phrase.lower()).strip("-")
    return words.removeprefix("the-") or "thing"
