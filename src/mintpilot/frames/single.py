"""One picture with its depth, and no pose."""

from __future__ import annotations

from collections.abc import Iterator

from mintpilot.core.errors import MapError
from mintpilot.core.observation import RawFrame
from mintpilot.core.ports import FrameSource, SourceOptions
from mintpilot.frames.intrinsics import kinect, read_intrinsics
from mintpilot.frames.pictures import joined, read_color, read_depth


class SinglePicture(FrameSource):
    """The view in two files.

    Args:
        where: not used; the files are in the options.
        options: ``color`` and ``depth`` are required; without ``intrinsics`` a Kinect's are assumed and said.

    Raises:
        MapError: one of the two files is not given.
    """

    def __init__(self, where: str, options: SourceOptions) -> None:
        del where
        if options.color is None or options.depth is None:
            raise MapError("a single picture needs both --color FILE and --depth FILE")
        self._color, self._depth, self._options = options.color, options.depth, options

    @property
    def z_is_up(self) -> bool:
        """False: there is no pose."""
        return False

    def frames(self) -> Iterator[RawFrame]:
        """The one picture. Raises `MapError` when it cannot be used."""
        depth = read_depth(self._depth, self._options.depth_unit_m)
        rgb = read_color(self._color)
        height, width = rgb.shape[:2]
        given = self._options.intrinsics
        camera = read_intrinsics(given) if given is not None else kinect(width, height)
        yield joined(rgb, depth, camera, time_s=0.0, pose=None, name=str(self._color))

    def remarks(self) -> tuple[str, ...]:
        """That the lens was assumed, where it was."""
        return () if self._options.intrinsics is not None else (ASSUMED_LENS,)


ASSUMED_LENS = "No intrinsics are given: those of a Kinect are assumed; sizes are wrong where the lens is another."
