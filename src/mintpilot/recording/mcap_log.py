"""``flight.mcap``: the flight for viewers such as Foxglove, written from the same events as the lossless log.

Unchunked and unbuffered: what was written is kept whatever happens to the program; a file without its footer is mended
by ``mintpilot log recover``. What a full disk does not take is lost whole: the file ends with its last whole record,
and the numbers of a topic's messages have a gap. Times are the mission's clock, counted from when the recording began.
"""

from __future__ import annotations

import io
import json
import os
import time
from collections.abc import Callable
from pathlib import Path
from typing import IO, Any, Final, cast

import numpy as np
from PIL import Image
from pydantic import JsonValue

from mintpilot.core.errors import RecordError
from mintpilot.core.events import (
    Asked,
    Deliberated,
    Event,
    FrameSeen,
    LegFlown,
    MapUpdated,
    MissionEnded,
    MissionStarted,
    Noticed,
    OrderTaken,
    PlanChosen,
    Stepped,
)
from mintpilot.core.geometry import Floats
from mintpilot.core.inputs import Ticked
from mintpilot.core.message import message
from mintpilot.core.observation import Frame
from mintpilot.core.ports import Recorder
from mintpilot.recording import mcap_scene as scene
from mintpilot.recording.build import speech_of
from mintpilot.recording.tree_data import tree_record
from mintpilot.recording.words import ORDER_WORDS
from mintpilot.wording.speech import Speech

MCAP_FILE: Final = "flight.mcap"
PICTURE_S: Final = 1.0
"""No more than one picture in so many seconds."""
MOST_POSES: Final = 400
"""Poses of one path in one message."""
_JSON_SCHEMA: Final = json.dumps({"type": "object"}).encode()
_LEVELS: Final = {"info": 2, "warning": 3}


