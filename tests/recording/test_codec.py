"""Values come back from JSON to the last bit, whatever is recorded; what has no exact form is refused by its place."""

from __future__ import annotations

import base64
import contextlib
import functools
import json
import math
import tracemalloc
import typing
import zlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import Enum, IntEnum
from typing import Annotated, Any, Literal, NewType

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from mintpilot.core.errors import RecordError
from mintpilot.core.events import Event
from mintpilot.core.gap import Belief
from mintpilot.core.geometry import Box, Floats
from mintpilot.core.plan import Plan
from mintpilot.core.semantic_map import SemanticMap
from mintpilot.core.tree import Mint
from mintpilot.recording.codec import Codec, decode, encode

from .values import any_array, differences, replaced, values

Name = NewType("Name", str)
SLOW = [HealthCheck.too_slow, HealthCheck.data_too_large, HealthCheck.filter_too_much, HealthCheck.large_base_example]


class Level(IntEnum):
    """Values that are no text."""

    LOW = 1
    HIGH = 2


class Odd(Enum):
    """Values that are neither."""

    A = (1, 2)
    B = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Small:
    """A member of a union."""

    x: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Every:
    """One field for each kind of hint."""

    level: Level
    odd: Odd
    name: Name
    mixed: int | str | float | bool | None
    member: Small | Box | tuple[int, ...]
    only: Small | None
    pair: tuple[int, str]
    nothing: tuple[()]
    many: Sequence[Small]
    table: Mapping[str, Small]
    numbered: dict[int, float]
    chosen: Literal["a", 1]
    set: frozenset[tuple[str, int]]
    noted: Annotated[float, "metres"]
    array: Floats
    more: Every | None = None


def there_and_back(value: Any, hint: Any) -> Any:
    text = json.dumps(encode(value, hint), allow_nan=False, ensure_ascii=False)
    text.encode()
    return decode(hint, json.loads(text))


@pytest.mark.long
@settings(max_examples=10, suppress_health_check=SLOW, deadline=None)
@given(st.data())
@pytest.mark.parametrize("cls", typing.get_args(Event), ids=lambda c: c.__name__)
def test_every_event_comes_back_to_the_last_bit(cls, data):
    event = data.draw(values(cls))
    document = encode(event, Event)
    assert document["type"] == cls.__name__
    assert encode(event, Event) == document
    assert differences(event, there_and_back(event, Event)) == []


@pytest.mark.long
@settings(max_examples=10, suppress_health_check=SLOW, deadline=None)
@given(st.data())
@pytest.mark.parametrize("cls", [Every, SemanticMap, Plan, Belief, Mint], ids=lambda c: c.__name__)
def test_nested_values_come_back(cls, data):
    value = data.draw(values(cls))
    assert differences(value, there_and_back(value, cls)) == []


@pytest.mark.long
@given(any_array())
def test_arrays_come_back(array):
    assert differences(array, there_and_back(array, Floats)) == []


@given(st.floats(-1e9, 1e9), st.integers(30, 200))
def test_long_smooth_arrays_come_back(start, count):
    array = start + np.cumsum(np.full((count, 3), 0.1), axis=0)
    assert differences(array, there_and_back(array, Floats)) == []


def test_scalars_of_numpy_become_plain_ones_and_stay_scalars_where_arrays_are_declared():
    assert type(there_and_back(Small(x=np.float64(0.1)), Small).x) is float
    back = there_and_back(np.float64(0.1), Floats)
    assert type(back) is np.float64
    assert back == 0.1


def test_a_set_is_written_sorted():
    assert encode(frozenset({"b", "a", "c"}), frozenset[str]) == ["a", "b", "c"]


def test_an_event_without_a_map_takes_well_under_a_millisecond(make_events):
    import time

    codec = Codec()
    event = next(e for e in make_events() if type(e).__name__ == "Asked")
    codec.encode(event, Event)
    times = []
    for _ in range(20):
        begun = time.perf_counter()
        json.dumps(codec.encode(event, Event))
        times.append(time.perf_counter() - begun)
    assert min(times) < 1e-3


