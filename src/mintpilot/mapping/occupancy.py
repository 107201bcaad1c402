"""Maps that others made: ROS map_server files (a YAML file that names a picture).

Axes: the picture's columns run along x (east), its rows from the top down to the south, so that its lowest row is the
one with the least y. ``origin`` is the outer corner of the lower left pixel. The flat map becomes one layer of voxels
around the height at which it is flown.

**Rule for a pixel.** Its shade is the mean of its colours, from 0 (black) to 1 (white); its occupancy is 1 - shade, or
the shade with ``negate``. The first line that fits counts:

1. not wholly opaque (alpha channel, transparent colour or palette entry), in every mode: unknown;
2. ``raw``: the shade times 255, rounded, is the occupancy in percent; above 100: unknown; ``negate`` has no effect;
3. the shade `SAVED_UNKNOWN` of 255 (with ``negate`` its opposite): unknown;
4. more occupancy than ``occupied_thresh``: occupied;
5. less than ``free_thresh``: free;
6. else: unknown. In ``scale`` that is a probability, which is not known free either.

map_server differs where that is less careful: in ``trinary`` it averages the alpha channel in with the colours, and the
shade that map_saver writes for unknown cells is free to it with ``free_thresh: 0.25``, which map_saver writes, too.
"""

from __future__ import annotations

import math
from collections.abc import Hashable
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path
from typing import Any

import numpy as np
import yaml
from numpy.typing import NDArray

from mintpilot.core.errors import MapError
from mintpilot.core.geometry import GridFrame
from mintpilot.core.semantic_map import Cell, SemanticMap
from mintpilot.mapping.map_file import check_file
from mintpilot.mapping.picture_map import Shades, read_picture
from mintpilot.mapping.turned import turned_cells

MAX_YAML_BYTES = 100_000
"""Bytes of a map's YAML file, at most."""
MAX_ORIGIN_M = 1e7
"""Distance of an origin from 0 along each axis, metres, at most: beyond it cells are not told apart exactly."""
SAVED_UNKNOWN = 205
"""Shade, of 255, that map_saver writes for an unknown cell."""


class Mode(StrEnum):
    """How a pixel is understood, in the words of map_server."""

    TRINARY = "trinary"
    SCALE = "scale"
    RAW = "raw"


@dataclass(frozen=True, slots=True, kw_only=True)
class RosMapHeader:
    """What the YAML file of a map says."""

    image: Path
    """The picture, made absolute from the YAML file's folder."""
    resolution_m: float
    """Edge of a pixel, metres."""
    origin_m: tuple[float, float]
    """Outer corner of the lower left pixel, metres."""
    yaw_rad: float
    """How far the picture is turned about that corner, counter-clockwise, radians."""
    negate: bool
    """True when light means occupied."""
    occupied_thresh: float
    """Pixels with more occupancy than this are occupied."""
    free_thresh: float
    """Pixels with less occupancy than this are free."""
    mode: Mode = Mode.TRINARY


def load_ros_map(path: str | Path, *, height_m: float = 1.0) -> SemanticMap:
    """The map of a map_server YAML file as one layer of voxels at that height above ground.

    A turned map is laid on an upright grid so that nothing becomes free that is not (`turned_cells`).

    Raises:
        MapError: the file or its picture is missing, unreadable or malformed.
        LimitError: the picture has too many pixels.
    """
    header = read_ros_header(Path(path))
    cells, origin_m = read_cells(header)
    res = header.resolution_m
    frame = GridFrame(
        origin_m=(*origin_m, height_m - res / 2), resolution_m=res, shape=(1, cells.shape[0], cells.shape[1])
    )
    return SemanticMap(frame=frame, cells=cells[None])


