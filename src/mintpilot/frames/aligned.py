"""From a source to frames in a world with z up: poses checked, gravity and floor estimated where they are not known."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import chain, islice

import numpy as np

from mintpilot.core.geometry import Floats
from mintpilot.core.observation import Frame, RawFrame
from mintpilot.core.ports import FrameSource
from mintpilot.frames.checks import checked_pose, checked_track, checked_unit, seen_faults
from mintpilot.frames.consistency import LEAST_OVERLAP, agreement, relative
from mintpilot.frames.gravity import Level, floor_along, level_of, patches_of
from mintpilot.frames.rotations import turning

PROBED = 12
"""Frames that are looked at before any is passed on."""
ON_AXIS_RAD = math.radians(3.0)
"""Up that is so near to an axis of the source's world is that axis."""
LEVEL_RAD = math.radians(10.0)
"""A source whose z is up may deviate by no more from what depth says."""
HELD_M = 4.0
"""A picture without a pose from higher up is worth a doubt about its depth unit."""
FITS = 0.3
"""Frames of which less fits the one before have jumped."""
_OUT_OF_ORDER = "out of order"
_JUMPED = "jumped"
_NO_POSE = "without a pose"


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Setting:
    """How the world of a source lies in ours."""

    world_from_source: Floats
    """Rigid motion (4, 4) that every pose was moved by."""
    floor_m: float
    """Height of the lowest level surface that was seen; 0 where none was."""
    floor_seen: bool
    """False: no level surface was seen, and the height is a guess."""
    posed: bool
    """False: the pictures have no pose; the first one stands at the origin, looking along x."""


