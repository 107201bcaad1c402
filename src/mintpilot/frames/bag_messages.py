"""ROS messages into pictures and poses."""

from __future__ import annotations

import io
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from mintpilot.core.errors import MapError
from mintpilot.core.observation import CameraModel
from mintpilot.frames.intrinsics import checked_camera

_KINDS: Final = {
    "rgb8": (np.uint8, 3),
    "bgr8": (np.uint8, 3),
    "rgba8": (np.uint8, 4),
    "bgra8": (np.uint8, 4),
    "mono8": (np.uint8, 1),
    "8UC1": (np.uint8, 1),
    "8UC3": (np.uint8, 3),
    "16UC1": (np.uint16, 1),
    "mono16": (np.uint16, 1),
    "32FC1": (np.float32, 1),
}
"""Encoding → type and channels."""


def picture_of(message: Any, kind: str, topic: str) -> NDArray[Any]:
    """The pixels (h, w) or (h, w, 3) of an ``Image`` or ``CompressedImage``; colours as red, green, blue.

    Raises:
        MapError: an encoding that is not read, or fewer bytes than the message says.
    """
    return _compressed(message, topic) if kind.endswith("CompressedImage") else _plain(message, topic)


def camera_of(message: Any, topic: str) -> CameraModel:
    """The lens in a ``CameraInfo``: its projection where it is rectified, else its matrix.

    Raises:
        MapError: no lens can be like that.
    """
    p, k = np.asarray(message.p, float), np.asarray(message.k, float)
    fx, fy, cx, cy = (p[0], p[5], p[2], p[6]) if p[0] > 0 else (k[0], k[4], k[2], k[5])
    return checked_camera(
        width=int(message.width),
        height=int(message.height),
        fx=float(fx),
        fy=float(fy),
        cx=float(cx) + 0.5,
        cy=float(cy) + 0.5,
        name=topic,
    )


def stamp_s(message: Any) -> float:
    """Time in the message's header, seconds."""
    stamp = message.header.stamp
    return float(stamp.sec) + 1e-9 * float(stamp.nanosec)


def _plain(message: Any, topic: str) -> NDArray[Any]:
    if message.encoding not in _KINDS:
        raise MapError(f"{topic}: pictures encoded as '{message.encoding}' are not read; known: {', '.join(_KINDS)}")
    kind, channels = _KINDS[message.encoding]
    item = np.dtype(kind).newbyteorder(">" if message.is_bigendian else "<")
    height, width, step = int(message.height), int(message.width), int(message.step)
    data = np.asarray(message.data, np.uint8)
    row = width * channels * item.itemsize
    if min(height, width) < 1 or step < row or data.size < step * height:
        raise MapError(f"{topic}: {data.size} bytes are no picture of {width} x {height}, {message.encoding}")
    rows = np.ascontiguousarray(data[: step * height].reshape(height, step)[:, :row])
    pixels = rows.view(item).reshape(height, width, channels).astype(kind)
    return _ordered(pixels, message.encoding.startswith("bgr"))


def _ordered(pixels: NDArray[Any], reverse: bool) -> NDArray[Any]:
    if pixels.shape[2] == 1:
        return pixels[..., 0]
    colours = pixels[..., :3]
    return np.ascontiguousarray(colours[..., ::-1]) if reverse else colours


def _compressed(message: Any, topic: str) -> NDArray[Any]:
    data = bytes(np.asarray(message.data, np.uint8))
    if "compressedDepth" in message.format:
        if "32FC1" in message.format:
            raise MapError(f"{topic}: compressed floating point depth is not read; record 16UC1 or the raw topic")
        data = data[12:]  # the transport's own header before the PNG
    try:
        with Image.open(io.BytesIO(data)) as picture:
            return np.asarray(picture)
    except (OSError, SyntaxError, ValueError, Image.DecompressionBombError) as error:
        raise MapError(f"{topic}: a compressed picture ({message.format}) cannot be read ({error})") from None
