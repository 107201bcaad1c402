"""One event as one line of JSON: what is written while the mission runs."""

from __future__ import annotations

import dataclasses
import json
import math
from collections.abc import Mapping
from enum import Enum
from functools import singledispatch
from pathlib import Path

import numpy as np
from pydantic import JsonValue

from mintpilot.core.errors import RecordError
from mintpilot.core.events import Event, Stepped
from mintpilot.core.gap import Assumptions, Belief, Joint
from mintpilot.core.observation import Detection, Frame
from mintpilot.core.plan import PlanningProblem
from mintpilot.core.semantic_map import Cell, Region, SemanticMap
from mintpilot.core.tree import Mint
from mintpilot.recording.tree_data import class_records, tree_record

MAX_ROWS = 500
"""Rows kept of a long array: evenly spaced ones, first and last included."""


def event_line(event: Event, *, number: int, at_s: float) -> bytes:
    """The event as one line that ends with a line feed.

    Pictures, voxels and the cells of regions are described, not held; long paths are thinned to `MAX_ROWS` rows.

    Args:
        event: what happened.
        number: its place in the file, from 0.
        at_s: when it was recorded, seconds since 1970.
    """
    body = {"event": type(event).__name__, "number": number, "at_s": round(at_s, 3), **_body(event)}
    line = json.dumps(body, ensure_ascii=False, allow_nan=False, separators=(",", ":"))
    return line.encode("utf-8", "replace") + b"\n"


def _body(event: Event) -> dict[str, JsonValue]:
    body = _json(event)
    return body if isinstance(body, dict) else {}


def read_events(path: Path) -> tuple[Mapping[str, JsonValue], ...]:
    """The events of a run folder (or of an events file), also of a mission still running or killed.

    Lines that were not written to their end (the last one after a kill, any one after a full disk) are left out;
    a gap in the events' ``number`` shows where.

    Raises:
        RecordError: the file cannot be read, or holds no event at all though it is not empty.
    """
    file = path / "events.ndjson" if path.is_dir() else path
    try:
        lines = file.read_bytes().splitlines()
    except OSError as error:
        raise RecordError(
            f"cannot read the events {file}: {error.strerror}; give the run folder of a mission"
        ) from error
    events = [event for line in lines if (event := _event(line)) is not None]
    if lines and not events:
        raise RecordError(f"{file} holds no event in any of its {len(lines)} lines: give the run folder of a mission")
    return tuple(events)


def _event(line: bytes) -> Mapping[str, JsonValue] | None:
    try:
        data = json.loads(line)
    except ValueError:
        return None
    return data if isinstance(data, dict) and "event" in data else None


@singledispatch
def _json(value: object) -> JsonValue:
    if dataclasses.is_dataclass(value):
        return _fields(value)
    if isinstance(value, Mapping):
        return {str(key): _json(item) for key, item in value.items()}
    if isinstance(value, frozenset | set):
        return [_json(item) for item in sorted(value)]
    if isinstance(value, tuple | list):
        return [_json(item) for item in value]
    if isinstance(value, np.generic):
        return _json(value.item())
    return str(value)


def _fields(value: object) -> dict[str, JsonValue]:
    return {f.name: _json(getattr(value, f.name)) for f in dataclasses.fields(value)}  # type: ignore[arg-type]


@_json.register
def _none(value: None) -> JsonValue:
    return value


@_json.register(bool)
@_json.register(int)
@_json.register(str)
def _as_is(value: int | str) -> JsonValue:
    return value


@_json.register
def _enum(value: Enum) -> JsonValue:
    return _json(value.value)


@_json.register
def _float(value: float) -> JsonValue:
    return round(value, 6) if math.isfinite(value) else None


@_json.register
def _array(value: np.ndarray) -> JsonValue:
    if value.dtype == bool:
        return int(value.sum())
    rows = value
    if value.ndim and len(value) > MAX_ROWS:
        rows = value[np.linspace(0, len(value) - 1, MAX_ROWS).astype(int)]
    return _json(np.round(rows, 4).tolist())


@_json.register
def _stepped(value: Stepped) -> JsonValue:
    return {"input": type(value.input).__name__, "directives": list(value.directives), "digest": value.digest}


@_json.register
def _frame(value: Frame) -> JsonValue:
    pose = _json(value.world_from_camera)
    return {"time_s": _json(value.time_s), "size": [value.camera.width, value.camera.height], "world_from_camera": pose}


@_json.register
def _detection(value: Detection) -> JsonValue:
    body = _fields(value)
    body["points_m"] = 0 if value.points_m is None else len(value.points_m)
    return body


@_json.register
def _region(value: Region) -> JsonValue:
    return {**_fields(value), "cells": int(value.cells.size)}


@_json.register
def _map(value: SemanticMap) -> JsonValue:
    counts = np.bincount(value.cells.ravel(), minlength=len(Cell))
    cells: dict[str, JsonValue] = {state.name.lower(): int(counts[state]) for state in Cell}
    return {**_fields_but(value, "cells"), "cells": cells}


@_json.register
def _problem(value: PlanningProblem) -> JsonValue:
    return _fields_but(value, "map", "gaps")


@_json.register
def _belief(value: Belief | Joint) -> JsonValue:
    return {gap.id: _json(value.marginal(gap.id)) for gap in value.gaps}


@_json.register
def _assumptions(value: Assumptions) -> JsonValue:
    return {gap_id: _json(values) for gap_id, values in value.items}


@_json.register
def _mint(value: Mint) -> JsonValue:
    return {
        "nodes": value.nodes,
        "not_expanded": value.not_expanded,
        "belief": _json(value.belief),
        "classes": [c.model_dump(mode="json") for c in class_records(value)],
        "tree": tree_record(value).model_dump(mode="json"),
    }


def _fields_but(value: object, *left_out: str) -> dict[str, JsonValue]:
    names = [f.name for f in dataclasses.fields(value) if f.name not in left_out]  # type: ignore[arg-type]
    return {name: _json(getattr(value, name)) for name in names}