class McapRecorder(Recorder):
    """Writes viewers' messages; close it, so that the file gets its footer.

    Args:
        path: the file; refused where it exists.
        clock: wall-clock seconds since 1970.

    Raises:
        RecordError: the file cannot be made, or exists.
    """

    def __init__(self, path: Path, *, clock: Callable[[], float] = time.time) -> None:
        from mcap.writer import CompressionType, Writer

        try:
            self._file = _WriteThrough(os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o644))
        except OSError as error:
            raise RecordError(f"cannot write {path}: {error.strerror}; give a new file") from error
        self._speech = Speech()
        self._writer = Writer(cast("IO[bytes]", self._file), use_chunking=False, compression=CompressionType.NONE)
        self._writer.start(profile="", library="mintpilot")
        self._begun_ns = int(clock() * 1e9)
        self._mission_s = 0.0
        self._channels: dict[str, int] = {}
        self._lossy = False
        self._counts: dict[str, int] = {}
        self._next_picture_s = 0.0
        self._closed = False

    def record(self, event: Event) -> None:
        """Writes what viewers show of the event.

        Raises:
            OSError: the disk does not take it. The file is as it was before, and the next event may be written.
        """
        match event:
            case Stepped():
                self._step(event)
            case FrameSeen():
                self._mission_s = max(self._mission_s, event.frame.time_s)
                self._picture(event.frame)
            case MapUpdated():
                self._proto("/map", scene.map_message(event.map, self._stamp()))
                self._proto("/grid", scene.grid_message(event.map, self._stamp()))
            case LegFlown():
                self._proto("/path/flown", self._path(event.log.position_m))
            case PlanChosen():
                if event.plan is not None and event.plan.legs:
                    self._proto("/path/planned", self._path(event.plan.path_m))
                self._say("info", self._speech(event.certificate.text))
            case Noticed():
                self._say("warning", self._speech(event.text))
            case OrderTaken():
                order = message("Order: {order}. {answer}", order=ORDER_WORDS[event.order], answer=event.answer)
                self._say("info", self._speech(order))
            case MissionStarted() | Deliberated() | Asked() | MissionEnded():
                self._told(event)
            case _:
                pass

    def close(self) -> None:
        """Writes the footer and closes the file; a second call does nothing. Raises `OSError` as `record` does."""
        if self._closed:
            return
        self._closed = True
        try:
            self._file.whole(self._finish)
        finally:
            self._file.close()

    def _finish(self) -> None:
        if not self._lossy:
            self._writer.finish()  # type: ignore[no-untyped-call]
            return
        from mcap.data_stream import RecordBuilder
        from mcap.records import DataEnd, Footer
        from mcap.writer import MCAP0_MAGIC

        # the writer's summary would count what was lost: readers do without one
        end = RecordBuilder()
        DataEnd(data_section_crc=0).write(end)
        Footer(summary_start=0, summary_offset_start=0, summary_crc=0).write(end)
        self._file.write(end.end() + MCAP0_MAGIC)  # type: ignore[no-untyped-call]

    def _told(self, event: MissionStarted | Deliberated | Asked | MissionEnded) -> None:
        match event:
            case MissionStarted():
                self._speech = speech_of(event)
                self._json("/mission", {"name": event.mission.name, "instruction": event.mission.instruction})
            case Deliberated():
                self._json(
                    "/gaps",
                    {
                        "gaps": [
                            {"id": g.id, "what": self._speech.thing(g.description), "prior": list(g.prior)}
                            for g in event.gaps
                        ]
                    },
                )
                if event.mint is not None:
                    tree = tree_record(event.mint, event.gaps, speech=self._speech)
                    self._json("/tree", tree.model_dump(mode="json"))
                if event.chosen is not None:
                    chosen = event.chosen
                    self._json(
                        "/query", {"query": chosen.query.id, "gain_bits": chosen.gain_bits, "score": chosen.score}
                    )
            case Asked():
                self._json("/answer", {"question": event.question.text, "reply": event.answer.reply.value,
                                       "text": event.answer.text, "latency_s": event.answer.latency_s})  # fmt: skip
                self._say("info", f"{event.question.text} {event.answer.reply.value}")
            case MissionEnded():
                outcome, reason = event.verdict.outcome.value, self._speech(event.verdict.reason)
                self._json("/verdict", {"outcome": outcome, "reason": reason})
                self._say("info", f"{outcome}: {reason}")

    def _step(self, event: Stepped) -> None:
        self._mission_s = max(self._mission_s, event.input.time_s)
        if isinstance(event.input, Ticked):
            vehicle = event.input.vehicle
            if vehicle is not None:
                self._proto("/tf", scene.pose_message(vehicle, self._stamp()))
        elif event.directives:
            self._json("/directive", {"after": type(event.input).__name__, "directives": list(event.directives)})

    def _picture(self, frame: Frame) -> None:
        if self._mission_s < self._next_picture_s:
            return
        self._next_picture_s = self._mission_s + PICTURE_S
        data = io.BytesIO()
        Image.fromarray(frame.rgb).save(data, "JPEG", quality=80)
        self._proto("/camera", scene.picture_message(data.getvalue(), self._stamp()))

    def _path(self, path_m: Floats) -> Any:
        step = max(1, len(path_m) // MOST_POSES)
        kept = np.concatenate([path_m[::step], path_m[-1:]]) if len(path_m) else path_m
        return scene.path_message(kept, self._stamp())

    def _say(self, level: str, text: str) -> None:
        self._proto("/log", scene.log_message(text, _LEVELS[level], self._stamp()))

    def _stamp(self) -> int:
        return self._begun_ns + int(self._mission_s * 1e9)

    def _proto(self, topic: str, message: Any) -> None:
        schema = lambda: (message.DESCRIPTOR.full_name, "protobuf", scene.descriptors_of(message))  # noqa: E731
        self._write(topic, message.SerializeToString(), "protobuf", schema)

    def _json(self, topic: str, fields: dict[str, JsonValue]) -> None:
        name = f"mintpilot{topic.replace('/', '.')}"
        data = json.dumps(fields, ensure_ascii=False).encode()
        self._write(topic, data, "json", lambda: (name, "jsonschema", _JSON_SCHEMA))

    def _write(self, topic: str, data: bytes, encoding: str, schema: Callable[[], tuple[str, str, bytes]]) -> None:
        """One message; the first of its topic goes to the disk in one piece with schema and channel.

        Args:
            topic: its name.
            data: the message, encoded.
            encoding: how messages of the topic are encoded.
            schema: its name, encoding and text.
        """
        self._counts[topic] = self._counts.get(topic, 0) + 1
        known = self._channels.get(topic)
        if known is None:
            channel = self._writer.register_channel(topic, encoding, self._writer.register_schema(*schema()))
        else:
            channel = known
        stamp = self._stamp()
        try:
            self._writer.add_message(
                channel, log_time=stamp, data=data, publish_time=stamp, sequence=self._counts[topic]
            )
        except BaseException:  # Ctrl-C as well: a channel counts only where its registration is in the file
            self._lossy = True
            raise
        self._channels[topic] = channel


class _WriteThrough:
    """A file whose bytes are in the operating system's hands when `write` returns; what fails leaves nothing behind.

    The writer wraps raw files in a buffer of its own, which a killed program would take with it.
    """

    def __init__(self, descriptor: int) -> None:
        self._descriptor = descriptor
        self._size = 0

    def write(self, data: bytes) -> int:
        rest, done = memoryview(data), 0
        try:
            while done < len(data):
                done += os.pwrite(self._descriptor, rest[done:], self._size + done)
        except BaseException:
            os.ftruncate(self._descriptor, self._size)
            raise
        self._size += done
        return done

    def whole(self, write: Callable[[], None]) -> None:
        """Several writes, all of them or none."""
        size = self._size
        try:
            write()
        except BaseException:
            self._size = size
            os.ftruncate(self._descriptor, size)
            raise

    def tell(self) -> int:
        return self._size

    def flush(self) -> None:
        """Nothing is held back."""

    def close(self) -> None:
        os.close(self._descriptor)