def read_cells(header: RosMapHeader) -> tuple[NDArray[np.uint8], tuple[float, float]]:
    """State of each cell (ny, nx) of the picture that the header names, and the grid's corner of least x and y, metres.

    Raises as `load_ros_map`.
    """
    cells = read_picture(header.image, lambda shades, white: _states(shades, white, header), hidden=Cell.UNKNOWN)
    if not header.yaw_rad % (2 * math.pi):
        return cells, header.origin_m
    turned, corner = turned_cells(cells, header.yaw_rad)
    x, y = (float(o + c * header.resolution_m) for o, c in zip(header.origin_m, corner, strict=True))
    return turned, (x, y)


def _states(shades: Shades, white: int, header: RosMapHeader) -> NDArray[np.uint8]:
    """The states of shades (n,) from 0 to ``white``, by the rule above."""
    grey = shades / white
    if header.mode is Mode.RAW:
        percent = np.round(grey * 255)
        known, occupancy = percent <= 100, percent / 100
    else:
        saved = 255 - SAVED_UNKNOWN if header.negate else SAVED_UNKNOWN
        known, occupancy = np.round(grey * 255) != saved, grey if header.negate else 1 - grey
    states = np.full(len(shades), Cell.UNKNOWN, np.uint8)
    states[known & (occupancy < header.free_thresh)] = Cell.FREE
    states[known & (occupancy > header.occupied_thresh)] = Cell.OCCUPIED
    return states


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
    x, y, yaw = _origin(path, values["origin"])
    return RosMapHeader(
        image=path.parent / values["image"],
        resolution_m=resolution,
        origin_m=(x, y),
        yaw_rad=yaw,
        negate=_flag(path, values.get("negate", 0)),
        occupied_thresh=occupied,
        free_thresh=free,
        mode=_mode(path, values.get("mode", "trinary")),
    )


class _PlainLoader(yaml.SafeLoader):
    """Reads YAML without aliases, whose expansion a short file can make endless."""

    def compose_node(self, parent: Any, index: Any) -> Any:
        if self.check_event(yaml.AliasEvent):
            raise yaml.YAMLError("an alias (*name) is not allowed here")
        return super().compose_node(parent, index)

    def construct_mapping(self, node: Any, deep: bool = False) -> dict[Hashable, Any]:
        keys = [key.value for key, _ in node.value if isinstance(key, yaml.ScalarNode)]
        repeated = sorted({key for key in keys if keys.count(key) > 1})
        if repeated:
            raise yaml.YAMLError(f"{', '.join(repeated)} is given more than once")
        return super().construct_mapping(node, deep)


def _yaml_mapping(path: Path) -> dict[str, object]:
    check_file(path, MAX_YAML_BYTES)
    try:
        loader = _PlainLoader(path.read_bytes())
        try:
            values = loader.get_single_data()
        finally:
            loader.dispose()
    except OSError as error:
        raise MapError(f"map '{path}' cannot be read: {error.strerror}; give a file that you may read") from None
    except (yaml.YAMLError, ValueError, TypeError, RecursionError) as error:
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


def _origin(path: Path, value: object) -> tuple[float, float, float]:
    if not isinstance(value, list) or len(value) not in (2, 3):
        raise MapError(f"'{path}': origin {value!r} must be [x, y, yaw] of the lower left pixel")
    x, y, *rest = (_number(path, "origin", v) for v in value)
    if max(abs(x), abs(y)) > MAX_ORIGIN_M:
        raise MapError(f"'{path}': origin {value!r} must be within {MAX_ORIGIN_M:g} m of 0; use local coordinates")
    return (x, y, rest[0] if rest else 0.0)


def _flag(path: Path, value: object) -> bool:
    if value in (0, 1):  # True and False are equal to these
        return bool(value)
    raise MapError(f"'{path}': negate {value!r} must be 0 or 1")


def _mode(path: Path, value: object) -> Mode:
    try:
        return Mode(str(value))
    except ValueError:
        raise MapError(f"'{path}': mode {value!r} must be one of {', '.join(Mode)}") from None
