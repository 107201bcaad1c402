"""Pictures as occupancy, row 0 being the southern edge: each shade is looked up in a table."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from mintpilot.core.errors import LimitError, MapError
from mintpilot.mapping.map_file import check_file

if TYPE_CHECKING:
    from PIL import Image

MAX_CELLS = 260_000_000
"""Cells of a map file, at most, that are read: 3 bytes of memory each, 7 for coloured pictures."""
MAX_BYTES = 1_100_000_000
"""Bytes of a map file, at most."""
FORMATS = ("PPM", "PNG", "BMP", "TIFF", "WEBP", "GIF")
"""Formats that are read (PPM stands for PGM, too). Others may start helper programs, or blur what they show."""
_BLOCK_PIXELS = 4_000_000
_EXPANDED = {"L;2": 85, "L;4": 17}
"""What Pillow multiplies the grey values of pictures with few bits a pixel with, but not their transparent one, by the
name of the coding."""

Shades = NDArray[np.int64]
LookUp = Callable[[Shades, int], NDArray[np.uint8]]
"""The states of shades (n,), each from 0 (black) to the given number (white)."""


def check_size(name: str | Path, width: int, height: int, depth: int = 1) -> None:
    """Refuses maps without cells, and those larger than `MAX_CELLS`.

    Raises:
        MapError: an edge is below one cell.
        LimitError: there are more cells than `MAX_CELLS`.
    """
    if min(width, height, depth) < 1:
        raise MapError(f"'{name}' is empty: {width} x {height} x {depth} cells; give at least one cell along each axis")
    if width * height * depth > MAX_CELLS:
        raise LimitError(
            f"'{name}' has {width * height * depth} cells, more than the {MAX_CELLS} that are read; "
            "cut the map to the part that is flown, or make it coarser"
        )


def read_picture(path: Path, look_up: LookUp, *, hidden: int) -> NDArray[np.uint8]:
    """The state of each pixel, (rows, columns), row 0 the lowest.

    Colours are averaged. Pixels that are not wholly opaque (by an alpha channel, or because their grey value, colour or
    palette entry is marked as transparent) show nothing.

    Args:
        path: a PGM, PPM, PNG, BMP, TIFF, WebP or GIF file, none of which compressed with losses.
        look_up: gives the states of shades.
        hidden: state of pixels that are not wholly opaque.

    Raises:
        MapError: the file is missing, unreadable, truncated, no picture, or one of another format.
        LimitError: it has more than `MAX_CELLS` pixels.
    """
    from PIL import Image, UnidentifiedImageError

    check_file(path, MAX_BYTES, "picture")
    try:
        _refuse_lossy(path)
        with _any_size(), Image.open(path, formats=FORMATS) as picture:
            check_size(path, *picture.size)
            if picture.mode == "F" or picture.info.get("compression") in ("jpeg", "tiff_jpeg", "webp"):
                raise MapError(f"'{path}' has pixels that are no plain shades; save the map as PGM or PNG")
            return _states(picture, look_up, hidden)
    except UnidentifiedImageError:
        raise MapError(f"'{path}' is not a picture that can be read; save the map as PGM or PNG") from None
    except (OSError, ValueError, SyntaxError, EOFError, OverflowError, MemoryError) as error:
        raise MapError(f"'{path}' cannot be read: {error}; it may be truncated, copy or export it again") from None


@contextmanager
def _any_size() -> Iterator[None]:
    """Lets Pillow open pictures of any size: `check_size` bounds it."""
    from PIL import Image

    before = Image.MAX_IMAGE_PIXELS
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            Image.MAX_IMAGE_PIXELS = None
            yield
    finally:
        Image.MAX_IMAGE_PIXELS = before


def _refuse_lossy(path: Path) -> None:
    with path.open("rb") as file:
        head = file.read(12)
        name = "JPEG" if head.startswith(b"\xff\xd8") else ""
        chunk = file.read(8) if head[:4] == b"RIFF" and head[8:] == b"WEBP" else b""
        while len(chunk) == 8 and not name:
            name = "lossy WebP" if chunk[:4] in (b"VP8 ", b"ANMF") else ""
            size = int.from_bytes(chunk[4:], "little")
            file.seek(size + size % 2, 1)
            chunk = file.read(8)
    if name:
        raise MapError(
            f"'{path}' is a {name} picture: its compression changes shades, so that walls and what nobody has seen may "
            "look free; export the map again as PGM or PNG"
        )


def _states(picture: Image.Image, look_up: LookUp, hidden: int) -> NDArray[np.uint8]:
    """All pixels' states, block by block of rows, so that little more than the picture itself is held."""
    tiles = getattr(picture, "tile", [])
    coding = tiles[0][3] if tiles else ""
    coding = str(coding[0] if isinstance(coding, tuple) else coding)
    picture.load()
    width, height = picture.size
    states = np.empty((height, width), np.uint8)
    rows = max(1, _BLOCK_PIXELS // width)
    for top in range(0, height, rows):
        bottom = min(height, top + rows)
        shades, white, opaque = _shades(picture, (0, top, width, bottom), coding)
        block = look_up(np.arange(white + 1), white)[shades]
        if opaque is not None:
            block[~opaque] = hidden
        states[height - bottom : height - top] = block[::-1]
    return states


def _shades(
    picture: Image.Image, box: tuple[int, int, int, int], coding: str
) -> tuple[NDArray[np.integer], int, NDArray[np.bool_] | None]:
    """Shades of a part of the picture, the shade of white, and which pixels are opaque (None: all)."""
    part = picture.crop(box)
    clear = picture.info.get("transparency")
    if picture.mode.startswith("I"):  # 16 bits a pixel; Pillow scales PGM to 0 … 65535
        deep = np.asarray(part).astype(np.int64)
        if deep.min() < 0 or deep.max() > 65535:
            raise ValueError("its values are outside 0 to 65535")
        return deep, 65535, deep != clear if isinstance(clear, int) else None
    if picture.mode in ("1", "L"):
        grey = np.asarray(part.convert("L") if picture.mode == "1" else part)
        return grey, 255, grey != clear * _EXPANDED.get(coding, 1) if isinstance(clear, int) else None
    if picture.mode == "RGB":
        colour = np.asarray(part)
        opaque = None
        if isinstance(clear, tuple):  # of 16 bits, Pillow keeps the upper 8 of a pixel, but all of this colour
            opaque = (colour != np.array(clear) >> (8 if "16" in coding else 0)).any(axis=2)
        return colour.sum(axis=2, dtype=np.uint16), 765, opaque
    pixels = np.asarray(part.convert("RGBA"))
    return pixels[..., :3].sum(axis=2, dtype=np.uint16), 765, pixels[..., 3] == 255
