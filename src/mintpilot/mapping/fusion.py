"""From what was gathered over frames to the nouns of the map, with stable ids and carried-over knowledge."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from mintpilot.core.geometry import Box, GridFrame, Vec3
from mintpilot.core.observation import OBJECT, Attribute, NameGuess, RegionKind
from mintpilot.core.semantic_map import Cell, Knowledge, MapObject, Region, Room, SemanticMap
from mintpilot.mapping.identity import Names, match
from mintpilot.mapping.objects import Track, closeness, same_body
from mintpilot.mapping.rooms import same_door, viewpoint_of
from mintpilot.mapping.settings import MappingSettings
from mintpilot.mapping.smoke import Cloud, cells_in
from mintpilot.mapping.wording import describe_all, place_in


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class FusionInput:
    """What the objects, regions and rooms of a map are fused with: its voxels, settings, and the map before."""

    frame: GridFrame
    cells: NDArray[np.uint8]
    """(nz, ny, nx), values of `Cell`; may still change."""
    volume: Box
    settings: MappingSettings
    names: Names
    previous: SemanticMap | None
    """What was known before."""
    hull_m: float
    """Radius and margin of the vehicle."""


def fused_objects(tracks: Sequence[Track], given: FusionInput) -> tuple[MapObject, ...]:
    """Objects seen often or surely enough, doors left out; ids from the previous map by nearness."""
    settings = given.settings
    kept = [
        t
        for t in tracks
        if (t.label != "door" or t.is_segment)
        and (_credible(t, settings) or _glimpsed(t, settings))
        and not _roofed(t, given)
    ]
    people = [t for t in kept if t.label == "person" and not _glimpsed(t, settings)]
    fires = [t for t in kept if t.label == "fire"]
    kept = [t for t in kept if not any(_limb_of(t, p) for p in people) and not any(_foot_of(t, f) for f in fires)]
    old = given.previous.objects if given.previous is not None else ()
    pairs = match([[_nearness(t, o) for o in old] for t in kept])
    for thing in old:
        given.names.seen(thing.id)
    named = [(t, old[pairs[i]].id if i in pairs else given.names.new(t.label)) for i, t in enumerate(kept)]
    objects = [_doubted(t, name, given) if _glimpsed(t, settings) else t.as_object(name) for t, name in named]
    backed = set(pairs.values())
    objects += [o for j, o in enumerate(old) if j not in backed and not _gone(o, tracks, given)]
    return tuple(sorted(objects, key=lambda o: _order(o.id)))


def fused_regions(clouds: Sequence[Cloud], given: FusionInput, prior_passable: float) -> tuple[Region, ...]:
    """One region per cloud, and every other region of the previous map unchanged.

    A cloud takes over the answer of the region that it overlaps. Where it overlaps several (two clouds turned out to be
    one), it is passable only if all of them are, and not passable as soon as one is not.
    """
    old = list(given.previous.regions) if given.previous is not None else []
    for region in old:
        given.names.seen(region.id)
    masks = [cells_in(given.frame, c.box_m) for c in clouds]
    smokes = [r for r in old if r.kind is RegionKind.SMOKE]
    shared = [[float(m.reshape(-1)[r.cells].sum()) for r in smokes] for m in masks]
    pairs = match(shared)
    descriptions = describe_all(given.volume, ["the grey smoke"] * len(clouds), [c.box_m.centre_m for c in clouds])
    solid = given.cells == Cell.OCCUPIED
    inside = cells_in(given.frame, given.volume)
    result: list[Region] = []
    for i, (cloud, mask) in enumerate(zip(clouds, masks, strict=True)):
        cells = np.flatnonzero(mask & inside & ~solid).astype(np.int64)
        if not cells.size:
            continue  # flames fill all of it: there is nothing to ask
        mine = smokes[pairs[i]] if i in pairs else None
        answers = {r.passable for r, n in zip(smokes, shared[i], strict=True) if n > 0}
        result.append(
            Region(
                id=mine.id if mine else given.names.new("smoke"),
                kind=RegionKind.SMOKE,
                cells=cells,
                passable=joint_knowledge(answers),
                prior_passable=mine.prior_passable if mine else prior_passable,
                description=descriptions[i],
                best_view=cloud.best_view or (mine.best_view if mine else None),
            )
        )
    # A region of old that no cloud touches any more is kept: nobody has said that it is gone.
    touched = {r.id for j, r in enumerate(smokes) if any(row[j] > 0 for row in shared)}
    result += [r for r in old if r.id not in touched]
    return tuple(sorted(result, key=lambda r: _order(r.id)))


def fused_rooms(tracks: Sequence[Track], given: FusionInput, prior_occupied: float) -> tuple[Room, ...]:
    """One room per closed door, with the answer and the search of the previous map; rooms of old stay."""
    sure = given.settings.sure_door
    doors = [t for t in tracks if t.label == "door" and not t.is_segment and t.score >= sure]
    old = given.previous.rooms if given.previous is not None else ()
    for room in old:
        given.names.seen(room.id)
    pairs = match([[same_door(t.box_m, r.door_m) for r in old] for t in doors])
    names = [f"the closed room with the {_colour(t)}door" for t in doors]
    descriptions = describe_all(given.volume, names, [t.box_m.centre_m for t in doors])
    result = []
    for i, door in enumerate(doors):
        mine = old[pairs[i]] if i in pairs else None
        viewpoint: Vec3 = viewpoint_of(door, given.frame, given.cells, given.hull_m, given.settings)
        room = Room(
            id=mine.id if mine else given.names.new("room"),
            door_m=door.box_m,
            viewpoint_m=viewpoint,
            prior_occupied=prior_occupied,
            description=descriptions[i],
            best_view=door.best_view,
        )
        if mine is not None:
            room = replace(room, occupied=mine.occupied, searched=mine.searched, prior_occupied=mine.prior_occupied)
        result.append(room)
    backed = set(pairs.values())
    result += [r for j, r in enumerate(old) if j not in backed]
    return tuple(sorted(result, key=lambda r: _order(r.id)))


def joint_knowledge(answers: set[Knowledge]) -> Knowledge:
    """What is known of a cloud that overlaps regions with these answers: one that is open never opens with the rest."""
    if Knowledge.NO in answers:
        return Knowledge.NO
    return Knowledge.YES if answers == {Knowledge.YES} else Knowledge.OPEN


def _order(identity: str) -> tuple[str, int]:
    kind, _, number = identity.rpartition("-")
    return (kind, int(number)) if number.isdigit() else (identity, 0)


def _colour(track: Track) -> str:
    return next((f"{a.value} " for a in track.attributes if a.name == "colour"), "")


def _credible(track: Track, settings: MappingSettings) -> bool:
    """Seen twice, or surely once; a danger counts as soon as it is seen."""
    return len(track.frames) >= 2 or track.score >= settings.sure_score or track.label == "fire"


def _glimpsed(track: Track, settings: MappingSettings) -> bool:
    """Whether it may be somebody who was seen once, and not surely: to be asked about or looked at again."""
    return track.label == "person" and not track.is_segment and not _credible(track, settings)


def _doubted(track: Track, name: str, given: FusionInput) -> MapObject:
    """Somebody glimpsed: a thing at that place, which is a person as surely as it was seen."""
    thing = track.as_object(name)
    where = Attribute(name="place", value=place_in(given.volume, thing.position_m))
    return replace(thing, attributes=(where,), names=(NameGuess(label="person", probability=track.score),))


def _limb_of(track: Track, person: Track) -> bool:
    """True for a low scrap beside somebody lying: an arm or a leg that was seen apart from the rest."""
    if (
        track.is_segment
        or track.label == "person"
        or track.box_m.hi_m[2] > 0.4
        or len(track.frames) > len(person.frames)
    ):
        return False
    a, b = track.box_m.centre_m, person.box_m.centre_m
    return float(np.hypot(a[0] - b[0], a[1] - b[1])) < 1.1


def _foot_of(track: Track, fire: Track) -> bool:
    """True for what was taken for somebody lying in the midst of flames: it is their own foot, of several colours."""
    if track.label != "person":
        return False
    (x, y, _), flames = track.box_m.centre_m, fire.box_m
    return flames.lo_m[0] <= x <= flames.hi_m[0] and flames.lo_m[1] <= y <= flames.hi_m[1]


def _roofed(track: Track, given: FusionInput) -> bool:
    """True for goods on a shelf or fragments of a rack: something solid is right above most of the thing."""
    if track.label != "box" or track.is_segment:
        return False
    box = track.box_m
    lo = (box.lo_m[0], box.lo_m[1], box.hi_m[2] + 1.5 * given.frame.resolution_m)
    above = Box(lo_m=lo, hi_m=(box.hi_m[0], box.hi_m[1], max(lo[2], box.hi_m[2] + 1.2)))
    column = cells_in(given.frame, above)
    if not column.any():
        return False
    return float((given.cells[column] == Cell.OCCUPIED).mean()) > 0.2


def _nearness(track: Track, thing: MapObject) -> float:
    """How likely a track is a thing of old, 0 or less for not at all. Bodies change their names as more is seen."""
    if track.is_segment:
        return same_body(track.box_m, thing.box_m) if thing.label == OBJECT or thing.names else 0.0
    return closeness(track.box_m, thing.box_m) if track.label == thing.label else 0.0


def _gone(thing: MapObject, tracks: Sequence[Track], given: FusionInput) -> bool:
    """True when a thing of old was absorbed by a track, or its place is now seen free."""
    if any(_nearness(t, thing) > 0 for t in tracks):
        return True
    inside = given.cells[cells_in(given.frame, thing.box_m)]
    return inside.size > 0 and float((inside == Cell.FREE).mean()) > 0.9