@pytest.mark.parametrize(
    ("hint", "document", "message"),
    [
        (Small, {"x": "far"}, r"Small\.x: 'far': a number is expected"),
        (Small, {"x": "nan:3ff0000000000000"}, r"Small\.x: .*a number"),
        (Small, {}, "needs the field 'x'"),
        (Small, {"x": 1, "y": 2}, "has no field 'y'"),
        (Small, [1], "an object with the fields of Small"),
        (Box, {"lo_m": [0, 0, 2], "hi_m": [1, 1, 1]}, "Box refuses it: box from"),
        (Box, {"lo_m": [0, 0], "hi_m": [1, 1, 1]}, r"Box\.lo_m: list: a list of 3"),
        (Box, {"lo_m": [0, 0, True], "hi_m": [1, None, 1]}, r"Box\.hi_m\[1\]: None: a number"),
        (Event, {"type": "os.system", "command": "rm"}, r"'os\.system': the 'type' is one of MissionStarted"),
        (Event, {"type": "Timed", "stage": "x", "seconds": []}, r"Timed\.seconds: list: a number"),
        (Event, {"type": ["Timed"]}, "list: the 'type' is one of"),
        (Level, "MIDDLE", "Level knows LOW, HIGH"),
        (int, 1.0, "1.0: a whole number"),
        (bool, 1, "1: true or false"),
        (str, {"surrogates": "!"}, "base64"),
        (frozenset[str], ["a", "a"], "nothing twice"),
        (Floats, {"float64": [1, [2]]}, "no array of float64"),
        (Floats, {"float64": ["1"]}, "does not hold numbers"),
        (Floats, {"int64": [1.5]}, "does not hold numbers"),
        (Floats, {"uint8": [300]}, "no array of uint8"),
        (Floats, {"object": [None]}, "'object': the elements"),
        (Floats, {"dtype": "float64", "shape": [-1], "data": ""}, "not below 0"),
        (Floats, {"dtype": "float64", "shape": [1], "data": "%%"}, "cannot be unpacked"),
        (Floats, {"dtype": "float64", "shape": [0, 10**30], "data": "eJwDAAAAAAE="}, "shape"),
    ],
)
def test_what_is_wrong_is_told_with_its_place(hint, document, message):
    with pytest.raises(RecordError, match=message):
        decode(hint, document)


def test_a_fault_deep_inside_names_the_way_to_it(make_events):
    event = next(e for e in make_events() if type(e).__name__ == "Deliberated")
    document = json.loads(json.dumps(encode(event, Event)))
    document["mint"]["root"]["children"][1]["plan"]["legs"][0]["stop"]["action"] = "explode"
    with pytest.raises(
        RecordError, match=r"Deliberated\.mint\.root\.children\[1\]\.plan\.legs\[0\]\.stop\.action: 'exp"
    ):
        decode(Event, document)


@functools.cache
def bomb(size: int) -> str:
    packer = zlib.compressobj(1)
    data = b"".join(packer.compress(bytes(2**20)) for _ in range(size // 2**20)) + packer.flush()
    return base64.b64encode(data).decode()


@pytest.mark.parametrize("shape", [[2**40], [2**20, 2**20], [100], [0], []])
def test_crafted_lengths_and_archives_are_refused_before_they_are_held(shape):
    document = {"dtype": "uint8", "shape": shape, "data": bomb(100 * 2**20)}
    tracemalloc.start()
    with pytest.raises(RecordError):
        decode(Floats, document)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 4 * 2**20


def test_many_archives_in_one_document_are_refused_together():
    packed = {"dtype": "uint8", "shape": [100 * 2**20], "data": bomb(100 * 2**20)}
    with pytest.raises(RecordError, match=r"\[2\]: arrays of more than"):
        decode(tuple[Floats, ...], [packed] * 4)


@dataclass(frozen=True)
class Unknown:
    """Holds what has no exact form."""

    run: typing.Callable[[], None]


@dataclass(frozen=True)
class Tagged:
    """Would hide the tag of a union."""

    type: str


@pytest.mark.parametrize(
    ("value", "hint", "message"),
    [
        (Unknown(run=print), None, r"Unknown\.run: values of type .*Callable.* have no exact form"),
        (Tagged(type="x"), Tagged | Small, "rename the field"),
        (Small(x="1"), None, r"Small\.x: '1': a number"),  # type: ignore[arg-type]
        (Small(x=np.longdouble(1)), None, "double precision"),  # type: ignore[arg-type]
        ([1], tuple[int, ...], "list: a tuple"),
        (np.array([None]), Floats, "an array of object"),
        (np.ma.masked_array([1.0]), Floats, "a numpy array is expected"),
        (Level.LOW, Odd, "a member of Odd"),
        (object(), None, "no exact form"),
    ],
)
def test_what_has_no_exact_form_is_refused_when_it_is_written(value, hint, message):
    with pytest.raises(RecordError, match=message):
        encode(value, hint)


@pytest.mark.long
@settings(max_examples=100, suppress_health_check=SLOW, deadline=None)
@given(st.data())
def test_changed_documents_are_refused_or_read_never_anything_else(make_events_once, data):
    event = data.draw(st.sampled_from(make_events_once))
    document = replaced(json.loads(json.dumps(encode(event, Event))), data)
    with contextlib.suppress(RecordError):
        decode(Event, document)


@pytest.fixture(scope="module")
def make_events_once():
    from .conftest import tell

    return tell()


def test_deep_documents_are_refused():
    deep: Any = {}
    for _ in range(100_000):
        deep = {"more": deep}
    with pytest.raises(RecordError):
        decode(Every, deep)
    assert math.isinf(decode(float, "inf"))
