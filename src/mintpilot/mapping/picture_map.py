"""Pictures as occupancy: the grey values of a map or mask, row 0 being the southern edge."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image, UnidentifiedImageError

from mintpilot.core.errors import LimitError, MapError
from mintpilot.core.geometry import Floats

MAX_CELLS = 20_000_000
"""Most cells of a map that is loaded: 1 GB of memory while planning."""


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


def read_picture(path: Path) -> tuple[Floats, NDArray[np.bool_]]:
    """Grey values from 0 (black) to 1 (white) and which pixels are opaque, both (rows, columns), row 0 the lowest.

    Colours are averaged, as map_server does. PGM (P2, P5) and PNG are usual; whatever Pillow reads is taken.

    Raises:
        MapError: the file is missing, unreadable, truncated or no picture.
        LimitError: it has more than `MAX_CELLS` pixels.
    """
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", Image.DecompressionBombWarning)
            with Image.open(path) as picture:
                check_size(path, *picture.size)
                grey, opaque = _grey(picture)
    except FileNotFoundError:
        raise MapError(f"there is no picture '{path}'; check 'image' in the map's YAML file") from None
    except Image.DecompressionBombError as error:
        raise LimitError(f"'{path}' is too large a picture ({error}); cut it to the part that is flown") from None
    except UnidentifiedImageError:
        raise MapError(f"'{path}' is not a picture that can be read; save the map as PGM or PNG") from None
    except (OSError, ValueError, SyntaxError, EOFError) as error:
        raise MapError(f"'{path}' cannot be read: {error}; it may be truncated, copy or export it again") from None
    return np.ascontiguousarray(grey[::-1]), np.ascontiguousarray(opaque[::-1])


def _grey(picture: Image.Image) -> tuple[Floats, NDArray[np.bool_]]:
    """Grey values and opaqueness, row 0 at the top as in the file."""
    if picture.mode.startswith(("I", "F")):  # 16 bits a pixel; Pillow scales PGM to 0 … 65535
        grey = np.asarray(picture, float) / 65535
        if grey.size and (not np.isfinite(grey).all() or grey.min() < 0 or grey.max() > 1):
            raise ValueError("its values are outside 0 to 65535")
        return grey, np.ones(grey.shape, bool)
    if picture.mode in ("1", "L"):
        grey = np.asarray(picture.convert("L"), float) / 255
        return grey, np.ones(grey.shape, bool)
    pixels = np.asarray(picture.convert("RGBA"))
    grey = pixels[..., :3].mean(axis=2) / 255
    return grey, pixels[..., 3] == 255
