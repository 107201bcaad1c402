"""Somebody who bends or crawls is seen in parts: what each of them says of a person counts for the largest."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

from mintpilot.core.observation import OBJECT, PERSON, NameGuess, chance_of
from mintpilot.core.semantic_map import MapObject

LEAST_CHANCE = 0.1
"""Of what is a person less probably than this nothing is counted."""
MOST_CHANCE = 0.49
"""Parts together make a question, never a person."""
TOUCH_M, LONGEST_M = 0.15, 2.1
"""Parts of one body are no further apart, and together no longer."""


def with_parts_counted(objects: Sequence[MapObject]) -> tuple[MapObject, ...]:
    """The objects, of which the largest of each group of possible parts of a body is a person as probably as any is."""
    parts = [o for o in objects if o.label == OBJECT and chance_of(o.names, PERSON) >= LEAST_CHANCE]
    changed: dict[str, MapObject] = {}
    left = sorted(parts, key=lambda o: (-math.prod(o.box_m.size_m), o.id))
    while left:
        group = [left.pop(0)]
        box = group[0].box_m
        for other in list(left):
            whole = box.around(other.box_m)
            if box.apart_m(other.box_m) < TOUCH_M and max(whole.size_m) <= LONGEST_M:
                group.append(other)
                left.remove(other)
                box = whole
        if len(group) > 1:
            chance = 1.0 - math.prod(1.0 - chance_of(o.names, PERSON) for o in group)
            changed[group[0].id] = _as_person(group[0], min(MOST_CHANCE, chance))
    return tuple(changed.get(o.id, o) for o in objects)


def _as_person(thing: MapObject, chance: float) -> MapObject:
    """The thing, a person that probably; what else it may be shares the rest as before."""
    share = (1.0 - chance) / max(1e-9, 1.0 - chance_of(thing.names, PERSON))
    names = [NameGuess(label=g.label, probability=g.probability * share) for g in thing.names if g.label != PERSON]
    names.append(NameGuess(label=PERSON, probability=chance))
    return replace(thing, names=tuple(sorted(names, key=lambda g: (-g.probability, g.label))))
