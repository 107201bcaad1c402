"""Random values of any recorded type, made from type hints, and a comparison that forgives nothing."""

from __future__ import annotations

import collections.abc as abc
import dataclasses
import struct
import types
import typing
from enum import Enum
from typing import Any

import numpy as np
from hypothesis import reject
from hypothesis import strategies as st
from hypothesis.extra import numpy as npst

from mintpilot.core.errors import MintPilotError
from mintpilot.core.gap import Assumptions, Belief, Candidate, CorrelationGroup, GapKind, Joint, KnowledgeGap
from mintpilot.core.geometry import Box, GridFrame
from mintpilot.core.georeference import Georeference
from mintpilot.core.mission import AskingSettings
from mintpilot.core.observation import CameraModel, Frame, RegionKind
from mintpilot.core.plan import Look, Plan, VehicleLimits
from mintpilot.core.query import Answer, Evidence, Query, Reply
from mintpilot.core.semantic_map import Knowledge, MapObject, Region, Room, SemanticMap

TEXTS = st.text(st.characters(exclude_categories=()), max_size=6)
"""Lone surrogates and control characters too."""
FLOATS = st.floats() | st.integers(-(2**70), 2**70) | st.sampled_from([-0.0, 5e-324, float("-nan")])
KINDS = (np.bool_, np.int8, np.uint8, np.int32, np.int64, np.uint64, np.float16, np.float32, np.float64)
COORDINATES = st.floats(-1e6, 1e6)
POINTS = st.tuples(COORDINATES, COORDINATES, COORDINATES)


def floats(shape: Any) -> st.SearchStrategy[np.ndarray]:
    return npst.arrays(np.float64, shape)


def any_array() -> st.SearchStrategy[Any]:
    shapes = npst.array_shapes(min_dims=0, max_dims=3, min_side=0, max_side=9)
    plain = st.sampled_from(KINDS).flatmap(lambda kind: npst.arrays(kind, shapes))
    return plain | plain.map(np.asfortranarray) | plain.map(lambda a: a[..., ::2] if a.ndim else a)


@st.composite
def boxes(draw: Any) -> Box:
    a, b = draw(POINTS), draw(POINTS)
    return Box(lo_m=tuple(map(min, a, b)), hi_m=tuple(map(max, a, b)))  # type: ignore[arg-type]


@st.composite
def gaps(draw: Any, name: str | None = None) -> KnowledgeGap:
    values = tuple(draw(st.lists(TEXTS, min_size=1, max_size=3, unique=True)))
    weights = [draw(st.floats(0.01, 1)) for _ in values]
    found = tuple(Candidate(id=v, position_m=draw(POINTS), description=draw(TEXTS)) for v in values)
    return KnowledgeGap(
        id=name if name is not None else draw(TEXTS), kind=draw(st.sampled_from(GapKind)), subject=draw(TEXTS),
        description=draw(TEXTS), values=values, prior=tuple(w / sum(weights) for w in weights),
        position_m=draw(POINTS), candidates=found if draw(st.booleans()) else (),
    )  # fmt: skip


@st.composite
def joints(draw: Any, names: tuple[str, ...] = ("a", "b")) -> Joint:
    held = tuple(draw(gaps(name)) for name in names[: draw(st.integers(1, len(names)))])
    return Joint(gaps=held, probability=draw(floats(tuple(len(g.values) for g in held))))


@st.composite
def regions(draw: Any, cells: int, name: str) -> Region:
    held = sorted(draw(st.sets(st.integers(0, cells - 1), max_size=cells)))
    return Region(
        id=name, kind=draw(st.sampled_from(RegionKind)), cells=np.array(held, np.int64), description=draw(TEXTS),
        passable=draw(st.sampled_from(Knowledge)), prior_passable=draw(st.floats(0, 1)),
    )  # fmt: skip