@dataclass(slots=True)
class AlignedFrames:
    """The usable frames of a source. Iterate it once; then `warnings` is complete.

    Raises while it is made or iterated:
        MapError: nothing can be read, or units or poses are wrong; the message names how.
    """

    source: FrameSource
    setting: Setting = field(init=False)
    _rest: Iterator[RawFrame] = field(init=False)
    _probe: tuple[RawFrame, ...] = field(init=False)
    _said: list[str] = field(init=False, default_factory=list)
    _left_out: Counter[str] = field(init=False, default_factory=Counter)
    used: int = field(init=False, default=0)

    def __post_init__(self) -> None:
        frames = self.source.frames()
        self._probe = tuple(islice(frames, PROBED))
        self._rest = frames
        checked_unit(self._probe)
        self._said += seen_faults(self._probe)
        posed = [f for f in self._probe if f.source_from_camera is not None]
        for number, frame in enumerate(posed):
            assert frame.source_from_camera is not None
            checked_pose(frame.source_from_camera, number)
        checked_track(posed)
        self.setting = self._setting(posed or list(self._probe[:1]), bool(posed))

    @property
    def warnings(self) -> tuple[str, ...]:
        """What the person should know, a sentence each."""
        left_out = [f"{n} frames {why} were left out." for why, n in sorted(self._left_out.items())]
        return (*self.source.remarks(), *self._said, *left_out)

    def __iter__(self) -> Iterator[Frame]:
        last: RawFrame | None = None
        for number, raw in enumerate(chain(self._probe, self._rest)):
            why = self._fault(raw, last, number)
            if why:
                self._left_out[why] += 1
                continue
            last = raw
            pose = np.eye(4) if raw.source_from_camera is None else checked_pose(raw.source_from_camera, number)
            self.used += 1
            yield Frame(
                time_s=raw.time_s,
                rgb=raw.rgb,
                depth_m=raw.depth_m,
                camera=raw.camera,
                world_from_camera=self.setting.world_from_source @ pose,
            )

    def _fault(self, raw: RawFrame, last: RawFrame | None, number: int) -> str:
        """Why a frame is left out; empty for a good one."""
        if not self.setting.posed:
            return "" if number == 0 else f"{_NO_POSE} after the first one"
        if raw.source_from_camera is None:
            return _NO_POSE
        if last is None:
            return ""
        if raw.time_s <= last.time_s:
            return _OUT_OF_ORDER
        assert last.source_from_camera is not None
        fit = agreement(raw, last, relative(raw.source_from_camera, last.source_from_camera))
        return f"whose pose {_JUMPED}" if fit.overlap > LEAST_OVERLAP and fit.agreeing < FITS else ""

    def _setting(self, frames: list[RawFrame], posed: bool) -> Setting:
        patches = patches_of(frames)
        level = level_of(patches)
        if self.source.z_is_up and posed:
            return self._checked_up(level, patches_floor=floor_along(patches, np.array([0.0, 0.0, 1.0])))
        if level is None:
            self._said.append("No level surface is in view: up is taken from the camera, which may be tilted.")
        up = level.up if level is not None else _up_of_cameras(frames)
        up = _snapped(up) if posed else up
        floor = level.floor if level is not None else None
        matrix = np.eye(4)
        matrix[:3, :3] = turning(up, np.array([0.0, 0.0, 1.0]))
        if not posed:
            matrix[:3, :3] = _facing_x(matrix[:3, :3])
            if floor is not None and -floor > HELD_M:
                self._said.append(
                    f"The camera would be {-floor:.1f} m above the lowest surface; if it was not, the depth unit is "
                    "wrong (TUM: --depth-unit 0.0002)."
                )
        matrix[2, 3] = -(floor if floor is not None else 0.0)
        if posed and math.acos(float(np.clip(up[2], -1, 1))) > ON_AXIS_RAD:
            self._said.append(
                "The source's world does not have z up: it was turned and moved so that the lowest level surface is at "
                "z = 0; see world_from_source."
            )
        self._say_floor(floor is not None)
        return Setting(world_from_source=matrix, floor_m=0.0, floor_seen=floor is not None, posed=posed)

    def _checked_up(self, level: Level | None, *, patches_floor: float | None) -> Setting:
        if level is not None:
            off = math.acos(float(np.clip(level.up[2], -1, 1)))
            if off > LEVEL_RAD and level.share > 0.2:
                self._said.append(
                    f"Level surfaces are {math.degrees(off):.0f} degrees off z: are the poses those of another frame "
                    "than the optical one?"
                )
        self._say_floor(patches_floor is not None)
        return Setting(
            world_from_source=np.eye(4),
            floor_m=patches_floor if patches_floor is not None else 0.0,
            floor_seen=patches_floor is not None,
            posed=True,
        )

    def _say_floor(self, seen: bool) -> None:
        if not seen:
            self._said.append("No floor is in view: heights are above an assumed floor.")


def _up_of_cameras(frames: list[RawFrame]) -> Floats:
    poses = [f.source_from_camera for f in frames if f.source_from_camera is not None]
    mean = np.mean([-p[:3, 1] for p in poses], axis=0) if poses else np.array([0.0, -1.0, 0.0])
    length = float(np.linalg.norm(mean))
    return mean / length if length > 1e-6 else np.array([0.0, 0.0, 1.0])


def _snapped(up: Floats) -> Floats:
    """The nearest axis where that is near: who records poses mostly has gravity along one."""
    axis = int(np.argmax(np.abs(up)))
    if math.acos(min(1.0, abs(float(up[axis])))) > ON_AXIS_RAD:
        return up
    snapped = np.zeros(3)
    snapped[axis] = np.sign(up[axis])
    return snapped


def _facing_x(rotation: Floats) -> Floats:
    """The rotation turned about z so that the camera looks along x."""
    ahead = rotation[:, 2]
    yaw = math.atan2(ahead[1], ahead[0])
    cosine, sine = math.cos(yaw), math.sin(yaw)
    turned: Floats = np.array([[cosine, sine, 0.0], [-sine, cosine, 0.0], [0.0, 0.0, 1.0]]) @ rotation
    return turned
