"""A RealSense camera. The package is loaded when a camera is asked for."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from mintpilot.core.errors import DeviceError, MissingPartError
from mintpilot.core.observation import RawFrame
from mintpilot.core.ports import FrameSource, SourceOptions
from mintpilot.frames.intrinsics import checked_camera
from mintpilot.frames.pictures import as_color, as_depth, joined

WAIT_MS = 5000
"""How long the next pair of pictures is waited for."""
FRAMES = 30
"""A camera that nobody tells where it is needs no more than these."""


class RealSense(FrameSource):
    """Colour and depth of a RealSense camera, the depth registered to the colour. It does not know where it is.

    Args:
        where: the camera's serial number; empty: the first one.
        options: ``longest`` bounds the number of frames.
        library: the ``pyrealsense2`` module; None: loaded here.
        frames: gives framesets one after the other in place of a pipeline, e.g. the syncer of a ``software_device``;
            returns None when there are no more.

    Raises:
        MissingPartError: ``pyrealsense2`` is not installed, or cannot be loaded.
    """

    def __init__(self, where: str, options: SourceOptions, *, library: Any = None, frames: Any = None) -> None:
        self._serial, self._options, self._frames = where, options, frames
        self._rs = library if library is not None else _library()

    @property
    def z_is_up(self) -> bool:
        """False: there is no pose."""
        return False

    def remarks(self) -> tuple[str, ...]:
        """Nothing."""
        return ()

    def frames(self) -> Iterator[RawFrame]:
        """Pictures until enough were taken. Raises `DeviceError` when the camera is not there or falls silent."""
        if self._frames is not None:
            yield from self._converted(self._frames)
            return
        pipeline, config = self._rs.pipeline(), self._rs.config()
        if self._serial:
            config.enable_device(self._serial)
        config.enable_stream(self._rs.stream.depth)
        config.enable_stream(self._rs.stream.color, self._rs.format.rgb8)
        try:
            pipeline.start(config)
        except RuntimeError as error:
            raise DeviceError(f"no RealSense camera answers ({error}); plug one in, or give a recording") from None
        align = self._rs.align(self._rs.stream.color)

        def waited() -> Any:
            try:
                return align.process(pipeline.wait_for_frames(WAIT_MS))
            except RuntimeError as error:
                raise DeviceError(f"the RealSense camera fell silent ({error}); check its cable") from None

        try:
            yield from self._converted(waited)
        finally:
            pipeline.stop()

    def _converted(self, take: Any) -> Iterator[RawFrame]:
        for _ in range(self._options.longest if self._options.live else min(FRAMES, self._options.longest)):
            frameset = take()
            if frameset is None:
                return
            color, depth = frameset.get_color_frame(), frameset.get_depth_frame()
            if not color or not depth:
                continue
            lens = color.get_profile().as_video_stream_profile().get_intrinsics()
            camera = checked_camera(
                width=lens.width,
                height=lens.height,
                fx=lens.fx,
                fy=lens.fy,
                cx=lens.ppx + 0.5,
                cy=lens.ppy + 0.5,
                name="RealSense",
            )
            unit_m = self._options.depth_unit_m or depth.get_units()
            yield joined(
                as_color(np.asanyarray(color.get_data()).copy(), "RealSense colour"),
                as_depth(np.asanyarray(depth.get_data()).copy(), unit_m, "RealSense depth"),
                camera,
                time_s=1e-3 * float(depth.get_timestamp()),
                pose=None,
                name="RealSense",
            )


def _library() -> Any:
    try:
        import pyrealsense2
    except ImportError as error:
        raise MissingPartError(
            f"RealSense cameras need the package 'pyrealsense2' ({error}); pip install 'mintpilot[realsense]', "
            "and on Debian apt install libusb-1.0-0"
        ) from None
    return pyrealsense2
