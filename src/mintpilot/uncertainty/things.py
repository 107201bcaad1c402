"""Things that a phrase may mean: objects and rooms of the map in one form, and the words for them."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

from mintpilot.core.geometry import Vec3
from mintpilot.core.observation import Attribute, NameGuess
from mintpilot.core.semantic_map import Room, SemanticMap

ROOM = "room"
_ROOM_DEPTH_M = 5.0

_ALIKE = (
    ("box", "package", "parcel", "container", "carton", "crate", "case", "bin"),
    ("person", "victim", "casualty", "survivor", "patient", "human", "man", "woman", "worker"),
    ("barrel", "drum", "cask"),
    ("rack", "shelf", "shelving", "shelves"),
    (ROOM, "closed room", "chamber"),
    ("door", "gate", "doorway"),
    ("fire", "flame", "flames", "blaze"),
    ("pillar", "column", "post"),
)
_AFTER_NOUN = frozenset({"with", "next", "near", "on", "at", "in", "by", "behind", "beside", "of", "to", "from"})
_NAMES = {"color": "colour", "hair color": "hair colour", "eye color": "eye colour"}
_VALUES = {
    "gray": "grey", "big": "large", "huge": "large", "little": "small", "tiny": "small", "round": "spherical",
    "cylinder": "cylindrical", "sphere": "spherical", "cube": "cubic",
}  # fmt: skip


@dataclass(frozen=True, slots=True, kw_only=True)
class Thing:
    """Something in the world that a phrase of the instruction may mean."""

    id: str
    label: str
    attributes: tuple[Attribute, ...]
    position_m: Vec3
    """Its centre."""
    size_m: Vec3
    goal_m: Vec3
    """Where the drone goes for it: its centre, or for a room the viewpoint in front of its door."""
    description: str = ""
    """Given by the map, for rooms; empty: made from the attributes."""
    called: frozenset[str] = frozenset()
    """For rooms: the words of their description, e.g. ``closed kitchen``."""
    name: str = ""
    """For rooms: the noun that their description calls them by: ``kitchen``, or only ``room``."""
    names: tuple[NameGuess, ...] = ()
    """What it may be, where that is not sure; what is missing to 1 is for none of them."""
    searched: bool = False
    """For rooms: already looked into."""
    behind_door: bool = False
    """For objects: seen inside a room when the drone looked in; the drone cannot get there."""


def name_of(attribute: Attribute) -> str:
    """The attribute's name in the one spelling used for comparing: lower case, British, no underscores."""
    name = attribute.name.lower().replace("_", " ").strip()
    return _NAMES.get(name, name)


def value_of(attribute: Attribute) -> str:
    """The attribute's value in the one spelling used for comparing."""
    value = attribute.value.lower().replace("_", " ").strip()
    return _VALUES.get(value, value)


def values_of(thing: Thing, name: str) -> frozenset[str]:
    """All values that the thing has for the attribute; with an empty name, the values of all its attributes."""
    return frozenset(value_of(a) for a in thing.attributes if not name or name_of(a) == name)


def synonyms(label: str) -> frozenset[str]:
    """Labels that may stand for the same class as ``label``, itself included."""
    word = label.lower().replace("_", " ").strip()
    return frozenset(x for group in _ALIKE if word in group for x in group) | {word}


def stands_for(name: str, label: str) -> bool:
    """Whether a thing of that name is one of the label: a ``medicine box`` is a ``box``, and so is a ``crate``."""
    alike = synonyms(label)
    word = name.lower().replace("_", " ").strip()
    return bool(synonyms(word) & alike) or any(word.endswith(f" {other}") for other in alike)


def things_of(map: SemanticMap) -> tuple[Thing, ...]:
    """Objects and rooms of the map, sorted by id, so that their order in the map never matters."""
    objects = (
        Thing(
            id=o.id,
            label=o.label,
            attributes=o.attributes,
            position_m=o.position_m,
            size_m=o.box_m.size_m,
            goal_m=o.position_m,
            names=o.names,
            behind_door=any(room.searched and is_inside(o.position_m, room) for room in map.rooms),
        )
        for o in map.objects
    )
    rooms = (
        Thing(
            id=r.id,
            label=ROOM,
            attributes=(),
            position_m=r.door_m.centre_m,
            size_m=r.door_m.size_m,
            goal_m=r.viewpoint_m,
            description=r.description,
            called=frozenset(r.description.lower().split()),
            name=_name(r.description),
            searched=r.searched,
        )
        for r in map.rooms
    )
    return tuple(sorted((*objects, *rooms), key=lambda thing: thing.id))


def _name(description: str) -> str:
    """The noun of a description: the last word before ``with``, ``next to`` and the like."""
    words = description.lower().split()
    end = next((i for i, word in enumerate(words) if i and word in _AFTER_NOUN), len(words))
    return words[end - 1] if words else ROOM


def is_inside(position_m: Vec3, room: Room) -> bool:
    """Whether it lies beyond the door, as seen from where the drone looks in."""
    (door_x, door_y, _), (view_x, view_y, _) = room.door_m.centre_m, room.viewpoint_m
    ahead, beyond = (door_x - view_x, door_y - view_y), (position_m[0] - door_x, position_m[1] - door_y)
    along = ahead[0] * beyond[0] + ahead[1] * beyond[1]
    deep_m = math.hypot(*beyond)
    return deep_m <= _ROOM_DEPTH_M and along > 0.5 * deep_m * math.hypot(*ahead)


def middle_m(points_m: Iterable[Vec3]) -> Vec3:
    """Mean of one or more points."""
    xs, ys, zs = zip(*points_m, strict=True)
    return (math.fsum(xs) / len(xs), math.fsum(ys) / len(ys), math.fsum(zs) / len(zs))


def nearest_first(things: Iterable[Thing], start_m: Vec3) -> tuple[Thing, ...]:
    """A short way round: always the nearest thing that is left, from ``start_m`` on; ties by id."""
    left, here, way = list(things), start_m, []
    while left:
        nearest = min(left, key=lambda thing: (math.dist(here, thing.goal_m), thing.id))
        left.remove(nearest)
        way.append(nearest)
        here = nearest.goal_m
    return tuple(way)
