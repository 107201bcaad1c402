"""What became of the objects, regions or rooms of a map, told by their ids.

``set`` holds those that are new, with all their fields, and those that changed, with the fields that did; the cells of
a region are told by those that were added and removed. ``removed`` holds ids, ``order`` all ids where those that stay
followed by those that are new is not the order.
"""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Mapping, Sequence
from typing import TypeAlias

import numpy as np
from pydantic import JsonValue

from mintpilot.core.geometry import GridFrame, Ints
from mintpilot.core.semantic_map import MapObject, Region, Room
from mintpilot.recording.codec import Codec
from mintpilot.recording.codec_arrays import decode_array, encode_array
from mintpilot.recording.codec_parts import Budget, CodecError, decode_text, encode_text, shown

Thing: TypeAlias = MapObject | Region | Room
Fields: TypeAlias = dict[str, JsonValue]
_NO_CELLS = np.zeros(0, np.int64)
_PLAIN = Codec()


def fields_of(thing: GridFrame | Thing) -> Fields:
    """All fields of a thing in the map; for a region without its cells."""
    plain = dataclasses.replace(thing, cells=_NO_CELLS) if isinstance(thing, Region) else thing
    document = _PLAIN.type_codec(type(thing)).encode(plain)
    assert isinstance(document, dict)
    document.pop("cells", None)
    return document


def distinct(things: Sequence[Thing]) -> bool:
    """Whether ids tell them apart."""
    return len({thing.id for thing in things}) == len(things)


def difference(before: Sequence[Thing], after: Sequence[Thing]) -> Fields:
    """What must be known to make the one of the other; empty where they are the same."""
    old = {thing.id: thing for thing in before}
    names = [thing.id for thing in after]
    changed: list[JsonValue] = []
    for thing in after:
        known = old.get(thing.id)
        if thing is not known and (fields := _changes(known, thing)):
            changed.append(fields)
    gone = [name for name in old if name not in set(names)]
    natural = [name for name in old if name not in gone] + [name for name in names if name not in old]
    document: Fields = {}
    if changed:
        document["set"] = changed
    if gone:
        document["removed"] = [encode_text(name) for name in gone]
    if names != natural:
        document["order"] = [encode_text(name) for name in names]
    return document


def applied(kind: type[Thing], before: Sequence[Thing], document: JsonValue, budget: Budget) -> tuple[Thing, ...]:
    """What the things became. Raises `CodecError` where the document does not tell it.

    Args:
        kind: their class.
        before: the things.
        document: what `difference` gave; it may be hostile.
        budget: memory that may be taken.
    """
    if not isinstance(document, dict) or not document.keys() <= {"set", "removed", "order"}:
        raise CodecError("what became of things is told by 'set', 'removed' and 'order'")
    things = {thing.id: thing for thing in before}
    for name in _names(document.get("removed")):
        if things.pop(name, None) is None:
            raise CodecError(f"{shown(name)} was removed, but was not there")
    for fields in _listed(document.get("set")):
        thing = _changed(kind, things, fields, budget)
        things[thing.id] = thing
    if "order" not in document:
        return tuple(things.values())
    names = _names(document["order"])
    if sorted(names) != sorted(things):
        raise CodecError("the order names everything once")
    return tuple(things[name] for name in names)


def _changes(old: Thing | None, new: Thing) -> Fields:
    """The id and the fields that differ; all of them where it is new; nothing where none does."""
    fields = fields_of(new)
    known = {} if old is None else fields_of(old)
    document = {name: item for name, item in fields.items() if name not in known or _text(known[name]) != _text(item)}
    if isinstance(new, Region):
        document |= _cell_changes(old.cells if isinstance(old, Region) else None, new.cells)
    return {"id": fields["id"], **document} if document else {}


def _text(document: JsonValue) -> str:
    """Tells 1 from 1.0 and from true, and 0.0 from -0.0, which are equal as values."""
    return json.dumps(document)


def _cell_changes(old: Ints | None, new: Ints) -> Fields:
    if old is None or not (_ascending(old) and _ascending(new)):
        same = old is not None and old.dtype == new.dtype and np.array_equal(old, new)
        return {} if same else {"cells": encode_array(new)}
    pairs = {
        "cells_added": np.setdiff1d(new, old, assume_unique=True),
        "cells_removed": np.setdiff1d(old, new, assume_unique=True),
    }
    return {name: encode_array(cells) for name, cells in pairs.items() if cells.size}


def _ascending(cells: Ints) -> bool:
    return cells.dtype == np.int64 and cells.ndim == 1 and bool((cells[1:] > cells[:-1]).all())


def _changed(kind: type[Thing], things: Mapping[str, Thing], document: JsonValue, budget: Budget) -> Thing:
    if not isinstance(document, dict) or "id" not in document:
        raise CodecError("a thing in the map has an id")
    old = things.get(decode_text(document["id"]))
    fields: Fields = {**({} if old is None else fields_of(old)), **document}
    cells = _NO_CELLS
    if kind is Region:
        cells = _cells_after(old.cells if isinstance(old, Region) else _NO_CELLS, fields, budget)
        fields["cells"] = encode_array(_NO_CELLS)
    thing = _PLAIN.type_codec(kind).decode(fields, budget)
    if isinstance(thing, Region):
        return dataclasses.replace(thing, cells=cells)
    assert isinstance(thing, MapObject | Room)
    return thing


def _cells_after(old: Ints, fields: Fields, budget: Budget) -> Ints:
    """Takes the cells out of the fields and applies them."""
    whole, added, removed = (fields.pop(name, None) for name in ("cells", "cells_added", "cells_removed"))
    if whole is not None:
        cells = decode_array(whole, budget)
        if not isinstance(cells, np.ndarray):
            raise CodecError("the cells of a region are an array")
        return cells  # type: ignore[return-value]  # of the type it was recorded with
    budget.take(old.nbytes)
    kept: Ints = old if removed is None else np.setdiff1d(old, indices(removed, budget), assume_unique=True)
    if added is None:
        return kept
    joined: Ints = np.union1d(kept, indices(added, budget))
    return joined


def indices(document: JsonValue, budget: Budget) -> Ints:
    """Flat indices of cells (n,). Raises `CodecError` for anything else."""
    cells = decode_array(document, budget)
    if not isinstance(cells, np.ndarray) or cells.dtype != np.int64 or cells.ndim != 1:
        raise CodecError("cells are told by whole numbers (int64) in a row")
    return cells  # type: ignore[return-value]  # checked above


def _names(document: JsonValue) -> list[str]:
    return [decode_text(name) for name in _listed(document)]


def _listed(document: JsonValue) -> list[JsonValue]:
    if document is None:
        return []
    if not isinstance(document, list):
        raise CodecError("a list is expected")
    return document
