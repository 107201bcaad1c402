"""Recordings in folders: the layout of the TUM RGB-D benchmark, and colour, depth and a trajectory side by side."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar

import numpy as np

from mintpilot.core.errors import MapError
from mintpilot.core.geometry import Floats
from mintpilot.core.observation import CameraModel, RawFrame
from mintpilot.core.ports import FrameSource, SourceOptions
from mintpilot.frames.intrinsics import kinect, read_intrinsics
from mintpilot.frames.pictures import joined, read_color, read_depth
from mintpilot.frames.rotations import pose_of
from mintpilot.frames.single import ASSUMED_LENS

TUM_UNIT_M = 0.0002
"""One step of a depth picture of the TUM benchmark, metres."""
SAME_S = 0.03
"""Colour, depth and pose no further apart in time than this belong together."""
T = TypeVar("T")
_PICTURES = (".png", ".jpg", ".jpeg", ".tif", ".tiff", ".bmp", ".ppm", ".pgm")


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _View:
    time_s: float
    color: Path
    depth: Path
    pose: Floats | None


class _Folder:
    """What both layouts share: reading the pictures, and what is said in the end."""

    def __init__(self, root: Path, options: SourceOptions) -> None:
        self._root, self._options = root, options
        self._lens = options.intrinsics or _only_lens(root)
        self._said: list[str] = [] if self._lens is not None else [ASSUMED_LENS]

    def read(self, views: Sequence[_View], unit_m: float | None) -> Iterator[RawFrame]:
        """The views one after the other; one that cannot be read is left out and said, unless it is the first."""
        camera = read_intrinsics(self._lens) if self._lens is not None else None
        broken: list[str] = []
        for number, view in enumerate(views[:: self._options.every][: self._options.longest]):
            try:
                yield self._frame(view, camera, unit_m)
            except MapError as error:
                if number == 0:
                    raise
                broken.append(str(error))
        if broken:
            self._said.append(f"{len(broken)} frames could not be read and were left out, the first: {broken[0]}.")

    def said(self) -> tuple[str, ...]:
        return tuple(self._said)

    def say(self, text: str) -> None:
        self._said.append(text)

    def _frame(self, view: _View, camera: CameraModel | None, unit_m: float | None) -> RawFrame:
        rgb = read_color(view.color)
        depth = read_depth(view.depth, self._options.depth_unit_m or unit_m)
        lens = camera or kinect(rgb.shape[1], rgb.shape[0])
        return joined(rgb, depth, lens, time_s=view.time_s, pose=view.pose, name=str(view.color))


class TumFolder(FrameSource):
    """``rgb.txt``, ``depth.txt`` and, for poses, ``groundtruth.txt``, as the TUM RGB-D benchmark has them.

    Depth is in 1/5000 m unless the options say otherwise. An intrinsics JSON in the folder is used where there is one.
    """

    def __init__(self, where: str, options: SourceOptions) -> None:
        self._root = Path(where)
        self._folder = _Folder(self._root, options)

    @property
    def z_is_up(self) -> bool:
        """True: the benchmark's world has z up."""
        return True

    def frames(self) -> Iterator[RawFrame]:
        """The pictures that have a depth picture near in time; raises `MapError` as the port says."""
        colors, depths = _listed(self._root / "rgb.txt"), _listed(self._root / "depth.txt")
        track = self._root / "groundtruth.txt"
        poses = _tum_poses(track) if track.exists() else []
        views = []
        for time_s, name in colors:
            near = _nearest(depths, time_s)
            if near is None:
                continue
            color, depth = self._root / name, self._root / near
            views.append(_View(time_s=time_s, color=color, depth=depth, pose=_nearest(poses, time_s)))
        if not views:
            raise MapError(
                f"'{self._root}': no colour picture has depth within {SAME_S} s; do both lists use one clock?"
            )
        lonely = len(colors) - len(views)
        if lonely:
            self._folder.say(f"{lonely} of {len(colors)} colour pictures have no depth and were left out.")
        yield from self._folder.read(views, TUM_UNIT_M)

    def remarks(self) -> tuple[str, ...]:
        """What was assumed or left out."""
        return self._folder.said()


