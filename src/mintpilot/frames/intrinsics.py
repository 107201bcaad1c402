"""Lenses from files, and whether they can be true."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from pathlib import Path

import yaml

from mintpilot.core.errors import MapError
from mintpilot.core.observation import CameraModel

KINECT_F = 525.0
"""Focal length of the first Kinect at 640 x 480, pixels, as most recordings with it assume."""
_LEAST_FOV_RAD, _WIDEST_FOV_RAD = math.radians(10.0), math.radians(160.0)


def kinect(width: int, height: int) -> CameraModel:
    """The first Kinect's lens for pictures of that size; an assumption that must be said."""
    scale = width / 640.0
    return checked_camera(
        width=width, height=height, fx=KINECT_F * scale, fy=KINECT_F * scale, cx=width / 2, cy=height / 2, name="Kinect"
    )


def read_intrinsics(path: Path) -> CameraModel:
    """The lens in a JSON or YAML file.

    Understood are Open3D's form (``width``, ``height``, ``intrinsic_matrix`` column by column), plain keys (``width``,
    ``height``, ``fx``, ``fy``, ``cx``, ``cy``) and ROS camera files (``image_width``, ``camera_matrix``). All three
    place the centre of the first pixel at (0, 0).

    Raises:
        MapError: the file cannot be read, lacks a number, or no lens can be like that.
    """
    try:
        text = path.read_text("utf-8-sig")
        content = json.loads(text) if text.lstrip().startswith("{") else yaml.safe_load(text)
    except (OSError, ValueError, yaml.YAMLError, RecursionError) as error:
        raise MapError(f"intrinsics '{path}' cannot be read ({_first_line(error)}); give a JSON or YAML file") from None
    if not isinstance(content, Mapping):
        raise MapError(f"intrinsics '{path}' hold no keys; write {json.dumps(_EXAMPLE)}")
    numbers = _numbers(content, path)
    return checked_camera(
        width=int(numbers["width"]),
        height=int(numbers["height"]),
        fx=numbers["fx"],
        fy=numbers["fy"],
        cx=numbers["cx"] + 0.5,
        cy=numbers["cy"] + 0.5,
        name=str(path),
    )


_EXAMPLE = {"width": 640, "height": 480, "fx": 525.0, "fy": 525.0, "cx": 319.5, "cy": 239.5}


def checked_camera(*, width: int, height: int, fx: float, fy: float, cx: float, cy: float, name: str) -> CameraModel:
    """The lens, if there can be one like it; ``cx`` and ``cy`` count from the picture's corner.

    Raises:
        MapError: a number is not finite or not above 0, the principal point is outside the picture, or the field of
            view is none of a pinhole camera's.
    """
    if width < 1 or height < 1:
        raise MapError(f"{name}: a picture of {width} x {height} pixels is empty; mend width and height")
    for key, value, edge in (("fx", fx, width), ("fy", fy, height)):
        if not math.isfinite(value) or value <= 0:
            raise MapError(f"{name}: focal length {key} = {value:g} must be above 0 pixels; mend the intrinsics")
        view = 2 * math.atan(edge / 2 / value)
        if not _LEAST_FOV_RAD <= view <= _WIDEST_FOV_RAD:
            raise MapError(
                f"{name}: {key} = {value:g} at {edge} pixels is a field of view of {math.degrees(view):.0f} degrees; "
                "a pinhole camera has 10 to 160. Are the intrinsics those of another picture size?"
            )
    for key, value, edge in (("cx", cx, width), ("cy", cy, height)):
        if not math.isfinite(value) or not 0 <= value <= edge:
            raise MapError(f"{name}: principal point {key} = {value:g} must be inside the {edge} pixels; mend it")
    return CameraModel(width=width, height=height, fx=fx, fy=fy, cx=cx, cy=cy)


def _numbers(content: Mapping[str, object], path: Path) -> dict[str, float]:
    found: dict[str, object] = {key: content.get(key) for key in _EXAMPLE}
    found["width"] = found["width"] or content.get("image_width")
    found["height"] = found["height"] or content.get("image_height")
    columns = content.get("intrinsic_matrix")
    matrix = content.get("camera_matrix")
    rows = matrix.get("data") if isinstance(matrix, Mapping) else None
    if isinstance(columns, list) and len(columns) == 9:
        found |= {"fx": columns[0], "fy": columns[4], "cx": columns[6], "cy": columns[7]}
    elif isinstance(rows, list) and len(rows) == 9:
        found |= {"fx": rows[0], "fy": rows[4], "cx": rows[2], "cy": rows[5]}
    numbers: dict[str, float] = {}
    for key, value in found.items():
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise MapError(
                f"intrinsics '{path}': '{key}' is {value!r}, a number is wanted; write {json.dumps(_EXAMPLE)}"
            )
        numbers[key] = float(value)
    return numbers


def _first_line(error: Exception) -> str:
    text = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
    return text.splitlines()[0]
