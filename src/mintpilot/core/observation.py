"""What the drone sees [V] and what it makes of one picture [O]."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

from mintpilot.core.errors import MapError
from mintpilot.core.geometry import Box, Floats, Vec3, frozen


@dataclass(frozen=True, slots=True, kw_only=True)
class CameraModel:
    """A pinhole camera without distortion; pixel (0, 0) is the top-left one, its centre at (0.5, 0.5)."""

    width: int
    """Pixels across."""
    height: int
    """Pixels down."""
    fx: float
    """Focal length in pixels, horizontally."""
    fy: float
    """Focal length in pixels, vertically."""
    cx: float
    """Principal point, pixels from the left edge."""
    cy: float
    """Principal point, pixels from the top edge."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Frame:
    """One RGB-D picture.

    The camera frame is the optical one: x right, y down, z forward. Depth is measured along z.
    """

    time_s: float
    """When it was taken, seconds on the vehicle's clock."""
    rgb: NDArray[np.uint8]
    """Colours (height, width, 3)."""
    depth_m: NDArray[np.float32]
    """Distance along the optical axis (height, width), metres; NaN or 0 where the sensor got no return."""
    camera: CameraModel
    """The lens."""
    world_from_camera: Floats
    """Pose of the camera's optical frame, homogeneous (4, 4)."""

    def __post_init__(self) -> None:
        size = (self.camera.height, self.camera.width)
        if self.rgb.shape != (*size, 3) or self.depth_m.shape != size:
            raise MapError(
                f"picture {self.rgb.shape} with depth {self.depth_m.shape}: the camera model says {size}; "
                "register depth to colour and give both the camera's size"
            )
        if self.world_from_camera.shape != (4, 4) or not np.isfinite(self.world_from_camera).all():
            raise MapError("camera pose must be a finite (4, 4) matrix; drop the frame or mend the pose")
        for array in (self.rgb, self.depth_m, self.world_from_camera):
            frozen(array)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class RawFrame:
    """One RGB-D picture as its source gives it, before its pose and its units were checked."""

    time_s: float
    """When it was taken, seconds on the source's clock."""
    rgb: NDArray[np.uint8]
    """Colours (height, width, 3)."""
    depth_m: NDArray[np.float32]
    """Distance along the optical axis (height, width), metres; 0 where the sensor got no return."""
    camera: CameraModel
    """The lens."""
    source_from_camera: Floats | None = None
    """Pose of the optical frame in the source's own world, homogeneous (4, 4), not checked; None: not known."""

    def __post_init__(self) -> None:
        for array in (self.rgb, self.depth_m, self.source_from_camera):
            if array is not None:
                frozen(array)


class RegionKind(StrEnum):
    """Volumes whose passability a camera cannot settle, or that somebody declared uncertain."""

    SMOKE = "smoke"
    DOOR = "door"
    AREA = "area"


@dataclass(frozen=True, slots=True, kw_only=True)
class Attribute:
    """One thing that can be said of an object, e.g. ``colour: red``. An object may have several of one name."""

    name: str
    value: str


OBJECT = "object"
"""Label of what nobody can name."""
PERSON = "person"
"""Label of people, in any posture."""


@dataclass(frozen=True, slots=True, kw_only=True)
class NameGuess:
    """A name that a thing may have."""

    label: str
    """Semantic class, e.g. ``can``."""
    probability: float
    """That the thing is one, 0 to 1."""


def chance_of(names: Iterable[NameGuess], label: str) -> float:
    """Probability of one of several names; 0 where it is not among them."""
    return next((guess.probability for guess in names if guess.label == label), 0.0)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Segment:
    """One body in a picture, whatever it is: found by its geometry, not named yet."""

    mask: NDArray[np.bool_]
    """Its pixels (height, width)."""
    points_m: Floats
    """World points (n, 3) of its pixels, in the order of ``mask``."""
    normals: Floats
    """Unit vectors (n, 3) of its surface towards the camera; 0 where they cannot be told."""
    box_m: Box
    """Extent of what is seen of it, down to what it stands on."""
    stands_on_m: float
    """Height of what is below it."""
    on_floor: bool
    """Whether that is the floor, and not a table or a shelf."""
    cut: bool
    """Whether a part of it is outside of the picture."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Detection:
    """One object found in one frame."""

    label: str
    """Semantic class: ``box``, ``person``, ``fire``, ``smoke``, ``glow`` (of flames hidden in smoke), ``door`` …"""
    score: float
    """Confidence, 0 to 1."""
    box_m: Box
    """Extent in the world."""
    attributes: tuple[Attribute, ...] = ()
    """Colour, size, shape …, in plain words."""
    pixels: tuple[int, int, int, int] = (0, 0, 0, 0)
    """Bounding box in the picture: left, top, right, bottom (exclusive)."""
    points_m: Floats | None = None
    """Some of its surface points (n, 3) in the world; for smoke, points inside the visible front."""
    frame_index: int = -1
    """Which frame it came from, for provenance."""
    names: tuple[NameGuess, ...] = ()
    """Names that a segment may have, likeliest first; what is missing to 1 is for none of them. Empty for detectors
    that look for one class only: their ``label`` and ``score`` say all."""

    @property
    def position_m(self) -> Vec3:
        """Centre of the extent, metres."""
        return self.box_m.centre_m
