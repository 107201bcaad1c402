"""What ``mintpilot log`` does with recorded flights: says what is in them, mends them, hands them on."""

from __future__ import annotations

import csv
import io
import json
import math
import struct
from collections import Counter
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from mintpilot.core.errors import RecordError
from mintpilot.core.events import MissionStarted, Stepped
from mintpilot.core.geometry import Vec3
from mintpilot.core.georeference import Georeference
from mintpilot.core.inputs import Ticked
from mintpilot.recording.event_log import EVENTS_FILE, read_event_log
from mintpilot.recording.mcap_log import MCAP_FILE

MAGIC: Final = b"\x89MCAP0\r\n"


@dataclass(frozen=True, slots=True, kw_only=True)
class LogInfo:
    """What a log holds."""

    file: str
    kind: str
    """``mcap`` or ``events``."""
    entries: int
    """Messages, or events."""
    seconds: float
    """From the first to the last one."""
    whole: bool
    """Whether it was closed; else it breaks off: ``recover`` mends it."""
    topics: dict[str, int]
    """Entries by topic, or by kind of event."""


def log_info(path: Path) -> LogInfo:
    """What the log holds; of a run folder that of its MCAP file, else of its events.

    Raises:
        RecordError: it is neither, or cannot be read.
    """
    file = _file_in(path)
    if file.suffix == ".mcap":
        messages, whole = _messages(file)
        times = [message.log_time for _, _, message in messages]
        return LogInfo(
            file=str(file),
            kind="mcap",
            entries=len(messages),
            seconds=(max(times) - min(times)) / 1e9 if times else 0.0,
            whole=whole,
            topics=dict(sorted(Counter(channel.topic for _, channel, _ in messages).items())),
        )
    log = read_event_log(file)
    events = [(logged.at_s, type(logged.event).__name__) for logged in log]
    return LogInfo(
        file=str(file),
        kind="events",
        entries=len(events),
        seconds=events[-1][0] - events[0][0] if events else 0.0,
        whole=not log.cut,
        topics=dict(sorted(Counter(name for _, name in events).items())),
    )


def recover(path: Path, out: Path) -> int:
    """Writes a whole MCAP file of all messages of one that breaks off; their number.

    Raises:
        RecordError: it is no MCAP file, or ``out`` cannot be written or exists.
    """
    from mcap.writer import Writer

    file = _file_in(path)
    if file.suffix != ".mcap":
        raise RecordError(f"{file} needs no mending: events are read up to where they break off")
    messages, _ = _messages(file)
    try:
        with out.open("xb") as made:
            writer = Writer(made)
            writer.start(profile="", library="mintpilot")
            schemas: dict[int, int] = {}
            channels: dict[int, int] = {}
            for schema, channel, message in messages:
                if schema is not None and schema.id not in schemas:
                    schemas[schema.id] = writer.register_schema(schema.name, schema.encoding, schema.data)
                if channel.id not in channels:
                    schema_id = 0 if schema is None else schemas[schema.id]
                    channels[channel.id] = writer.register_channel(channel.topic, channel.message_encoding, schema_id)
                writer.add_message(
                    channels[channel.id],
                    log_time=message.log_time,
                    data=message.data,
                    publish_time=message.publish_time,
                    sequence=message.sequence,
                )
            writer.finish()  # type: ignore[no-untyped-call]
    except FileExistsError:
        raise RecordError(f"{out} exists; give another file with --out") from None
    except OSError as error:
        raise RecordError(f"cannot write {out}: {error.strerror}; give another file with --out") from error
    return len(messages)


@dataclass(frozen=True, slots=True, kw_only=True)
class _Fix:
    """Where the drone was."""

    time_s: float
    position_m: Vec3
    yaw_rad: float
    endurance_left_s: float | None


def track_csv(path: Path) -> str:
    """Where the drone was, as CSV: mission seconds, metres, heading, battery. Raises `RecordError`.

    A ``flight.mcap`` without its run folder says nothing of the battery: that column is empty.
    """
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(("time_s", "x_m", "y_m", "z_m", "yaw_rad", "endurance_left_s"))
    for fix in _track(path)[1]:
        left = "" if fix.endurance_left_s is None else f"{fix.endurance_left_s:.2f}"
        place = (f"{value:.4f}" for value in fix.position_m)
        writer.writerow((f"{fix.time_s:.3f}", *place, f"{fix.yaw_rad:.4f}", left))
    return text.getvalue()


