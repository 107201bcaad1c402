"""The semantic map from above, as one small grey picture and a list of what stands in it."""

from __future__ import annotations

import io
from collections.abc import Mapping
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from mintpilot.console.protocol import MapPane, RegionPane, Thing
from mintpilot.core.geometry import Bools, Box
from mintpilot.core.semantic_map import Cell, Knowledge, MapObject, Region, Room, SemanticMap
from mintpilot.wording.speech import IN_ENGLISH, Speech

_UNKNOWN, _FREE, _OCCUPIED, _FIRST_REGION = 0, 1, 2, 3
_MOST_REGIONS = 200
_MOST_THINGS = 200
_STRUCTURE = {"wall", "partition", "pillar", "floor", "ceiling"}
"""Classes that are part of the building: their voxels show them."""
_BAND_M = (0.6, 0.6)
"""Below and above the height of flight: what stands there is drawn as a wall, metres."""


def map_pane(
    map: SemanticMap, height_m: float, speech: Speech = IN_ENGLISH, called: Mapping[str, str] = MappingProxyType({})
) -> tuple[MapPane, bytes]:
    """The map seen from above, and its picture as PNG.

    Args:
        map: as the drone believes it to be.
        height_m: at which the drone flies; obstacles near that height are drawn.
        speech: in which regions and rooms are named.
        called: what questions call them, by id; others are called as the map does.
    """
    box = map.frame.box
    regions = map.regions[:_MOST_REGIONS]
    pane = MapPane(
        box=(box.lo_m[0], box.lo_m[1], box.hi_m[0], box.hi_m[1]),
        things=(*_rooms(map.rooms, speech, called), *_objects(map.objects)),
        regions=tuple(_region(map, region, speech, called) for region in regions),
    )
    return pane, _png(columns(map, height_m))


def columns(map: SemanticMap, height_m: float) -> NDArray[np.uint8]:
    """One value for each column of voxels (ny, nx), south first: 0 unknown, 1 free, 2 occupied, 3 + i region i."""
    nz = map.frame.shape[0]
    heights_m = map.frame.origin_m[2] + (np.arange(nz) + 0.5) * map.frame.resolution_m
    band = (heights_m >= height_m - _BAND_M[0]) & (heights_m <= height_m + _BAND_M[1])
    layers = map.cells[band] if band.any() else map.cells
    seen = np.where((layers == Cell.FREE).any(axis=0), _FREE, _UNKNOWN).astype(np.uint8)
    seen[(layers == Cell.OCCUPIED).any(axis=0)] = _OCCUPIED
    for number, region in enumerate(map.regions[:_MOST_REGIONS]):
        inside = _from_above(map, region)
        seen[inside & (seen != _OCCUPIED)] = _FIRST_REGION + number
    return seen


def _from_above(map: SemanticMap, region: Region) -> Bools:
    _, ny, nx = map.frame.shape
    inside = np.zeros(ny * nx, bool)
    inside[region.cells % (ny * nx)] = True
    return inside.reshape(ny, nx)


def _region(map: SemanticMap, region: Region, speech: Speech, called: Mapping[str, str]) -> RegionPane:
    y, x = np.nonzero(_from_above(map, region))
    middle = (0.0, float(y.mean()) if y.size else 0.0, float(x.mean()) if x.size else 0.0)
    centre = map.frame.centres_of([middle])[0]
    return RegionPane(
        id=region.id,
        words=speech.thing(called.get(region.id) or region.description) or region.id,
        passable=region.passable.value,
        centre=(round(float(centre[0]), 2), round(float(centre[1]), 2)),
    )


def _rooms(rooms: tuple[Room, ...], speech: Speech, called: Mapping[str, str]) -> tuple[Thing, ...]:
    return tuple(
        Thing(
            id=room.id,
            label="room",
            words=speech.thing(called.get(room.id) or room.description) or room.id,
            box=_flat(room.door_m),
            state="searched"
            if room.searched
            else room.occupied.value
            if room.occupied is not Knowledge.OPEN
            else "open",
        )
        for room in rooms
    )


def _objects(objects: tuple[MapObject, ...]) -> tuple[Thing, ...]:
    shown = [o for o in objects if o.label not in _STRUCTURE]
    return tuple(Thing(id=o.id, label=o.label, words=_words(o), box=_flat(o.box_m)) for o in shown[:_MOST_THINGS])


def _words(one: MapObject) -> str:
    said = [a.value for a in one.attributes if a.name in ("size", "colour")]
    return " ".join([*sorted(set(said)), one.label])


def _flat(box: Box) -> tuple[float, float, float, float]:
    left, bottom, right, top = (*box.lo_m[:2], *box.hi_m[:2])
    return (round(left, 2), round(bottom, 2), round(right, 2), round(top, 2))


def _png(values: NDArray[np.uint8]) -> bytes:
    from PIL import Image

    out = io.BytesIO()
    Image.fromarray(values[::-1]).save(out, "PNG")
    return out.getvalue()
