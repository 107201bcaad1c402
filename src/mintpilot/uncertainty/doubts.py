"""What pictures leave open of the things themselves: is that a person, and which of them, if any, is meant?"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from mintpilot.core.gap import ABSENT, PRESENT, GapKind, KnowledgeGap, presence_id
from mintpilot.core.observation import OBJECT, PERSON, chance_of
from mintpilot.core.semantic_map import MapObject
from mintpilot.uncertainty.things import Thing, stands_for

DOUBTFUL = (0.25, 0.9)
"""Between these probabilities it is asked whether a thing is a person."""
NOT_SEEN = 0.1
"""Probability, before anything is known of a place, that what is sought in it was not seen yet."""
SURE_NAME = 0.95
"""A single thing whose name is at least so likely is what a phrase means; one of a weaker name is asked about."""
UNNAMED = 0.03
"""Probability of any one name for a thing that nobody could name."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Referents:
    """P(g | I, V): what a phrase may mean among the things that were seen."""

    things: tuple[tuple[str, float], ...]
    """Id and probability, likeliest first."""
    none_of_them: float
    """That it means none of the things that were seen, although it is in view."""
    not_yet_seen: float
    """That it was not in any picture."""


def is_doubtful_person(thing: MapObject | Thing) -> bool:
    """Whether it is to be asked if a thing is a person."""
    return DOUBTFUL[0] <= chance_of(thing.names, PERSON) < DOUBTFUL[1]


def doubtful_people(objects: Sequence[MapObject]) -> list[KnowledgeGap]:
    """One gap for each thing that may be a person: a doubtful person is asked about, never left out in silence."""
    gaps = []
    for thing in sorted(objects, key=lambda o: o.id):
        chance = chance_of(thing.names, PERSON)
        if is_doubtful_person(thing):
            gaps.append(
                KnowledgeGap(
                    id=presence_id(thing.id),
                    kind=GapKind.PRESENCE,
                    subject=thing.id,
                    description=said_of(thing),
                    values=(PRESENT, ABSENT),
                    prior=(chance, 1.0 - chance),
                    position_m=thing.position_m,
                    is_thing=True,
                )
            )
    return gaps


def said_of(thing: MapObject) -> str:
    """A thing by what can be said of it: ``the red box on the table``, ``the knee-high grey thing on the floor``."""
    words = {a.name: a.value for a in thing.attributes}
    noun = "thing" if thing.label in (OBJECT, PERSON) and thing.names else thing.label
    parts = [
        "the",
        words.get("height", "") if noun == "thing" else "",
        words.get("colour", ""),
        noun,
        words.get("place", ""),
    ]
    return " ".join(part for part in parts if part)


def referents(label: str, fitting: Sequence[MapObject | Thing], *, unseen: float = NOT_SEEN) -> Referents:
    """What a phrase may mean, by how sure the names of the things are.

    Each thing is what the phrase says with the probability of its name, and of those that are, each is as likely meant:
    two things that are surely boxes stay a question. A thing without doubt about its name counts fully, one that nobody
    could name a little.

    Args:
        label: the noun of the phrase.
        fitting: things whose known attributes do not speak against the phrase.
        unseen: probability that it was in no picture.
    """
    chances = {o.id: p for o in fitting if (p := min(0.999, _chance(label, o))) > 0.005}
    none = (1.0 - unseen) * math.prod(1.0 - p for p in chances.values())
    share = (1.0 - unseen - none) / max(math.fsum(chances.values()), 1e-12)
    named = sorted(((i, p * share) for i, p in chances.items()), key=lambda pair: (-pair[1], pair[0]))
    return Referents(things=tuple(named), none_of_them=none, not_yet_seen=unseen)


def _chance(label: str, thing: MapObject | Thing) -> float:
    if not thing.names:
        if thing.label == OBJECT:
            return UNNAMED
        return 1.0 if stands_for(thing.label, label) else 0.0
    said = [g.probability for g in thing.names if stands_for(g.label, label)]
    rest = 1.0 - math.fsum(g.probability for g in thing.names)
    return math.fsum(said) if said else UNNAMED * max(0.0, rest)