def track_geojson(path: Path) -> str:
    """Where the drone was, as GeoJSON.

    Raises:
        RecordError: the run cannot be read, or its map has no georeference.
    """
    reference, track = _track(path)
    if reference is None:
        raise RecordError(f"{path}: there is no georeference of the mission's map in it; export CSV, in metres")
    line = []
    for fix in track:
        place = reference.geodetic(fix.position_m)
        line.append([place.longitude_deg, place.latitude_deg, place.altitude_m])
    feature = {"type": "Feature", "geometry": {"type": "LineString", "coordinates": line},
               "properties": {"what": "flown", "seconds": [round(fix.time_s, 3) for fix in track]}}  # fmt: skip
    return json.dumps({"type": "FeatureCollection", "features": [feature]}) + "\n"


def _track(path: Path) -> tuple[Georeference | None, list[_Fix]]:
    """The map's georeference and every place; of a ``flight.mcap`` in a run folder from the events beside it."""
    events = path / EVENTS_FILE if path.is_dir() else path.with_name(EVENTS_FILE) if path.name == MCAP_FILE else path
    if path.suffix == ".mcap" and not (path.name == MCAP_FILE and events.exists()):
        return None, _places(path)
    reference: Georeference | None = None
    track = []
    for logged in read_event_log(events):
        event = logged.event
        if isinstance(event, MissionStarted):
            reference = event.mission.georeference
        elif isinstance(event, Stepped) and isinstance(event.input, Ticked) and event.input.vehicle is not None:
            at = event.input.vehicle
            track.append(
                _Fix(time_s=event.input.time_s, position_m=at.position_m, yaw_rad=at.yaw_rad,
                     endurance_left_s=at.endurance_left_s)
            )  # fmt: skip
    return reference, track


def _places(file: Path) -> list[_Fix]:
    """Every place in an MCAP file; its first message is the mission's beginning."""
    from foxglove_schemas_protobuf.FrameTransform_pb2 import FrameTransform

    messages, _ = _messages(file)
    begun_ns = min((message.log_time for _, _, message in messages), default=0)
    track = []
    for schema, channel, message in messages:
        if channel.topic != "/tf" or schema is None or schema.name != FrameTransform.DESCRIPTOR.full_name:
            continue
        transform = FrameTransform.FromString(message.data)
        at, turn = transform.translation, transform.rotation
        track.append(
            _Fix(time_s=(message.log_time - begun_ns) / 1e9, position_m=(at.x, at.y, at.z),
                 yaw_rad=2 * math.atan2(turn.z, turn.w), endurance_left_s=None)
        )  # fmt: skip
    return track


def _file_in(path: Path) -> Path:
    """The log that a path means."""
    if path.is_dir():
        for name in (MCAP_FILE, EVENTS_FILE):
            if (path / name).exists():
                return path / name
        raise RecordError(f"{path} holds neither {MCAP_FILE} nor {EVENTS_FILE}; give a run folder")
    if path.suffix not in (".mcap", ".ndjson"):
        raise RecordError(f"{path} is no log of a flight; give a run folder, a .mcap or a .ndjson file")
    return path


def _messages(file: Path) -> tuple[list[tuple[Any, Any, Any]], bool]:
    """(schema, channel, message) of all that is readable, and whether the file is whole."""
    from mcap.exceptions import McapError
    from mcap.records import Channel, Footer, Message, Schema
    from mcap.stream_reader import StreamReader

    schemas: dict[int, Any] = {}
    channels: dict[int, Any] = {}
    found: list[tuple[Any, Any, Any]] = []
    whole = False
    try:
        with file.open("rb") as stream:
            if stream.read(len(MAGIC)) != MAGIC:
                raise RecordError(f"{file} is no MCAP file")
            stream.seek(0)
            try:
                for record in StreamReader(stream, record_size_limit=1 << 28).records:
                    if isinstance(record, Schema):
                        schemas[record.id] = record
                    elif isinstance(record, Channel):
                        channels[record.id] = record
                    elif isinstance(record, Message):
                        channel = channels[record.channel_id]
                        found.append((schemas.get(channel.schema_id), channel, record))
                    elif isinstance(record, Footer):
                        whole = True
            except (McapError, EOFError, KeyError, ValueError, OverflowError, MemoryError, struct.error):
                whole = False
    except OSError as error:
        raise RecordError(f"cannot read {file}: {error.strerror}") from error
    return found, whole
