"""Maps that others made: ROS map_server files (a YAML file that names a picture).

Axes: the picture's columns run along x (east), its rows from the top down to the south, so that its lowest row is the
one with the least y. ``origin`` is the outer corner of the lower left pixel. The flat map becomes one layer of voxels
around the height at which it is flown.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path

import numpy as np
import yaml
from numpy.typing import NDArray

from mintpilot.core.errors import MapError
from mintpilot.core.geometry import Floats, GridFrame
from mintpilot.core.semantic_map import Cell, SemanticMap
from mintpilot.mapping.picture_map import read_picture

MAX_YAML_BYTES = 100_000
SAVED_UNKNOWN = 205
"""What map_saver writes for an unknown cell. With the thresholds that it writes beside it (``free_thresh: 0.25``),
map_server reads that shade as free; a drone must not."""


class Mode(StrEnum):
    """How a pixel is understood, in the words of map_server."""

    TRINARY = "trinary"
    """Dark: occupied; light: free; between the thresholds, and the shade `SAVED_UNKNOWN`: unknown."""
    SCALE = "scale"
    """As trinary; between the thresholds lies a probability, which is not known free: unknown."""
    RAW = "raw"
    """The pixel is the occupancy in percent, 0 to 100; above: unknown. ``negate`` has no effect."""


@dataclass(frozen=True, slots=True, kw_only=True)
class RosMapHeader:
    """What the YAML file of a map says."""

    image: Path
    """The picture, made absolute from the YAML file's folder."""
    resolution_m: float
    """Edge of a pixel, metres."""
    origin_m: tuple[float, float]
    """Outer corner of the lower left pixel, metres."""
    negate: bool
    """True when light means occupied."""
    occupied_thresh: float
    """Pixels with more occupancy than this are occupied."""
    free_thresh: float
    """Pixels with less occupancy than this are free."""
    mode: Mode = Mode.TRINARY


def load_ros_map(path: str | Path, *, height_m: float = 1.0) -> SemanticMap:
    """The map of a map_server YAML file as one layer of voxels at that height above ground.

    Pixels that are not opaque are unknown. A turned map (yaw other than 0) is refused.

    Raises:
        MapError: the file or its picture is missing, unreadable, malformed, or turned.
        LimitError: the picture has too many pixels.
    """
    header = read_ros_header(Path(path))
    cells = read_cells(header)[None]
    res = header.resolution_m
    frame = GridFrame(
        origin_m=(*header.origin_m, height_m - res / 2), resolution_m=res, shape=(1, cells.shape[1], cells.shape[2])
    )
    return SemanticMap(frame=frame, cells=cells)


def read_cells(header: RosMapHeader) -> NDArray[np.uint8]:
    """State of each cell (ny, nx) of the picture that the header names; raises as `load_ros_map`."""
    grey, opaque = read_picture(header.image)
    occupied, free = _thresholded(grey, header)
    cells = np.full(grey.shape, Cell.UNKNOWN, np.uint8)
    cells[free & opaque] = Cell.FREE
    cells[occupied & opaque] = Cell.OCCUPIED
    return cells


def _thresholded(grey: Floats, header: RosMapHeader) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Which pixels are occupied, and which free; both false: unknown."""
    if header.mode is Mode.RAW:
        percent = np.round(grey * 255)
        known = percent <= 100
        return known & (percent > header.occupied_thresh * 100), known & (percent < header.free_thresh * 100)
    occupancy = grey if header.negate else 1 - grey
    free = occupancy < header.free_thresh
    if header.mode is Mode.TRINARY and not header.negate:
        free &= np.round(grey * 255) != SAVED_UNKNOWN
    return occupancy > header.occupied_thresh, free


def read_ros_header(path: Path) -> RosMapHeader:
    """What the YAML file of a map says, checked. Raises `MapError` for all that is wrong with it."""
    values = _yaml_mapping(path)
    missing = [key for key in ("image", "resolution", "origin") if key not in values]
    if missing:
        raise MapError(f"'{path}' lacks {', '.join(missing)}; a map_server file has image, resolution and origin")
    if not isinstance(values["image"], str) or not values["image"]:
        raise MapError(f"'{path}': image {values['image']!r} must be the name of the picture")
    resolution = _number(path, "resolution", values["resolution"])
    if not 1e-4 <= resolution <= 1e4:
        raise MapError(f"'{path}': resolution {resolution} must be from 0.0001 to 10000 metres a pixel")
    free = _number(path, "free_thresh", values.get("free_thresh", 0.25))
    occupied = _number(path, "occupied_thresh", values.get("occupied_thresh", 0.65))
    if not 0 <= free < occupied <= 1:
        raise MapError(
            f"'{path}': free_thresh {free} and occupied_thresh {occupied} must be from 0 to 1, free below occupied"
        )
    return RosMapHeader(
        image=path.parent / values["image"],
        resolution_m=resolution,
        origin_m=_origin(path, values["origin"]),
        negate=_flag(path, values.get("negate", 0)),
        occupied_thresh=occupied,
        free_thresh=free,
        mode=_mode(path, values.get("mode", "trinary")),
    )


def _yaml_mapping(path: Path) -> dict[str, object]:
    try:
        with path.open("rb") as file:
            data = file.read(MAX_YAML_BYTES + 1)
        if len(data) > MAX_YAML_BYTES:
            raise MapError(f"'{path}' has more than {MAX_YAML_BYTES} bytes: that is no map_server file")
        values = yaml.safe_load(data)
    except FileNotFoundError:
        raise MapError(f"there is no map '{path}'; check the name, relative to the mission file") from None
    except OSError as error:
        raise MapError(f"map '{path}' cannot be read: {error.strerror}; give a file that you may read") from None
    except (yaml.YAMLError, ValueError, RecursionError) as error:
        first = str(error).splitlines()[0]
        raise MapError(f"'{path}' is not YAML ({first}); give the YAML file that map_server saved") from None
    if not isinstance(values, dict):
        raise MapError(f"'{path}' is no map_server file: it must hold keys such as image, resolution and origin")
    return values


def _number(path: Path, name: str, value: object) -> float:
    # YAML 1.1 reads 5e-2 as text.
    if not isinstance(value, bool) and isinstance(value, int | float | str):
        try:
            number = float(value)
        except (ValueError, OverflowError):
            number = math.nan
        if math.isfinite(number):
            return number
    raise MapError(f"'{path}': {name} {value!r} must be a finite number")


def _origin(path: Path, value: object) -> tuple[float, float]:
    if not isinstance(value, list) or len(value) not in (2, 3):
        raise MapError(f"'{path}': origin {value!r} must be [x, y, yaw] of the lower left pixel")
    x, y, *rest = (_number(path, "origin", v) for v in value)
    if rest and abs(rest[0]) > 1e-6:
        raise MapError(
            f"'{path}': origin has yaw {rest[0]}, turned maps are not read; turn the picture and set yaw to 0"
        )
    return (x, y)


def _flag(path: Path, value: object) -> bool:
    if value in (0, 1):  # True and False are equal to these
        return bool(value)
    raise MapError(f"'{path}': negate {value!r} must be 0 or 1")


def _mode(path: Path, value: object) -> Mode:
    try:
        return Mode(str(value))
    except ValueError:
        raise MapError(f"'{path}': mode {value!r} must be one of {', '.join(Mode)}") from None
