"""The report on what was seen, as it is printed and kept."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from pydantic import BaseModel, ConfigDict

from mintpilot.core.gap import KnowledgeGap
from mintpilot.core.semantic_map import MapObject, Region, Room, SemanticMap

SCHEMA_VERSION = 1


class _Report(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid", defer_build=True)


class ObjectSeen(_Report):
    """A thing."""

    id: str
    label: str
    """What it is; `object` where nobody could tell."""
    confidence: float
    """That it is what the label says; for an `object`, that there is one thing there."""
    attributes: dict[str, list[str]]
    """What can be said of it."""
    position_m: tuple[float, float, float]
    """Its centre."""
    size_m: tuple[float, float, float]
    frames: int
    """In how many frames it was seen."""
    names: dict[str, float]
    """What it may be; what is missing to 1 is for none of these."""
    best_view: dict[str, int | list[int]] | None
    """Frame, and pixels there: left, top, right, bottom."""


class RegionSeen(_Report):
    """A volume of which a camera cannot tell whether it may be entered."""

    id: str
    kind: str
    description: str
    position_m: tuple[float, float, float]
    size_m: tuple[float, float, float]


class RoomSeen(_Report):
    """A closed room."""

    id: str
    description: str
    door_m: tuple[float, float, float]
    viewpoint_m: tuple[float, float, float]


class GapSeen(_Report):
    """What is not known."""

    id: str
    kind: str
    subject: str
    description: str
    values: dict[str, float]
    """Each possible value with its probability."""
    candidates: dict[str, str] = {}
    """For a phrase: what each value looks like."""
    question: str = ""
    """How it could be asked."""


class SeenReport(_Report):
    """What was seen, and what was not understood of it."""

    schema_version: int = SCHEMA_VERSION
    source: str
    frames: int
    instruction: str | None
    world_from_source: list[list[float]]
    """How the source's world was moved: 4 x 4, row by row."""
    floor_m: float
    objects: list[ObjectSeen]
    regions: list[RegionSeen]
    rooms: list[RoomSeen]
    gaps: list[GapSeen]
    warnings: list[str]


def report_of(
    *,
    name: str,
    frames: int,
    instruction: str | None,
    world_from_source: list[list[float]],
    floor_m: float,
    map: SemanticMap,
    gaps: Sequence[GapSeen],
    warnings: Sequence[str],
) -> SeenReport:
    """The report on a map and what is not known of it."""
    return SeenReport(
        source=name,
        frames=frames,
        instruction=instruction,
        world_from_source=world_from_source,
        floor_m=floor_m,
        objects=[object_seen(o) for o in map.objects],
        regions=[_region(r, map) for r in map.regions],
        rooms=[_room(r) for r in map.rooms],
        gaps=list(gaps),
        warnings=list(warnings),
    )


def object_seen(thing: MapObject) -> ObjectSeen:
    """One thing."""
    names = {g.label: round(g.probability, 4) for g in thing.names}
    attributes: dict[str, list[str]] = {}
    for attribute in thing.attributes:
        attributes.setdefault(attribute.name, []).append(attribute.value)
    view = thing.best_view
    return ObjectSeen(
        id=thing.id,
        label=thing.label,
        confidence=round(min(1.0, names.get(thing.label, thing.score)), 4),
        attributes=attributes,
        position_m=thing.position_m,
        size_m=thing.box_m.size_m,
        frames=thing.sightings,
        names=names,
        best_view=None if view is None else {"frame": view[0], "pixels": list(view[1:])},
    )


def gap_seen(gap: KnowledgeGap, question: str = "") -> GapSeen:
    """One gap."""
    return GapSeen(
        id=gap.id,
        kind=str(gap.kind),
        subject=gap.subject,
        description=gap.description,
        values=dict(zip(gap.values, gap.prior, strict=True)),
        question=question,
    )


def _region(region: Region, map: SemanticMap) -> RegionSeen:
    z, y, x = np.unravel_index(region.cells, map.frame.shape)
    r, origin = map.frame.resolution_m, map.frame.origin_m
    lo = tuple(o + r * float(a.min()) for o, a in zip(origin, (x, y, z), strict=True))
    hi = tuple(o + r * float(a.max() + 1) for o, a in zip(origin, (x, y, z), strict=True))
    return RegionSeen(
        id=region.id,
        kind=str(region.kind),
        description=region.description,
        position_m=((lo[0] + hi[0]) / 2, (lo[1] + hi[1]) / 2, (lo[2] + hi[2]) / 2),
        size_m=(hi[0] - lo[0], hi[1] - lo[1], hi[2] - lo[2]),
    )


def _room(room: Room) -> RoomSeen:
    return RoomSeen(id=room.id, description=room.description, door_m=room.door_m.centre_m, viewpoint_m=room.viewpoint_m)
