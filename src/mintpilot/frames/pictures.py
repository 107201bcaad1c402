"""Colour and depth pictures of any common kind into the one form of `RawFrame`, and what is wrong with them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from mintpilot.core.errors import MapError
from mintpilot.core.geometry import Floats
from mintpilot.core.observation import CameraModel, RawFrame
from mintpilot.frames.intrinsics import checked_camera

MILLIMETRE_M = 0.001
LARGEST_PIXELS = 50_000_000
"""Larger pictures are refused: no depth camera makes them."""


def read_color(path: Path) -> NDArray[np.uint8]:
    """The colours (h, w, 3) of a picture file. Raises `MapError` when it cannot be read."""
    return as_color(_read(path), str(path))


def read_depth(path: Path, unit_m: float | None) -> NDArray[np.float32]:
    """The depth (h, w), metres, of a picture file of whole numbers, or of floating point metres.

    Args:
        path: 16-bit PNG or TIFF, or a floating point TIFF.
        unit_m: metres in one step of whole numbers; None: millimetres.

    Raises:
        MapError: it cannot be read, or is no depth.
    """
    return as_depth(_read(path), unit_m or MILLIMETRE_M, str(path))


def as_color(pixels: NDArray[Any], name: str) -> NDArray[np.uint8]:
    """Any picture as 8-bit red, green, blue (h, w, 3).

    Grey becomes three equal channels, transparency is dropped, 16 bits are shortened; floating point is taken for 0 to
    1 where nothing is above 1, else for 0 to 255.

    Raises:
        MapError: it has another number of channels, or is empty.
    """
    if pixels.ndim == 2:
        pixels = np.repeat(pixels[..., None], 3, axis=2)
    if pixels.ndim != 3 or pixels.shape[2] not in (3, 4) or not pixels.size:
        raise MapError(f"{name}: a colour picture has 1, 3 or 4 channels, this one has the shape {pixels.shape}")
    pixels = pixels[..., :3]
    if pixels.dtype == np.uint16:
        pixels = pixels >> 8
    elif np.issubdtype(pixels.dtype, np.floating):
        finite = np.nan_to_num(pixels, nan=0.0, posinf=0.0, neginf=0.0)
        pixels = np.clip(finite * (255.0 if finite.max(initial=0.0) <= 1.0 else 1.0), 0, 255)
    elif pixels.dtype == np.bool_:
        pixels = pixels * 255
    return np.ascontiguousarray(pixels.astype(np.uint8))


def as_depth(pixels: NDArray[Any], unit_m: float, name: str) -> NDArray[np.float32]:
    """Any depth picture (h, w) in metres; what is not finite or below 0 becomes 0, no return.

    Raises:
        MapError: it is no single channel of numbers, has 8 bits only, or the unit is not above 0.
    """
    if pixels.ndim != 2 or not pixels.size:
        raise MapError(f"{name}: a depth picture has one channel, this one has the shape {pixels.shape}")
    if not np.isfinite(unit_m) or unit_m <= 0:
        raise MapError(f"depth unit {unit_m:g} m must be above 0; 0.001 means millimetres")
    if np.issubdtype(pixels.dtype, np.floating):
        depth = pixels.astype(np.float32)
    elif pixels.dtype.itemsize == 1:
        raise MapError(f"{name}: 8 bits a pixel are no depth; give the 16-bit original or floating point metres")
    else:
        depth = (pixels.astype(np.float64) * unit_m).astype(np.float32)
    return np.where(np.isfinite(depth) & (depth > 0), depth, np.float32(0)).astype(np.float32)


def joined(
    rgb: NDArray[np.uint8],
    depth_m: NDArray[np.float32],
    camera: CameraModel,
    *,
    time_s: float,
    pose: Floats | None,
    name: str,
) -> RawFrame:
    """Colour and depth of one view, brought to the size of the depth.

    Raises:
        MapError: the two show different parts of the world, or the lens is that of neither.
    """
    height, width = depth_m.shape
    if rgb.shape[:2] != (height, width):
        if abs(rgb.shape[1] / rgb.shape[0] - width / height) > 0.01:
            raise MapError(
                f"{name}: colour of {rgb.shape[1]} x {rgb.shape[0]} and depth of {width} x {height} pixels have "
                "different proportions; register the depth to the colour first"
            )
        rgb = np.asarray(Image.fromarray(rgb).resize((width, height), Image.Resampling.BOX))
    if (camera.width, camera.height) != (width, height):
        camera = _scaled(camera, width, height, name)
    return RawFrame(time_s=time_s, rgb=rgb, depth_m=depth_m, camera=camera, source_from_camera=pose)


def _scaled(camera: CameraModel, width: int, height: int, name: str) -> CameraModel:
    """The lens for a picture of another size with the same proportions."""
    if abs(camera.width / camera.height - width / height) > 0.01:
        raise MapError(
            f"{name}: intrinsics for {camera.width} x {camera.height} pixels, pictures of {width} x {height}; "
            "give those of these pictures"
        )
    scale = width / camera.width
    return checked_camera(
        width=width,
        height=height,
        fx=camera.fx * scale,
        fy=camera.fy * scale,
        cx=camera.cx * scale,
        cy=camera.cy * scale,
        name=name,
    )


def _read(path: Path) -> NDArray[Any]:
    try:
        with Image.open(path) as picture:
            if picture.width * picture.height > LARGEST_PIXELS:
                raise MapError(f"picture '{path}' of {picture.width} x {picture.height} pixels is too large; shrink it")
            if picture.mode in ("P", "CMYK", "YCbCr", "LA"):
                return np.asarray(picture.convert("RGB"))
            return np.asarray(picture)
    except FileNotFoundError:
        raise MapError(f"there is no picture '{path}'; check the name") from None
    except (OSError, SyntaxError, ValueError, Image.DecompressionBombError) as error:
        raise MapError(f"picture '{path}' cannot be read ({error}); it may be cut short or no picture") from None