@st.composite
def maps(draw: Any, frame: GridFrame | None = None) -> SemanticMap:
    """Small maps; those on one lattice share names, so that things are added, changed, removed and swapped."""
    if frame is None:
        shape = draw(st.tuples(*[st.integers(1, 4)] * 3))
        frame = GridFrame(origin_m=draw(POINTS), resolution_m=draw(st.floats(0.01, 2)), shape=shape)
    names = st.lists(st.sampled_from(["a", "b", "c", "\ud800"]), max_size=4, unique=True)
    box = boxes()
    return SemanticMap(
        frame=frame,
        cells=draw(npst.arrays(np.uint8, frame.shape, elements=st.integers(0, 2))),
        objects=tuple(
            MapObject(id=n, label=draw(TEXTS), box_m=draw(box), score=draw(FLOATS), sightings=draw(st.integers(0, 3)))
            for n in draw(names)
        ),
        regions=tuple(draw(regions(frame.size, n)) for n in draw(names)),
        rooms=tuple(
            Room(id=n, door_m=draw(box), viewpoint_m=draw(POINTS), searched=draw(st.booleans())) for n in draw(names)
        ),
    )


@st.composite
def frames(draw: Any) -> Frame:
    camera = CameraModel(width=draw(st.integers(1, 4)), height=draw(st.integers(1, 4)), fx=1.5, fy=2.5, cx=0.5, cy=0.1)
    size = (camera.height, camera.width)
    return Frame(
        time_s=draw(FLOATS), rgb=draw(npst.arrays(np.uint8, (*size, 3))), camera=camera,
        depth_m=draw(npst.arrays(np.float32, size)),
        world_from_camera=draw(npst.arrays(np.float64, (4, 4), elements=st.floats(-10, 10))),
    )  # fmt: skip


@st.composite
def groups(draw: Any) -> CorrelationGroup:
    return CorrelationGroup(gaps=("a", "b"), joint=((("x", "y"), draw(st.floats(0, 1))), (("x", "z"), 0.25)))


OWN: dict[object, st.SearchStrategy[Any]] = {
    str: TEXTS,
    int: st.integers(),
    bool: st.booleans(),
    float: FLOATS,
    type(None): st.none(),
    Box: boxes(),
    KnowledgeGap: gaps(),
    Joint: joints(),
    Belief: st.tuples(joints(("a", "b")), joints(("c", "d"))).map(lambda f: Belief(factors=f)),
    SemanticMap: maps(),
    GridFrame: maps().map(lambda m: m.frame),
    Region: regions(9, "smoke-1"),
    Frame: frames(),
    CorrelationGroup: groups(),
    Assumptions: st.dictionaries(TEXTS, st.sets(TEXTS)).map(Assumptions.of),
    Georeference: st.floats(-90, 90).map(lambda a: Georeference(latitude_deg=a, longitude_deg=2 * a)),
    VehicleLimits: st.floats(0.1, 9).map(lambda r: VehicleLimits(radius_m=r)),
    AskingSettings: st.integers(0, 50).map(lambda n: AskingSettings(max_questions=n, objective="ec2")),
}
"""Types whose values must keep rules that hints do not tell."""


def values(hint: Any, depth: int = 0) -> st.SearchStrategy[Any]:
    """Values of that type."""
    if hint in OWN:
        return OWN[hint]
    origin, arguments = typing.get_origin(hint), typing.get_args(hint)
    if origin is np.ndarray:
        kind = typing.get_args(arguments[1])[0]
        return npst.arrays(kind, npst.array_shapes(max_dims=2, min_side=0, max_side=9))
    if origin is typing.Literal:
        return st.sampled_from(arguments)
    if origin in (typing.Union, types.UnionType):
        members = [a for a in arguments if a is type(None)] if depth > 4 else []
        return st.one_of([values(a, depth + 1) for a in members or arguments])
    if origin in (tuple, frozenset, abc.Sequence):
        if origin is tuple and ... not in arguments:
            return st.tuples(*[values(a, depth) for a in arguments])
        items = st.just([]) if depth > 3 else st.lists(st.deferred(lambda: values(arguments[0], depth + 1)), max_size=2)
        return items.map(frozenset if origin is frozenset else tuple)
    if origin in (dict, abc.Mapping):
        return st.dictionaries(values(arguments[0], depth + 1), values(arguments[1], depth + 1), max_size=2)
    if isinstance(hint, typing.NewType):
        return values(hint.__supertype__, depth)
    if isinstance(hint, type) and issubclass(hint, Enum):
        return st.sampled_from(hint)
    assert dataclasses.is_dataclass(hint), f"no values of {hint} are known"
    return built(hint, depth)


