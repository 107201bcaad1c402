"""Semantic maps as differences to the map before, each with a digest of the whole.

The first map stands under ``whole``, the next ones under ``delta``: which cells changed and to what, and what became of
objects, regions and rooms (`mintpilot.recording.map_things`).
"""

from __future__ import annotations

import dataclasses
import functools
import hashlib
import json
import typing
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pydantic import JsonValue

from mintpilot.core.geometry import GridFrame
from mintpilot.core.semantic_map import MapObject, Region, Room, SemanticMap
from mintpilot.recording.codec import Codec
from mintpilot.recording.codec_arrays import decode_array, encode_array
from mintpilot.recording.codec_parts import Budget, CodecError, TypeCodec, shown
from mintpilot.recording.map_things import Fields, Thing, applied, difference, distinct, fields_of, indices

_PLAIN = Codec()
_KINDS: Mapping[str, type[Thing]] = {"objects": MapObject, "regions": Region, "rooms": Room}
_OTHERS = tuple(f.name for f in dataclasses.fields(SemanticMap) if f.name not in {"frame", "cells", *_KINDS})
"""Fields of maps that are written whole whenever they change."""


class MapDeltas:
    """Both ways for the maps of one log, in their order; writer and reader each need one of their own."""

    def __init__(self) -> None:
        self._before: SemanticMap | None = None
        self._digest = ""

    def type_codec(self) -> TypeCodec:
        """For `mintpilot.recording.codec.Codec`."""
        return TypeCodec(encode=self._encode, decode=self._decode)

    def forget(self) -> None:
        """The next map is written whole: what was encoded last did not reach the record."""
        self._before = None

    def _encode(self, value: object) -> JsonValue:
        if not isinstance(value, SemanticMap):
            raise CodecError(f"{shown(value)}: SemanticMap is expected")
        before = self._before
        if value is before:
            return {"delta": {}, "digest": self._digest}
        self._before, self._digest = value, map_digest(value)
        if before is None or not _comparable(before, value):
            return {"whole": _PLAIN.type_codec(SemanticMap).encode(value), "digest": self._digest}
        return {"delta": _delta(before, value), "digest": self._digest}

    def _decode(self, document: JsonValue, budget: Budget) -> SemanticMap:
        if not isinstance(document, dict) or document.keys() not in ({"whole", "digest"}, {"delta", "digest"}):
            raise CodecError("a map has a digest and stands under 'whole' or 'delta'")
        if "whole" in document:
            value = _PLAIN.type_codec(SemanticMap).decode(document["whole"], budget)
        elif self._before is None:
            raise CodecError("a map is told by its difference to one that is not in the record")
        else:
            value = _applied(self._before, document["delta"], budget)
        assert isinstance(value, SemanticMap)
        digest = self._digest if value is self._before else map_digest(value)
        if digest != document["digest"]:
            raise CodecError(f"the map's digest is {digest}, not {shown(document['digest'])}: it was changed")
        self._before, self._digest = value, digest
        return value


def map_digest(value: SemanticMap) -> str:
    """BLAKE2b over lattice, cells, objects, regions and rooms; equal maps have equal ones."""
    digest = hashlib.blake2b(digest_size=16)
    things: tuple[GridFrame | Thing, ...] = (value.frame, *value.objects, *value.regions, *value.rooms)
    for thing in things:
        digest.update(json.dumps(fields_of(thing)).encode() + b"\n")
    digest.update(json.dumps(_others(value)).encode())
    digest.update(_content(value.cells))
    for region in value.regions:
        digest.update(_content(region.cells))
    return digest.hexdigest()


def _content(array: NDArray[Any]) -> bytes:
    head = f"{array.dtype.name} {array.shape} ".encode()
    return head + np.ascontiguousarray(array, array.dtype.newbyteorder("<")).tobytes()


def _comparable(before: SemanticMap, after: SemanticMap) -> bool:
    """Whether the one can be told as a difference to the other."""
    plain = all(m.cells.dtype == np.uint8 and m.cells.flags.c_contiguous for m in (before, after))
    same = fields_of(before.frame) == fields_of(after.frame)
    return (
        plain
        and same
        and all(distinct(m.objects) and distinct(m.regions) and distinct(m.rooms) for m in (before, after))
    )


def _delta(before: SemanticMap, after: SemanticMap) -> Fields:
    document: Fields = {}
    if before.cells is not after.cells:
        changed = np.flatnonzero(before.cells != after.cells)
        if changed.size:
            document["cells"] = {"at": encode_array(changed), "to": encode_array(after.cells.reshape(-1)[changed])}
    for name in _KINDS:
        if change := difference(getattr(before, name), getattr(after, name)):
            document[name] = change
    old = _others(before)
    return document | {name: item for name, item in _others(after).items() if json.dumps(item) != json.dumps(old[name])}


def _others(value: SemanticMap) -> Fields:
    return {name: _PLAIN.type_codec(_hints()[name]).encode(getattr(value, name)) for name in _OTHERS}


@functools.cache
def _hints() -> Mapping[str, object]:
    return typing.get_type_hints(SemanticMap)


def _applied(before: SemanticMap, document: JsonValue, budget: Budget) -> SemanticMap:
    if document == {}:
        return before
    known = {"cells", *_KINDS, *_OTHERS}
    if not isinstance(document, dict) or not document.keys() <= known:
        raise CodecError(f"the difference of two maps has the fields {', '.join(sorted(known))}")
    changed: dict[str, Any] = {}
    for name, item in document.items():
        try:
            if name == "cells":
                changed[name] = _with_cells(before.cells, item, budget)
            elif name in _KINDS:
                changed[name] = applied(_KINDS[name], getattr(before, name), item, budget)
            else:
                changed[name] = _PLAIN.type_codec(_hints()[name]).decode(item, budget)
        except CodecError as fault:
            raise fault.under(name).under("delta") from None
    try:
        return dataclasses.replace(before, **changed)
    except Exception as error:  # whatever the map's own checks raise
        raise CodecError(f"SemanticMap refuses it: {error}") from None


def _with_cells(before: NDArray[np.uint8], document: JsonValue, budget: Budget) -> NDArray[np.uint8]:
    if not isinstance(document, dict) or document.keys() != {"at", "to"}:
        raise CodecError("changed cells are told by 'at' and 'to'")
    at, to = indices(document["at"], budget), decode_array(document["to"], budget)
    if to.dtype != np.uint8 or at.shape != to.shape:
        raise CodecError("'to' holds one state (uint8) for each cell of 'at'")
    if at.size and (at.min() < 0 or at.max() >= before.size):
        raise CodecError(f"a changed cell lies outside the lattice of {before.size}")
    budget.take(before.nbytes)
    cells = before.copy()
    cells.reshape(-1)[at] = to
    return cells
