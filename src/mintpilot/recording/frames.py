"""The pictures of a run: all that were taken lately while it runs, a chosen few at its end."""

from __future__ import annotations

import io
from collections.abc import Iterable
from pathlib import Path

from PIL import Image, ImageDraw

from mintpilot.core.observation import Frame

FRAMES = "frames"
"""Folder of the pictures within a run folder."""
MAX_IN_FLIGHT = 400
"""Pictures on disk while the mission runs; beyond it every second one goes."""
MAX_SAMPLES = 8
"""Pictures kept at the end besides those that show where something was found."""


class FrameStore:
    """Pictures in one folder, named by their index: ``00012.jpg``.

    JPEG, because a picture is written in a few milliseconds and serves people, not measurements.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._kept: set[int] = set()

    def add(self, index: int, frame: Frame) -> None:
        """Writes one picture. Raises `OSError` when it cannot."""
        if len(self._kept) >= MAX_IN_FLIGHT:
            self._drop(sorted(self._kept)[1::2])
        write_jpeg(self.file(index), frame)
        self._kept.add(index)

    def prune(self, referenced: Iterable[int]) -> None:
        """Keeps the referenced pictures and `MAX_SAMPLES` others, evenly spread."""
        wanted = set(referenced)
        others = sorted(self._kept - wanted)
        step = max(len(others) / MAX_SAMPLES, 1.0)
        spread = {others[int(i * step)] for i in range(min(MAX_SAMPLES, len(others)))}
        self._drop(self._kept - wanted - spread)

    def file(self, index: int) -> Path:
        """Where that picture is, or would be."""
        return self._folder / frame_name(index)

    def _drop(self, indices: Iterable[int]) -> None:
        for index in list(indices):
            self.file(index).unlink(missing_ok=True)
            self._kept.discard(index)


def frame_name(index: int) -> str:
    """Name of the file of a picture."""
    return f"{index:05d}.jpg"


def write_jpeg(file: Path, frame: Frame) -> None:
    """Writes the picture into that file; makes its folder. Raises `OSError` when it cannot."""
    buffer = io.BytesIO()
    Image.fromarray(frame.rgb).save(buffer, "JPEG", quality=88)
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_bytes(buffer.getvalue())


def crop_jpeg(file: Path, pixels: tuple[int, int, int, int], *, width: int = 360, height: int = 240) -> bytes | None:
    """A close-up of a part of a picture with a frame drawn around it, as JPEG; None where there is no such picture.

    Args:
        file: the picture.
        pixels: left, top, right, bottom of the part.
        width: of the result, pixels.
        height: of the result, pixels.
    """
    try:
        with Image.open(file) as opened:
            image = opened.convert("RGB")
    except OSError:
        return None
    left, top, right, bottom = pixels
    scale = max((right - left) * 1.6 / width, (bottom - top) * 1.6 / height, 80 / width)
    scale = min(scale, image.width / width, image.height / height)
    wide, tall = width * scale, height * scale
    x0 = min(max((left + right - wide) / 2, 0), image.width - wide)
    y0 = min(max((top + bottom - tall) / 2, 0), image.height - tall)
    view = image.resize((width, height), Image.Resampling.LANCZOS, box=(x0, y0, x0 + wide, y0 + tall))
    box = tuple(((p - o) / scale) for p, o in zip(pixels, (x0, y0, x0, y0), strict=True))
    draw = ImageDraw.Draw(view)
    draw.rectangle(_inside(box, width, height, 1), outline=(20, 20, 20), width=5)
    draw.rectangle(_inside(box, width, height, 2), outline=(255, 214, 64), width=3)
    return jpeg(view)


def jpeg(image: Image.Image) -> bytes:
    """A picture as JPEG."""
    buffer = io.BytesIO()
    image.save(buffer, "JPEG", quality=84)
    return buffer.getvalue()


def _inside(box: tuple[float, ...], width: int, height: int, inset: int) -> tuple[float, float, float, float]:
    """The box clipped to the picture, with its corners in order."""
    left, top = min(max(box[0], inset), width - inset - 2), min(max(box[1], inset), height - inset - 2)
    return (left, top, max(left + 1, min(box[2], width - inset)), max(top + 1, min(box[3], height - inset)))