def built(cls: Any, depth: int) -> st.SearchStrategy[Any]:
    """Instances, each field by its hint; those that break a rule of the class are not used."""
    hints = typing.get_type_hints(cls)
    fields = {f.name: st.deferred(lambda n=f.name: values(hints[n], depth + 1)) for f in dataclasses.fields(cls)}  # type: ignore[misc]
    prices = {name: st.floats(0, 999) for name in fields if name.endswith("price_s")}
    fields |= prices
    if cls is Query:
        literals = values(typing.get_args(hints["literals"])[0], depth + 1)
        fields["literals"] = st.lists(literals, min_size=1, max_size=2).map(tuple)
        fields |= {"options": st.just(()), "none_of_these": st.just(False)}
    if cls is Answer:
        fields["reply"] = st.sampled_from([reply for reply in Reply if reply is not Reply.OPTION])
        fields["option"] = st.none()
    if cls is Look:
        fields |= {"dwell_s": st.floats(0, 999), "sees": st.floats(0.01, 1)}
    if cls is Evidence:
        fields["part"] = st.integers(0, 1)
    if cls is Plan:  # else the plan computes one from the way, and the way makes no sense here
        fields["signature"] = st.text(min_size=1, max_size=3)

    def make(**given: Any) -> Any:
        try:
            return cls(**given)
        except MintPilotError:
            reject()

    return st.builds(make, **fields)


def differences(a: object, b: object, path: str = "") -> list[str]:
    """Where two values are not the same to the last bit; arrays of the second must be read-only."""
    if isinstance(a, float) and isinstance(b, float):
        return [] if type(a) is type(b) and struct.pack(">d", a) == struct.pack(">d", b) else [f"{path}: {a} {b}"]
    if type(a) is not type(b):
        return [f"{path}: {type(a)} {type(b)}"]
    if isinstance(a, np.ndarray) and isinstance(b, np.ndarray):
        same = a.dtype == b.dtype and a.shape == b.shape and a.tobytes() == b.tobytes()
        order = not a.flags.f_contiguous or b.flags.f_contiguous
        return [] if same and order and not b.flags.writeable else [f"{path}: {a!r} {b!r} {b.flags}"]
    if dataclasses.is_dataclass(a):
        names = [f.name for f in dataclasses.fields(a)]
        return [d for n in names for d in differences(getattr(a, n), getattr(b, n), f"{path}.{n}")]
    if isinstance(a, tuple) and isinstance(b, tuple):
        if len(a) != len(b):
            return [f"{path}: {len(a)} {len(b)}"]
        return [d for i, (x, y) in enumerate(zip(a, b, strict=True)) for d in differences(x, y, f"{path}[{i}]")]
    if isinstance(a, dict) and isinstance(b, dict):
        return differences(tuple(a.items()), tuple(b.items()), path)
    return [] if a == b else [f"{path}: {a!r} {b!r}"]


_LEAVES = (
    st.none() | st.booleans() | st.integers() | st.text(max_size=3) | st.floats(allow_nan=False, allow_infinity=False)
)
JSON = st.recursive(_LEAVES, lambda i: st.lists(i, max_size=3) | st.dictionaries(st.text(max_size=3), i, max_size=3))


def replaced(document: Any, data: st.DataObject) -> Any:
    """The document with one part of it replaced by anything."""
    if not document or not isinstance(document, dict | list) or data.draw(st.integers(0, 6)) == 0:
        return data.draw(JSON)
    copy = document.copy()
    key = data.draw(st.sampled_from(sorted(document) if isinstance(document, dict) else range(len(document))))
    copy[key] = replaced(document[key], data)
    return copy