class TrajectoryFolder(FrameSource):
    """``color/``, ``depth/``, an intrinsics JSON, and ``trajectory.log`` with a 4 x 4 matrix for each frame.

    Pictures go together by their order. Depth is in millimetres unless the options say otherwise. Without a trajectory
    frames have no pose.
    """

    def __init__(self, where: str, options: SourceOptions) -> None:
        self._root = Path(where)
        self._folder = _Folder(self._root, options)

    @property
    def z_is_up(self) -> bool:
        """False: such recordings agree on no direction."""
        return False

    def frames(self) -> Iterator[RawFrame]:
        """The pictures in the order of their names; raises `MapError` as the port says."""
        colors, depths = _pictures(self._root / "color"), _pictures(self._root / "depth")
        if not colors or len(colors) != len(depths):
            raise MapError(
                f"'{self._root}': {len(colors)} pictures in color/ and {len(depths)} in depth/; "
                "each colour picture needs one of depth"
            )
        track = self._root / "trajectory.log"
        poses = _log_poses(track) if track.exists() else {}
        if poses and max(poses) >= len(colors):
            raise MapError(f"'{track}' speaks of frame {max(poses)}, but there are {len(colors)} pictures, from 0 on")
        views = [
            _View(time_s=float(i), color=color, depth=depth, pose=poses.get(i))
            for i, (color, depth) in enumerate(zip(colors, depths, strict=True))
        ]
        yield from self._folder.read(views, None)

    def remarks(self) -> tuple[str, ...]:
        """What was assumed or left out."""
        return self._folder.said()


def _only_lens(root: Path) -> Path | None:
    """The one intrinsics file of a folder."""
    named = [p for p in sorted(root.glob("*.json")) if any(w in p.name for w in ("intrinsic", "camera", "calib"))]
    return named[0] if named else None


def _pictures(folder: Path) -> list[Path]:
    return sorted(p for p in folder.glob("*") if p.suffix.lower() in _PICTURES)


def _lines(path: Path) -> list[list[str]]:
    try:
        text = path.read_text("utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise MapError(f"'{path}' cannot be read ({error}); it must be a text file") from None
    return [line.split() for line in text.splitlines() if line.strip() and not line.startswith("#")]


def _listed(path: Path) -> list[tuple[float, str]]:
    """Time and file name of each line, by time."""
    try:
        return sorted((float(words[0]), words[1]) for words in _lines(path))
    except (ValueError, IndexError):
        raise MapError(f"'{path}': each line must be a time and a file name") from None


def _tum_poses(path: Path) -> list[tuple[float, Floats]]:
    poses = []
    for words in _lines(path):
        try:
            time_s, x, y, z, qx, qy, qz, qw = (float(word) for word in words)
        except ValueError:
            raise MapError(f"'{path}': each line must be: time x y z qx qy qz qw; found {' '.join(words)}") from None
        poses.append((time_s, pose_of((x, y, z), (qx, qy, qz, qw))))
    return sorted(poses, key=lambda pair: pair[0])


def _log_poses(path: Path) -> dict[int, Floats]:
    """Frame number → pose, from blocks of a line of numbers and a 4 x 4 matrix."""
    lines = _lines(path)
    if len(lines) % 5:
        raise MapError(f"'{path}' has {len(lines)} lines; each frame has 5: three numbers, then a matrix of 4 x 4")
    poses = {}
    for start in range(0, len(lines), 5):
        try:
            number = int(lines[start][0])
            matrix = np.array([[float(word) for word in row] for row in lines[start + 1 : start + 5]])
        except (ValueError, IndexError):
            matrix = np.zeros(0)
        if matrix.shape != (4, 4):
            raise MapError(f"'{path}': frame block {start // 5} is no frame number with a 4 x 4 matrix")
        poses[number] = matrix
    return poses


def _nearest(listed: Sequence[tuple[float, T]], time_s: float) -> T | None:
    """What is nearest in time of a list that is sorted by it; None where nothing is near enough."""
    after = bisect_left(listed, time_s, key=lambda pair: pair[0])
    around = listed[max(0, after - 1) : after + 1]
    best = min(around, key=lambda pair: abs(pair[0] - time_s), default=None)
    return None if best is None or abs(best[0] - time_s) > SAME_S else best[1]
