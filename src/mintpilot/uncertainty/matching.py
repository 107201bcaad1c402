"""Which things of the map a phrase may mean (method, section 1: target gaps).

An attribute that nothing is known of does not rule a thing out; one that is known to differ does. Where some things
are known to have all that the phrase asks for, only those are meant. Nothing is chosen among equals: that is a gap.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from mintpilot.core.geometry import Vec3
from mintpilot.core.observation import Attribute
from mintpilot.core.task import Reference
from mintpilot.uncertainty.things import ROOM, Thing, name_of, stands_for, synonyms, value_of, values_of

SIDE = "side"
"""Attribute of a reference: ``left`` or ``right`` of the line from the start to the middle of the map."""
NEAR = "near"
"""Attribute of a reference: the words for a landmark within `NEAR_M`."""
EXTREME = "extreme"
"""Attribute of a reference: the most of its kind, one of `EXTREMES`."""
KIND = "kind"
"""Attribute of a reference to a room: what the room is called by: ``kitchen``, ``storage room``."""
NEAR_M = 3.0
WEAK_NAME = 0.15
"""Names that are less likely do not make a thing one that a phrase may mean."""
_TIE = 0.05


@dataclass(frozen=True, slots=True, kw_only=True)
class Standpoint:
    """From where ``left``, ``nearest`` and the like are judged."""

    start_m: Vec3
    """Where the drone is."""
    towards_m: Vec3
    """What it looks at: the middle of the map."""

    def distance_m(self, thing: Thing) -> float:
        """From the drone to the thing."""
        return math.dist(self.start_m, thing.position_m)

    def left_m(self, thing: Thing) -> float:
        """Metres to the left of the line of sight; negative to the right."""
        ahead_x, ahead_y = self.towards_m[0] - self.start_m[0], self.towards_m[1] - self.start_m[1]
        norm = math.hypot(ahead_x, ahead_y)
        ahead_x, ahead_y = (ahead_x / norm, ahead_y / norm) if norm > 1e-6 else (1.0, 0.0)
        x, y = thing.position_m[0] - self.start_m[0], thing.position_m[1] - self.start_m[1]
        return ahead_x * y - ahead_y * x


EXTREMES: dict[str, Callable[[Standpoint, Thing], float]] = {
    "nearest": lambda view, thing: -view.distance_m(thing),
    "farthest": lambda view, thing: view.distance_m(thing),
    "largest": lambda _, thing: math.prod(thing.size_m),
    "smallest": lambda _, thing: -math.prod(thing.size_m),
    "tallest": lambda _, thing: thing.size_m[2],
    "lowest": lambda _, thing: -thing.position_m[2],
    "highest": lambda _, thing: thing.position_m[2],
    "leftmost": lambda view, thing: view.left_m(thing),
    "rightmost": lambda view, thing: -view.left_m(thing),
}


def match(reference: Reference, things: Sequence[Thing], view: Standpoint) -> tuple[Thing, ...]:
    """The things that the reference may mean, in the order of ``things``.

    Unnamed attributes may be part of the label (``fire extinguisher``). The label itself counts first; only where
    nothing has it, its synonyms. Of an extreme (``the largest box``) those within 5 % of the most are kept.
    """
    plain = [a for a in reference.attributes if name_of(a) != EXTREME]
    whole = " ".join((*(value_of(a) for a in plain if not name_of(a)), reference.label))
    found = tuple(t for t in things if reference.label and (_word(t.label) == _word(whole) or _may_be(t, whole)))
    if found and whole != reference.label:
        plain = [a for a in plain if name_of(a)]  # the unnamed ones are part of the name
    found = found or _of_label(reference.label, things)
    for attribute in plain:
        found = tuple(t for t in found if _has(t, attribute, things, view) is not False)
    for attribute in plain:
        found = tuple(t for t in found if _has(t, attribute, things, view)) or found
    for attribute in reference.attributes:
        measure = EXTREMES.get(value_of(attribute))
        if name_of(attribute) == EXTREME and measure is not None and found:
            most = max(measure(view, t) for t in found)
            found = tuple(t for t in found if measure(view, t) >= most - _TIE * abs(most))
    return found


def _of_label(label: str, things: Sequence[Thing]) -> tuple[Thing, ...]:
    if not label:
        return tuple(things)
    exact = tuple(t for t in things if _word(t.label) == _word(label) or _may_be(t, label))
    return exact or tuple(t for t in things if stands_for(t.label, label))


def name_probability(label: str, thing: Thing) -> float:
    """That the thing is what the label says, as far as its names tell; 1 for one without doubt about its name."""
    if not thing.names or not label:
        return 1.0
    return math.fsum(g.probability for g in thing.names if stands_for(g.label, label))


def asked_name(reference: Reference, things: Sequence[Thing]) -> str:
    """The name that a phrase asks for: ``medicine box`` where something may be so called, else its noun alone."""
    whole = " ".join((*(value_of(a) for a in reference.attributes if not name_of(a)), reference.label))
    named = {g.label for t in things for g in t.names} | {t.label for t in things}
    return whole if any(stands_for(name, whole) for name in named) else reference.label


def _may_be(thing: Thing, label: str) -> bool:
    """Whether a thing has that name weakly: it is then one of those that are asked about."""
    return bool(thing.names) and name_probability(label, thing) >= WEAK_NAME


def _word(label: str) -> str:
    return label.lower().replace("_", " ").strip()


def _has(thing: Thing, attribute: Attribute, things: Sequence[Thing], view: Standpoint) -> bool | None:
    """Whether the thing has the attribute; None where that is not known."""
    name, value = name_of(attribute), value_of(attribute)
    if name == SIDE:
        return (view.left_m(thing) > 0) == (value == "left")
    if name == NEAR:
        marks = [t for t in things if t.id != thing.id and _is_called(t, value)]
        return any(math.dist(t.position_m, thing.position_m) <= NEAR_M for t in marks) if marks else None
    if name == KIND:
        if set(value.split()) <= thing.called:
            return True
        return None if thing.name in ("", ROOM) else False
    known = values_of(thing, name)
    if value in known or (not name and value in thing.called):
        return True
    return False if known and name else None


def _is_called(thing: Thing, words: str) -> bool:
    wanted = set(words.split()) - {"the", "a", "an"}
    own = synonyms(thing.label) | values_of(thing, "") | thing.called
    return bool(wanted & (synonyms(thing.label) | {thing.name})) and wanted <= own
