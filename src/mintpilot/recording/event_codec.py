"""Events as JSON: by their type hints, with maps as differences, plans once, and frames without their pictures."""

from __future__ import annotations

from dataclasses import dataclass
from typing import cast

import numpy as np
from pydantic import JsonValue

from mintpilot.core.events import Event
from mintpilot.core.geometry import Floats
from mintpilot.core.observation import CameraModel, Frame
from mintpilot.core.plan import Plan
from mintpilot.core.semantic_map import SemanticMap
from mintpilot.recording.codec import Codec
from mintpilot.recording.codec_parts import Budget, CodecError, TypeCodec, shown
from mintpilot.recording.map_deltas import MapDeltas
from mintpilot.recording.shared_plans import SharedPlans

_EVENT = cast(type[Event], Event)
"""All that is recorded: whatever joins this union."""


class EventCodec:
    """The codec of one writer or one reader of a log, with what it remembers of earlier lines."""

    def __init__(self) -> None:
        self._maps, self._plans = MapDeltas(), SharedPlans()
        picture = TypeCodec(encode=_encode_picture, decode=_decode_picture)
        self._codec = Codec({SemanticMap: self._maps.type_codec(), Plan: self._plans.type_codec(), Frame: picture})

    def encode(self, event: Event) -> JsonValue:
        """The event as JSON. Raises `RecordError` where it holds what has no exact form."""
        self._plans.begin()
        return self._codec.encode(event, Event)

    def decode(self, document: JsonValue) -> Event:
        """The event. Raises `RecordError` where the document holds none, by its place and the rule."""
        return self._codec.decode(_EVENT, document)

    def forget(self) -> None:
        """The event that was encoded last did not reach the log: the next ones are written without reference to it."""
        self._maps.forget()
        self._plans.forget()


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _View:
    """What the log keeps of a picture."""

    time_s: float
    camera: CameraModel
    world_from_camera: Floats


_VIEWS = Codec()


def _encode_picture(value: object) -> JsonValue:
    if not isinstance(value, Frame):
        raise CodecError(f"{shown(value)}: Frame is expected")
    view = _View(time_s=value.time_s, camera=value.camera, world_from_camera=value.world_from_camera)
    return _VIEWS.type_codec(_View).encode(view)


def _decode_picture(document: JsonValue, budget: Budget) -> Frame:
    view = _VIEWS.type_codec(_View).decode(document, budget)
    assert isinstance(view, _View)
    size = (view.camera.height, view.camera.width)
    try:
        return Frame(
            time_s=view.time_s,
            rgb=np.broadcast_to(np.uint8(0), (*size, 3)),
            depth_m=np.broadcast_to(np.float32(np.nan), size),
            camera=view.camera,
            world_from_camera=view.world_from_camera,
        )
    except Exception as error:  # whatever the noun's own checks raise
        raise CodecError(f"Frame refuses it: {error}") from None
