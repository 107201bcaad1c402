"""ROS 2 bags in SQLite or MCAP, read without ROS."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from mintpilot.core.errors import MapError, MissingPartError
from mintpilot.core.observation import CameraModel, RawFrame
from mintpilot.core.ports import FrameSource, SourceOptions
from mintpilot.frames.bag_messages import camera_of, picture_of, stamp_s
from mintpilot.frames.bag_transforms import Transforms
from mintpilot.frames.intrinsics import read_intrinsics
from mintpilot.frames.pictures import MILLIMETRE_M, as_color, as_depth, joined

SAME_S = 0.05
"""Colour and depth no further apart in time than this belong together."""
_IMAGES = ("sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage")
_INFO = "sensor_msgs/msg/CameraInfo"
_TF = "tf2_msgs/msg/TFMessage"
_ODOMETRY = "nav_msgs/msg/Odometry"


class RosBag(FrameSource):
    """Colour, depth, lens and poses of a bag; the poses come from its transforms, or from odometry.

    Args:
        where: the bag's folder, or its ``.mcap`` or ``.db3`` file.
        options: ``intrinsics`` replaces the bag's own; ``depth_unit_m`` is for whole numbers, default millimetres.

    Raises:
        MissingPartError: ``rosbags`` is not installed.
    """

    def __init__(self, where: str, options: SourceOptions) -> None:
        try:
            from rosbags.highlevel import AnyReader
        except ImportError:
            raise MissingPartError("ROS bags need the package 'rosbags'; pip install 'mintpilot[bags]'") from None
        self._reader: Any = AnyReader
        path = Path(where)
        self._path = path.parent if path.suffix == ".db3" and (path.parent / "metadata.yaml").exists() else path
        self._options = options
        self._said: list[str] = []

    @property
    def z_is_up(self) -> bool:
        """True: worlds in ROS have z up."""
        return True

    def remarks(self) -> tuple[str, ...]:
        """What was assumed or left out."""
        return tuple(self._said)

    def frames(self) -> Iterator[RawFrame]:
        """Each colour picture with the depth nearest in time.

        Raises:
            MapError: the bag cannot be opened or has no colour, no depth or no lens.
        """
        from rosbags.typesys import Stores, get_typestore

        reader = self._reader([self._path], default_typestore=get_typestore(Stores.ROS2_JAZZY))
        try:
            reader.open()
        except Exception as error:  # whatever a broken file makes the reader raise
            raise MapError(
                f"bag '{self._path}' cannot be opened ({error}); it may be cut short: 'ros2 bag reindex' may mend it"
            ) from None
        try:
            yield from self._read(reader)
        finally:
            reader.close()

    def _read(self, reader: Any) -> Iterator[RawFrame]:
        color, depth = self._topic(reader, depth=False), self._topic(reader, depth=True)
        lens, transforms, depths = self._first_pass(reader, color, depth)
        taken = 0
        unmatched = 0
        seen = 0
        for connection, message in self._messages(reader, [color]):
            time_s = stamp_s(message)
            near = _nearest_time(depths, time_s)
            if near is None:
                unmatched += 1
                continue
            seen += 1
            if (seen - 1) % self._options.every:
                continue
            if taken >= self._options.longest:
                break
            taken += 1
            depth_m = as_depth(near, self._options.depth_unit_m or MILLIMETRE_M, depth.topic)
            pose = transforms.pose(message.header.frame_id, time_s)
            if pose is None:
                pose = transforms.body_pose(time_s)
            rgb = as_color(picture_of(message, connection.msgtype, color.topic), color.topic)
            yield joined(rgb, depth_m, lens, time_s=time_s, pose=pose, name=f"{color.topic} at {time_s:.2f} s")
        if unmatched:
            self._said.append(f"{unmatched} colour pictures have no depth within {SAME_S} s and were left out.")
        if not taken:
            raise MapError(f"bag '{self._path}': no colour picture has depth within {SAME_S} s; is it cut short?")

    def _first_pass(self, reader: Any, color: Any, depth: Any) -> tuple[CameraModel, Transforms, list[Any]]:
        """Lens, transforms and all depth pictures with their times."""
        infos = [c for c in reader.connections if c.msgtype == _INFO]
        infos.sort(key=lambda c: -_common(c.topic, color.topic))
        others = [c for c in reader.connections if c.msgtype in (_TF, _ODOMETRY)]
        lens = read_intrinsics(self._options.intrinsics) if self._options.intrinsics is not None else None
        if lens is None and not infos:
            raise MapError(f"bag '{self._path}' has no CameraInfo; give the lens by --intrinsics FILE")
        transforms, depths = Transforms(), []
        for connection, message in self._messages(reader, [depth, *infos[:1], *others]):
            if connection.topic == depth.topic:
                depths.append((stamp_s(message), picture_of(message, connection.msgtype, depth.topic)))
            elif connection.msgtype == _INFO:
                lens = lens or camera_of(message, connection.topic)
            elif connection.msgtype == _TF:
                transforms.add(message.transforms, fixed=connection.topic.endswith("tf_static"))
            else:
                transforms.add_odometry(message)
        if lens is None:
            raise MapError(f"bag '{self._path}': its CameraInfo holds no message; give the lens by --intrinsics FILE")
        depths.sort(key=lambda pair: pair[0])
        return lens, transforms, depths

    def _messages(self, reader: Any, connections: list[Any]) -> Iterator[tuple[Any, Any]]:
        """The messages that can be read; a bag that is cut short gives those before the cut."""
        messages = reader.messages(connections=connections)
        while True:
            try:
                connection, _, raw = next(messages)
                message = reader.deserialize(raw, connection.msgtype)
            except StopIteration:
                return
            except MapError:
                raise
            except Exception as error:  # whatever a broken file makes the reader raise
                text = f"The bag is cut short or broken ({error}): what comes before was read."
                if text not in self._said:
                    self._said.append(text)
                return
            yield connection, message

    def _topic(self, reader: Any, *, depth: bool) -> Any:
        """The topic of colour or of depth: by its name, aligned depth and colour before others."""
        pictures = [c for c in reader.connections if c.msgtype in _IMAGES and c.msgcount != 0]
        fitting = [c for c in pictures if ("depth" in c.topic.lower()) == depth]
        wanted = "aligned" if depth else "color"
        fitting.sort(key=lambda c: (wanted not in c.topic, "infra" in c.topic, "ompressed" in c.msgtype, c.topic))
        if not fitting:
            what = "depth" if depth else "colour"
            topics = ", ".join(sorted(c.topic for c in reader.connections)) or "none"
            raise MapError(f"bag '{self._path}' has no pictures of {what}; its topics: {topics}")
        return fitting[0]


def _common(a: str, b: str) -> int:
    """How many leading parts two topics share."""
    pairs = zip(a.split("/"), b.split("/"), strict=False)
    return next((i for i, (x, y) in enumerate(pairs) if x != y), min(a.count("/"), b.count("/")) + 1)


def _nearest_time(depths: list[Any], time_s: float) -> Any:
    after = bisect_left(depths, time_s, key=lambda pair: pair[0])
    best = min(depths[max(0, after - 1) : after + 1], key=lambda pair: abs(pair[0] - time_s), default=None)
    return None if best is None or abs(best[0] - time_s) > SAME_S else best[1]
