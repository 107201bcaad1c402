"""Maps as differences: every map comes back to the last bit, small changes are small, changed lines are found."""

from __future__ import annotations

import copy
import dataclasses
import json

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from mintpilot.core.errors import RecordError
from mintpilot.core.geometry import GridFrame
from mintpilot.core.semantic_map import Cell, Knowledge, SemanticMap
from mintpilot.recording.codec import Codec
from mintpilot.recording.map_deltas import MapDeltas, map_digest

from .conftest import hall
from .values import differences, maps

FRAME = GridFrame(origin_m=(0.0, 0.0, 0.0), resolution_m=0.5, shape=(2, 3, 4))


def codec() -> Codec:
    return Codec({SemanticMap: MapDeltas().type_codec()})


def copied(document):
    return json.loads(json.dumps(document))


@pytest.mark.long
@settings(max_examples=40, deadline=None, suppress_health_check=list(HealthCheck))
@given(st.lists(maps(FRAME) | maps(), min_size=1, max_size=3), st.data())
def test_every_map_of_a_row_comes_back_to_the_last_bit(row, data):
    row = [data.draw(st.sampled_from(row)) for _ in range(len(row) + 2)]
    writer, reader = codec(), codec()
    for value in row:
        assert differences(value, reader.decode(SemanticMap, copied(writer.encode(value)))) == []


def test_what_changed_alone_is_written():
    before = hall()
    cells = before.cells.copy()
    cells[3, 10, 10:20] = Cell.OCCUPIED
    smoke = dataclasses.replace(before.regions[0], cells=before.regions[0].cells[:-3])
    box = dataclasses.replace(before.objects[0], score=0.25)
    after = dataclasses.replace(before, cells=cells, regions=(smoke,), objects=(*before.objects[1:], box))
    writer = codec()
    writer.encode(before)
    delta = copied(writer.encode(after))["delta"]
    assert len(json.dumps(delta)) < 600
    assert set(delta) == {"cells", "objects", "regions"}
    assert delta["objects"] == {"set": [{"id": "box-1", "score": 0.25}], "order": ["box-2", "box-3", "box-1"]}
    assert delta["regions"]["set"] == [
        {"id": "smoke-1", "cells_removed": {"int64": before.regions[0].cells[-3:].tolist()}}
    ]
    assert copied(writer.encode(after))["delta"] == {}


def test_a_forgotten_map_is_followed_by_a_whole_one():
    deltas = MapDeltas()
    writer = Codec({SemanticMap: deltas.type_codec()})
    writer.encode(hall())
    deltas.forget()
    assert "whole" in copied(writer.encode(hall(Knowledge.NO)))


def test_the_digest_tells_maps_apart():
    one = hall()
    moved = dataclasses.replace(one.regions[0], cells=one.regions[0].cells + 1)
    others = [
        dataclasses.replace(one, cells=np.where(one.cells == Cell.UNKNOWN, np.uint8(1), one.cells)),
        dataclasses.replace(one, frame=dataclasses.replace(one.frame, origin_m=(0.0, 0.0, 0.1))),
        dataclasses.replace(one, objects=one.objects[::-1]),
        dataclasses.replace(one, regions=(moved,)),
        hall(Knowledge.YES),
        one.with_room("room-1", searched=True),
    ]
    assert len({map_digest(m) for m in (one, *others)}) == 7
    assert map_digest(hall()) == map_digest(one)


def _set(document, value, *path):
    document = copy.deepcopy(document)
    inner = document
    for step in path[:-1]:
        inner = inner[step]
    inner[path[-1]] = value
    return document


def test_changed_differences_are_refused():
    before = hall()
    cells = before.cells.copy()
    cells[3, 10, 10:20] = Cell.OCCUPIED
    after = dataclasses.replace(before, cells=cells, objects=before.objects[:1])
    writer = codec()
    first, second = copied(writer.encode(before)), copied(writer.encode(after))
    assert second["delta"]["objects"] == {"removed": ["box-2", "box-3"]}
    wrong = {
        "digest is": [
            _set(second, {"uint8": [1] * 10}, "delta", "cells", "to"),
            _set(second, {}, "delta", "objects"),
            _set(second, "0" * 32, "digest"),
        ],
        "outside the lattice": [_set(second, {"int64": [10**9] * 10}, "delta", "cells", "at")],
        "whole numbers": [_set(second, {"float64": [1.0] * 10}, "delta", "cells", "at")],
        "was not there": [_set(second, ["box-9"], "delta", "objects", "removed")],
        "needs the field": [_set(second, {"set": [{"id": "box-9"}]}, "delta", "objects")],
        "names everything once": [_set(second, {"order": ["box-1"] * 3}, "delta", "objects")],
        "under 'whole' or 'delta'": [{"delta": {}}, [], _set(second, {}, "whole")],
        "has the fields": [_set(second, {}, "delta", "people")],
    }
    for message, documents in wrong.items():
        for document in documents:
            reader = codec()
            reader.decode(SemanticMap, first)
            with pytest.raises(RecordError, match=message):
                reader.decode(SemanticMap, document)
    with pytest.raises(RecordError, match="not in the record"):
        codec().decode(SemanticMap, second)
